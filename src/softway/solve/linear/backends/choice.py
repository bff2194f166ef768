"""Choice of the direct solver: the requested one, or the next that works on this machine."""

import platform
import sys
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp

from softway.errors import InputError, NoConvergence
from softway.solve.linear.backends.cholmod import Cholmod
from softway.solve.linear.backends.mumps import Mumps
from softway.solve.linear.backends.pardiso import Pardiso
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import LOG, LinearSolver, Precision, counted, number_type

Made = Callable[[Precision, int | None], LinearSolver]

BACKENDS: Mapping[str, Made] = MappingProxyType(
    {
        "pardiso": Pardiso,
        "cholmod": lambda precision, threads: Cholmod(precision),
        "superlu": lambda precision, threads: SuperLU(precision),
        "mumps": Mumps,
    }
)
"""Backends by name."""

PREFERRED = ("pardiso", "cholmod", "superlu")
"""Backends in the order of preference, the fastest first."""


def best_solver(precision: Precision = "double", threads: int | None = None) -> LinearSolver:
    """Fastest direct solver that works on this machine.

    To be called once in a computation; it warns in the log if a faster solver is missing.

    Parameters
    ----------
    precision
        Precision of the factor.
    threads
        None for the default of the library; CHOLMOD uses the threads of its BLAS, SuperLU one thread.

    Examples
    --------
    >>> solver = best_solver("single", threads=1)
    >>> solver.precision
    'single'
    """
    number_type(precision)
    counted(threads)
    return _working(_offered(precision), precision, threads)


def solver_named(name: str, precision: Precision = "double", threads: int | None = None) -> LinearSolver:
    """Direct solver by name; if it does not work here, the next one, with a warning in the log.

    Parameters
    ----------
    name
        pardiso, cholmod, mumps or superlu.
    precision, threads
        As in :func:`best_solver`.

    Raises
    ------
    InputError
        If there is no such backend, or it does not support the precision.

    Examples
    --------
    >>> solver_named("superlu")
    SuperLU(precision='double')
    """
    require_solver(name, precision, threads)
    return _working([name, *(n for n in _offered(precision) if n != name)], precision, threads)


def require_solver(name: str, precision: Precision = "double", threads: int | None = None) -> None:
    """Refuse a name without a backend, and a precision or a number of threads that the backend does not support.

    Raises
    ------
    InputError
        With the parameter.
    """
    number_type(precision)
    counted(threads)
    if name not in BACKENDS:
        raise InputError("linear", f"no solver '{name}'", ", ".join(BACKENDS))
    BACKENDS[name](precision, threads)


def _offered(precision: Precision) -> list[str]:
    """Preferred backends for this machine and a precision."""
    supported = platform.machine() in ("x86_64", "AMD64") and sys.platform in ("linux", "win32")
    possible = {"pardiso": supported, "cholmod": precision == "double"}
    return [n for n in PREFERRED if possible.get(n, True)]


def _working(names: Iterable[str], precision: Precision, threads: int | None) -> LinearSolver:
    """First backend that works; a warning names the ones that do not."""
    reasons: dict[str, str] = {}
    for name in names:
        try:
            solver = BACKENDS[name](precision, threads)
            _tried(solver)
        except Exception as error:
            reasons[name] = f"{name} does not work here ({type(error).__name__}: {error})"
            continue
        if reasons:
            what, extra = "; ".join(reasons.values()), next(iter(reasons))
            LOG.warning("%s; %s is used instead\n  try: pip install 'softway[%s]'", what, name, extra)
        return solver
    raise ImportError("; ".join(reasons.values()))


def _tried(solver: LinearSolver) -> None:
    """Test a solver with the matrix (10, 10) of a chain of springs."""
    matrix = sp.csc_array(sp.diags_array([-1.0, 2.5, -1.0], offsets=[-1, 0, 1], shape=(10, 10)))  # type: ignore[arg-type]
    x = np.arange(1.0, 11.0)
    error = float(np.abs(solver.factor(matrix).solve(matrix @ x) - x).max())
    if not error < 1e-4:
        raise NoConvergence(f"the solution of ten equations is off by {error:.2g}")
