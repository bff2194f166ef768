"""Factor of an operator that has to be positive definite."""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.errors import NoConvergence
from softway.solve.linear.interface import Analysis, Factor, finite

SHIFTS = tuple(4.0**k for k in range(-8, -3)) + tuple(2.0**k for k in range(-5, 2))
"""Multiples of the sums of absolute entries that are tried; with the last one every matrix is positive definite."""


def positive_definite_factor(analysis: Analysis, matrix: sp.csc_array) -> Factor:
    """Factor of ``A + s D``, with the least tried s for which it is positive definite.

    D is the diagonal matrix of the sums of the absolute entries in the columns of the symmetric matrix A; s is zero if
    A is positive definite.

    Parameters
    ----------
    analysis
        Symbolic analysis of the pattern of A, which stores its diagonal.
    matrix
        (f, f) A.

    Raises
    ------
    NoConvergence
        If an entry is not a number, or a column is zero.

    References
    ----------
    Nocedal, Wright (2006), Numerical optimization, 3.4: Newton's method with modified Hessian.

    Examples
    --------
    >>> from softway.solve.linear.backends.superlu import SuperLU
    >>> saddle = sp.csc_array(np.array([[1.0, 2.0], [2.0, 1.0]]))
    >>> positive_definite_factor(SuperLU(), saddle).solve(np.array([9.0, 9.0]))  # 3/8 of the sums 3 do not suffice
    array([2., 2.])
    """
    finite(matrix)
    sums = np.asarray(abs(matrix).sum(axis=0)).ravel()
    for shift in (0.0, *SHIFTS[:-1]):
        try:
            factor = analysis.factor(_shifted(matrix, shift * sums))
        except NoConvergence:
            continue
        if not factor.indefinite:
            return factor
    return analysis.factor(_shifted(matrix, SHIFTS[-1] * sums))


def _shifted(matrix: sp.csc_array, shift: Array) -> sp.csc_array:
    """Matrix (f, f) with values (f,) added to its diagonal; its pattern is kept."""
    columns = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    data = matrix.data + np.where(matrix.indices == columns, shift[columns], 0.0)
    return sp.csc_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)
