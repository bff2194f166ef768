"""Dual shape functions of linear facets that may be partly covered.

On the covered part of a facet with shape functions ``N_k >= 0``, the dual ones ``psi_j = sum_k A_jk N_k`` satisfy
``int psi_j N_k = delta_jk int N_k``.  They add up to one, so the multipliers transmit a uniform pressure on any covered
part (docs/theory/contact/mortar.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.kernels.mortar.dual_basis import dual_bases, warped


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DualBasis:
    """Test functions of f facets with b nodes.

    Parameters
    ----------
    coefficients
        (f, b, b) of the shape functions N_k in the test functions psi_j.
    own
        (f, b, b) ``int psi_j N_k`` [m^r]: diagonal where enough of the facet is covered.
    """

    coefficients: Array
    own: Array


def dual_basis(mass: Array, coverage: Array, warp: Array | None = None) -> DualBasis:
    """Test functions over the covered parts.

    Parameters
    ----------
    mass
        (f, b, b) ``int N_j N_k`` over the covered parts [m^r].
    coverage
        (f,) covered fraction of each facet.
    warp
        (f, b) nodal values of the functions that are zero in the middle; ``None``: the facets cannot be warped.

    Examples
    --------
    A segment of length one, covered completely:

    >>> made = dual_basis(np.array([[[1.0, 0.5], [0.5, 1.0]]]) / 3.0, np.ones(1))
    >>> made.coefficients.round(12).tolist(), made.own.tolist()
    ([[[2.0, -1.0], [-1.0, 2.0]]], [[[0.5, 0.0], [0.0, 0.5]]])
    """
    made = DualBasis(coefficients=np.empty(mass.shape), own=np.empty(mass.shape))
    bent = np.zeros(mass.shape[:2]) if warp is None else warp
    dual_bases(mass, coverage, bent, made.coefficients, made.own)
    return made


def warping(corners: Array) -> Array:
    """Nodal values (f, 4) of the functions on four-node facets (f, 4, 3) that are orthogonal to every linear one.

    Examples
    --------
    >>> square = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]])
    >>> warping(square).tolist()
    [[0.5, -0.5, 0.5, -0.5]]
    """
    out = np.empty(corners.shape[:2])
    warped(corners.reshape(-1, 3), np.arange(4 * len(corners)).reshape(-1, 4), out)
    return out
