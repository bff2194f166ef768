"""The element of the paper, bilinear in space and time, on the mesh whose slab is the transit of an edge.

With the virtual time function constant, a consistent mass and h = edge / c the difference equation of the free nodes is
(1 + dx^2/6) dt^2 u = (1 + dt^2/6) dx^2 u, with dx^2, dt^2 the second differences: the factor is the same on both sides,
and what remains is solved by every wave of d'Alembert.  The element sits on its limit of stability there.
"""

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.cases.waves.a06_struck_continuum_bar import HAT
from softway.apps.verify.exact import bar as waves
from softway.apps.verify.scenes import bars

WALL = sw.obstacles.HalfSpace(point=1.0 + bars.OUT_OF_REACH, normal=-1.0)
meshes = pytest.mark.parametrize("cells", [10, 20])


def free_motion(cells: int, bar: sw.Solid, until: float) -> bars.Record:
    """The march with h = edge / c."""
    return bars.run(bar, WALL, sw.contact.Impulse(), until=until, step=1.0 / cells, weight=sw.model.Momentum())


@meshes
def test_the_hat_of_the_second_example_is_nodally_exact(cells: int) -> None:
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=bars.ELASTIC,
        density=1.0,
        velocity=bars.HAT,
        supports=(sw.Fixed(on="left"),),
    )
    march = free_motion(cells, bar, until=6.0)
    exact = waves.solve(waves.Bar(velocity=HAT, far="fixed"), 6.5)
    s = np.linspace(1.0, 0.0, cells + 1)
    table = np.array([exact.displacement(s, t) for t in march.times])
    np.testing.assert_allclose(march.displacement, table, rtol=0.0, atol=1e-13)


@meshes
def test_a_vibration_is_nodally_exact(cells: int) -> None:
    """The third mode of the fixed bar and the second of the free one, from rest."""
    x = np.linspace(0.0, 1.0, cells + 1)
    for wave, supports, omega in (
        (np.sin(2.5 * np.pi * x), (sw.Fixed(on="left"),), 2.5 * np.pi),
        (np.cos(2.0 * np.pi * x), (), 2.0 * np.pi),
    ):
        bar = sw.Solid(
            mesh=sw.meshes.Interval(length=1.0, cells=cells),
            material=bars.ELASTIC,
            density=1.0,
            displacement=0.01 * wave[:, None],
            supports=supports,
        )
        march = free_motion(cells, bar, until=3.0)
        table = 0.01 * np.cos(omega * march.times)[:, None] * wave
        np.testing.assert_allclose(march.displacement, table, rtol=0.0, atol=1e-13)


@meshes
def test_free_flight_with_a_travelling_wave_is_nodally_exact(cells: int) -> None:
    """What a bar does after a rebound: it flies with a wave that runs from end to end."""
    length, fast = 1.0, ((0.0, 0.5, -1.0, -0.5), (0.5, 1.0, -0.5, -1.0))
    at = (0.0, 0.5, 1.0)
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=length, cells=cells),
        material=bars.ELASTIC,
        density=1.0,
        velocity=sw.bodies.Profile(at=at, values=(-1.0, -0.5, -1.0)),
    )
    march = free_motion(cells, bar, until=3.0)
    exact = waves.solve(waves.Bar(velocity=fast), 3.5)
    s = np.linspace(1.0, 0.0, cells + 1)
    table = np.array([exact.displacement(s, t) for t in march.times])
    np.testing.assert_allclose(march.displacement, table, rtol=0.0, atol=1e-13)


def test_a_longer_slab_is_refused() -> None:
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=10), material=bars.ELASTIC, density=1.0)
    with pytest.raises(sw.InputError, match="beyond the stability limit 0.1 s of Momentum"):
        bars.run(bar, WALL, sw.contact.Impulse(), until=1.001, step=0.1001, weight=sw.model.Momentum())


def test_with_the_end_peaks_it_disperses() -> None:
    """The same mesh and slab with the default weight: exactness belongs to the constant one."""
    march = bars.struck(40, sw.contact.Impulse(), velocity=bars.HAT, step=1.0 / 40.0, until=8.0)
    exact = waves.solve(waves.Bar(velocity=HAT, far="fixed"), 8.5)
    assert 1e-3 <= np.abs(march.displacement[:, -1] - exact.tip(march.times)).max() <= 0.05
