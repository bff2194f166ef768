"""Every direct solver passes the public examination; those that are not installed are skipped."""

import pytest

from softway.solve.linear.backends import Cholmod, Mumps, Pardiso
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import LinearSolver
from softway.testing import check_solver

SOLVERS: list[tuple[str | None, LinearSolver]] = [
    (None, SuperLU()),
    (None, SuperLU("single")),
    ("sksparse", Cholmod()),
    *(
        (module, kind(p, t))
        for module, kind in (("pypardiso", Pardiso), ("mumps", Mumps))
        for p in ("double", "single")
        for t in (None, 1, 2)
    ),
]


@pytest.mark.parametrize(("module", "solver"), SOLVERS, ids=lambda x: repr(x))
def test_direct_solvers_pass(module: str | None, solver: LinearSolver) -> None:
    if module is not None:
        pytest.importorskip(module, reason=f"{module} is not installed")
    check_solver(solver)
