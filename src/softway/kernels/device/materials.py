"""Laws at a point as functions of Warp; tensors and names as in :mod:`softway.kernels.jit.lanes`.

``H_Ji = du_i/dX_J``; the strain E is Green's for the laws ``HOOKE_GREEN`` and ``NEO_HOOKEAN``, and linearised for
``HOOKE``; ``dS = soft (B:dE) B + 2 stiff B dE B``.
"""

from softway.kernels.device.door import wp

HOOKE = wp.constant(0)
HOOKE_GREEN = wp.constant(1)
NEO_HOOKEAN = wp.constant(2)
SERIES_BELOW = wp.constant(wp.float64(1e-2))
"""|j| below which j - ln(1 + j) is a series: 10 terms have an error below 1e-17 of j^2/2."""


@wp.func
def identity():
    """Identity of three dimensions."""
    one, none = wp.float64(1.0), wp.float64(0.0)
    return wp.mat33d(one, none, none, none, one, none, none, none, one)


@wp.func
def carrier(law: int, H: wp.mat33d):
    """``I + H``, or I in the linear theory."""
    if law == HOOKE:
        return identity()
    return identity() + H


@wp.func
def spin(law: int):
    """Factor of the geometric stiffness."""
    if law == HOOKE:
        return wp.float64(0.0)
    return wp.float64(1.0)


@wp.func
def strain(law: int, H: wp.mat33d):
    """Strain E; ``nan`` where the material is inverted."""
    half, none = wp.float64(0.5), wp.float64(0.0)
    E = half * (H + wp.transpose(H))
    if law != HOOKE:
        E = E + half * (H * wp.transpose(H))
        if not (wp.determinant(identity() + H) > none):
            E = E + (none / none) * identity()
    return E


@wp.func
def log1p(j: wp.float64):
    """``ln(1 + j)`` to rounding (Kahan): the error of ``1 + j`` cancels in the quotient."""
    one = wp.float64(1.0)
    near = one + j
    if near == one:
        return j
    return wp.log(near) * (j / (near - one))


@wp.func
def excess(j: wp.float64, logarithm: wp.float64):
    """``j - ln(1 + j)`` without cancellation: ``j^2 (1/2 - j/3 + j^2/4 - ...)``."""
    if wp.abs(j) >= SERIES_BELOW:
        return j - logarithm
    one = wp.float64(1.0)
    series = one / wp.float64(10.0) - j / wp.float64(11.0)
    for k in range(8):
        series = one / wp.float64(9 - k) - j * series
    return j * j * series


@wp.func
def volume_change(E: wp.mat33d):
    """``det C - 1`` of ``C = I + 2 E``, and its terms beyond the first order."""
    two = wp.float64(2.0)
    second = (
        E[0, 0] * E[1, 1]
        + E[1, 1] * E[2, 2]
        + E[2, 2] * E[0, 0]
        - E[0, 1] * E[0, 1]
        - E[1, 2] * E[1, 2]
        - E[2, 0] * E[2, 0]
    )
    higher = wp.float64(4.0) * second + wp.float64(8.0) * wp.determinant(E)
    return two * wp.trace(E) + higher, higher


@wp.func
def bridge(law: int, E: wp.mat33d):
    """Tensor B of the moduli: I, or the inverse of ``C = I + 2 E``."""
    if law == NEO_HOOKEAN:
        return wp.inverse(identity() + wp.float64(2.0) * E)
    return identity()


@wp.func
def stiffness(law: int, shear: wp.float64, bulk_part: wp.float64, E: wp.mat33d):
    """Factor ``stiff`` of the moduli; ``soft`` is the first Lame constant."""
    if law == NEO_HOOKEAN:
        j, higher = volume_change(E)
        return shear - wp.float64(0.5) * bulk_part * log1p(j)
    return shear


@wp.func
def stress(law: int, bulk_part: wp.float64, shear: wp.float64, E: wp.mat33d):
    """Second Piola-Kirchhoff stress S."""
    two = wp.float64(2.0)
    if law == NEO_HOOKEAN:
        B = bridge(law, E)
        j, higher = volume_change(E)
        return two * shear * (B * E) + (wp.float64(0.5) * bulk_part * log1p(j)) * B
    return bulk_part * wp.trace(E) * identity() + two * shear * E


@wp.func
def energy(law: int, bulk_part: wp.float64, shear: wp.float64, E: wp.mat33d):
    """Energy per reference volume W; infinite where the strain is not finite."""
    half = wp.float64(0.5)
    W = half * bulk_part * wp.trace(E) * wp.trace(E) + shear * wp.ddot(E, E)
    if law == NEO_HOOKEAN:
        j, higher = volume_change(E)
        logarithm = log1p(j)
        W = half * shear * (excess(j, logarithm) - higher) + wp.float64(0.125) * bulk_part * logarithm * logarithm
    if wp.isfinite(W):
        return W
    return wp.float64(wp.inf)


@wp.func
def flux_change(law: int, bulk_part: wp.float64, shear: wp.float64, H: wp.mat33d, dH: wp.mat33d):
    """Change ``dS f + S dH`` of the flux ``P = S f`` by a change dH; the second term only with Green's strain."""
    E, f = strain(law, H), carrier(law, H)
    half = dH * wp.transpose(f)
    dE = wp.float64(0.5) * (half + wp.transpose(half))
    B = bridge(law, E)
    dS = bulk_part * wp.ddot(B, dE) * B + wp.float64(2.0) * stiffness(law, shear, bulk_part, E) * (B * dE * B)
    return dS * f + spin(law) * (stress(law, bulk_part, shear, E) * dH)
