"""The direct solver of a computation: the one asked for, or the next that works here."""

from collections.abc import Callable, Mapping
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
    return named(PREFERRED[0], precision, threads)


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
    chosen = BACKENDS[name](precision, threads)
    reasons = []
    for other in (name, *(n for n in PREFERRED if n != name)):
        try:
            solver = chosen if other == name else BACKENDS[other](precision, threads)
            _tried(solver)
        except Exception as error:
            reasons.append(f"{other} does not work here ({type(error).__name__}: {error})")
            continue
        if reasons:
            LOG.warning("%s; %s is used instead\n  try: pip install 'softway[%s]'", "; ".join(reasons), other, name)
        return solver
    raise ImportError("; ".join(reasons))


def _tried(solver: LinearSolver) -> None:
    """Solve with the matrix (10, 10) of a chain of springs."""
    matrix = sp.csc_array(sp.diags_array([-1.0, 2.5, -1.0], offsets=[-1, 0, 1], shape=(10, 10)))  # type: ignore[arg-type]
    x = np.arange(1.0, 11.0)
    error = float(np.abs(solver.factor(matrix).solve(matrix @ x) - x).max())
    if not error < 1e-4:
        raise NoConvergence(f"the solution of ten equations is off by {error:.2g}")
