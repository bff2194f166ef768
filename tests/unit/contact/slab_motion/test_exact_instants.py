"""Exact slab averages of massless contact nodes, against enumeration of the active sets on a fine grid in time."""

from dataclasses import dataclass
from itertools import product

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given
from hypothesis import strategies as st

from single import single
from softway.bodies.dof_map import NodalDofs
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.exact_instants import ExactInstantMean, exact_instant_mean, lcp

NODES, DIM, ROWS = 5, 2, 3


def enumerated(compliance: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Multipliers of 0 <= P _|_ gap + W P >= 0 by trying every active set."""
    best, found = np.inf, np.zeros(len(gap))
    for choice in product([False, True], repeat=len(gap)):
        active = np.array(choice, bool)
        force = np.zeros(len(gap))
        force[active] = np.linalg.solve(compliance[np.ix_(active, active)], -gap[active])
        violation = max(-force.min(initial=0.0), -(gap + compliance @ force).min(initial=0.0))
        if violation < best:
            best, found = violation, force
    return found


@st.composite
def problems(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    m = draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    root = rng.normal(size=(m, m + 2))
    return root @ root.T + 0.1 * np.eye(m), rng.normal(size=m)


@given(problems())
def test_lcp_finds_the_active_set(problem: tuple[np.ndarray, np.ndarray]) -> None:
    compliance, gap = problem
    np.testing.assert_array_equal(lcp(compliance, gap), enumerated(compliance, gap) > 0.0)


def test_lcp_without_rows() -> None:
    assert lcp(np.zeros((0, 0)), np.zeros(0)).shape == (0,)


@dataclass(frozen=True)
class Case:
    """Two nodes with inertia and three without, one of these held in x, three rows."""

    located: ExactInstantMean
    stiffness: np.ndarray
    load: np.ndarray
    free: np.ndarray
    rows: ContactRows
    u0: np.ndarray
    u1: np.ndarray

    def still(self, s: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (n, d) with the massless nodes in constrained equilibrium, and multipliers (m,), at s."""
        flat = ((1.0 - s) * self.u0 + s * self.u1).ravel()
        light = self.located.still
        flat[light] = 0.0
        inner = self.stiffness[np.ix_(light, light)]
        flexible = np.linalg.inv(inner)
        rows = self.rows.matrix(NodalDofs(self.free)).toarray()
        full = np.zeros((len(self.rows.node), flat.size))
        full[:, self.free.ravel()] = rows
        N = full[:, light]
        flat[light] = flexible @ (self.load.ravel()[light] - self.stiffness[light] @ flat)
        force = enumerated(N @ flexible @ N.T, self.rows.gap(flat.reshape(NODES, DIM)))
        flat[light] += flexible @ (N.T @ force)
        return flat.reshape(NODES, DIM), force


@st.composite
def slabs(draw: st.DrawFn) -> Case:
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    root = rng.normal(size=(NODES * DIM, NODES * DIM + 3))
    stiffness = root @ root.T + np.eye(NODES * DIM)
    free = np.ones((NODES, DIM), bool)
    free[2, 0] = False
    normal = rng.normal(size=(ROWS, DIM))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    rows = single([2, 3, 4], normal, 0.3 * rng.normal(size=ROWS), NODES)
    massive = np.array([True, True, False, False, False])
    load = 0.1 * rng.normal(size=(NODES, DIM))
    located = exact_instant_mean(rows, free, massive, load, sp.csc_array(stiffness))
    u0, u1 = rng.normal(size=(2, NODES, DIM)) * free
    case = Case(located, stiffness, load, free, rows, u0, u1)
    u0[2:], u1[2:] = case.still(0.0)[0][2:], case.still(1.0)[0][2:]
    return Case(located, stiffness, load, free, rows, u0, u1)


@given(slabs())
def test_the_mean_is_that_of_the_motion_in_equilibrium(case: Case) -> None:
    grid = (np.arange(200) + 0.5) / 200
    average = np.mean([case.still(s)[0] for s in grid], axis=0)
    np.testing.assert_allclose(case.located.mean(case.u0, case.u1), average, atol=1e-4)


@given(slabs())
def test_branches_lead_from_the_first_active_set_to_the_last(case: Case) -> None:
    closed = case.still(0.0)[1] > 0.0
    state = closed.copy()
    last = 0.0
    for branch in case.located.branches(case.u0, case.u1, closed, case.still(1.0)[1] > 0.0):
        assert last <= branch.instant <= 1.0
        assert state[branch.row] != branch.closes
        for s, expected in ((branch.instant - 1e-6, not branch.closes), (branch.instant + 1e-6, branch.closes)):
            if last + 2e-6 < s < 1.0:
                assert (case.still(s)[1][branch.row] > 0.0) == expected
        state[branch.row], last = branch.closes, branch.instant
    np.testing.assert_array_equal(state, case.still(1.0)[1] > 0.0)


def test_one_spring_that_closes_in_the_slab() -> None:
    """Mean gap of an opening that shuts at s: a^2 / (2 (a - b)), a and b the gaps without contact at both ends."""
    rows = single([1], [[-1.0]], 0.3, 2)
    stiffness = sp.csc_array(np.array([[2.0, -2.0], [-2.0, 2.0]]))
    free, massive = np.ones((2, 1), bool), np.array([True, False])
    located = exact_instant_mean(rows, free, massive, np.zeros((2, 1)), stiffness)
    u0, u1 = np.array([[0.0], [0.0]]), np.array([[0.4], [0.3]])
    a, b = 0.3, -0.1
    assert located.mean(u0, u1)[:, 0] == pytest.approx([0.2, 0.3 - a**2 / (2 * (a - b))], abs=1e-9)
    (branch,) = located.branches(u0, u1, np.array([False]), np.array([True]))
    assert (branch.instant, branch.row, branch.closes) == (pytest.approx(0.75), 0, True)


@pytest.mark.parametrize("late", [1e-6, 1e-12, 0.0])
def test_a_touch_just_before_the_end_is_told(late: float) -> None:
    rows = single([1], [[-1.0]], 0.3, 2)
    stiffness = sp.csc_array(np.array([[2.0, -2.0], [-2.0, 2.0]]))
    free, massive = np.ones((2, 1), bool), np.array([True, False])
    located = exact_instant_mean(rows, free, massive, np.zeros((2, 1)), stiffness)
    u0, u1 = np.array([[0.0], [0.0]]), np.array([[0.3 * (1.0 + late)], [0.3]])
    told = located.branches(u0, u1, np.array([False]), np.array([late > 0.0]))
    assert [b.closes for b in told] == ([True] if late > 0.0 else [])
