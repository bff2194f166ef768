"""Which direct solver is taken, and what is particular to each."""

import gc
import logging
import sys
from collections import defaultdict
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp

from softway.errors import InputError, NoConvergence
from softway.solve.linear.backends import Cholmod, Mumps, Pardiso, best_solver, choice, solver_named
from softway.solve.linear.backends.mumps import NEGATIVE
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.condensed_compliance import condensed_compliance
from softway.solve.linear.interface import LinearSolver


def lattice(side: int) -> sp.csc_array:
    """Springs on a square lattice with a ground."""
    chain = sp.diags_array([-1.0, 2.1, -1.0], offsets=[-1, 0, 1], shape=(side, side))
    matrix = sp.csc_array(sp.kron(chain, sp.eye_array(side)) + sp.kron(sp.eye_array(side), chain))
    matrix.sort_indices()
    return matrix


def absent(monkeypatch: pytest.MonkeyPatch, *modules: str) -> None:
    for module in modules:
        monkeypatch.setitem(sys.modules, module, None)
    if "pypardiso" in modules:
        monkeypatch.setattr("softway.solve.linear.backends.pardiso.files", lambda name: ())


def test_the_fastest_is_taken_without_a_word(caplog: pytest.LogCaptureFixture) -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    assert best_solver("single", threads=1) == Pardiso("single", 1)
    assert not caplog.records


@pytest.mark.parametrize(
    ("missing", "precision", "expected"),
    [
        (("pypardiso", "sksparse", "sksparse.cholmod"), "double", SuperLU()),
        (("pypardiso",), "single", SuperLU("single")),
    ],
)
def test_a_missing_backend_is_named_once(
    missing: tuple[str, ...],
    precision: str,
    expected: LinearSolver,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    absent(monkeypatch, *missing)
    assert best_solver(precision) == expected
    (record,) = caplog.records
    assert (record.name, record.levelno) == ("softway.solve.linear.interface", logging.WARNING)
    for word in ("pardiso does not work here", "superlu is used", "pip install 'softway[pardiso]'"):
        assert word in record.getMessage()


def test_where_there_is_no_mkl_it_is_not_missed(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("platform.machine", lambda: "aarch64")
    assert best_solver("single") == SuperLU("single")
    assert not caplog.records
    absent(monkeypatch, "sksparse", "sksparse.cholmod")
    assert best_solver("double") == SuperLU()
    assert "pip install 'softway[cholmod]'" in caplog.text


def test_a_library_without_the_solver_is_named(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    absent(monkeypatch, "sksparse", "sksparse.cholmod")
    monkeypatch.setattr("softway.solve.linear.backends.pardiso.files", lambda name: ())
    monkeypatch.setitem(sys.modules, "pypardiso", SimpleNamespace(ps=SimpleNamespace(libmkl={})))
    assert solver_named("pardiso") == SuperLU()
    assert len(caplog.records) == 1


def test_a_backend_that_solves_wrongly_is_not_used(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    wrong = SimpleNamespace(factor=lambda matrix: SimpleNamespace(solve=lambda b: b))
    monkeypatch.setattr(choice, "BACKENDS", {"wrong": lambda precision, threads: wrong, **choice.BACKENDS})
    assert solver_named("wrong") != wrong
    assert "ten equations is off by" in caplog.text


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        (lambda: solver_named("gauss"), "no solver 'gauss'"),
        (lambda: solver_named("cholmod", "single"), "no factors in single precision"),
        (lambda: solver_named("superlu", "half"), "precision: 'half'"),
        (lambda: Pardiso(threads=0), "threads: 0"),
        (lambda: Mumps("quadruple"), "precision: 'quadruple'"),
    ],
)
def test_what_does_not_exist_is_refused(wanted, message: str) -> None:
    with pytest.raises(InputError, match=message):
        wanted()


@pytest.mark.parametrize(
    ("module", "solver"), [("pypardiso", Pardiso(threads=1)), ("sksparse", Cholmod()), ("mumps", Mumps(threads=1))]
)
def test_another_pattern_is_refused(module: str, solver: LinearSolver) -> None:
    pytest.importorskip(module, reason=f"{module} is not installed")
    matrix = lattice(4)
    with pytest.raises(InputError, match="pattern"):
        solver.analyse(matrix).factor(sp.csc_array(matrix @ matrix))


def test_threads_belong_to_the_factor() -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    matrix = lattice(40)
    b = np.random.default_rng(0).normal(size=1600)
    alone = {t: Pardiso("single", t).factor(matrix).solve(b) for t in (1, 2)}
    factors = {t: Pardiso("single", t).factor(matrix) for t in (1, 2)}
    for t in (1, 2, 1, 2):
        np.testing.assert_array_equal(factors[t].solve(b), alone[t])


def test_memory_is_used_again_and_given_back() -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    matrix = lattice(10)
    analysis = Pardiso(threads=1).analyse(matrix)
    factor = analysis.factor(matrix)
    first = factor.handle
    del factor
    gc.collect()
    assert analysis.factor(matrix).handle is first


def test_an_indefinite_matrix_is_noted(caplog: pytest.LogCaptureFixture) -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    matrix = sp.csc_array(lattice(6) - 1.93 * sp.eye_array(36))
    with caplog.at_level(logging.DEBUG, "softway"):
        factor = Pardiso(threads=1).factor(matrix)
    assert "L D L^T" in caplog.text
    b = np.arange(36.0)
    np.testing.assert_allclose(matrix @ factor.solve(b), b, atol=1e-10)


def test_an_indefinite_matrix_has_no_cholesky_factor() -> None:
    pytest.importorskip("sksparse", reason="sksparse is not installed")
    with pytest.raises(NoConvergence, match="36 unknowns cannot be factored"):
        Cholmod().factor(sp.csc_array(lattice(6) - 1.93 * sp.eye_array(36)))


@pytest.mark.parametrize("wrong", [np.ones(35), np.ones((35, 2)), np.ones(37)])
def test_a_right_hand_side_of_another_size_is_refused(wrong: np.ndarray) -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    with pytest.raises(ValueError, match="36 unknowns"):
        Pardiso(threads=1).factor(lattice(6)).solve(wrong)


class Context:
    """Interface of python-mumps as far as it is used, by dense matrices; Schur complements are lower triangles."""

    def __init__(self) -> None:
        self.mumps_instance = SimpleNamespace(infog=defaultdict(int), icntl={})

    def set_matrix(self, matrix: sp.csc_array, symmetric: bool) -> None:
        self.matrix = matrix.toarray()

    def analyze(self) -> None:
        """Dense matrices have one pattern."""

    def factor(self, reuse_analysis: bool) -> None:
        self.factor_stats = SimpleNamespace(nonzeros=self.matrix.size)
        self.mumps_instance.infog[NEGATIVE] = int((np.linalg.eigvalsh(self.matrix) < 0.0).sum())

    def solve(self, b: np.ndarray, overwrite_b: bool) -> np.ndarray:
        return np.linalg.solve(self.matrix, b)

    def schur(self, last: np.ndarray) -> np.ndarray:
        return np.tril(np.linalg.inv(np.linalg.inv(self.matrix)[np.ix_(last, last)]))


@pytest.mark.parametrize("precision", ["double", "single"])
def test_mumps_condenses_where_pardiso_does(precision: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Compliance of half the unknowns by one Schur complement, for a matrix far from one and after it has changed."""
    monkeypatch.setitem(sys.modules, "mumps", SimpleNamespace(Context=Context))
    matrix = sp.csc_array(1e-6 * lattice(24))
    factor = Mumps(precision, threads=1).factor(matrix)
    exact = np.linalg.inv(matrix.toarray())[::2, ::2]
    matrix.data[:] = 0.0
    found = condensed_compliance(factor, sp.csc_array(sp.eye_array(576, format="csc")[:, ::2]), 288)
    np.testing.assert_allclose(found, exact, rtol=0.0, atol=(1e-12 if precision == "double" else 1e-4) * exact.max())


def test_mumps_condenses_no_indefinite_matrix(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mumps", SimpleNamespace(Context=Context))
    factor = Mumps().factor(sp.csc_array(lattice(6) - 1.93 * sp.eye_array(36)))
    assert factor.schur_complement(np.arange(4)) is None


@pytest.mark.parametrize(("precision", "accuracy"), [("double", 1e-12), ("single", 1e-5)])
@pytest.mark.parametrize(("module", "kind"), [("pypardiso", Pardiso), ("mumps", Mumps)])
def test_all_unknowns_but_a_few_are_eliminated(module: str, kind, precision: str, accuracy: float) -> None:
    pytest.importorskip(module, reason=f"{module} is not installed")
    matrix, stay = lattice(12), np.array([3, 0, 77, 143, 50])
    found = kind(precision, threads=1).factor(matrix).schur_complement(stay)
    dense, others = matrix.toarray(), np.setdiff1d(np.arange(144), stay)
    rest = np.linalg.solve(dense[np.ix_(others, others)], dense[np.ix_(others, stay)])
    expected = dense[np.ix_(stay, stay)] - dense[np.ix_(stay, others)] @ rest
    np.testing.assert_allclose(found, expected, atol=accuracy)
    np.testing.assert_allclose(found, found.T, atol=0.0)


def test_an_indefinite_matrix_is_not_condensed() -> None:
    pytest.importorskip("pypardiso", reason="pypardiso is not installed")
    factor = Pardiso(threads=1).factor(sp.csc_array(lattice(6) - 1.93 * sp.eye_array(36)))
    assert factor.schur_complement(np.arange(4)) is None
