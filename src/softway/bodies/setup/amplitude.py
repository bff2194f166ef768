"""Amplitude of a load over time."""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass

import numpy as np

from softway.errors import InputError
from softway.units import Pure, Second


@dataclass(frozen=True, slots=True, kw_only=True)
class Ramp:
    """Piecewise linear factor of a load over time, constant before the first and after the last instant.

    Parameters
    ----------
    times
        Increasing instants [s].
    factors
        Factors of the load at the instants.

    Examples
    --------
    >>> up = Ramp(times=(0.0, 2.0), factors=(0.0, 1.0))
    >>> up.at(1.0), up.mean(1.0, 3.0)
    (0.5, 0.875)
    """

    times: tuple[Second, ...] = (0.0,)
    factors: tuple[Pure, ...] = (1.0,)

    def __post_init__(self) -> None:
        if len(self.times) != len(self.factors) or not self.times:
            raise InputError("factors", f"{len(self.factors)} factors at {len(self.times)} times", "one for each time")
        if not (np.diff(self.times) > 0.0).all():
            raise InputError("times", f"{list(self.times)} do not increase", "increasing instants")
        if not np.isfinite([*self.times, *self.factors]).all():
            raise InputError("factors", f"{list(self.factors)} at {list(self.times)}", "finite numbers")

    @property
    def steady(self) -> bool:
        """True if the factor never changes."""
        return len(set(self.factors)) == 1

    def at(self, time: float) -> float:
        """Factor at a time [s]."""
        near = self._near(time, time)
        return float(np.interp(time, self.times[near], self.factors[near]))

    def mean(self, start: float, end: float) -> float:
        """Mean factor from ``start`` to ``end`` [s]."""
        if end <= start:
            return self.at(start)
        near = self._near(start, end)
        times = self.times[near]
        x = np.array([start, *(t for t in times if start < t < end), end])
        return float(np.trapezoid(np.interp(x, times, self.factors[near]), x) / (end - start))

    def _near(self, start: float, end: float) -> slice:
        """Instants around a span: whole tables would be converted to arrays in every slab."""
        return slice(max(bisect_right(self.times, start) - 1, 0), bisect_left(self.times, end) + 1)
