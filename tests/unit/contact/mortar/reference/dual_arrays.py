"""NumPy reference: dual shape functions of linear facets that may be partly covered.

On the covered part of a facet with shape functions ``N_k >= 0``, the dual ones ``psi_j = sum_k A_jk N_k`` satisfy
``int psi_j N_k = delta_jk int N_k``.  They add up to one, so the multipliers transmit a uniform pressure on any covered
part (docs/theory/contact/mortar.md).
"""

import numpy as np

from softway.arrays import Array
from softway.contact.mortar.dual_basis import DualBasis

DUAL, MEAN = 0.999, 0.5
"""Covered fractions above which the basis is dual, and below which it is the shape functions; mixed in between: a dual
function on a partly covered facet extrapolates, and would detect overlap where curved surfaces separate."""
ROUND = 0.2
"""Last part of the way between both that is round."""
STIFF = 1e-6
"""Penalty of warping, relative to the mass: a partly covered four-node facet does not determine it."""


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

    """
    b = mass.shape[-1]
    sums = mass.sum(axis=2)
    mean = mean_part(coverage)[:, None, None]
    diagonal = sums[:, :, None] * np.eye(b)
    regular = mass
    if warp is not None:
        penalty = STIFF * sums.sum(axis=1) * np.where(np.real(coverage) < 1.0, 1.0 - coverage, 0.0)
        regular = mass + penalty[:, None, None] * warp[:, :, None] * warp[:, None, :]
    regular = np.where(np.real(mean) < 1.0, regular, np.eye(b))
    coefficients = (1.0 - mean) * (sums[:, :, None] * np.linalg.inv(regular)) + mean * np.eye(b)
    return DualBasis(coefficients=coefficients, own=(1.0 - mean) * diagonal + mean * mass)


def mean_part(coverage: Array) -> Array:
    """Part (f,) of the shape functions in the basis of facets of which these fractions are covered, complex or not: a
    line that begins at ``DUAL``, and a parabola with a horizontal tangent at ``MEAN``.
    """
    way = (DUAL - coverage) / (DUAL - MEAN)
    slope, here = 1.0 / (1.0 - 0.5 * ROUND), np.real(way)
    bent = 1.0 - slope * (1.0 - way) ** 2 / (2.0 * ROUND)
    return np.select([here <= 0.0, here <= 1.0 - ROUND, here < 1.0], [0.0 * way, slope * way, bent], 1.0 + 0.0 * way)


def warping(corners: Array) -> Array:
    """Nodal values (f, 4) of the functions on four-node facets (f, 4, 3) that are orthogonal to every linear one."""
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    area = np.einsum("fki,fi->fk", np.cross(after, before), normal)  # twice the triangle at each corner
    opposite = np.roll(area, 2, axis=1) * np.array([1.0, -1.0, 1.0, -1.0])
    return np.asarray(opposite / np.sum(normal**2, axis=1)[:, None])
