"""Checks of a direct solver."""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.errors import NoConvergence
from softway.solve.linear.interface import CondensingFactor, Factor, LinearSolver, number_type
from softway.testing.verdict import close, require

ACCURACY = {"double": 1e-12, "single": 1e-4}
"""Allowed error of the solution of well-conditioned equations, relative to its largest entry."""

SOLVES = 100
"""Number of repeated solutions of the same equations; a race between threads does not show every time."""


def check_solver(solver: LinearSolver) -> None:
    """Check a direct solver; raise ``AssertionError`` with the first error found.

    Checked: accuracy for one, several and no right-hand sides; arguments left unchanged; other values on the same
    pattern; several factors at the same time; bitwise reproducible results; systems of one and two unknowns.
    Indefinite matrices must be solved or refused, and singular matrices and matrices with NaN must be refused.
    Schur complements, where factors offer them, are compared with solutions.

    Examples
    --------
    >>> from softway.solve.linear.backends.superlu import SuperLU
    >>> check_solver(SuperLU())
    """
    _accuracy(solver)
    _arguments(solver)
    _refactored(solver)
    _condensed(solver)
    _repeated(solver)
    _small(solver)
    _indefinite(solver)
    _refused(solver)


def _lattice(side: int = 6) -> sp.csc_array:
    """Stiffness matrix of a cubic lattice of springs tied to the ground: (side^3, side^3), positive definite."""
    chain = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(side, side))  # type: ignore[arg-type]
    one = sp.eye_array(side)
    sum_ = sp.kron(sp.kron(chain, one), one) + sp.kron(sp.kron(one, chain), one) + sp.kron(sp.kron(one, one), chain)
    return _sorted(sum_ + 0.5 * sp.eye_array(side**3))


def _other() -> sp.csc_array:
    """Positive definite matrix with the pattern of the lattice but other values and scales."""
    scale = sp.diags_array(np.random.default_rng(1).uniform(0.5, 2.0, 216))
    return _sorted(3.0 * scale @ _lattice() @ scale)


def _sorted(matrix: sp.sparray) -> sp.csc_array:
    out = sp.csc_array(matrix)
    out.sort_indices()
    return out


def _solves(solver: LinearSolver, factor: Factor, matrix: sp.csc_array, complaint: str, columns: int = 0) -> None:
    """Check that a factor reproduces a known solution."""
    f = matrix.shape[0]
    x = np.random.default_rng(0).normal(size=(f, columns) if columns else f)
    found = factor.solve(matrix @ x)
    require(found.shape == x.shape, solver, f"{complaint}: right-hand side {x.shape} gives shape {found.shape}")
    require(found.dtype == np.float64, solver, f"{complaint}: the solution has the type {found.dtype}")
    close(found, x, ACCURACY[solver.precision], solver, complaint)


def _accuracy(solver: LinearSolver) -> None:
    matrix = _lattice()
    factor = solver.factor(matrix)
    for columns in (0, 1, 7):
        _solves(solver, factor, matrix, "the solution is wrong", columns)
    require(factor.solve(np.zeros((216, 0))).shape == (216, 0), solver, "zero right-hand sides give a wrong shape")
    require(not factor.indefinite, solver, "a factor of a positive definite matrix says that it is indefinite")
    require(not factor.solve(np.zeros(216)).any(), solver, "a zero right-hand side gives a nonzero solution")
    least = (matrix.nnz + 216) // 2 * (4 if solver.precision == "single" else 8)
    require(factor.bytes >= least, solver, f"a factor of {factor.bytes} bytes cannot hold the matrix")
    one, several = np.ones(216), np.ones((216, 3))[:, ::2]
    for column in factor.solve(several).T:
        close(column, factor.solve(one), ACCURACY[solver.precision], solver, "strided columns are solved differently")


def _arguments(solver: LinearSolver) -> None:
    matrix, b = _lattice(), np.random.default_rng(2).normal(size=(216, 3))
    kept, given = matrix.copy(), b.copy()
    factor = solver.factor(matrix)
    first = factor.solve(b)
    same = all(np.array_equal(getattr(matrix, n), getattr(kept, n)) for n in ("data", "indices", "indptr"))
    require(same, solver, "the matrix was changed")
    require(np.array_equal(b, given), solver, "the right-hand side was changed")
    matrix.data[:] = 0.0
    require(np.array_equal(factor.solve(b), first), solver, "a factor changes when its matrix is changed afterwards")
    b[:] = 0.0
    factor.solve(b)
    require(bool(first.any()), solver, "a solution is overwritten by the next one")


def _refactored(solver: LinearSolver) -> None:
    analysis = solver.analyse(_lattice())
    first, second = analysis.factor(_lattice()), analysis.factor(_other())
    _solves(solver, second, _other(), "the solution for other values on the same pattern is wrong")
    _solves(solver, first, _lattice(), "a factor is lost when another one is computed")
    del first
    for _ in range(3):
        _solves(
            solver,
            analysis.factor(_lattice()),
            _lattice(),
            "a factor computed after the deletion of another one is wrong",
        )
    del analysis
    _solves(solver, second, _other(), "a factor is lost when its analysis is deleted")


def _condensed(solver: LinearSolver) -> None:
    """Schur complements of unknowns in any order; an indefinite matrix may have none."""
    which = np.array([200, 3, 64, 0, 215])
    for matrix in (_lattice(), _sorted(_lattice() - 4.03 * sp.eye_array(216))):
        try:
            factor = solver.factor(matrix)
        except NoConvergence:
            continue
        if not isinstance(factor, CondensingFactor):
            return
        found, again = factor.schur_complement(which), factor.schur_complement(which)
        if found is not None and again is not None:
            inverse = factor.solve(np.eye(216)[:, which])[which]
            close(
                found @ inverse, np.eye(5), 10.0 * ACCURACY[solver.precision], solver, "the Schur complement is wrong"
            )
            require(np.array_equal(found, again), solver, "a second Schur complement differs")
            _solves(solver, factor, matrix, "the factor is lost with the Schur complement")


def _repeated(solver: LinearSolver) -> None:
    b: Array = np.random.default_rng(3).normal(size=2744)
    matrix = _lattice(14)
    analysis = solver.analyse(matrix)
    factor = analysis.factor(matrix)
    first = factor.solve(b)
    for _ in range(SOLVES):
        require(np.array_equal(factor.solve(b), first), solver, "solving again gives a different result")
    for other, what in ((analysis.factor(matrix), "factor"), (solver.factor(matrix), "analyse")):
        require(np.array_equal(other.solve(b), first), solver, f"{what} again gives a different result")


def _small(solver: LinearSolver) -> None:
    for rows in ([[4.0]], [[2.0, 1.0], [1.0, 3.0]], [[2.0, 0.0], [0.0, 3.0]]):
        matrix = sp.csc_array(np.array(rows))
        _solves(solver, solver.factor(matrix), matrix, f"the solution for {len(rows)} unknowns is wrong")


def _indefinite(solver: LinearSolver) -> None:
    swap = sp.csc_array(np.array([[0.0, 1.0], [1.0, 0.0]]))
    shifted = _sorted(_lattice() - 4.03 * sp.eye_array(216))
    for matrix in (swap, shifted):
        try:
            factor = solver.factor(matrix)
        except NoConvergence:
            continue
        require(factor.indefinite, solver, "a factor does not say that its matrix is indefinite")
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
        require(False, solver, f"a matrix of {matrix.shape[0]} unknowns that is singular or holds NaN is not refused")
    _blown(solver)


def _blown(solver: LinearSolver) -> None:
    """Accept a singular matrix whose pivot is pure rounding if the solution is huge, because then the error shows."""
    try:
        x = solver.factor(sp.csc_array(np.ones((2, 2)))).solve(np.array([1.0, -1.0]))
    except NoConvergence:
        return
    huge = 1e-2 / float(np.finfo(number_type(solver.precision)).eps)
    shown = not np.isfinite(x).all() or float(np.abs(x).max()) > huge
    require(shown, solver, "a singular matrix of 2 unknowns is factored without any sign in the solution")
