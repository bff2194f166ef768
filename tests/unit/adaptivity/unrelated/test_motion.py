"""Motion on a mesh that replaces another one: momentum, spin and energy, though a projection loses short waves."""

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.balances import spin
from softway.adaptivity.unrelated.motion import HeavySolid, balanced_on, moved_on


def heavy(cells: int) -> HeavySolid:
    """A square of so many cells along each side, with its inertia."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(cells, cells))
    solid = sw.Solid(mesh=mesh, material=sw.J2(E=1.0, nu=0.3, yield_stress=0.1), density=2.0)
    model = sw.build(sw.Scene(bodies={"square": solid}))
    return HeavySolid(part=model.parts[0], mass=model.mass, follow=model.follow)


@pytest.mark.parametrize(("aim", "books"), [(1.0, False), (1.05, False), (3.0, True)])
def test_energy_that_the_projection_loses_comes_back(aim: float, books: bool) -> None:
    """A wave of two long cells has a sixth of its energy on them; much more than it had is booked."""
    fine, coarse = heavy(12), heavy(6)
    x = fine.points
    wave = np.sin(6.0 * np.pi * x[:, :1]) * [0.0, 1.0]
    given = [0.2, -0.1] + 0.3 * np.stack([-x[:, 1], x[:, 0]], axis=1) + wave
    still = np.zeros_like(given)
    found = moved_on(fine, coarse, still, given)
    before = fine.kinetic(given)
    assert coarse.kinetic(found) < 0.6 * before
    velocity = balanced_on(fine, coarse, still, (given, found), aim * before)
    momenta = [mass.mass @ field for mass, field in ((fine, given), (coarse, velocity))]
    assert momenta[1].sum(axis=0) == pytest.approx(momenta[0].sum(axis=0), rel=1e-12)
    assert spin(coarse.points, momenta[1]) == pytest.approx(spin(x, momenta[0]), rel=1e-12)
    assert (coarse.kinetic(velocity) == pytest.approx(aim * before, rel=1e-12)) != books
