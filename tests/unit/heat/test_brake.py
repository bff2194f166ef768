"""Heat of a braking block that enters a half space: surface temperature, and heat as exact as the kinetic energy."""

from functools import cache

import numpy as np
import pytest

import softway as sw
from softway.meshes.generators.graded import geometric

heat = sw.heat
GREATEST, AT_END = 53.86994034088822, 38.091800117156815
"""Rise of the surface temperature by Duhamel's integral [K]."""


@cache
def braked(step: float, damped: bool) -> tuple[heat.HeatStep, ...]:
    """Half space under 1 MW/m^2 that falls to zero in 2 s."""
    x = np.array([*np.linspace(0.0, 6e-3, 31), *geometric(6e-3, 0.1, 40, 30.0)[1:]])
    cells = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    mesh = sw.Mesh(points=x[:, None], blocks={"bar2": cells}).with_tag("surface", lambda p: p[:, 0] == 0.0)
    law = heat.Conduction(conductivity=50.0, capacity=500.0)
    body = heat.Conductor(mesh=mesh, law=law, density=7800.0, temperature=300.0)
    falls = sw.bodies.Ramp(times=(0.0, 2.0), factors=(1.0, 0.0))
    flux = heat.HeatFlux(on="disc.surface", value=1e6, ramp=falls)
    return tuple(
        heat.march_heat(heat.HeatScene(bodies={"disc": body}, loads=(flux,)), until=2.0, step=step, damped=damped)
    )


def surface(step: float, damped: bool = True) -> np.ndarray:
    return np.array([found.temperature["disc"][0] - 300.0 for found in braked(step, damped)])


@pytest.mark.parametrize("step", [0.02, 0.1])
def test_the_surface_is_as_hot_as_duhamel_found(step: float) -> None:
    rise = surface(step)
    assert rise.max() == pytest.approx(GREATEST, rel=1e-3)
    assert rise[-1] == pytest.approx(AT_END, rel=2e-3)


def test_without_a_damped_slab_long_slabs_ring() -> None:
    assert abs(surface(0.1, damped=False).max() / GREATEST - 1.0) > 1e-2
    assert abs(surface(0.02, damped=False).max() / GREATEST - 1.0) < 1e-3


def test_the_heat_is_the_kinetic_energy() -> None:
    """The power of friction falls linearly, so that half the product of its start and 2 s is the energy."""
    last = braked(0.1, True)[-1]
    assert last.ledger.heat_in == pytest.approx(0.5 * 1e6 * 2.0, rel=1e-12)
    assert last.ledger.relative_error < 1e-12
