"""The direct solver of a computation: the one asked for, or the next that works here."""

import platform
import sys
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp

from softway.errors import InputError, NoConvergence
from softway.solve.backends.cholmod import Cholmod
from softway.solve.backends.mumps import Mumps
from softway.solve.backends.pardiso import Pardiso
from softway.solve.linear import LOG, LinearSolver, Precision, SuperLU, counted, number_type

Made = Callable[[Precision, int | None], LinearSolver]

BACKENDS: Mapping[str, Made] = MappingProxyType(
    {
        "pardiso": Pardiso,
        "cholmod": lambda precision, threads: Cholmod(precision),
        "superlu": lambda precision, threads: SuperLU(precision),
        "mumps": Mumps,
    }
)
"""Every backend by its name."""

PREFERRED = ("pardiso", "cholmod", "superlu")
"""Backends to try, the fastest first."""


def best(precision: Precision = "double", threads: int | None = None) -> LinearSolver:
    """The fastest direct solver that works here.

    It is meant to be called once for a computation, and warns in the log if a faster one is missing.

    Parameters
    ----------
    precision
        Of the factor.
    threads
        None for all that the library would use; CHOLMOD takes those of its BLAS, SuperLU one.

    Examples
    --------
    >>> solver = best("single", threads=1)
    >>> solver.precision
    'single'
    """
    number_type(precision)
    counted(threads)
    return _working(_offered(precision), precision, threads)


def named(name: str, precision: Precision = "double", threads: int | None = None) -> LinearSolver:
    """The direct solver of a name, or with one warning in the log the next that works here.

    Parameters
    ----------
    name
        pardiso, cholmod, mumps or superlu.
    precision, threads
        As in :func:`best`.

    Raises
    ------
    InputError
        If there is no such backend, or it does not know the precision.

    Examples
    --------
    >>> named("superlu")
    SuperLU(precision='double')
    """
    number_type(precision)
    counted(threads)
    if name not in BACKENDS:
        raise InputError("linear", f"no solver '{name}'", ", ".join(BACKENDS))
    BACKENDS[name](precision, threads)
    return _working([name, *(n for n in _offered(precision) if n != name)], precision, threads)


def _offered(precision: Precision) -> list[str]:
    """Preferred backends that there are for this machine and a precision."""
    known = platform.machine() in ("x86_64", "AMD64") and sys.platform in ("linux", "win32")
    possible = {"pardiso": known, "cholmod": precision == "double"}
    return [n for n in PREFERRED if possible.get(n, True)]


def _working(names: Iterable[str], precision: Precision, threads: int | None) -> LinearSolver:
    """The first backend that works; those before it are named in a warning."""
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
    """Solve with the matrix (10, 10) of a chain of springs."""
    matrix = sp.csc_array(sp.diags_array([-1.0, 2.5, -1.0], offsets=[-1, 0, 1], shape=(10, 10)))  # type: ignore[arg-type]
    x = np.arange(1.0, 11.0)
    error = float(np.abs(solver.factor(matrix).solve(matrix @ x) - x).max())
    if not error < 1e-4:
        raise NoConvergence(f"the solution of ten equations is off by {error:.2g}")
