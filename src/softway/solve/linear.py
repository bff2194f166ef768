"""Linear solvers behind one protocol: factor once, solve many times."""

from dataclasses import dataclass
from typing import Any, Protocol

import scipy.sparse as sp
from scipy.sparse.linalg import splu

from softway.errors import NoConvergence
from softway.typing import Array


class Factor(Protocol):
    """A factored symmetric matrix."""

    def solve(self, b: Array) -> Array:
        """Solution of A x = b for b (f,) or (f, k)."""
        ...


class LinearSolver(Protocol):
    """A direct solver."""

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Factor a sparse symmetric matrix (f, f)."""
        ...


@dataclass(frozen=True, slots=True)
class SuperLU:
    """SciPy's SuperLU with a symmetric ordering and diagonal pivots.

    Examples
    --------
    >>> import numpy as np
    >>> SuperLU().factor(sp.csc_array(np.diag([2.0, 4.0]))).solve(np.array([2.0, 2.0]))
    array([1. , 0.5])
    """

    def factor(self, matrix: sp.csc_array) -> Factor:
        """Factor a sparse symmetric matrix (f, f).

        Raises
        ------
        NoConvergence
            If it is singular.
        """
        try:
            lu: Any = splu(
                sp.csc_matrix(matrix),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:
            raise NoConvergence(f"the operator of {matrix.shape[0]} unknowns cannot be factored ({error})") from None
        return lu
