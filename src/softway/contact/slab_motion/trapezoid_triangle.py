"""Split of Fig. 4 of the paper: a trapezoid and a triangle in place of the product element next to the contact.

The element between the inner node i and the contact node c, with xi from 0 at i to 1 at c, is cut along the line from
(c, t_c) to (i, t1).  Below it the velocity is bilinear on the trapezoid (i,t0) (c,t0) (c,t_c) (i,t1), above it linear
on the triangle (c,t_c) (c,t1) (i,t1), where it is zero on the obstacle.  Stress follows from the velocity gradient
inside the two elements; the jump across the line has no effect.  Compared with the product form the inertia is the
same, and the mean elongation is greater by ``h v_c (1 - tau_c)^2 / 3`` (docs/theory/contact/contact.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.contact.slab_motion.trajectory import Trajectory


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrapezoidTriangle:
    """Two-node bars at the contact rows: inner node (m,) and stiffness E A / L (m,) of the element of each row."""

    inner: IntArray
    stiffness: Array

    def difference(self, path: Trajectory, q: Array, product: Array) -> Array:
        """Difference (n, 1) of the mean force to that of the product form with mean displacement ``product`` (n, 1)."""
        out = np.zeros_like(q)
        events, rows = path.events, path.rows
        for r in np.flatnonzero(events.closed & np.isfinite(events.touch)):
            c, i, n = rows.node[r], self.inner[r], rows.normal[r, 0]
            ends = path.velocity[i, 0], q[i, 0], events.speed[r] * n, events.approach[r] * n
            start = path.start[c, 0] - path.start[i, 0]
            elongation = start + path.span * mean_growth(float(events.touch[r]), *ends)
            more = self.stiffness[r] * (elongation - (product[c, 0] - product[i, 0]))
            out[c, 0] += more
            out[i, 0] -= more
        return out


def mean_growth(touch: float, inner0: float, inner1: float, outer0: float, outer1: float) -> float:
    """Mean elongation of the split element over the slab, divided by h [m/s].

    Parameters
    ----------
    touch
        Instant tau_c.
    inner0, inner1
        Velocity of the inner node at both ends of the slab.
    outer0, outer1
        Velocity of the contact node at t0 and just before the touch.

    Notes
    -----
    ``int int (1 - tau) dv/dxi dxi dtau`` by Gauss points on the trapezoid (mapped by tau = sigma T(xi),
    T = 1 - xi (1 - tau_c)) and on the triangle, where the gradient is ``-inner1``.

    Examples
    --------
    A bar that moves as one and stops at the start of the slab: only the triangle shortens it.

    >>> round(mean_growth(0.0, 0.0, 1.0, 0.0, 0.0), 6)
    -0.166667
    """
    x, w = np.polynomial.legendre.leggauss(5)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    xi, sigma = np.meshgrid(x, x, indexing="ij")
    weight = np.outer(w, w)
    height = 1.0 - xi * (1.0 - touch)
    inner = (1.0 - sigma) * inner0 + sigma * inner1
    outer = (1.0 - sigma) * outer0 + sigma * outer1
    rate = (1.0 - xi) * (inner1 - inner0) + xi * (outer1 - outer0)
    slope = outer - inner + rate * sigma * (1.0 - touch) / height
    below = np.sum(weight * height * (1.0 - sigma * height) * slope)
    later = height + sigma * (1.0 - height)
    above = np.sum(weight * (1.0 - height) * (1.0 - later) * -inner1)
    return float(below + above)
