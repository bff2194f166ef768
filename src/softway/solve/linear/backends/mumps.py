"""Multifrontal solver MUMPS, by python-mumps, with Schur complements."""

import weakref
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.solve.linear.interface import Factor, Precision, counted, finite, number_type, unfactored
from softway.solve.linear.pattern import Pattern
from softway.solve.linear.power_scaling import enlarged, reduced

THREADS = 16
"""Entry of ``icntl`` that sets the number of threads."""
NEGATIVE = 11
"""Entry of ``infog`` with the number of negative pivots."""


@dataclass(frozen=True, slots=True)
class Mumps:
    """MUMPS: L D L^T with pivots of one or two rows; the matrix may be indefinite.

    Parameters
    ----------
    precision
        Precision of the factor.
    threads
        None for the default of the library.

    References
    ----------
    Amestoy, Duff, L'Excellent, Koster (2001), SIAM J. Matrix Anal. Appl. 23, 15-41.

    Examples
    --------
    >>> Mumps(threads=1).threads
    1
    """

    precision: Precision = "double"
    threads: int | None = None

    def __post_init__(self) -> None:
        number_type(self.precision)
        counted(self.threads)

    def analyse(self, matrix: sp.csc_array) -> "_Analysis":
        """Order the unknowns of a sparse symmetric matrix (f, f).

        Raises
        ------
        ImportError
            If python-mumps is not installed.
        NoConvergence
            If the matrix is structurally singular.
        """
        analysis = _Analysis(self, Pattern.of(matrix), [])
        analysis.idle.append(analysis.context(matrix))
        return analysis

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Analyse and factor a sparse symmetric matrix (f, f)."""
        return self.analyse(matrix).factor(matrix)

    def _loaded(self, matrix: sp.csc_array) -> Any:
        from mumps import Context

        finite(matrix)
        context = Context()
        context.set_matrix(matrix.astype(number_type(self.precision)), symmetric=True)
        if self.threads is not None:
            context.mumps_instance.icntl[THREADS] = self.threads
        return context


@dataclass(frozen=True, slots=True, eq=False)
class _Analysis:
    """Analysed pattern; ``idle`` contains the memory of unused factors."""

    solver: Mumps
    pattern: Pattern
    idle: list[Any]

    def factor(self, matrix: sp.csc_array) -> Factor:
        finite(matrix)
        matrix, power = enlarged(matrix, self.solver.precision)
        self.pattern.require(matrix)
        context = self.context(matrix)
        kind = np.dtype(number_type(self.solver.precision))
        kept = matrix.astype(kind)
        context.set_matrix(kept, symmetric=True)
        try:
            context.factor(reuse_analysis=True)
        except RuntimeError as error:
            raise unfactored(matrix.shape[0], error) from None
        size = int(context.factor_stats.nonzeros) * kind.itemsize
        factor = _Factor(self.solver, kept, context, kind, size)
        weakref.finalize(factor, self.idle.append, context).atexit = False
        return reduced(factor, power)

    def context(self, matrix: sp.csc_array) -> Any:
        """Analysed memory for a matrix of this pattern."""
        if self.idle:
            return self.idle.pop()
        context = self.solver._loaded(matrix)
        try:
            context.analyze()
        except RuntimeError as error:
            raise unfactored(matrix.shape[0], error) from None
        return context


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class _Factor:
    """Factor of a ``matrix`` (f, f) in the memory of MUMPS."""

    solver: Mumps
    matrix: sp.csc_array
    context: Any
    kind: np.dtype[Any]
    bytes: int

    @property
    def indefinite(self) -> bool:
        return int(self.context.mumps_instance.infog[NEGATIVE]) > 0

    def solve(self, b: Array) -> Array:
        if not b.size:
            return np.zeros(b.shape)
        return np.asarray(self.context.solve(np.array(b, self.kind, order="F"), overwrite_b=True), float)

    def schur_complement(self, which: IntArray) -> Array | None:
        """Schur complement (k, k) at the unknowns ``which`` (k,), by a factor of its own that ends there; None if the
        matrix is not positive definite.
        """
        if self.indefinite:
            return None
        try:
            lower = self.solver._loaded(self.matrix).schur(which)
        except RuntimeError:
            return None
        return np.asarray(np.tril(lower) + np.tril(lower, -1).T, float)
