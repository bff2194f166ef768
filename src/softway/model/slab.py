"""Slab (time step): the layer of space-time between two instants."""

from dataclasses import dataclass

from softway.model.time_weight import EndPeaks, TimeWeight


@dataclass(frozen=True, slots=True, kw_only=True)
class Slab:
    """Time interval [start, end] with the virtual time function g of eq. (2.5).

    Parameters
    ----------
    start, end
        [s], ``end > start``.
    weight
        Virtual time function.

    Examples
    --------
    >>> Slab(start=0.0, end=0.5).span
    0.5
    """

    start: float
    end: float
    weight: TimeWeight = EndPeaks()

    @property
    def span(self) -> float:
        """Length h of the slab [s]."""
        return self.end - self.start
