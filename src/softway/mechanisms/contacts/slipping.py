"""Instants inside a slab (time step) at which the sliding of stops begins or ends, if friction is greater at rest.

The force of a stop at an instant is the mean over a slab of twice the length up to it, and the velocity of the sliding
at the end of a slab is twice its mean less that at the start: both are exact for forces that are linear in time, or
velocities (docs/theory/rigid_friction.md).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from softway.arrays import Array, BoolArray
from softway.mechanisms.contacts.stop_rows import NOISE, Stops
from softway.mechanisms.members.stops import StopEvent

EARLY = 1e-6
"""Part of a slab before which sliding that ends has ended at its start."""
SOON = 1e-3
"""Part of a slab before which sliding that begins has begun at its start."""
LATE = 1.0 - 1e-9
"""Part of a slab after which an instant is its end."""
FINE = 1e-10
"""Accuracy of the instant at which sliding begins, relative to the slab."""
SLOWED = 1e-6
"""Velocity relative to that at the start of a slab at which sliding has ended."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Change:
    """End of a part of a slab at which sliding changes.

    Parameters
    ----------
    span
        Length of the part [s], zero if sliding changed at its start: then the part has to be solved again.
    ending, starting
        (s,) stops whose sliding ends, and begins, at the end of the part.
    iterations
        Iterations of the search.
    """

    span: float
    ending: BoolArray
    starting: BoolArray
    iterations: int


def next_change(stops: Stops, before: Array, begun: BoolArray, span: float, h: float, extent: float) -> Change:
    """First change of sliding in a part of a slab of length h, which was tried; the solution is in the work space.

    ``before`` (s, t) are the velocities of the sliding at its start; stops whose sliding begins there are noted in
    ``begun`` (s,).
    """
    counted, kept, none = [0], stops.it.motion.impulse / span, np.zeros(len(stops.rows), bool)

    def solved(length: float) -> bool:
        stops.it.motion.impulse[:] = kept * length
        used = stops.tried(length, extent)
        counted[0] += used
        return used > 0

    end, ending = _first_end(stops, solved, before, begun, span, h, extent)
    if end == 0.0:
        stops.sliding[ending] = False
        return Change(span=0.0, ending=none, starting=none, iterations=counted[0])
    resting = stops.located & stops.closed & ~stops.sliding
    if not resting.any():
        return Change(span=end, ending=ending, starting=none, iterations=counted[0])
    start, starting = _first_start(stops, solved, end)
    if starting.any() and start < SOON * h:
        begun |= starting
        stops.sliding[starting] = True
        return Change(span=0.0, ending=none, starting=none, iterations=counted[0])
    span = end if start > LATE * end else start
    solved(span)
    return Change(
        span=span,
        ending=ending if span == end else none,
        starting=starting,
        iterations=counted[0],
    )


def _first_end(
    stops: Stops,
    solved: Callable[[float], bool],
    before: Array,
    begun: BoolArray,
    span: float,
    h: float,
    extent: float,
) -> tuple[float, BoolArray]:
    """Length at which the first sliding ends, zero if at once, and the stops (s,); the whole ``span`` if none does."""
    size = np.linalg.norm(before, axis=1)
    moving = stops.located & stops.closed & stops.sliding & ~begun & (size > NOISE * extent / h)

    def left(length: float) -> Array:
        along = np.einsum("st,st->s", stops.slid(length), before)
        return np.where(moving, 2.0 * along / (length * np.where(moving, size, 1.0) ** 2) - 1.0, np.inf)

    def least(length: float) -> float:
        return float(left(length).min()) if solved(length) else -1.0

    if not moving.any() or not (left(span) < 0.0).any():
        return span, np.zeros(len(moving), bool)
    low = min(EARLY * h, span)
    if least(low) <= 0.0:
        return 0.0, left(low) <= 0.0
    length = float(brentq(least, low, span, xtol=1e-15 * span, rtol=1e-15))
    length = span if length > LATE * span else length
    least(length)
    return length, left(length) <= SLOWED


def _first_start(stops: Stops, solved: Callable[[float], bool], span: float) -> tuple[float, BoolArray]:
    """Length after which a stop at rest begins to slide, and the stops (s,) that do; the whole ``span`` if none does."""
    factor, found = 1.0, stops.breaking(span)
    if solved(2.0 * span) and (more := stops.breaking(2.0 * span)).any():
        factor, found = 2.0, more
    low, high = 0.0, span
    while found.any() and high - low > FINE * span:
        middle = 0.5 * (low + high)
        more = stops.breaking(factor * middle) if solved(factor * middle) else found
        if more.any():
            high, found = middle, more
        else:
            low = middle
    return (low if found.any() else span), found


def tell_sliding(stops: Stops, time: float, events: list[StopEvent]) -> None:
    """Add an event for each located stop whose sliding has begun, or ended, since it was told."""
    for k in np.flatnonzero(stops.located):
        now = int(stops.sliding[k]) if stops.closed[k] else -1
        if min(now, int(stops.told[k])) >= 0 and now != stops.told[k]:
            events.append(StopEvent(time=float(time), stop=stops.names[k], kind="slip" if now else "stick"))
        stops.told[k] = now
