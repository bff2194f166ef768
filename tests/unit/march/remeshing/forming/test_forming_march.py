"""Forging with rezoned meshes: volume, energy and force, and corners that follow a fold onto the platen."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.volume import volume_of
from softway.arrays import Array
from softway.errors import InputError
from softway.laws.law import Material
from softway.march.remeshing.forming.forming_march import FormedStep, forming_march
from softway.march.remeshing.forming.remesh import Remesh

HEIGHT = 0.75
LAW = sw.laws.NortonHoff(K=1.0, m=0.3)


def press(cells: tuple[int, int], material: Material = LAW) -> sw.Scene:
    """Press of case E02, with contacts on the flank."""
    mesh = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=cells).build()
    body = sw.Solid(
        mesh=mesh.with_tag("flank", lambda x: (x[:, 0] > 0.999) & (x[:, 1] < 0.999 * HEIGHT)),
        material=material,
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="mean",
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, HEIGHT), normal=(0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    rough = sw.laws.NortonHoffFriction(alpha=0.3, p=0.3, K=1.0)
    contacts = tuple(
        sw.Contact(between=(f"body.{tag}", "platen"), name=tag, friction=rough) for tag in ("top", "flank")
    )
    return sw.Scene(bodies={"body": body, "platen": platen}, contacts=contacts, inertia=sw.bodies.Off())


def forged(
    how: Remesh, reduction: float, slabs: int, cells: tuple[int, int], material: Material = LAW
) -> list[FormedStep]:
    until = reduction * HEIGHT
    return list(forming_march(press(cells, material), {"body": how}, until=until, step=until / slabs))


def places(one: FormedStep) -> Array:
    return np.asarray(one.model.points + one.step.after.displacement["body"])


def volume(one: FormedStep) -> float:
    part = one.model.parts[0]
    return volume_of(part.mesh.blocks, part.internal.section, places(one))


def force(one: FormedStep) -> float:
    return sum(c.force_n for c in one.step.ledger.contacts.values())


@pytest.mark.parametrize("material", [LAW, sw.J2(E=1e3, nu=0.3, yield_stress=1.0)], ids=["norton_hoff", "j2"])
def test_force_volume_and_energy_through_new_meshes(material: Material) -> None:
    kept = forged(Remesh(quality=0.0, angle=0.0, ratio=1e9, shortened=0.0), 0.3, 15, (6, 5), material)
    new = forged(Remesh(ratio=1.3, shortened=0.0), 0.3, 15, (6, 5), material)
    changes = [one for one in new if one.exchanges]
    assert len(changes) >= 2
    for one in changes:
        found = one.exchanges["body"]
        assert abs(found.volume) < 1e-13
        assert abs(found.energy) < 1e-13 * one.step.ledger.work_external
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=5e-3)
    assert volume(new[-1]) == pytest.approx(volume(kept[-1]), rel=1e-5)
    assert abs(new[-1].step.ledger.energy_error) < 1e-12 * new[-1].step.ledger.work_external


@pytest.mark.slow
def test_the_corner_follows_the_fold_onto_the_platen() -> None:
    steps = forged(Remesh(), 0.74, 40, (12, 10))
    flank = [one.step.after.closed["flank"].any() for one in steps]
    assert any(flank)
    mesh = steps[-1].model.parts[0].mesh
    assert cell_quality(mesh.blocks, places(steps[-1])).worst[0] > 0.0
    lost = volume(steps[-1]) / (np.pi * HEIGHT) - 1.0
    assert -1e-4 < lost < 0.0  # by the pressure, not by new meshes
    assert sum(abs(one.exchanges["body"].volume) for one in steps if one.exchanges) < 1e-12


@pytest.mark.parametrize(
    ("material", "words"),
    [
        (sw.NeoHookean(E=1.0, nu=0.3), "NeoHookean: the stress depends on the undeformed shape"),
        (sw.J2(E=1.0, nu=0.3, yield_stress=1.0, rate=sw.laws.GreenNaghdi()), "knows the deformation since the start"),
    ],
)
def test_laws_that_need_the_undeformed_shape(material: Material, words: str) -> None:
    with pytest.raises(InputError, match=words):
        forged(Remesh(), 0.1, 2, (2, 2), material)


@pytest.mark.parametrize("wrong", [{"quality": 1.0}, {"angle": -1.0}, {"ratio": 1.0}, {"every": 0}, {"shortened": 2.0}])
def test_wrong_limits(wrong: dict[str, float]) -> None:
    with pytest.raises(InputError, match=next(iter(wrong))):
        Remesh(**wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("remesh", "changed", "words"),
    [
        ({}, {}, "no solid"),
        ({"platen": Remesh()}, {}, "no solid of this name"),
        ({"body": Remesh()}, {"loads": (sw.Traction(on="body.right", value=(1.0, 0.0)),)}, "a traction on"),
    ],
)
def test_scenes_without_new_meshes(remesh: dict[str, Remesh], changed: dict[str, Any], words: str) -> None:
    scene = replace(press((2, 2)), **changed)
    with pytest.raises(InputError, match=words):
        next(forming_march(scene, remesh, until=1.0, step=0.1))
