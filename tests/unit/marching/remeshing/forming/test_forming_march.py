"""Forging with meshes that are replaced: volume, energy and force, and corners that follow a fold onto the platen."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from forging import HEIGHT, KEPT, LAW, force, forged, places, press, volume

import softway as sw
from softway.adaptivity.rezoning.quality import cell_quality
from softway.errors import InputError
from softway.laws.law import Material
from softway.marching.remeshing.forming.formable import formable, replacements
from softway.meshes.adaptive.adapt import Adapt


@pytest.mark.parametrize(
    "material",
    [
        pytest.param(LAW, id="norton_hoff", marks=pytest.mark.minutes),
        pytest.param(sw.J2(E=1e3, nu=0.3, yield_stress=1.0), id="j2", marks=pytest.mark.slow),
    ],
)
def test_force_volume_and_energy_through_new_meshes(material: Material) -> None:
    kept = forged(KEPT, 0.3, 15, (6, 5), material)
    new = forged(sw.meshes.Remesh(ratio=1.3, shortened=0.0), 0.3, 15, (6, 5), material)
    changes = [one for one in new if one.exchanges]
    assert len(changes) >= 2
    for one in changes:
        found = one.exchanges["body"]
        assert abs(found.volume) < 1e-13
        assert abs(found.energy) < 1e-13 * one.ledger.work_external
    assert force(new[-1]) == pytest.approx(force(kept[-1]), rel=5e-3)
    assert volume(new[-1]) == pytest.approx(volume(kept[-1]), rel=1e-5)
    assert abs(new[-1].ledger.energy_error) < 1e-12 * new[-1].ledger.work_external


@pytest.mark.slow
def test_the_corner_follows_the_fold_onto_the_platen() -> None:
    steps = forged(sw.meshes.Remesh(), 0.74, 40, (12, 10))
    flank = [one.after.closed["flank"].any() for one in steps]
    assert any(flank)
    folded = [k for k in range(1, len(steps)) if steps[k].exchanges and flank[k - 1]]
    assert folded  # a side of the flank becomes one of the end face, with its force
    for k in folded:
        old, new = steps[k - 1].after.pressure, steps[k].before.pressure
        assert old["flank"].sum() > 1e-3 * old["top"].sum()
        assert new["flank"].sum() + new["top"].sum() == pytest.approx(old["flank"].sum() + old["top"].sum(), rel=1e-12)
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
        forged(sw.meshes.Remesh(), 0.1, 2, (2, 2), material)


@pytest.mark.parametrize("wrong", [{"quality": 1.0}, {"angle": -1.0}, {"ratio": 1.0}, {"every": 0}, {"shortened": 2.0}])
def test_wrong_limits(wrong: dict[str, float]) -> None:
    with pytest.raises(InputError, match=next(iter(wrong))):
        sw.meshes.Remesh(**wrong)  # type: ignore[arg-type]


REFUSED: dict[str, tuple[dict[str, Any], dict[str, Any], dict[str, Any], str]] = {
    "traction": ({}, {"loads": (sw.Traction(on="body.right", value=(1.0, 0.0)),)}, {}, r"loads\[0\]: a traction on"),
    "adapts": ({"adapt": Adapt(levels=1)}, {"inertia": sw.bodies.Full()}, {}, "whose|adapts"),
    "travel": (
        {
            "supports": (
                sw.bodies.Guided(
                    on="bottom", components="y", travel=sw.bodies.SmoothSteps(times=(0.0, 1.0), points=(0.0, 0.1))
                ),
            )
        },
        {},
        {},
        "bodies.body.supports: Guided",
    ),
    "shock": (
        {"shock": sw.bodies.BulkViscosity()},
        {"inertia": sw.bodies.Full()},
        {},
        "bodies.body.shock: bulk viscosity",
    ),
    "explicit": ({}, {"inertia": sw.bodies.Full()}, {"method": sw.Explicit()}, "solver: Explicit"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_scenes_without_new_meshes(name: str) -> None:
    """With numbers they are refused; with auto the mesh stays."""
    solid, scene, given, words = REFUSED[name]
    method = given.get("method", sw.FixedPoint())
    for how in (sw.meshes.Remesh(), "auto"):
        plain = press((2, 2), how)  # type: ignore[arg-type]
        body = replace(plain.bodies["body"], **solid)
        made = replace(plain, bodies={**plain.bodies, "body": body}, **scene)
        if how != "auto":
            with pytest.raises(InputError, match=words):
                sw.march(made, until=1e-3, step=1e-3, **given)
        else:
            model, stay = formable(sw.build(made), method)
            assert set(stay) == {"body"} and not replacements(model.scene)
