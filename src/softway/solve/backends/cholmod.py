"""CHOLMOD's supernodal Cholesky factor, by scikit-sparse."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.errors import InputError
from softway.solve.linear import Precision, finite, number_type, unfactored
from softway.solve.pattern import Pattern
from softway.typing import Array


@dataclass(frozen=True, slots=True)
class Cholmod:
    """CHOLMOD: matrices that are not positive definite have no factor. Its threads are those of its BLAS.

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
            raise InputError("precision", "CHOLMOD has no factors of single precision", "double, or another backend")

    def analyse(self, matrix: sp.csc_array) -> "_Analysis":
        """Order the unknowns of a sparse symmetric matrix (f, f).

        Raises
        ------
        ImportError
            If scikit-sparse is not there.
        """
        from sksparse.cholmod import analyze

        order = analyze(sp.csc_matrix(matrix), mode="supernodal", ordering_method="metis")
        return _Analysis(Pattern.of(matrix), order, [])

    def factor(self, matrix: sp.csc_array) -> "_Factor":
        """Analyse and factor a sparse symmetric matrix (f, f)."""
        return self.analyse(matrix).factor(matrix)


@dataclass(frozen=True, slots=True, eq=False)
class _Analysis:
    """Symbolic factor of a pattern; ``entries`` holds their number once it was asked for: counting copies a factor."""

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

    held: Any
    entries: list[int]

    @property
    def bytes(self) -> int:
        if not self.entries:
            self.entries.append(int(self.held.L().nnz))
        return 8 * self.entries[0]

    def solve(self, b: Array) -> Array:
        return np.asarray(self.held(b)) if b.size else np.zeros(b.shape)
