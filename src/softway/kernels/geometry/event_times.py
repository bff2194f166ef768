"""Event times inside a slab (time step), batched: roots of gaps and reactions for tau in [0, 1]."""

import numpy as np

from softway.arrays import Array


def crossing(gap: Array, slope: Array, curvature: Array) -> Array:
    """First tau in [0, 1] where ``gap + slope tau + curvature tau^2 / 2`` changes from positive to negative.

    Parameters
    ----------
    gap, slope, curvature
        (m,) value, first and second derivative at tau = 0; a gap that is negative by rounding is taken as zero.

    Returns
    -------
    (m,) instants; nan where the gap does not close inside the slab.

    Examples
    --------
    >>> crossing(np.array([1.0, 0.0, 1.0]), np.array([-2.0, 1.0, -0.5]), np.array([0.0, -4.0, 0.0]))
    array([0.5, 0.5, nan])
    """
    start = np.maximum(gap, 0.0)
    root = np.sqrt(np.maximum(slope**2 - 2.0 * curvature * start, 0.0))
    real = slope**2 - 2.0 * curvature * start >= 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        # the root with negative slope, written without cancellation on either branch
        tau = np.where(slope <= 0.0, 2.0 * start / (root - slope), -(slope + root) / curvature)
    tau = np.where((slope <= 0.0) & (start == 0.0), 0.0, tau)
    return np.where(real & (tau >= 0.0) & (tau <= 1.0), tau, np.nan)


def fading(first: Array, last: Array) -> Array:
    """Fraction s in [0, 1] at which a quantity that varies linearly from ``first`` to ``last`` < 0 vanishes.

    The fraction is 0 if ``first`` is not positive.

    Examples
    --------
    >>> fading(np.array([1.0, -1.0]), np.array([-1.0, -2.0]))
    array([0.5, 0. ])
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        s = first / (first - last)
    return np.where(first > 0.0, np.clip(s, 0.0, 1.0), 0.0)
