"""Kinematics of a time step (slab): strain increment, and push-forward of tensors.

The deformation gradients at both ends of a slab give the strain increment in the middle of the slab, and the maps that
push tensors forward from the start to the middle and from there to the end.  For corotational rates these maps are
rotations, for the Truesdell rate they are the deformation itself (docs/theory/bodies/rates.md).

The trace of every strain increment is set to ``ln J1/J0``: a closed cycle leaves no volume change.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg import tensors
from softway.laws.objective_rates import GreenNaghdi, Jaumann, Logarithmic, Rate, Truesdell


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabDeformation:
    """Deformation of the material in a slab.

    Parameters
    ----------
    strain
        (..., 3, 3) strain increment in the axes of the middle.
    first, second
        (..., 3, 3) maps A from start to middle and from middle to end; a stress s becomes ``A s A^T / det A``.
    """

    strain: Array
    first: Array
    second: Array


def slab_deformation(rate: Rate, F0: Array, F1: Array) -> SlabDeformation:
    """Compute the :class:`SlabDeformation` between two deformation gradients (..., 3, 3).

    Examples
    --------
    >>> turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    >>> quarter = slab_deformation(Jaumann(), np.eye(3), turn)
    >>> bool(abs(quarter.strain).max() < 1e-15), (quarter.second @ quarter.first).round(12).tolist() == turn.tolist()
    (True, True)
    """
    if isinstance(rate, Jaumann) and rate.increment == "polar":
        return _polar(F0, F1)
    middle = 0.5 * (F0 + F1)
    gradient = (F1 - F0) @ np.linalg.inv(middle)
    strain = _with_trace(tensors.symmetric(gradient), _dilation(gradient))
    match rate:
        case Jaumann():
            half = half_turn(gradient)
            return SlabDeformation(strain=strain, first=half, second=half)
        case GreenNaghdi():
            R0, Rm, R1 = (tensors.rotation(F) for F in (F0, middle, F1))
            return SlabDeformation(strain=strain, first=Rm @ _transposed(R0), second=R1 @ _transposed(Rm))
        case Logarithmic():
            half = half_turn(gradient + logarithmic_extra(middle, tensors.symmetric(gradient)))
            return SlabDeformation(strain=strain, first=half, second=half)
        case Truesdell():
            return SlabDeformation(strain=strain, first=middle @ np.linalg.inv(F0), second=F1 @ np.linalg.inv(middle))


def push_forward(T: Array, A: Array, rate: Rate) -> Array:
    """Push tensors T (..., 3, 3) forward by a map A (..., 3, 3).

    Examples
    --------
    >>> float(push_forward(np.eye(3), 2.0 * np.eye(3), Truesdell())[0, 0])
    0.5
    """
    moved = A @ T @ _transposed(A)
    return moved / tensors.determinant(A)[..., None, None] if isinstance(rate, Truesdell) else moved


def half_turn(gradient: Array) -> Array:
    """Square root (..., 3, 3) of the Cayley rotation of the skew part w of an increment (..., 3, 3).

    ``(I - w/2)^-1 (I + w/2)`` is the unit quaternion along (1, w/2), w as a vector; its square root halves the angle.

    Examples
    --------
    >>> quarter = np.array([[0.0, -2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]])  # tan(90/2) = 1 = |w|/2
    >>> half_turn(quarter)[0].round(6).tolist()
    [0.707107, -0.707107, 0.0]
    """
    x = 0.25 * (gradient[..., 2, 1] - gradient[..., 1, 2])
    y = 0.25 * (gradient[..., 0, 2] - gradient[..., 2, 0])
    z = 0.25 * (gradient[..., 1, 0] - gradient[..., 0, 1])
    length = np.sqrt(1.0 + (x * x + y * y + z * z))
    shrink = 1.0 / (1.0 + length)
    return _from_rodrigues(x * shrink, y * shrink, z * shrink)


def _from_rodrigues(x: Array, y: Array, z: Array) -> Array:
    """Rotation (..., 3, 3) with the Rodrigues vector (x, y, z): ``tan(angle/2)`` along the axis."""
    square = x * x + y * y + z * z
    scale = 2.0 / (1.0 + square)
    R = np.empty((*x.shape, 3, 3))
    R[..., 0, 0] = 1.0 - scale * (y * y + z * z)
    R[..., 1, 1] = 1.0 - scale * (z * z + x * x)
    R[..., 2, 2] = 1.0 - scale * (x * x + y * y)
    R[..., 0, 1], R[..., 1, 0] = scale * (x * y - z), scale * (x * y + z)
    R[..., 1, 2], R[..., 2, 1] = scale * (y * z - x), scale * (y * z + x)
    R[..., 2, 0], R[..., 0, 2] = scale * (z * x - y), scale * (z * x + y)
    return R


def logarithm(C: Array) -> Array:
    """Natural logarithm of symmetric positive definite (..., 3, 3)."""
    values, axes = np.linalg.eigh(C)
    with np.errstate(invalid="ignore", divide="ignore"):
        return (axes * np.log(values)[..., None, :]) @ _transposed(axes)


def logarithmic_extra(F: Array, D: Array) -> Array:
    """Difference of the logarithmic spin and W, (..., 3, 3) skew, for the deformation F and the stretching D.

    ``N_ij = ((b_i + b_j)/(b_j - b_i) ... + 2/ln(b_i/b_j)) D_ij`` in the principal axes of ``B = F F^T``, eq. (41) of
    Xiao, Bruhns, Meyers; with ``x = ln(b_i/b_j)/2`` the factor is ``1/x - coth x``, odd and -x/3 for small x.
    """
    values, axes = np.linalg.eigh(F @ _transposed(F))
    with np.errstate(invalid="ignore", divide="ignore"):
        x = 0.5 * (np.log(values)[..., :, None] - np.log(values)[..., None, :])
        small = np.abs(x) < 1e-3
        safe = np.where(small, 1.0, x)
        factor = np.where(small, -x / 3.0 * (1.0 - x * x / 15.0), 1.0 / safe - 1.0 / np.tanh(safe))
    return axes @ (factor * (_transposed(axes) @ D @ axes)) @ _transposed(axes)


def _polar(F0: Array, F1: Array) -> SlabDeformation:
    """Stretch followed by rotation: the axes of the middle are those of the start."""
    change = F1 @ np.linalg.inv(F0)
    R = tensors.rotation(change)
    strain = 0.5 * logarithm(_transposed(change) @ change)
    with np.errstate(invalid="ignore", divide="ignore"):
        J0, J1 = tensors.determinant(F0), tensors.determinant(F1)
        wanted = np.log1p((J1 - J0) / J0)
    return SlabDeformation(strain=_with_trace(strain, wanted), first=np.broadcast_to(np.eye(3), R.shape), second=R)


def _dilation(gradient: Array) -> Array:
    """``ln J1/J0 = ln det(I + L/2)/det(I - L/2)`` (...,) of an increment L (..., 3, 3) on the middle.

    The formula in the invariants of L avoids cancellation for small L.  The result is ``nan`` where the volume changes
    sign.
    """
    first = tensors.trace(gradient)
    second = 0.5 * (first * first - np.einsum("...ij,...ji->...", gradient, gradient))
    top = 0.5 * first + 0.125 * tensors.determinant(gradient)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(2.0 * np.arctanh(top / (1.0 + 0.25 * second)))


def _with_trace(strain: Array, wanted: Array) -> Array:
    """Strain (..., 3, 3) with its trace replaced by ``wanted`` (...,)."""
    missing = (wanted - tensors.trace(strain)) / 3.0
    return strain + missing[..., None, None] * np.eye(3)


def _transposed(T: Array) -> Array:
    return np.swapaxes(T, -1, -2)
