"""Collision at one contact in the plane with Coulomb's friction, as a function of the normal impulse (Routh).

The sliding may stop, and reverse, while the impulse grows.  Poisson's coefficient is that of the normal impulses of the
expansion and of the compression.
"""

from softway.kernels.jit.compilation import kernel

PIECES = 6
"""Greatest number of pieces: sliding, sticking or sliding back, in compression and in expansion."""


@kernel
def impulses_in_order(W, normal, sliding, friction, ratio, x):
    """Normal and tangential impulse x (2,) from the compliance W (2, 2) and the velocities before; 1 if it ends."""
    x[:] = 0.0
    if normal >= 0.0:  # bodies that touch and move apart
        return 1
    end, still = -1.0, 1e-14 * (abs(normal) + abs(sliding))
    for _ in range(PIECES):
        share = _tangential_share(W, sliding, still, friction)
        opening, slope = W[0, 0] + W[0, 1] * share, W[1, 0] + W[1, 1] * share
        stop = -sliding / slope if abs(sliding) > still and sliding * slope < 0.0 else -1.0
        if end < 0.0:
            left = -normal / opening if opening > 0.0 else -1.0
        else:
            left = end - x[0]
        if left < 0.0 and stop < 0.0:
            return 0
        stops = stop >= 0.0 and (left < 0.0 or stop < left)
        more = stop if stops else left
        x[0] += more
        x[1] += share * more
        normal += opening * more
        sliding = 0.0 if stops else sliding + slope * more
        if not stops:
            if end >= 0.0:
                return 1
            end = (1.0 + ratio) * x[0]
    return 0


@kernel
def _tangential_share(W, sliding, still, friction):
    """Tangential impulse over the normal one: against the sliding, or what keeps it still, as far as friction can."""
    if abs(sliding) > still:
        return -friction if sliding > 0.0 else friction
    keeping = -W[1, 0] / W[1, 1] if W[1, 1] > 0.0 else 0.0
    return min(max(keeping, -friction), friction)
