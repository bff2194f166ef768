"""Factors in single precision of matrices whose inverses decay below the normal numbers."""

import numpy as np
import pytest
import scipy.sparse as sp
from numba import njit

from softway.kernels.slab.solution import solve
from softway.solve.linear.backends import Pardiso, SuperLU
from softway.solve.linear.backends.pardiso import solve_call
from softway.solve.linear.interface import LinearSolver
from softway.solve.linear.power_scaling import PowerScaled, enlarged, exponent
from softway.tolerances import EXPONENT

EMPTY = np.zeros((0, 0))
SOLVERS = [SuperLU("single"), Pardiso("single", 1)]


def chain(size: int, scale: float) -> sp.csc_array:
    """Springs in a row, each tied to the ground: the inverse decays by .127 from one to the next."""
    return sp.csc_array(
        scale * sp.diags_array([-1.0, 8.0, -1.0], offsets=[-1, 0, 1], shape=(size, size))  # type: ignore[arg-type]
    )


def usable(solver: LinearSolver) -> None:
    """Skip a solver whose library is not there."""
    if isinstance(solver, Pardiso):
        pytest.importorskip("pypardiso", reason="pypardiso is not installed")


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("scale", [1e-30, 1e-6, 1.0, 1e30])
def test_solutions_are_right_far_from_one(solver: LinearSolver, scale: float) -> None:
    usable(solver)
    matrix, b = chain(30, scale), np.zeros((30, 2))
    b[0] = 1.0, 1e-35
    factor = solver.factor(matrix)
    np.testing.assert_allclose(factor.solve(b), np.linalg.solve(matrix.toarray(), b), rtol=1e-5)
    np.testing.assert_allclose(factor.solve(b[:, 0]), factor.solve(b)[:, 0], rtol=1e-5)
    assert not factor.solve(np.zeros(30)).any()


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_unit_of_mass_changes_no_digit(solver: LinearSolver) -> None:
    usable(solver)
    b = np.random.default_rng(0).normal(size=30)
    one, other = solver.factor(chain(30, 1.0)).solve(b), solver.factor(chain(30, 2.0**-20)).solve(b)
    np.testing.assert_array_equal(one, 2.0**-20 * other)


def test_the_numbers_stay_normal() -> None:
    """The Cholesky factor of the chain holds powers of its decay: of the matrix itself all are far from 1e-38."""
    matrix, e = enlarged(chain(30, 1e-20), "single")
    assert 2.0 ** (EXPONENT - 1) <= matrix.data.max() < 2.0**EXPONENT
    column = np.linalg.solve(matrix.toarray(), 2.0**EXPONENT * np.eye(30)[:, 0])
    assert column.min() > np.finfo(np.float32).tiny
    assert enlarged(chain(30, 1e-20), "double")[1] == 0
    assert e > EXPONENT


@pytest.mark.parametrize("values", [np.zeros(3), np.zeros(0), np.array([np.inf]), np.array([np.nan, 1.0])])
def test_what_has_no_greatest_entry_stays(values: np.ndarray) -> None:
    assert exponent(values) == 0


def test_a_reduced_factor_tells_of_the_one_within() -> None:
    factor = SuperLU("single").factor(sp.csc_array(np.diag([-1.0, 2.0])))
    assert isinstance(factor, PowerScaled)
    assert factor.indefinite
    assert factor.bytes == factor.factor.bytes
    assert factor.schur_complement(np.array([0])) is None


def test_schur_complements_have_the_scale_of_the_matrix() -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    matrix, last = chain(20, 1e-12), np.array([7, 0])
    found = Pardiso("single", 1).factor(matrix).schur_complement(last)
    inverse = np.linalg.inv(matrix.toarray())[np.ix_(last, last)]
    np.testing.assert_allclose(found @ inverse, np.eye(2), atol=1e-5)


@njit
def by_address(single: np.ndarray, library: np.ndarray, x: np.ndarray) -> None:
    """Solve in place in compiled code."""
    solve(EMPTY, EMPTY, x, single, library, x)


@pytest.mark.parametrize(("scale", "load"), [(1e-30, 1.0), (1.0, 1e-300), (1e30, 1e-35), (1e-6, 1e20)])
def test_compiled_code_finds_the_same_bits(scale: float, load: float) -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    factor, b = Pardiso("single", 1).factor(chain(30, scale)), load * np.arange(1.0, 31.0)
    call = solve_call(factor)
    assert call is not None
    for _ in range(2):
        x = b.copy()
        with call.limited():
            by_address(call.single, call.library, x)
        assert not call.failed
        np.testing.assert_array_equal(x, factor.solve(b))
    none = np.zeros(30)
    by_address(call.single, call.library, none)
    assert not none.any()


def test_other_factors_are_not_for_compiled_code() -> None:
    assert solve_call(SuperLU("single").factor(chain(5, 1.0))) is None
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    assert solve_call(Pardiso("double", 1).factor(chain(5, 1.0))) is None
    assert solve_call(Pardiso("single", 1).factor(chain(5, -1.0))) is None
