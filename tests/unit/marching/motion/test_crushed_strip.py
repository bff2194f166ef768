"""An elastic-plastic strip that is crushed and buckles: slabs are solved at the first attempt, and energy is kept."""

from functools import cache

import numpy as np
import pytest

import softway as sw
from softway.marching.results.step import Step

E = 1e6
SLABS = 50


def strip(*, inert: bool) -> sw.Scene:
    """Two by fifty cells with hardening of a hundredth of E, pushed down at 1 m/s; a weight to the side bends it."""
    solid = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.04, 1.0), cells=(2, 50), origin=(-0.02, 0.0)),
        material=sw.J2(E=E, nu=0.3, yield_stress=0.01 * E, hardening=sw.laws.LinearHardening(modulus=0.01 * E)),
        density=1000.0,
        supports=(
            sw.Fixed(on="bottom"),
            sw.Driven(on="top", components="y", velocity=-1.0),
            sw.Fixed(on="top", components="x"),
        ),
    )
    inertia = {} if inert else {"inertia": sw.bodies.Off()}
    return sw.Scene(bodies={"strip": solid}, loads=(sw.Gravity(acceleration=(1.0, 0.0)),), **inertia)


@cache
def crushed(inert: bool, slabs: int = SLABS) -> tuple[Step, ...]:
    """All slabs to half of the height."""
    return tuple(sw.march(strip(inert=inert), until=0.5, step=0.5 / slabs))


def place(steps: tuple[Step, ...]) -> np.ndarray:
    """Displacements (n, 2) at the end [m]."""
    return steps[-1].after.displacement["strip"]


@pytest.mark.slow
def test_with_inertia_no_slab_is_tried_again() -> None:
    """Where the scalar jumped between its bounds, 371 attempts failed and the march ended at half of its way."""
    steps = crushed(True)
    assert sum(len(s.report.rejections) for s in steps) == 0
    assert steps[-1].after.time == pytest.approx(0.5)
    assert len(steps) < 2 * SLABS
    report = steps[-1].report
    assert 0 < report.renewals < report.factorisations
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * steps[-1].ledger.work_external


def test_without_inertia_slabs_keep_their_length() -> None:
    """A large scalar only weighs works; it moves nothing, and halved the slabs to 142 before."""
    steps = crushed(False)
    assert len(steps) == SLABS and not any(s.report.rejections for s in steps)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-5 * steps[-1].ledger.work_external


@pytest.mark.parametrize(
    ("inert", "works", "places"), [(False, 2e-3, 5e-4), pytest.param(True, 3e-2, 3e-2, marks=pytest.mark.slow)]
)
def test_slabs_of_a_quarter_have_the_same_answer(inert: bool, works: float, places: float) -> None:
    """Work and dissipation relative to the work, places relative to the height."""
    long, short = crushed(inert), crushed(inert, 4 * SLABS)
    one, other = long[-1].ledger, short[-1].ledger
    assert one.work_external == pytest.approx(other.work_external, rel=works)
    assert one.dissipation == pytest.approx(other.dissipation, abs=works * other.work_external)
    assert np.abs(place(long) - place(short)).max() < places


def test_the_march_goes_on_from_any_slab_with_the_same_bits() -> None:
    """After slabs with renewed operators, from march states without the operator."""
    steps = crushed(True)
    renewed = [k for k in range(1, len(steps)) if steps[k].report.renewals > steps[k - 1].report.renewals]
    for k in renewed[:2]:
        again = sw.march(strip(inert=True), until=0.5, step=0.5 / SLABS, state=steps[k].march_state)
        for one, other in zip(again, steps[k + 1 : k + 3], strict=False):
            np.testing.assert_array_equal(one.after.displacement["strip"], other.after.displacement["strip"])
            assert one.report.renewals == other.report.renewals
