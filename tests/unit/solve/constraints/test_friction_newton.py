"""The return map, and Newton's method on the forces of rows with friction."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count
from typing import ClassVar

import numpy as np
import pytest

from softway.contact.friction_rows import FrictionRows
from softway.errors import NoConvergence
from softway.laws.friction import Coulomb, NortonHoff, StaticKinetic, Stribeck, Tresca
from softway.laws.friction_law import FrictionLaw
from softway.solve.constraints import friction_newton
from softway.solve.constraints.friction_conditions import (
    GROWN,
    FrictionProblem,
    friction_problem,
    friction_residual,
    gauss_seidel,
    linearised,
)
from softway.solve.constraints.friction_newton import STUCK, KeptNewton, _newton, solve_multipliers
from softway.solve.constraints.return_map import STEEPEST, SlipConditions, return_map
from softway.solve.constraints.turning_slip import chord_force, end_force
from softway.solve.effort import Effort


def slipping(law: FrictionLaw, count: int, k: int = 1, *, sliding: bool = False, ahead: float = 0.0) -> SlipConditions:
    """Rows of unit area, with the slip as speed."""
    friction = FrictionRows(laws=(law,), contact=np.zeros(count, int), area=np.ones(count))
    return SlipConditions(
        friction=friction,
        shift=np.zeros((count, k)),
        speed_factor=1.0,
        unit=1.0,
        ahead=ahead,
        before=np.zeros(count),
        sliding=np.full(count, sliding),
    )


def test_coulomb_is_a_projection():
    trial = np.array([0.5, 2.9, 3.1, 100.0])
    found = return_map(slipping(Coulomb(mu=0.3), 4), trial, np.full(4, 10.0), np.full(4, 7.0))
    assert found.force.tolist() == [0.5, 2.9, 3.0, 3.0]
    assert found.slips.tolist() == [False, False, True, True]


@pytest.mark.parametrize(
    "law",
    [
        NortonHoff(alpha=1.0, p=0.3),
        NortonHoff(alpha=2.0, p=1.0),
        NortonHoff(alpha=1.0, p=3.0),
        Stribeck(mu_s=0.5, mu_k=0.2, v_s=0.3, viscous=0.01),
        Tresca(shear=1.0),
    ],
    ids=lambda law: type(law).__name__,
)
def test_the_force_is_that_of_the_slip_that_is_left(law):
    trial, pressed, stiffness = np.geomspace(0.1, 1e3, 40), np.full(40, 2.0), np.full(40, 0.7)
    found = return_map(slipping(law, 40), trial, pressed, stiffness)
    slip = (trial - found.force) / stiffness
    assert (slip >= 0.0).all()
    resisted = law.resistance(slip[found.slips], pressed[found.slips])[0]
    assert found.force[found.slips] == pytest.approx(resisted, rel=1e-9, abs=1e-13)
    assert (trial[~found.slips] <= law.limit(pressed[~found.slips])).all()


@pytest.mark.parametrize("power", [0.5, 0.8])
def test_the_force_is_found_where_the_extrapolated_speed_reaches_zero(power):
    """Below a third of the speed before there is no force; just above it it rises infinitely steeply."""
    law, n = NortonHoff(alpha=1.0, p=power), 400
    conditions = replace(slipping(law, n, ahead=0.5), before=np.geomspace(1e-3, 10.0, n))
    trial, pressed, stiffness = np.tile(np.geomspace(0.1, 10.0, 20), 20), np.full(n, 2.0), np.full(n, 0.7)
    found = return_map(conditions, trial, pressed, stiffness)
    slip = (trial - found.force) / stiffness
    speed = 1.5 * slip - 0.5 * conditions.before
    least, most = (law.resistance(np.maximum(speed + d, 0.0), pressed)[0] for d in (-1e-13, 1e-13))
    assert (found.force >= least - 1e-12).all() and (found.force <= most + 1e-12).all()


def test_slopes_of_the_return_map_agree_with_differences():
    law = slipping(NortonHoff(alpha=1.0, p=0.6), 5, ahead=0.5)
    trial, pressed, stiffness, d = np.linspace(0.5, 3.0, 5), np.ones(5), np.full(5, 0.7), 1e-6
    up, down = (return_map(law, trial + s, pressed, stiffness).force for s in (d, -d))
    assert return_map(law, trial, pressed, stiffness).steep == pytest.approx((up - down) / (2 * d), rel=1e-7)
    dry = slipping(Coulomb(mu=0.3), 5)
    up, down = (return_map(dry, trial, pressed + s, stiffness).force for s in (d, -d))
    assert return_map(dry, trial, pressed, stiffness).pressure_slope == pytest.approx((up - down) / (2 * d), rel=1e-7)


def test_static_friction_holds_only_what_rests():
    law, one = StaticKinetic(mu_s=0.4, mu_k=0.2), np.ones(1)
    resting, moving = slipping(law, 1), slipping(law, 1, sliding=True)
    assert return_map(resting, 0.3 * one, one, one).force == pytest.approx([0.3])
    assert return_map(moving, 0.3 * one, one, one).force == pytest.approx([0.2])
    assert return_map(resting, 0.5 * one, one, one).force == pytest.approx([0.2])


def problem(seed: int, count: int, k: int, law: FrictionLaw):
    """Rows with a random compliance that couples all of them, some pressed, some lifted, pulled along all ways."""
    rng = np.random.default_rng(seed)
    size = count * (1 + k)
    root = rng.normal(size=(size, size)) / np.sqrt(size)
    compliance = root @ root.T + 0.6 * np.eye(size)
    free = np.concatenate([rng.normal(size=count) - 0.5, rng.normal(size=count * k)])
    return friction_problem(compliance, free, slipping(law, count, k))


def turning(seed: int, count: int) -> np.ndarray:
    """Directions of the slip in the slab before, times ratios of lengths of slabs; some rows did not slip."""
    rng = np.random.default_rng(seed)
    angle, ratio = rng.uniform(-np.pi, np.pi, count), rng.choice([0.0, 0.3, 0.5, 0.9], count)
    return ratio[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def test_the_force_at_the_end_turns_with_the_slip():
    """By the extrapolated direction, less than 30 degrees from the chord; the chord force is its inverse."""
    rng, before = np.random.default_rng(3), turning(3, 500)
    chord = rng.normal(size=(500, 2))
    force = end_force(before, chord)
    size, ratio = np.linalg.norm(chord, axis=1), np.linalg.norm(before, axis=1)
    assert chord_force(before, force) == pytest.approx(chord, abs=1e-14)
    assert np.linalg.norm(force, axis=1) == pytest.approx(size, rel=1e-14)
    turned = np.abs(chord[:, 0] * force[:, 1] - chord[:, 1] * force[:, 0]) / size**2
    assert (turned <= ratio / (1.0 + ratio) + 1e-14).all() and np.sum(chord * force, axis=1).min() > 0.0
    d = -chord / size[:, None]
    e = d + ratio[:, None] * d - before
    assert force == pytest.approx(-(size / np.linalg.norm(e, axis=1))[:, None] * e, abs=1e-14)
    assert not end_force(before, np.zeros((500, 2))).any() and not chord_force(before, np.zeros((500, 2))).any()


@pytest.mark.few(15)
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("law", [Coulomb(mu=0.4), Tresca(shear=0.3), NortonHoff(alpha=0.5, p=0.5)], ids=repr)
def test_forces_that_turn_obey_the_law_and_take_energy(seed, law):
    it = problem(seed, 12, 2, law)
    it = replace(it, law=replace(it.law, turning=turning(seed, 12)))
    x, slips = solve_multipliers(it, np.zeros(36))
    p, s = it.split(x)
    gap, slip = it.split(it.free + it.compliance @ x)
    touch, speed = p > 0.0, np.linalg.norm(slip, axis=1)
    assert gap.min() > -1e-13 and np.abs(gap[touch]).max() < 1e-13
    assert np.abs(slip[touch & ~slips]).max(initial=0.0) < 1e-13
    assert (np.linalg.norm(s, axis=1)[touch & ~slips] <= law.limit(p[touch & ~slips]) + 1e-12).all()
    resisted = np.minimum(law.resistance(speed, p)[0], STEEPEST * p)[:, None]
    chord = -resisted * slip / np.maximum(speed, 1e-300)[:, None]
    assert s[slips] == pytest.approx(end_force(it.law.turning, chord)[slips], abs=1e-10)
    assert (np.sum(s * slip, axis=1)[slips] <= -0.86 * (np.linalg.norm(s, axis=1) * speed)[slips]).all()


@pytest.mark.few(30)
@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("law", [Coulomb(mu=0.4), Tresca(shear=0.3), NortonHoff(alpha=0.5, p=0.5)], ids=repr)
def test_the_forces_obey_the_law(seed, k, law):
    it = problem(seed, 12, k, law)
    x, slips = solve_multipliers(it, np.zeros(12 * (1 + k)))
    p, s = it.split(x)
    gap, slip = it.split(it.free + it.compliance @ x)
    touch = p > 0.0
    assert (p >= 0.0).all()
    assert gap.min() > -1e-13
    assert np.abs(gap[touch]).max() < 1e-13
    size = np.linalg.norm(s, axis=1)
    assert (size[touch & ~slips] <= law.limit(p[touch & ~slips]) + 1e-12).all()
    assert np.abs(slip[touch & ~slips]).max(initial=0.0) < 1e-13
    assert np.abs(s[~touch]).max(initial=0.0) == 0.0
    speed = np.linalg.norm(slip[slips], axis=1)
    resisted = np.minimum(law.resistance(speed, p[slips])[0], STEEPEST * p[slips])
    assert size[slips] == pytest.approx(resisted, abs=1e-11)
    assert np.sum(s[slips] * slip[slips], axis=1) == pytest.approx(-size[slips] * speed, abs=1e-12)


def of_few_rows(
    compliance: list[list[float]], free: list[float], previous: list[float], law: FrictionLaw, unit: float,
    before: list[float], sliding: list[bool],
) -> FrictionProblem:  # fmt: skip
    """Rows in the plane that have slipped in the slab before."""
    count = len(before)
    friction = FrictionRows(laws=(law,), contact=np.zeros(count, int), area=np.full(count, 0.25))
    conditions = SlipConditions(
        friction=friction, shift=np.zeros((count, 1)), speed_factor=0.5, unit=unit, ahead=0.5, before=np.array(before),
        sliding=np.array(sliding),
    )  # fmt: skip
    return friction_problem(np.array(compliance), np.array(free), conditions, np.array(previous))


ONE_ROW = [[499.0, -313.0], [-313.0, 472.0]]
HARD = {
    "a force that rises steeply": of_few_rows(
        ONE_ROW, [-0.0374, 0.0575], [0.00049, 0.00021], NortonHoff(alpha=0.5, p=0.5, K=0.02, v0=0.05), 10.0, [0.0083],
        [True],
    ),
    "a force that falls steeply": of_few_rows(
        ONE_ROW, [-0.000578, -0.00304], [0.00056, 0.000336], Stribeck(mu_s=0.6, mu_k=0.3, v_s=0.02, viscous=0.1), 10.0,
        [0.00298], [True],
    ),
    "a row that sticking at any force would open": of_few_rows(
        [[39260.0, 1433.0, -14328.0, -1026.0], [1433.0, 33547.0, -1153.0, -18316.0],
         [-14328.0, -1153.0, 40263.0, 773.0], [-1026.0, -18316.0, 773.0, 25350.0]],
        [-0.149, -0.0391, -0.0253, 0.277], [5.34e-5, 0.0, 1.6e-5, 0.0], StaticKinetic(mu_s=0.6, mu_k=0.3), 80.0,
        [0.0174, 0.1376], [True, False],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", HARD)
def test_few_rows_always_find_their_forces(case, monkeypatch):
    """By Newton's method: each has one solution, which no sequence of proximal problems has to approach."""
    monkeypatch.setattr(friction_newton, "ROUNDS", 1)
    hard = HARD[case]
    x, slips = solve_multipliers(hard, np.zeros(len(hard.free)))
    obeyed = replace(hard, law=hard.law.with_slipping(slips))
    assert friction_residual(obeyed.firmer(0.3), x).worst < 1e-13
    assert slips.all()


@pytest.mark.parametrize("turns", [False, True])
def test_the_linearised_conditions_agree_with_differences(turns):
    it = problem(3, 6, 2, NortonHoff(alpha=0.5, p=0.7))
    it = replace(it, law=replace(it.law, turning=turning(5, 6))) if turns else it
    x = np.abs(np.random.default_rng(4).normal(size=18)) + 0.5
    look, d = friction_residual(it, x), 1e-7
    columns = [
        (friction_residual(it, x + d * e).missed - friction_residual(it, x - d * e).missed) / (2 * d)
        for e in np.eye(18)
    ]
    assert linearised(it, look) == pytest.approx(np.array(columns).T, abs=1e-6)


@pytest.mark.parametrize("turns", [False, True])
def test_sweeps_over_the_rows_come_to_the_same_forces(turns):
    it = problem(5, 8, 2, Coulomb(mu=0.3))
    it = replace(it, law=replace(it.law, turning=turning(5, 8))) if turns else it
    assert gauss_seidel(it, np.zeros(24), 400) == pytest.approx(solve_multipliers(it, np.zeros(24))[0], abs=1e-9)


def dependent(seed: int, places: int, rows: int) -> FrictionProblem:
    """Rows of which only some are independent, as where corners, edges and faces meet at one place."""
    rng = np.random.default_rng(seed)
    shares = rng.dirichlet(np.ones(places), rows)
    root = rng.normal(size=(3 * places, 3 * places))
    compliance = root @ root.T / (3 * places) + 0.05 * np.eye(3 * places)
    way = np.zeros((3 * rows, 3 * places))
    for k in range(3):
        to, of = (np.arange(n) if k == 0 else n + 2 * np.arange(n) + k - 1 for n in (rows, places))
        way[np.ix_(to, of)] = shares
    free = way @ np.concatenate([rng.normal(size=places) - 1.0, rng.normal(size=2 * places)])
    return friction_problem(way @ compliance @ way.T, free, slipping(Coulomb(mu=0.4), rows, 2))


def test_rows_that_depend_on_each_other_find_forces():
    """Newton's method alone does not settle in all of them."""
    alone, seeds = 0, (*range(40), 120, 159, 220)
    for seed in seeds:
        it = dependent(seed, 4, 10)
        alone += _newton(it, np.zeros(30))[1]
        x, slips = solve_multipliers(it, np.zeros(30))
        p, s = it.split(x)
        gap, slip = it.split(it.free + it.compliance @ x)
        size = np.linalg.norm(s, axis=1)
        assert (p >= 0.0).all() and gap.min() > -1e-12
        assert np.abs(p * gap).max() < 1e-12
        assert (size <= 0.4 * p + 1e-12).all()
        assert np.abs(slip[(p > 0.0) & ~slips]).max(initial=0.0) < 1e-12
        assert np.sum(s[slips] * slip[slips], axis=1) == pytest.approx(
            -size[slips] * np.linalg.norm(slip[slips], axis=1), abs=1e-12
        )
    assert alone < len(seeds)


def test_the_same_row_twice_shares_the_force():
    one = np.array([[1.0, 0.2], [0.2, 1.0]])
    it = friction_problem(np.kron(one, np.ones((2, 2))), np.repeat([-1.0, 0.5], 2), slipping(Coulomb(mu=2.0), 2))
    x, _ = solve_multipliers(it, np.zeros(4))
    assert it.free + it.compliance @ x == pytest.approx(np.zeros(4), abs=1e-13)


def wedged(seed: int, contradiction: float) -> FrictionProblem:
    """Two rows of one point, on walls across each other, under forces that let both stick.

    One gap contradicts the others by a part of the greatest gap or slip: no motion of the point closes both.
    """
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0].T
    directions = axes[[0, 1, 1, 2, 0, 2]]
    root = rng.normal(size=(3, 3))
    compliance = directions @ (root @ root.T + np.eye(3)) @ directions.T
    forces = np.concatenate([rng.uniform(1.0, 2.0, size=2), 0.1 * rng.normal(size=4)])
    free = -compliance @ forces
    free[1] -= contradiction * np.abs(free).max()
    return friction_problem(compliance, free, slipping(Coulomb(mu=0.49), 2, 2))


@pytest.mark.parametrize("contradiction", [0.0, 1e-12, 1e-10, 1e-9, 1e-8])
def test_rows_of_one_point_that_contradict_each_other_find_forces(contradiction: float) -> None:
    for seed in range(40):
        it = wedged(seed, contradiction)
        x, slips = solve_multipliers(it, np.zeros(6))
        p, s = it.split(x)
        gap, slip = it.split(it.free + it.compliance @ x)
        scale = np.abs(it.free).max()
        assert (p >= 0.0).all()
        assert (np.linalg.norm(s, axis=1) <= 0.49 * p * (1.0 + 1e-6)).all()
        assert gap.min() > -10.0 * (contradiction + 1e-13) * scale
        assert np.abs(slip[(p > 0.0) & ~slips]).max(initial=0.0) < 10.0 * (contradiction + 1e-13) * scale


@dataclass(frozen=True)
class Counted:
    """A law of friction that is asked a limited number of times."""

    law: FrictionLaw
    calls: Iterator[int]
    frictionless: ClassVar[bool] = False

    def limit(self, pressure: np.ndarray) -> np.ndarray:
        assert next(self.calls) < 1000, "no end"
        return self.law.limit(pressure)

    def resistance(self, speed: np.ndarray, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.law.resistance(speed, pressure)


def test_a_row_that_is_released_does_not_stick_again_when_its_neighbour_follows():
    """Two pressed rows of a nearly rigid body carry a pull of 0.7: one breaks away, and the other cannot hold alone."""
    compliance = np.kron(np.diag([0.0, 1.0]), np.full((2, 2), 50.0)) + np.eye(4)
    pull = np.array([0.45, 0.25])
    free = -compliance @ [1.0, 1.0, *pull]
    law = Counted(StaticKinetic(mu_s=0.4, mu_k=0.1), count())
    x, slips = solve_multipliers(friction_problem(compliance, free, slipping(law, 2)), np.array([1.0, 1.0, 0.0, 0.0]))
    assert slips.tolist() == [True, True]
    assert x == pytest.approx([1.0, 1.0, 0.1, 0.1], rel=1e-12)


@pytest.mark.parametrize("rested", [True, False])
def test_a_row_that_no_force_lets_stick_slips(rested: bool) -> None:
    """A row pulled along: sticking at any force it would have to pull, and released it would overlap (Painleve)."""
    compliance, free = np.array([[1.0, 0.9], [0.9, 1.0]]), np.array([-0.1, -1.0])
    assert np.linalg.solve(compliance, -free)[0] < 0.0 > free[0]
    it = friction_problem(compliance, free, slipping(StaticKinetic(mu_s=0.9, mu_k=0.45), 1))
    (p, s), slips = solve_multipliers(it, np.array([0.0 if rested else 0.05, 0.0]))
    assert slips.tolist() == [True]
    assert p == pytest.approx(0.1 / (1.0 + 0.45 * 0.9), rel=1e-12) and s == pytest.approx(0.45 * p, rel=1e-12)


def test_an_attempt_looks_a_few_times_only_for_forces_that_let_rows_stick() -> None:
    """A search takes up to 75 steps of Newton's method, and the next iterate of a slab has nearly the same rows."""
    compliance, free = np.array([[1.0, 0.9], [0.9, 1.0]]), np.array([-0.1, -1.0])
    law, effort, steps = StaticKinetic(mu_s=0.9, mu_k=0.45), Effort(), []
    for _ in range(STUCK + 2):
        before = effort.steps
        x, slips = solve_multipliers(
            friction_problem(compliance, free, slipping(law, 1), effort=effort), np.array([0.05, 0.0])
        )
        steps.append(effort.steps - before)
        assert slips.tolist() == [True] and x[1] == pytest.approx(0.45 * x[0], rel=1e-12)
    assert max(steps[STUCK:]) < 0.3 * min(steps[:STUCK])


@pytest.mark.parametrize("seed", range(40))
def test_friction_that_drops_has_forces_for_every_compliance(seed: int) -> None:
    """Among these are rows that no forces let stick."""
    law = StaticKinetic(mu_s=0.9, mu_k=0.45)
    it = problem(seed, 12, 1, law)
    x, slips = solve_multipliers(it, np.concatenate([np.ones(12), np.zeros(12)]))
    p, s = it.split(x)
    gap, slip = it.split(it.free + it.compliance @ x)
    touch, size = p > 0.0, np.abs(s[:, 0])
    assert p.min() >= 0.0 and gap.min() > -1e-13 and np.abs(gap[touch]).max() < 1e-13
    assert (size[touch & ~slips] <= 0.9 * p[touch & ~slips] * (1.0 + 1e-12)).all()
    assert np.abs(slip[touch & ~slips]).max(initial=0.0) < 1e-13
    assert size[slips] == pytest.approx(0.45 * p[slips], abs=1e-12)
    assert (s[slips, 0] * slip[slips, 0] <= 1e-12).all()


@pytest.mark.parametrize("seed", [0, 1, 3, 112])
def test_forces_that_grow_without_bound_are_given_up(seed):
    """A compliance that is not positive, as of crushed cells: sweeps over the rows would end in an overflow."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(12, 12))
    it = friction_problem(root + root.T, rng.normal(size=12) - 0.5, slipping(Coulomb(mu=0.6), 4, 2))
    start = np.zeros(12)
    x = gauss_seidel(it, start, 400)
    assert np.abs(x).max() <= GROWN * it.usual_force(start)
    with pytest.raises(NoConvergence, match="friction of 4 contact rows leaves"):
        solve_multipliers(it, start)


@pytest.mark.parametrize("size", [1e160, 1e300])
def test_forces_that_overflow_are_refused_without_a_warning(size):
    it = problem(4, 6, 2, Coulomb(mu=0.3))
    it = replace(it, law=replace(it.law, turning=size * turning(5, 6)), free=size * it.free)
    with pytest.raises(NoConvergence, match="friction of 6 contact rows: the forces are not finite"):
        solve_multipliers(it, np.full(18, size))


def test_a_problem_is_given_up_by_its_steps():
    """By their number alone: ten rows that depend on each other need many, whatever the rounding."""
    hard = dependent(71, 4, 10)
    told = "attempt given up after 0 iterations, 0 factors and 6 steps of the contact problems, of 5 allowed; the last"
    with pytest.raises(NoConvergence, match=told):
        solve_multipliers(replace(hard, effort=Effort(limit=0.1)), np.zeros(30))


@pytest.mark.few(3)
@pytest.mark.parametrize("k", [1, 2])
@pytest.mark.parametrize("law", [Coulomb(mu=0.3), Tresca(shear=0.2), NortonHoff(alpha=0.3, p=1.0)], ids=str)
def test_rows_that_turn_a_little_are_solved_for_with_the_kept_factor(law, k):
    """Forces and slipping rows are those of their own problem."""
    solved = 0
    for seed in range(10):
        first = problem(seed, 8, k, law)
        x, _ = solve_multipliers(first, np.zeros(len(first.free)))
        kept, rng = KeptNewton.at(first, x), np.random.default_rng(seed)
        turn = rng.normal(scale=1e-4, size=first.compliance.shape)
        now = replace(first, compliance=first.compliance + turn + turn.T, free=first.free + 1e-4 * x)
        expected, slips = solve_multipliers(now, x)
        found = kept.solved(now.free, (now.law, now.previous, now.equal), x, lambda y, now=now: now.compliance @ y)
        if friction_residual(now, expected).status == kept.status:
            assert found is not None
            np.testing.assert_allclose(found[0], expected, atol=1e-11)
            np.testing.assert_array_equal(found[1], slips)
            solved += 1
        else:
            assert found is None
    assert solved >= 8, "a few rows come to touch or slip"


def test_the_kept_factor_is_not_for_other_rows_nor_for_friction_that_drops():
    first = problem(0, 6, 2, Coulomb(mu=0.3))
    x, _ = solve_multipliers(first, np.zeros(len(first.free)))
    kept = KeptNewton.at(first, x)

    known = first.law, first.previous, first.equal

    def moved(y):
        return first.compliance @ y

    assert kept.solved(first.free, known, x, moved) is not None
    assert kept.solved(first.free[:9], known, x[:9], moved) is None
    dropping = slipping(StaticKinetic(mu_s=0.4, mu_k=0.2), 6, 2)
    assert kept.solved(first.free, (dropping, *known[1:]), x, moved) is None
    assert kept.solved(first.free, (replace(first.law, stick_at_any_force=True), *known[1:]), x, moved) is None
    assert kept.solved(first.free + 1.0, known, x, moved) is None, "all rows are open"
    assert kept.solved(first.free, known, x, lambda y: 40.0 * y) is None, "much stiffer"
