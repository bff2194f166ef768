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
    assert results.missed("A02") == set()


@pytest.mark.parametrize(("cells", "most"), [(20, 1.1), (50, 1.1), (100, 1.1)])
def test_the_force_starts_without_overshoot(cells: int, most: float) -> None:
    """The inertia of the contact node, spread over five cells, comes back as a force of 1 + 1/15 (theory/overshoot)."""
    march = results.thrown(cells)
    assert 1.0 + 1.0 / 15.0 - 0.01 <= march.force.max() <= most
    assert march.error[-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("spread", "peak"), [(1, 1.305), (3, 1.111), (8, 1.042)])
def test_the_overshoot_follows_the_spread(spread: int, peak: float) -> None:
    """All the mass on the first node: 1.305; over k cells 1 + 1/(3 k)."""
    march = runs.thrown(100, sw.Energy(spread=spread))
    assert march.force.max() == pytest.approx(peak, abs=0.015)


@pytest.mark.parametrize(("cells", "most"), [(20, 0.08), (100, 0.05)])
def test_with_the_step_of_an_element_transit(cells: int, most: float, courant: dict[int, runs.Record]) -> None:
    march, transit = courant[cells], 1.0 / cells
    assert march.kinds == ["touch", "release"]
    assert march.first("touch") == pytest.approx(EXACT.touch, abs=1e-10)
    assert abs(march.first("release") - EXACT.release) <= 2.5 * transit
    assert march.force_error(EXACT.touch + 2 * transit, EXACT.release - 2 * transit, 1.0) <= most
    assert march.force.max() <= 1.12


@pytest.mark.parametrize(("cells", "most"), [(20, 0.08), (50, 0.05), (100, 0.03)])
def test_with_the_automatic_step(cells: int, most: float) -> None:
    march, transit = results.thrown(cells), 1.0 / cells
    assert march.kinds == ["touch", "release"]
    assert march.first("touch") == pytest.approx(EXACT.touch, abs=1e-10)
    assert abs(march.first("release") - EXACT.release) <= 0.9 * transit
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
    assert runs.order(release, [1 / 20, 1 / 50, 1 / 100]) >= 0.85
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


@pytest.mark.parametrize(("cells", "factor"), [(2, 0.0102), (20, 0.5)])
def test_located_instants_give_the_same_motion(cells: int, factor: float) -> None:
    """With the instants located no scalar is needed; both forms agree to O(h^2), and both keep the energy to 1e-12."""
    for step in (0.05, 0.025):
        pair = [runs.thrown(cells, sw.Energy(located=x), step=step, until=2.8) for x in (False, True)]
        assert all(np.abs(m.error).max() <= 1e-12 * EXACT.energy for m in pair)
        assert all(m.gap.min() >= -1e-12 and m.kinds == ["touch", "release"] for m in pair)
        assert abs(pair[0].first("release") - pair[1].first("release")) <= factor * step**2
