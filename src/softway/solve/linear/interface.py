"""Direct solvers behind one protocol: analyse a pattern once, factor its matrices, solve many times."""

import logging
from collections.abc import Callable
from typing import Literal, Protocol, runtime_checkable

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.errors import InputError, NoConvergence

LOG = logging.getLogger(__name__)

Precision = Literal["double", "single"]
"""Precision of the numbers of a factor; right-hand sides and solutions are in double precision."""


class Factor(Protocol):
    """A factored symmetric matrix."""

    @property
    def bytes(self) -> int:
        """Bytes of the entries of the factor."""
        ...

    @property
    def indefinite(self) -> bool:
        """True if the factor shows that the matrix is not positive definite."""
        ...

    def solve(self, b: Array) -> Array:
        """Solution of A x = b for b (f,) or (f, k)."""
        ...


@runtime_checkable
class CondensingFactor(Protocol):
    """Factor of a library that also eliminates all unknowns but a few."""

    @property
    def bytes(self) -> int:
        """Bytes of the entries of the factor."""
        ...

    def schur_complement(self, which: IntArray) -> Array | None:
        """Schur complement (k, k) at the unknowns ``which`` (k,): the inverse of that block of the inverse matrix; None
        if the library cannot eliminate the others.
        """
        ...


class Analysis(Protocol):
    """Symbolic analysis of the pattern of a matrix: order of elimination and places of the entries."""

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Factor a matrix (f, f) of the analysed pattern."""
        ...


class LinearSolver(Protocol):
    """A direct solver of symmetric matrices, stored with both triangles and sorted indices."""

    @property
    def precision(self) -> Precision:
        """Precision of the factors."""
        ...

    def analyse(self, matrix: sp.csc_array) -> Analysis:
        """Order the unknowns of a sparse symmetric matrix (f, f)."""
        ...

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Analyse and factor a sparse symmetric matrix (f, f)."""
        ...


def number_type(precision: Precision) -> type[np.float32] | type[np.float64]:
    """Type of the numbers of a factor.

    Examples
    --------
    >>> number_type("single").__name__
    'float32'
    """
    if precision not in ("double", "single"):
        raise InputError("precision", f"'{precision}'", "double or single")
    return np.float32 if precision == "single" else np.float64


def counted(threads: int | None) -> None:
    """Refuse a number of threads below one."""
    if threads is not None and threads < 1:
        raise InputError("threads", f"{threads}", "1 or more, or None for the default of the library")


def unfactored(size: int, why: object) -> NoConvergence:
    """Exception for an operator of ``size`` unknowns that cannot be factored."""
    return NoConvergence(f"the operator of {size} unknowns cannot be factored ({why})")


def finite(matrix: sp.csc_array) -> None:
    """Raise :class:`NoConvergence` if an entry is not a number."""
    if not np.isfinite(matrix.data).all():
        raise unfactored(matrix.shape[0], "an entry is not a number")


def by_columns(solve: Callable[[Array], Array], b: Array) -> Array:
    """Solution (f,) or (f, k) by a ``solve`` with right-hand sides and solutions as rows (k, f)."""
    return solve(b[None])[0] if b.ndim == 1 else solve(np.ascontiguousarray(b.T)).T
