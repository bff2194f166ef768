"""Sliding of stops: instants inside a slab (time step) at which it begins or ends, if friction is greater at rest.

The force of a stop at an instant is the mean over a slab of twice the length up to it, and the velocity of the sliding
at the end of a slab is twice its mean less that at the start: both are exact for forces that are linear in time, or
velocities (docs/theory/rigid_friction.md).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.rigid_contact import closed_stops
from softway.kernels.rigid_contact.closed_stops import NOISE
from softway.kernels.rigid_contact.contact import compliances
from softway.mechanisms.contacts.stop_rows import Stops
from softway.mechanisms.members.stops import StopEvent

EARLY = 1e-6
"""Part of a slab before which sliding that ends has ended at its start."""
SOON = 1e-3
"""Part of a slab before which sliding that begins has begun at its start."""
LATE = 1.0 - 1e-9
"""Part of a slab after which an instant is its end."""
FINE = 1e-10
"""Accuracy of the instant at which sliding begins, relative to the slab."""
ROUNDED, PUSHED = 1e-14, 1e-10
"""Sliding that is rounding, relative to the motion, and to the displacement by friction alone."""
SLOWED, SIDEWAYS = 1e-6, 1e-2
"""Velocities along and across that at the start of a slab, relative to it, at which sliding has ended."""


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
    """Length at which the first sliding ends, zero if at once, and the stops (s,); the whole ``span`` if none does.

    In space sliding that turns by a right angle does not end.
    """
    size = np.linalg.norm(before, axis=1)
    moving = stops.located & stops.closed & stops.sliding & ~begun & (size > NOISE * extent / h)

    def left(length: float) -> Array:
        along = np.einsum("st,st->s", stops.slid(length), before)
        return np.where(moving, 2.0 * along / (length * np.where(moving, size, 1.0) ** 2) - 1.0, np.inf)

    def least(length: float) -> float:
        return float(left(length).min()) if solved(length) else -1.0

    if not moving.any() or not (left(span) < 0.0).any():
        return span, np.zeros(len(moving), bool)
    from scipy.optimize import brentq  # slow to load

    low = min(EARLY * h, span)
    if least(low) <= 0.0:
        return 0.0, left(low) <= 0.0
    length = float(brentq(least, low, span, xtol=1e-15 * span, rtol=1e-15))
    length = span if length > LATE * span else length
    least(length)
    after = 2.0 / length * stops.slid(length) - before
    ended = (left(length) <= SLOWED) & (np.linalg.norm(after, axis=1) <= SIDEWAYS * size)
    if not ended.any():  # it only turns
        solved(span)
        return span, ended
    return length, ended


def _breaking(stops: Stops, span: float) -> BoolArray:
    """Stops (s,) at rest that slide in a slab of this length that was tried, with the greatest friction.

    Of several stops on one body some may have their greatest friction before it slides.
    """
    rows, friction = stops.closed_rows()
    found = stops.located & stops.closed & ~stops.sliding
    found[stops.closed] &= ~closed_stops.below_limit(stops.it.motion.impulse[rows], friction)[:, 0]
    moved = np.linalg.norm(stops.slid(span), axis=1)
    rounding = ROUNDED * float(np.abs(stops.room.z[:, :3]).max())
    for k in np.flatnonzero(found):
        mine = stops.rows[k, stops.tangential]
        W, pushed = compliances(stops.it.joints, stops.room, mine)[0], stops.it.motion.impulse[mine]
        found[k] = moved[k] > max(rounding, PUSHED * 0.5 * span * float(np.linalg.norm(W @ pushed)))
    return found


def _first_start(stops: Stops, solved: Callable[[float], bool], span: float) -> tuple[float, BoolArray]:
    """Length after which a stop at rest begins to slide, and the stops (s,); the whole ``span`` if none does."""
    factor, found = 1.0, _breaking(stops, span)
    if solved(2.0 * span) and (more := _breaking(stops, 2.0 * span)).any():
        factor, found = 2.0, more
    low, high = 0.0, span
    while found.any() and high - low > FINE * span:
        middle = 0.5 * (low + high)
        more = _breaking(stops, factor * middle) if solved(factor * middle) else found
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


def jammed(stops: Stops) -> IntArray:
    """Closed stops (k,) whose sliding has no continuous course at the present state."""
    return np.flatnonzero(closed_stops.jammed(stops.it.joints, stops.it.motion, stops.room, stops.table))
