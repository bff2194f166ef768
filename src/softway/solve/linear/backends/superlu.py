"""SuperLU of SciPy, which is always installed."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import DTypeLike
from scipy.sparse.linalg import splu

from softway.arrays import Array
from softway.solve.linear.interface import Factor, Precision, finite, number_type, unfactored
from softway.solve.linear.power_scaling import enlarged, reduced


@dataclass(frozen=True, slots=True)
class SuperLU:
    """SciPy's SuperLU with a symmetric ordering and diagonal pivots, on one thread.

    Its analysis does nothing: SciPy offers no factorisation in two steps.

    Parameters
    ----------
    precision
        Precision of the factor.

    References
    ----------
    Li (2005), ACM Trans. Math. Software 31, 302-325.

    Examples
    --------
    >>> import numpy as np
    >>> SuperLU().factor(sp.csc_array(np.diag([2.0, 4.0]))).solve(np.array([2.0, 2.0]))
    array([1. , 0.5])
    """

    precision: Precision = "double"

    def __post_init__(self) -> None:
        number_type(self.precision)

    def analyse(self, matrix: sp.csc_array) -> "SuperLU":
        """The solver itself, for a sparse symmetric matrix (f, f)."""
        return self

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Factor a sparse symmetric matrix (f, f).

        Raises
        ------
        NoConvergence
            If the matrix is singular.
        """
        symmetric = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
        return _factored(matrix, self.precision, symmetric)


def factor_unsymmetric(matrix: sp.csc_array) -> Factor:
    """Factor a sparse matrix (f, f) that need not be symmetric.

    Raises
    ------
    NoConvergence
        If the matrix is singular.

    Examples
    --------
    >>> import numpy as np
    >>> factor_unsymmetric(sp.csc_array(np.array([[0.0, 2.0], [4.0, 1.0]]))).solve(np.array([2.0, 5.0]))
    array([1., 1.])
    """
    return _factored(matrix, "double", {})


def _factored(matrix: sp.csc_array, precision: Precision, how: dict[str, Any]) -> Factor:
    """Factor of a matrix, with the options of SuperLU."""
    finite(matrix)
    matrix, power = enlarged(matrix, precision)
    kind = number_type(precision)
    try:
        lu = splu(sp.csc_matrix(matrix, dtype=kind), **how)
    except RuntimeError as error:
        raise unfactored(matrix.shape[0], error) from None
    return reduced(_LU(lu, kind), power)


@dataclass(frozen=True, slots=True, eq=False)
class _LU:
    """Factors L and U of SuperLU."""

    lu: Any
    kind: DTypeLike

    @property
    def bytes(self) -> int:
        return int(self.lu.nnz) * np.dtype(self.kind).itemsize

    @property
    def indefinite(self) -> bool:
        off_diagonal = not np.array_equal(self.lu.perm_r, self.lu.perm_c)
        return off_diagonal or bool((self.lu.U.diagonal() <= 0.0).any())

    def solve(self, b: Array) -> Array:
        return np.asarray(self.lu.solve(np.asarray(b, self.kind)), float)
