"""Free lateral faces: lateral strains of bars and plates without lateral stress.

The lateral normal strains of a bar or a plate minimise the stored energy, so that the lateral stress vanishes.  They
are found by Newton's method on the energy.  For Green's measure the unknowns are logarithmic strains: the neo-Hookean
energy is convex in them, and no iterate can invert the material.
"""

import numpy as np

from softway.arrays import Array
from softway.laws.law import StoredEnergy

_TOLERANCE = 1e-9  # last correction of a lateral strain; the remaining error is about its square
_LIMIT = 50  # Newton's method needs 1 to 6 steps where a lateral strain exists


def completed(law: StoredEnergy, E: Array, free: tuple[int, ...]) -> Array:
    """Complete strain (..., 3, 3) from the strain (..., m, m) along the cell.

    The axes ``free`` have no normal stress; the other axes across the cell have no strain.  The result is ``nan`` where
    no lateral strain exists.

    Examples
    --------
    >>> from softway.laws.bulk import LinearElastic
    >>> completed(LinearElastic(E=1.0, nu=0.25), np.array([[0.4]]), (1, 2)).diagonal().round(15).tolist()
    [0.4, -0.1, -0.1]
    """
    m = E.shape[-1]
    full = np.zeros((*E.shape[:-2], 3, 3))
    full[..., :m, :m] = E
    if not free:
        return full
    axes = np.array(free)
    if law.linear:
        full[..., axes, axes] = law.measure.lateral(_first_guess(law, E, axes))[0]
        return full
    with np.errstate(all="ignore"):
        y = _first_guess(law, E, axes)
        for _ in range(_LIMIT):
            full[..., axes, axes], slope, curvature = law.measure.lateral(y)
            gradient = law.stress(full)[..., axes, axes]
            moduli = law.tangent(full)[..., axes, axes, :, :][..., axes, axes]
            hessian = moduli * slope[..., :, None] * slope[..., None, :]
            hessian += (gradient * curvature)[..., None] * np.eye(len(free))
            step = np.linalg.solve(_regular(hessian), (gradient * slope)[..., None])[..., 0]
            y = y - step
            if not np.any(np.abs(step) > _TOLERANCE):
                break
        y = np.where(np.abs(step) > _TOLERANCE, np.nan, y)
        full[..., axes, axes] = law.measure.lateral(y)[0]
    return full


def condensed(C: Array, m: int, free: tuple[int, ...]) -> Array:
    """Moduli (..., m, m, m, m) along the cell, from the complete moduli (..., 3, 3, 3, 3) and ``free`` lateral faces.

    Examples
    --------
    >>> from softway.kernels.linalg.tensors import isotropic
    >>> float(condensed(isotropic(1.0, 1.0), 1, (1, 2))[0, 0, 0, 0])
    2.5
    """
    inside = C[..., :m, :m, :m, :m]
    if not free:
        return inside
    axes = np.array(free)
    coupling = C[..., :m, :m, axes, axes]
    stiffness = C[..., axes, axes, :, :][..., axes, axes]
    follow = np.linalg.solve(_regular(stiffness)[..., None, None, :, :], coupling[..., None])[..., 0]
    return inside - np.einsum("...ijf,...klf->...ijkl", coupling, follow)


def _first_guess(law: StoredEnergy, E: Array, axes: Array) -> Array:
    """Parameters of the lateral strains from the moduli of the undeformed material; exact for a linear law."""
    C, m = law.tangent(np.zeros((3, 3))), E.shape[-1]
    coupling = C[axes, axes, :m, :m].reshape(len(axes), m * m)
    ratio = np.linalg.solve(C[axes[:, None], axes[:, None], axes, axes], coupling)
    return -law.measure.parameters(E).reshape(*E.shape[:-2], m * m) @ ratio.T


def _regular(A: Array) -> Array:
    """Replace singular or unbounded matrices of A, which the solver would reject, by ``nan``."""
    det = A[..., 0, 0] if A.shape[-1] == 1 else A[..., 0, 0] * A[..., 1, 1] - A[..., 0, 1] * A[..., 1, 0]
    bad = ~(np.isfinite(det) & (det != 0.0))
    return np.where(bad[..., None, None], np.nan, A) if np.any(bad) else A
