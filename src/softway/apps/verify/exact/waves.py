"""Piecewise linear functions of time, with jumps allowed between the pieces.

Every wave in a bar with piecewise linear initial data has this form.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Wave:
    """Function f(t) on [starts[0], ends[-1]], linear on each piece, continuous from the right.

    Parameters
    ----------
    starts, ends
        (k,) ends of the pieces, without gaps between them.
    first, last
        (k,) values at both ends of each piece.

    Examples
    --------
    >>> ramp = joined([(0.0, 1.0, 0.0, 2.0), (1.0, 3.0, -1.0, -1.0)])
    >>> float(ramp(0.5)), float(ramp(1.0)), float(ramp(1.0, side=-1))
    (1.0, -1.0, 2.0)
    >>> float(ramp.integral(3.0)), round(ramp.square(0.0, 3.0), 12)
    (-1.0, 3.333333333333)
    """

    starts: Array
    ends: Array
    first: Array
    last: Array

    def _piece(self, t: Array, side: int) -> NDArray[np.intp]:
        k = np.searchsorted(self.starts, t, side="right" if side > 0 else "left") - 1
        return np.clip(k, 0, len(self.starts) - 1)

    def __call__(self, t: float | Array, side: int = +1) -> Array:
        """Value at t: limit from the right (+1) or from the left (-1)."""
        t = np.asarray(t, float)
        k = self._piece(t, side)
        s = (np.clip(t, self.starts[k], self.ends[k]) - self.starts[k]) / (self.ends[k] - self.starts[k])
        return self.first[k] + (self.last[k] - self.first[k]) * s

    def _sums(self) -> tuple[Array, Array, Array]:
        """Slope of each piece, and the integral and the double integral up to its start."""
        span = self.ends - self.starts
        slope = (self.last - self.first) / span
        once = np.concatenate(([0.0], np.cumsum(0.5 * span * (self.first + self.last))))[:-1]
        twice = np.concatenate(([0.0], np.cumsum(once * span + self.first * span**2 / 2.0 + slope * span**3 / 6.0)))[
            :-1
        ]
        return slope, once, twice

    def integral(self, t: float | Array) -> Array:
        """Integral from the start of the first piece to t."""
        slope, once, _ = self._sums()
        k = self._piece(np.asarray(t, float), +1)
        x = np.asarray(t, float) - self.starts[k]
        return once[k] + self.first[k] * x + slope[k] * x**2 / 2.0

    def double(self, t: float | Array) -> Array:
        """Integral of the integral."""
        slope, once, twice = self._sums()
        k = self._piece(np.asarray(t, float), +1)
        x = np.asarray(t, float) - self.starts[k]
        return twice[k] + once[k] * x + self.first[k] * x**2 / 2.0 + slope[k] * x**3 / 6.0

    def between(self, a: float, b: float) -> "Wave":
        """Wave restricted to [a, b]."""
        kept = (self.ends > a) & (self.starts < b)
        starts, ends = np.maximum(self.starts[kept], a), np.minimum(self.ends[kept], b)
        return Wave(starts=starts, ends=ends, first=self(starts, +1), last=self(ends, -1))

    def square(self, a: float, b: float) -> float:
        """Integral of f^2 from a to b."""
        w = self.between(a, b)
        return float(np.sum((w.ends - w.starts) * (w.first**2 + w.first * w.last + w.last**2)) / 3.0)


def joined(pieces: list[tuple[float, float, float, float]]) -> Wave:
    """Wave from pieces (start, end, first value, last value) in order of time."""
    starts, ends, first, last = np.array(pieces, float).T
    return Wave(starts=starts, ends=ends, first=first, last=last)
