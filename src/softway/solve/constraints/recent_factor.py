"""Solutions for active rows that hardly change between iterations, with the factor of an earlier iteration.

The compliance S of combined rows changes with every iterate.  Its factor costs more than all else in the iteration;
S times a vector is cheap.  So the factor S_0 of an earlier iteration of the slab serves as long as the refinement
``x <- x + S_0^-1 (b - S x)`` converges fast.  The result is that of a new factor up to rounding.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from softway.arrays import Array
from softway.kernels.linalg.dense import DenseFactor
from softway.solve.constraints.friction_newton import ACCURATE, FALLS, KeptNewton

Push = TypeVar("Push")

FEW = 32
"""Number of rows below which a new factor is as cheap."""


class RecentFactor:
    """Factored compliance of active rows in an earlier iteration, and the linearisation of their friction; none at the
    start of a slab. The iterations write both attributes.

    Examples
    --------
    >>> from softway.kernels.linalg.dense import factored
    >>> recent = RecentFactor()
    >>> recent.factor = factored(np.diag([1.0, 2.0]))
    >>> force, motion = recent.refined(np.ones(2), lambda x: np.array([1.01, 2.01]) * x, lambda motion: motion)
    >>> force.round(6).tolist(), bool(abs(motion - 1.0).max() < 1e-13)
    ([0.990099, 0.497512], True)
    >>> recent.refined(np.ones(2), lambda x: x, lambda motion: motion) is None  # half as stiff: too far away
    True
    """

    __slots__ = ("factor", "friction")

    def __init__(self) -> None:
        self.factor: DenseFactor | None = None
        self.friction: KeptNewton | None = None

    def refined(
        self, wanted: Array, push: Callable[[Array], Push], measure: Callable[[Push], Array]
    ) -> tuple[Array, Push] | None:
        """Forces (k,) that move the rows by ``wanted`` (k,), and what they ``push``; ``measure`` gives the motion (k,)
        of the rows in it.  None if the factor is of other rows or the refinement converges slowly.
        """
        if self.factor is None or len(self.factor.matrix) != len(wanted):
            return None
        last = float(np.abs(wanted).max(initial=0.0))
        force, left, goal = np.zeros(len(wanted)), wanted, ACCURATE * last
        while True:
            force = force + self.factor.once(left)
            pushed = push(force)
            left = wanted - measure(pushed)
            now = float(np.abs(left).max(initial=0.0))
            if now <= goal:
                return force, pushed
            if not now <= FALLS * last:
                return None
            last = now
