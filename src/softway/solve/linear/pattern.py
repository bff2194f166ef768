"""Pattern of a sparse matrix."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import IntArray
from softway.errors import InputError


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """Pattern of the entries of a matrix (f, f) by columns: ``starts`` (f + 1,) and row ``indices`` (z,).

    Examples
    --------
    >>> Pattern.of(sp.csc_array(np.eye(2))).require(sp.csc_array(2.0 * np.eye(2)))
    """

    starts: IntArray
    indices: IntArray

    @classmethod
    def of(cls, matrix: sp.csc_array) -> "Pattern":
        """Pattern of a matrix (f, f)."""
        return cls(matrix.indptr.copy(), matrix.indices.copy())

    def require(self, matrix: sp.csc_array) -> None:
        """Raise :class:`InputError` unless a matrix (f, f) has this pattern."""
        if not (np.array_equal(matrix.indptr, self.starts) and np.array_equal(matrix.indices, self.indices)):
            raise InputError("matrix", "its pattern differs from the analysed one", "a new analysis")
