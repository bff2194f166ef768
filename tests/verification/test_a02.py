"""A02: an elastic bar thrown at a rigid wall, 20 to 100 elements, against d'Alembert."""

import numpy as np
import pytest

import results
import runs
import semidiscrete as discrete
import softway as sw
from exact_thrown import Thrown

EXACT = Thrown(gap=0.3)


@pytest.fixture(scope="module")
def courant() -> dict[int, runs.Record]:
    """20 and 100 elements with h c = edge."""
    return {n: runs.thrown(n, sw.Energy(), step=1.0 / n) for n in (20, 100)}


def test_case() -> None:
    """All but the overshoot of the force, see below."""
    assert results.missed("A02") == {"overshoot of contact force"}


@pytest.mark.parametrize("cells", [20, 50, 100])
def test_the_force_overshoots_at_first(cells: int) -> None:
    """The case admits 1.1; the rule gives 1.25 to 1.36 on every mesh.

    It is the mean force of the first slabs.  The contact node has no inertia, so the first node behind it stops against
    the spring of one element: the front of the wave is as steep as the mesh can carry, and overshoots like a truncated
    Fourier series.  Refinement shortens it and does not lower it; after two element transits the force is 1 with the
    root mean square errors asserted here.
    """
    march = results.thrown(cells)
    assert 1.25 <= march.force.max() <= 1.36
    assert march.middles[np.argmax(march.force)] < EXACT.touch + 3.0 / cells


@pytest.mark.parametrize(("cells", "most"), [(20, 0.08), (100, 0.05)])
def test_with_the_step_of_an_element_transit(cells: int, most: float, courant: dict[int, runs.Record]) -> None:
    march, transit = courant[cells], 1.0 / cells
    assert march.kinds == ["touch", "release"]
    assert march.first("touch") == pytest.approx(EXACT.touch, abs=1e-10)
    assert abs(march.first("release") - EXACT.release) <= 2.5 * transit
    assert march.force_error(EXACT.touch + 2 * transit, EXACT.release - 2 * transit, 1.0) <= most
    assert 1.25 <= march.force.max() <= 1.36


@pytest.mark.parametrize(("cells", "most"), [(20, 0.08), (50, 0.05), (100, 0.03)])
def test_with_the_automatic_step(cells: int, most: float) -> None:
    march, transit = results.thrown(cells), 1.0 / cells
    assert march.kinds == ["touch", "release"]
    assert march.first("touch") == pytest.approx(EXACT.touch, abs=1e-10)
    assert abs(march.first("release") - EXACT.release) <= 0.8 * transit
    assert march.force_error(EXACT.touch + 2 * transit, EXACT.release - 2 * transit, 1.0) <= most


@pytest.mark.parametrize("cells", [20, 50, 100])
def test_the_energy_rule_keeps_what_it_promises(cells: int) -> None:
    """Energy, no penetration at slab ends, no power of the contact force, momentum balanced by the impulse."""
    march = results.thrown(cells)
    assert np.abs(march.error).max() <= 1e-12 * EXACT.energy
    assert march.gap.min() >= -1e-12
    assert march.power.max() <= 1e-12 * EXACT.energy
    assert march.force.min() >= 0.0
    assert march.impulse == pytest.approx(1.0 - march.momentum[-1], abs=1e-12)


def test_the_ends_follow_the_exact_bar() -> None:
    march = results.thrown(100)
    assert np.abs(march.displacement[:, -1] - EXACT.tip(march.times)).max() <= 0.012
    assert np.abs(march.displacement[:, 0] - EXACT.rear(march.times)).max() <= 0.012


def test_the_errors_fall_with_the_mesh() -> None:
    release = [abs(results.thrown(n).first("release") - EXACT.release) for n in (20, 50, 100)]
    speed = [abs(results.thrown(n).momentum[-1] + 1.0) for n in (20, 50, 100)]
    assert runs.order(release, [1 / 20, 1 / 50, 1 / 100]) >= 0.9
    assert runs.order(speed, [1 / 20, 1 / 50, 1 / 100]) >= 0.6


@pytest.mark.parametrize(
    ("rule", "mass", "lost"),
    [
        (sw.Paper(), sw.Consistent(), 2.0 / 60.0),
        (sw.Impulse(), sw.Consistent(), 1.0 / np.linalg.inv(discrete.bar(20).mass)[-1, -1]),
        (sw.Impulse(), sw.Lumped(), 1.0 / 40.0),
        (sw.Paper(), sw.Lumped(), 1.0 / 40.0),
    ],
)
def test_a_node_with_inertia_loses_the_theoretical_energy(
    rule: sw.Paper | sw.Impulse, mass: sw.Consistent | sw.Lumped, lost: float
) -> None:
    """Fractions of the kinetic energy at the first touch of 20 elements: 2/(3N), 1/(m (M^-1)_tip), 1/(2N)."""
    march = runs.thrown(20, rule, mass=mass, step=0.01, until=1.0)
    assert march.kinds == ["touch"]
    assert march.first("touch") == pytest.approx(0.3, abs=1e-12)
    assert march.dissipation[-1] / EXACT.energy == pytest.approx(lost, rel=1e-12)


@pytest.mark.parametrize(("cells", "factor"), [(2, 0.01), (20, 0.5)])
def test_located_instants_give_the_same_motion(cells: int, factor: float) -> None:
    """With the instants located no scalar is needed; both forms agree to O(h^2), and both keep the energy to 1e-12."""
    for step in (0.05, 0.025):
        pair = [runs.thrown(cells, sw.Energy(located=x), step=step, until=2.8) for x in (False, True)]
        assert all(np.abs(m.error).max() <= 1e-12 * EXACT.energy for m in pair)
        assert all(m.gap.min() >= -1e-12 and m.kinds == ["touch", "release"] for m in pair)
        assert abs(pair[0].first("release") - pair[1].first("release")) <= factor * step**2
