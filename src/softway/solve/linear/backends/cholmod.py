"""Supernodal Cholesky factor of CHOLMOD, by scikit-sparse."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.errors import InputError
from softway.solve.linear.interface import Precision, finite, number_type, unfactored
from softway.solve.linear.pattern import Pattern


@dataclass(frozen=True, slots=True)
class Cholmod:
    """CHOLMOD, for positive definite matrices only.  Its threads are those of its BLAS.

    Parameters
    ----------
    precision
        Double only.

    References
    ----------
    Chen, Davis, Hager, Rajamanickam (2008), ACM Trans. Math. Software 35, 22.

    Examples
    --------
    >>> Cholmod().precision
    'double'
    """

    precision: Precision = "double"

    def __post_init__(self) -> None:
        if number_type(self.precision) is not np.float64:
            raise InputError("precision", "CHOLMOD has no factors in single precision", "double, or another backend")

    def analyse(self, matrix: sp.csc_array) -> "_Analysis":
        """Order the unknowns of a sparse symmetric matrix (f, f).

        Raises
        ------
        ImportError
            If scikit-sparse is not installed.
        """
        from sksparse.cholmod import analyze

        order = analyze(sp.csc_matrix(matrix), mode="supernodal", ordering_method="metis")
        return _Analysis(Pattern.of(matrix), order, [])

    def factor(self, matrix: sp.csc_array) -> "_Factor":
        """Analyse and factor a sparse symmetric matrix (f, f)."""
        return self.analyse(matrix).factor(matrix)


@dataclass(frozen=True, slots=True, eq=False)
class _Analysis:
    """Symbolic factor of a pattern; ``entries`` caches their number: counting copies a factor."""

    pattern: Pattern
    order: Any
    entries: list[int]

    def factor(self, matrix: sp.csc_array) -> "_Factor":
        from sksparse.cholmod import CholmodError

        finite(matrix)
        self.pattern.require(matrix)
        try:
            return _Factor(self.order.cholesky(sp.csc_matrix(matrix)), self.entries)
        except CholmodError as error:
            raise unfactored(matrix.shape[0], error) from None


@dataclass(frozen=True, slots=True, eq=False)
class _Factor:
    """A factor of CHOLMOD."""

    cholesky: Any
    entries: list[int]

    @property
    def bytes(self) -> int:
        if not self.entries:
            self.entries.append(int(self.cholesky.L().nnz))
        return 8 * self.entries[0]

    @property
    def indefinite(self) -> bool:
        return False  # such a matrix has no factor

    def solve(self, b: Array) -> Array:
        return np.asarray(self.cholesky(b)) if b.size else np.zeros(b.shape)
