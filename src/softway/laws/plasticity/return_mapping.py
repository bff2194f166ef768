"""Scalar equation of radial return, for any hardening and rate dependence."""

import numpy as np

from softway.arrays import Array
from softway.laws.plasticity.hardening import Hardening
from softway.laws.plasticity.rate_dependence import Flow

LIMIT = 60
"""Greatest number of iterations: Newton's method needs 1 to 6; bisection replaces steps that leave the bracket."""
TOLERANCE = 1e-14
"""Relative change of the gain below which it is accepted."""


def returned(
    norm: Array,
    slope: float,
    p: Array,
    span: float,
    initial: float,
    hardening: Hardening,
    flow: Flow,
    factor: Array | None = None,
) -> tuple[Array, Array]:
    """Gain x (...,) of the plastic strain, and its derivative (...,) with respect to the trial stress [1/Pa].

    Solves ``norm - slope x = s(p + x, x/span)`` for ``x >= 0`` by Newton's method inside a bracket.  The left side is
    the trial stress ``norm`` [Pa] minus the relaxation by plastic flow; the right side is the flow stress, times the
    ``factor`` (...,) of a thermal softening.

    Examples
    --------
    >>> from softway.laws.plasticity.rate_dependence import RateIndependent
    >>> from softway.laws.plasticity.hardening import LinearHardening
    >>> x, rise = returned(np.array([2.0, 0.5]), 3.0, np.zeros(2), 1.0, 1.0, LinearHardening(modulus=1.0),
    ...                    RateIndependent())
    >>> x.tolist(), rise.tolist()
    ([0.25, 0.0], [0.25, 0.0])
    """

    def missing(x: Array) -> tuple[Array, Array]:
        """Excess of the trial stress over the flow stress, and the negative of its slope."""
        still, up = hardening.stress(initial, p + x), hardening.slope(initial, p + x)
        stress, of_still, of_rate = flow.stress(still, x / span)
        if factor is not None:
            stress, of_still, of_rate = factor * stress, factor * of_still, factor * of_rate
        return norm - slope * x - stress, slope + of_still * up + of_rate / span

    none = np.zeros_like(norm)
    flowing = missing(none)[0] > 0.0
    low, high = none, np.where(flowing, norm / slope, 0.0)
    x = np.where(flowing, np.minimum(missing(none)[0] / np.maximum(missing(0.5 * high)[1], 1e-300), high), 0.0)
    fall, moving = np.ones_like(norm), flowing  # those that have settled stay: no point depends on others
    for _ in range(LIMIT if flowing.any() else 0):
        rest, fall = missing(x)
        low, high = np.where(rest > 0.0, x, low), np.where(rest > 0.0, high, x)
        new = x + rest / fall
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        change = np.abs(np.where(moving, new - x, 0.0))
        x = np.where(moving, new, x)
        moving = moving & (change > TOLERANCE * high)
        if not moving.any():
            break
    fall = missing(x)[1]
    return x, np.where(flowing, 1.0 / fall, 0.0)
