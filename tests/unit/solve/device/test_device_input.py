"""Refusals of devices; those without Warp are tested wherever it is installed or not."""

import importlib.util
from typing import Any

import pytest

import softway as sw

SOFT = sw.NeoHookean(E=1e4, nu=0.3)


def scene(material: Any = SOFT, **changes: Any) -> sw.Scene:
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2))
    return sw.Scene(bodies={"block": sw.Solid(mesh=mesh, material=material, density=1.0, **changes)})


@pytest.mark.parametrize("name", ["gpu", "cuda", "cuda:x", ""])
def test_names_that_no_device_has(name: str) -> None:
    with pytest.raises(sw.InputError, match="no device.*\n.*'cuda:0'") as told:
        sw.solve.Device(device=name)
    assert told.value.where == "device"
    with pytest.raises(sw.InputError, match="no device"):
        sw.Explicit(device=name)


METHODS = {"operator": sw.FixedPoint(operator=sw.solve.Device()), "explicit": sw.Explicit(device="auto")}


@pytest.mark.parametrize("kind", METHODS)
def test_without_warp_the_remedy_tells_how_to_install_it(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    own = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *a: None if name == "warp" else own(name, *a))
    with pytest.raises(sw.InputError, match="without Warp") as told:
        next(sw.march(scene(), until=0.01, method=METHODS[kind]))
    assert "pip install 'softway[gpu]'" in told.value.remedy
    assert told.value.where.startswith("solver")


def test_a_device_that_is_not_there(device: str) -> None:
    with pytest.raises(sw.InputError, match="'cuda:77' is no device of this machine") as told:
        next(sw.march(scene(), until=0.01, method=sw.FixedPoint(operator=sw.solve.Device(device="cuda:77"))))
    assert told.value.where == "solver.operator.device"


@pytest.mark.parametrize("kind", METHODS)
def test_solids_that_no_device_evaluates(kind: str, device: str) -> None:
    plastic = sw.J2(E=1e4, nu=0.3, yield_stress=10.0)
    with pytest.raises(sw.InputError, match="with the solid 'block'\n.*LinearElastic"):
        next(sw.march(scene(plastic), until=0.01, method=METHODS[kind]))
