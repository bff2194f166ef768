"""Examination of a direct solver."""

import numpy as np
import scipy.sparse as sp

from softway.errors import NoConvergence
from softway.solve.linear import Factor, LinearSolver, number_type
from softway.testing.verdict import close, require
from softway.typing import Array

ACCURACY = {"double": 1e-12, "single": 1e-4}
"""Error of a solution, relative to its greatest number, of well-conditioned equations."""

SOLVES = 100
"""Times that the same equations are solved: threads that race do not lose every time."""


def check_solver(solver: LinearSolver) -> None:
    """Raise ``AssertionError`` saying what is wrong with a direct solver; return quietly if nothing is.

    Examined: accuracy for one, several and no right-hand sides, arguments left as they are, other values on the same
    pattern, factors that live side by side, the same bits again, systems of one and two unknowns, matrices that are
    indefinite (solved or refused), singular (refused) or hold what is not a number (refused), and the refusal of
    another pattern.

    Examples
    --------
    >>> from softway.solve.linear import SuperLU
    >>> check_solver(SuperLU())
    """
    _accuracy(solver)
    _arguments(solver)
    _refactored(solver)
    _repeated(solver)
    _small(solver)
    _indefinite(solver)
    _refused(solver)


def _lattice(side: int = 6) -> sp.csc_array:
    """Springs between the neighbours of a cubic lattice, on a ground: (side^3, side^3), positive definite."""
    chain = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(side, side))  # type: ignore[arg-type]
    one = sp.eye_array(side)
    sum_ = sp.kron(sp.kron(chain, one), one) + sp.kron(sp.kron(one, chain), one) + sp.kron(sp.kron(one, one), chain)
    return _sorted(sum_ + 0.5 * sp.eye_array(side**3))


def _other() -> sp.csc_array:
    """Other values on the pattern of the lattice, positive definite and of other scales."""
    scale = sp.diags_array(np.random.default_rng(1).uniform(0.5, 2.0, 216))
    return _sorted(3.0 * scale @ _lattice() @ scale)


def _sorted(matrix: sp.sparray) -> sp.csc_array:
    out = sp.csc_array(matrix)
    out.sort_indices()
    return out


def _solves(solver: LinearSolver, factor: Factor, matrix: sp.csc_array, complaint: str, columns: int = 0) -> None:
    """Require that a factor finds a known solution."""
    f = matrix.shape[0]
    x = np.random.default_rng(0).normal(size=(f, columns) if columns else f)
    found = factor.solve(matrix @ x)
    require(found.shape == x.shape, solver, f"{complaint}: right-hand side {x.shape} gives shape {found.shape}")
    require(found.dtype == np.float64, solver, f"{complaint}: the solution has numbers of {found.dtype}")
    close(found, x, ACCURACY[solver.precision], solver, complaint)


def _accuracy(solver: LinearSolver) -> None:
    matrix = _lattice()
    factor = solver.factor(matrix)
    for columns in (0, 1, 7):
        _solves(solver, factor, matrix, "solution is off", columns)
    require(factor.solve(np.zeros((216, 0))).shape == (216, 0), solver, "no right-hand side gives another shape")
    require(not factor.solve(np.zeros(216)).any(), solver, "zero gives what is not zero")
    least = (matrix.nnz + 216) // 2 * (4 if solver.precision == "single" else 8)
    require(factor.bytes >= least, solver, f"a factor of {factor.bytes} bytes cannot hold the matrix")
    one, several = np.ones(216), np.ones((216, 3))[:, ::2]
    for column in factor.solve(several).T:
        close(column, factor.solve(one), ACCURACY[solver.precision], solver, "columns with gaps are solved differently")


def _arguments(solver: LinearSolver) -> None:
    matrix, b = _lattice(), np.random.default_rng(2).normal(size=(216, 3))
    kept, given = matrix.copy(), b.copy()
    factor = solver.factor(matrix)
    first = factor.solve(b)
    same = all(np.array_equal(getattr(matrix, n), getattr(kept, n)) for n in ("data", "indices", "indptr"))
    require(same, solver, "the matrix given was changed")
    require(np.array_equal(b, given), solver, "the right-hand side given was changed")
    matrix.data[:] = 0.0
    require(np.array_equal(factor.solve(b), first), solver, "a factor changes with the matrix it was made of")
    b[:] = 0.0
    factor.solve(b)
    require(bool(first.any()), solver, "a solution changes with the next one")


def _refactored(solver: LinearSolver) -> None:
    analysis = solver.analyse(_lattice())
    first, second = analysis.factor(_lattice()), analysis.factor(_other())
    _solves(solver, second, _other(), "solution of other values on the same pattern is off")
    _solves(solver, first, _lattice(), "a factor is lost when another is made")
    del first
    for _ in range(3):
        _solves(solver, analysis.factor(_lattice()), _lattice(), "a factor made after another went is off")
    del analysis
    _solves(solver, second, _other(), "a factor is lost with its analysis")


def _repeated(solver: LinearSolver) -> None:
    b: Array = np.random.default_rng(3).normal(size=2744)
    matrix = _lattice(14)
    analysis = solver.analyse(matrix)
    factor = analysis.factor(matrix)
    first = factor.solve(b)
    for _ in range(SOLVES):
        require(np.array_equal(factor.solve(b), first), solver, "solve again gives other bits")
    for other, what in ((analysis.factor(matrix), "factor"), (solver.factor(matrix), "analyse")):
        require(np.array_equal(other.solve(b), first), solver, f"{what} again gives other bits")


def _small(solver: LinearSolver) -> None:
    for rows in ([[4.0]], [[2.0, 1.0], [1.0, 3.0]], [[2.0, 0.0], [0.0, 3.0]]):
        matrix = sp.csc_array(np.array(rows))
        _solves(solver, solver.factor(matrix), matrix, f"solution of {len(rows)} unknowns is off")


def _indefinite(solver: LinearSolver) -> None:
    swap = sp.csc_array(np.array([[0.0, 1.0], [1.0, 0.0]]))
    shifted = _sorted(_lattice() - 4.03 * sp.eye_array(216))
    for matrix in (swap, shifted):
        try:
            factor = solver.factor(matrix)
        except NoConvergence:
            continue
        x = np.linspace(1.0, 2.0, matrix.shape[0])
        residual = matrix @ (factor.solve(matrix @ x) - x)
        close(residual, 0.0, 10.0 * ACCURACY[solver.precision], solver, "an indefinite matrix is solved wrongly", 6.0)


def _refused(solver: LinearSolver) -> None:
    broken = _lattice()
    broken.data[7] = np.nan
    empty = (np.zeros((1, 1)), np.diag([1.0, 0.0]))
    for matrix in (*(sp.csc_array(m) for m in empty), broken):
        try:
            solver.factor(matrix)
        except NoConvergence:
            continue
        require(False, solver, f"a matrix of {matrix.shape[0]} unknowns without an inverse is factored")
    _blown(solver)


def _blown(solver: LinearSolver) -> None:
    """A pivot that is the difference of equal numbers may be rounding: then what has no solution gets a huge one."""
    try:
        x = solver.factor(sp.csc_array(np.ones((2, 2)))).solve(np.array([1.0, -1.0]))
    except NoConvergence:
        return
    huge = 1e-2 / float(np.finfo(number_type(solver.precision)).eps)
    shown = not np.isfinite(x).all() or float(np.abs(x).max()) > huge
    require(shown, solver, "a matrix of 2 unknowns without an inverse is factored, and does not show")
