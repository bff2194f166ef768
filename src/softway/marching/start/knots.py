"""Ends of slabs (time steps): the end of the march, and the knots of loads and prescribed motions before it.

Where a prescribed rate bends or jumps inside a slab, its integral over the slab is exact, but the forces, which the
slab takes as smooth, are not.  So slabs end at knots (docs/theory/time/control.md).
"""

from collections.abc import Iterable, Iterator
from math import log2

import numpy as np

from softway.bodies.prescribed_motion import Sliding, Swinging, Table
from softway.bodies.setup.directions import DirectedMotion
from softway.bodies.setup.knots import knots_of_pieces, knots_of_table
from softway.bodies.setup.supports import Driven, Guided
from softway.bodies.solid import Tool
from softway.marching.start.slab_length import evenly
from softway.marching.state.march_state import MarchState, Settings, StepHistory
from softway.model.model import Model
from softway.solve.methods.central_difference import Explicit

ALONE = 0.5 * (1.0 - 1e-9)
"""Least distance of two ends, in requested slab lengths: no slab is divided into shorter ones."""
SLIVER = 1e-3
"""Time to a knot, relative to the proposed length, that is no slab of its own: it is part of the next one."""


def slab_ends(model: Model, settings: Settings, span: float) -> tuple[float, ...]:
    """Instants [s] at which slabs of the length ``span`` end: knots, and the end of the march; empty without knots.

    A table that is finer than the slabs is a curve: knots closer to another one of their table than half a slab are
    left to the integral in the slab.  Of different tables the first of such knots counts.  Slabs of central differences
    are much shorter than their tables, and do not end at knots.
    """
    if not settings.control.knots or isinstance(settings.method, Explicit):
        return ()
    apart, until = ALONE * span, settings.until
    found = sorted(t for law in _laws(model) for t in _lonely(law, apart))
    ends = [0.0]
    for t in found:
        if t - ends[-1] >= apart and until - t >= apart:
            ends.append(t)
    return (*ends[1:], until) if len(ends) > 1 else ()


def slab_length(ends: tuple[float, ...], march_state: MarchState) -> float:
    """Length [s] of the next slab, at most the proposed one: it divides the time to the next end evenly."""
    return length_at(ends, march_state.settings, march_state.step_history, march_state.state.time)


def length_at(ends: tuple[float, ...], settings: Settings, history: StepHistory, time: float) -> float:
    """Length [s] of a slab that begins at a time [s], see :func:`slab_length`."""
    least, until, lowest = settings.control.least * history.span, settings.until, min(history.length, history.span)
    sliver = max(SLIVER * lowest, least)
    for end in ends:
        if end - time > sliver:
            return _within(evenly(end - time, lowest), history, end - time)
    length = _within(min(lowest, until - time), history, until - time)
    return until - time if until - time - length < least else length


def end_after(ends: tuple[float, ...], march_state: MarchState, time: float) -> float:
    """End [s] of a slab from ``time`` of the length that the march state proposes."""
    settings = march_state.settings
    return slab_end(ends, settings.until, time, length_at(ends, settings, march_state.step_history, time))


def _within(lowest: float, history: StepHistory, left: float) -> float:
    """Length [s] on the proposed rung above the ``lowest`` one, or on the highest one that fits into the time left."""
    length, doublings = lowest, max(0, round(log2(history.length / history.span)))
    for _ in range(doublings):
        length = 2.0 * length if 2.0 * length <= left * (1.0 + 1e-9) else length
    return length


def slab_end(ends: tuple[float, ...], until: float, time: float, length: float) -> float:
    """End [s] of a slab from ``time``: that of the march, or a knot, to the last digit if it is there to rounding.

    Examples
    --------
    >>> slab_end((0.3, 1.0), 1.0, 0.2, 0.3 - 0.2), slab_end((), 1.0, 0.2, 0.25)
    (0.3, 0.45)
    """
    for end in (*ends, until):
        if abs(time + length - end) < 1e-9 * length:
            return end
    return time + length


def _lonely(law: Iterable[float], apart: float) -> tuple[float, ...]:
    """Those of the increasing knots of a law that are ``apart`` from the others."""
    times = np.array([-np.inf, *law, np.inf])
    near = np.diff(times) < apart
    return tuple(times[1:-1][~(near[:-1] | near[1:])].tolist())


def _laws(model: Model) -> Iterator[tuple[float, ...]]:
    """Knots of each law over time: of supports, tools, motors and loads."""
    scene = model.scene
    for support, _ in model.driven:
        for law in support.supports if isinstance(support, DirectedMotion) else (support,):
            match law:
                case Driven():
                    yield knots_of_table(law.times, np.atleast_1d(law.velocity) if law.times else ())
                case Guided():
                    yield knots_of_pieces(law.travel.pieces)
    for body in scene.bodies.values():
        if isinstance(body, Tool):
            match body.motion:
                case Table():
                    yield knots_of_table(body.motion.times, body.motion.displacements)
                case Sliding():
                    yield knots_of_pieces(body.motion.travel.pieces)
                case Swinging():
                    yield knots_of_pieces(body.motion.angle.pieces)
    for load in scene.loads:
        yield knots_of_table(load.ramp.times, load.ramp.factors)
    for motor in () if scene.mechanism is None else scene.mechanism.motors.values():
        yield knots_of_pieces(motor.motion.pieces)
