"""Powers of two that keep the numbers of factors in single precision normal.

Compliances decay over a body.  With masses of micrograms as units, what is far away soon falls below 1e-38, the
smallest normal number of single precision, and processors take many times longer for subnormal numbers: the factor of
100,000 unknowns took four times as long.  Powers of two change no digit.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray, greatest
from softway.solve.linear.interface import CondensingFactor, Factor, Precision
from softway.tolerances import EXPONENT


def exponent(values: Array) -> int:
    """Exponent e for which the greatest of the values is about ``2^(EXPONENT - e)``; zero if all are zero.

    Examples
    --------
    >>> exponent(np.array([0.25, -1.0])), exponent(np.zeros(2))
    (59, 0)
    """
    most = greatest(values)
    return EXPONENT - int(np.frexp(most)[1]) if most > 0.0 and np.isfinite(most) else 0


def enlarged(matrix: sp.csc_array, precision: Precision) -> tuple[sp.csc_array, int]:
    """Matrix (f, f) times ``2^e``, and e: zero in double precision.

    Examples
    --------
    >>> matrix, e = enlarged(sp.csc_array([[1e-6]]), "single")
    >>> float(matrix[0, 0]) == 2.0**e * 1e-6, e
    (True, 79)
    """
    e = exponent(matrix.data) if precision == "single" else 0
    if e == 0:
        return matrix, 0
    return sp.csc_array((np.ldexp(matrix.data, e), matrix.indices, matrix.indptr), shape=matrix.shape), e


def reduced(factor: Factor, e: int) -> Factor:
    """Factor of A from that of ``2^e A``."""
    return PowerScaled(factor, e) if e else factor


@dataclass(frozen=True, slots=True, eq=False)
class PowerScaled:
    """Factor of A, made of the ``factor`` of ``2^e A``."""

    factor: Factor
    e: int

    @property
    def bytes(self) -> int:
        """Bytes of the entries of the factor."""
        return self.factor.bytes

    @property
    def indefinite(self) -> bool:
        """True if the factor shows that the matrix is not positive definite."""
        return self.factor.indefinite

    def solve(self, b: Array) -> Array:
        """Solution of A x = b for b (f,) or (f, k)."""
        k = exponent(b) if b.ndim == 1 else np.array([exponent(column) for column in b.T], int)
        return np.asarray(np.ldexp(self.factor.solve(np.ldexp(b, k)), self.e - k))

    def schur_complement(self, which: IntArray) -> Array | None:
        """Schur complement (k, k) at the unknowns ``which`` (k,), if the factor has one."""
        found = self.factor.schur_complement(which) if isinstance(self.factor, CondensingFactor) else None
        return None if found is None else np.asarray(np.ldexp(found, -self.e))
