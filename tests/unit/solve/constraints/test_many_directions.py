"""Compliance of many contact directions from one Schur complement, against solutions for each."""

import numpy as np
import pytest
import scipy.sparse as sp

from softway.arrays import Array
from softway.solve.constraints.compliance import FrozenOperator, RowBasis, frozen_operator
from softway.solve.constraints.normal_active_set import multipliers
from softway.solve.constraints.recent_factor import RecentFactor
from softway.solve.constraints.row_basis import CombinedRows
from softway.solve.linear.backends import Pardiso
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.condensed_compliance import MANY, condensed_compliance

pytest.importorskip("pypardiso", reason="pypardiso is not installed")
SIDE = 14


def lattice() -> sp.csc_array:
    """Springs on a cubic lattice with a ground."""
    chain, one = sp.diags_array([-1.0, 2.1, -1.0], offsets=[-1, 0, 1], shape=(SIDE, SIDE)), sp.eye_array(SIDE)
    first, second = sp.kron(chain, one), sp.kron(one, chain)
    matrix = sp.csc_array(sp.kron(first, one) + sp.kron(second, one) + sp.kron(sp.kron(one, one), chain))
    matrix.sort_indices()
    return matrix


def face(order: np.ndarray) -> RowBasis:
    """Unknowns of one face and of the layer below it, in some order."""
    ones = (np.ones(len(order)), (order, np.arange(len(order))))
    return RowBasis(directions=sp.csc_array(ones, shape=(SIDE**3, len(order))), component=order)


def combined() -> RowBasis:
    """Directions that are rows, each of two unknowns."""
    rng, count = np.random.default_rng(4), MANY + 20
    first, second = np.arange(count), np.arange(count) + 7
    places = (np.concatenate([first, second]), np.tile(np.arange(count), 2))
    matrix = sp.csc_array((rng.normal(size=2 * count), places), shape=(SIDE**3, count))
    return RowBasis(directions=matrix, component=None, place=np.arange(count))


BASES = {
    "unknowns": lambda: face(np.arange(2 * SIDE**2)),
    "unknowns in another order": lambda: face(np.random.default_rng(1).permutation(2 * SIDE**2)),
    "rows": combined,
}


def both(basis: RowBasis) -> tuple[FrozenOperator, FrozenOperator]:
    """Operators that condense, and that solve for each direction."""
    return frozen_operator(lattice(), basis, Pardiso(threads=1)), frozen_operator(lattice(), basis, SuperLU())


@pytest.mark.parametrize("name", BASES)
def test_one_schur_complement_gives_the_columns_of_all_directions(name: str) -> None:
    fast, plain = both(BASES[name]())
    count, some = fast.basis.directions.shape[1], np.arange(MANY)
    np.testing.assert_allclose(fast.square(some), plain.square(some), atol=1e-13)
    assert fast.table.count == count
    assert [len(batch) for batch in fast.table.batches] == [count]
    push = np.random.default_rng(0).normal(size=count)
    np.testing.assert_allclose(fast.compliance_times(push), plain.compliance_times(push), atol=1e-12)
    np.testing.assert_allclose(fast.solve_push(push), plain.solve_push(push), atol=1e-12)


def test_columns_computed_before_stay_and_the_batches_give_the_same_bits() -> None:
    fast, _ = both(BASES["unknowns"]())
    few = np.arange(3, 20)
    before = fast.square(few)
    fast.fill(np.arange(300))
    np.testing.assert_array_equal(fast.square(few), before)
    again, _ = both(BASES["unknowns"]())
    again = again.filled(fast.table.batches)
    every = np.arange(fast.basis.directions.shape[1])
    np.testing.assert_array_equal(again.square(every), fast.square(every))


def test_few_directions_and_other_libraries_are_solved_for() -> None:
    matrix, directions = lattice(), face(np.arange(2 * SIDE**2)).directions
    assert condensed_compliance(Pardiso(threads=1).factor(matrix), directions, MANY - 1) is None
    assert condensed_compliance(SuperLU().factor(matrix), directions, MANY) is None


def test_more_unknowns_than_pay_are_solved_for() -> None:
    """Those of half of the lattice: their dense inverse would take longer than the solutions."""
    directions = face(np.arange(SIDE**3 // 2)).directions
    assert condensed_compliance(Pardiso(threads=1).factor(lattice()), directions, MANY) is None


def turned(rows: sp.csr_array, angle: float) -> CombinedRows:
    """Rows whose entries are turned a little against each other."""
    other = sp.csr_array((rows.data[::-1].copy(), rows.indices, rows.indptr), shape=rows.shape)
    return CombinedRows(sp.csr_array(np.cos(angle) * rows + np.sin(angle) * other))


def solved(operator: FrozenOperator, rows: CombinedRows, wanted: Array) -> tuple[Array, Array]:
    force, push = multipliers(operator, rows, wanted)
    return force, rows.from_basis(push.sensed)


@pytest.mark.parametrize("angle", [0.0, 1e-6, 1e-3, 1e-2, 1.0])
def test_rows_that_have_turned_are_solved_for_with_an_earlier_factor(angle: float) -> None:
    """With the accuracy of their own factor, however far they have turned."""
    _, operator = both(BASES["unknowns"]())
    rng = np.random.default_rng(2)
    places = rng.permutation(2 * SIDE**2)[:160].reshape(40, 4)
    rows = sp.csr_array(
        (rng.normal(size=160), places.ravel(), np.arange(0, 161, 4)), shape=(40, operator.basis.directions.shape[1])
    )
    iterating, wanted = operator.in_iteration(), rng.normal(size=40)
    solved(iterating, CombinedRows(rows), wanted)
    first = iterating.recent.factor
    force, motion = solved(iterating, turned(rows, angle), wanted)
    np.testing.assert_allclose(motion, wanted, atol=1e-12)
    np.testing.assert_allclose(force, solved(operator, turned(rows, angle), wanted)[0], atol=1e-10)
    assert (iterating.recent.factor is first) == (angle < 0.5), "a new factor where the old one serves no more"


def test_other_rows_are_factored_anew() -> None:
    recent = RecentFactor()
    assert recent.refined(np.ones(2), lambda x: x, lambda x: x) is None
