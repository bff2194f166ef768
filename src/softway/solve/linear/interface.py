"""Direct solvers behind one protocol: analyse a pattern once, factor its matrices, solve many times."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import DTypeLike
from scipy.sparse.linalg import splu

from softway.arrays import Array
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
        finite(matrix)
        kind = number_type(self.precision)
        try:
            lu = splu(
                sp.csc_matrix(matrix, dtype=kind),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:
            raise unfactored(matrix.shape[0], error) from None
        return _LU(lu, kind)


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
