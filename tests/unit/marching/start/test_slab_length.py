"""Automatic length of a slab: scaled masses slow the waves down, by the root of the factor."""

import pytest

import softway as sw
from softway.bodies import Off, Scaled
from softway.bodies.inertia.inertia_scaling import Full, Inertia
from softway.scenario.checks.scales import BodyScales

BAR = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=10), material=sw.LinearElastic(E=1.0), density=1.0)


def checked(inertia: Inertia, solver: object = sw.FixedPoint()) -> tuple[float, BodyScales]:
    """Slab length and scales of a bar."""
    held = sw.Solid(mesh=BAR.mesh, material=BAR.material, density=1.0, supports=(sw.bodies.Fixed(on="left"),))
    scenario = sw.Scenario(bodies={"bar": held}, time=sw.Time(end=1000.0), inertia=inertia, solver=solver)  # type: ignore[arg-type]
    found = sw.check(scenario)
    return found.step, found.bodies["bar"]


@pytest.mark.parametrize("solver", [sw.FixedPoint(), sw.Newton(), sw.Explicit()])
@pytest.mark.parametrize("factor", [0.01, 4.0, 100.0])
def test_the_step_belongs_to_the_scaled_waves(factor: float, solver: object) -> None:
    step, scales = checked(Scaled(factor=factor), solver)
    full, own = checked(Full(), solver)
    assert step / full == pytest.approx(factor**0.5, rel=2e-3)  # slabs divide the time evenly
    assert scales.wave_speed == pytest.approx(own.wave_speed / factor**0.5, rel=1e-12)
    assert scales.stable_step == pytest.approx(own.stable_step * factor**0.5, rel=1e-12)


def test_without_inertia_the_scales_are_those_of_full_inertia() -> None:
    assert checked(Off())[1] == checked(Scaled(factor=1.0))[1]
