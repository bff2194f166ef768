"""Friction of contact nodes with inertia: slip conditions of a slab (time step), and its result.

The tangential impulse of a row over the slab obeys the law with the normal impulse over the slab and with its slip:

    rows that go on slipping (in space)   y = w0 + w1 = 2 s / h     the mean slip
    all others                            y = w1                    the slip at the end, zero in stick

with the slip velocities w0 and w1 at both ends.  A force along w0 is not admitted, so that friction never drives the
bodies: its work is that over the mean slip velocity (docs/theory/contact/friction.md).
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.trajectory import ContactEvents
from softway.marching.results.friction_result import RESTED, FrictionResult
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.constraints.return_map import NO_SLIP, SlipConditions
from softway.solve.methods.iteration import Solution

MOVES = 1e-9
"""Slip velocity, relative to the greatest velocity, above which a row slips at the start of a slab."""
SLOWED = 0.5
"""Ratio of the slip velocities at end and start of a slab below which a row does not go on slipping."""
BRIEF = 1e-9
"""Least fraction of the slab in which a row is closed."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImpulseSlip:
    """Slip of the rows of a slab of length ``span`` at its start.

    Parameters
    ----------
    velocity
        (m, d) slip velocities at the start [m/s].
    moves
        (m,) rows that slip at the start.
    onward
        (m,) rows that are expected to go on slipping in the same direction.
    rested
        (m,) rows of contacts that have come to rest at the start.
    """

    span: float
    velocity: Array
    moves: BoolArray
    onward: BoolArray
    rested: BoolArray

    def conditions(
        self,
        model: Model,
        now: ModelState,
        rows: ContactRows,
        given: tuple[Array, Array, Array | float],
        stick: bool = False,
    ) -> SlipConditions:
        """Slip conditions of the rows.

        ``given`` are their known normal impulses (m,) [N s], the fractions (m,) of the slab in which they are closed,
        and the prescribed velocities (n, d) at its end; with ``stick``, rows at rest stick at any force.
        """
        if not rows.shear.count:
            return NO_SLIP
        known, closed, prescribed = given
        h, shear, start = self.span, rows.shear, now.start
        twice = self.onward[:, None]
        fixed = np.where(model.free, 0.0, prescribed)
        before = np.linalg.norm(self.velocity, axis=1)
        way = self.velocity / np.where(before > 0.0, before, np.inf)[:, None]
        against = (self.moves & ~self.onward & ~self.rested)[:, None]
        return SlipConditions(
            friction=model.friction.at(start.displacement + 0.5 * h * start.velocity),
            shift=shear.flat(shear.moved / h - shear.weights @ fixed - np.where(twice, self.velocity, 0.0)),
            speed_factor=1.0,
            unit=1.0 / (h * np.maximum(closed, BRIEF)),
            ahead=-0.5,
            before=np.where(self.onward, 0.0, before),
            sliding=self.moves & ~self.rested,
            stick_at_any_force=stick,
            given=np.maximum(known, 0.0),
            undriven=shear.flat(np.where(against, way, 0.0)),
        )

    def halted(self, rows: ContactRows, q: Array) -> "ImpulseSlip | None":
        """Slip without the rows that do not go on slipping in a solution q (n, d); None if all of them do."""
        if not self.onward.any():
            return None
        end = rows.shear.slip(self.span * q) / self.span
        along = np.einsum("md,md->m", end, self.velocity)
        stops = self.onward & (along < SLOWED * np.einsum("md,md->m", self.velocity, self.velocity))
        return replace(self, onward=self.onward & ~stops) if stops.any() else None

    def turned(self, end: Array) -> BoolArray:
        """Rows (m,) driven back in the slab: their slip velocities (m, d) at its ``end`` oppose those at its start."""
        along = np.einsum("md,md->m", end, self.velocity)
        return np.asarray(self.moves & (along < -MOVES * np.einsum("md,md->m", self.velocity, self.velocity)))


def initial_slip(
    model: Model,
    now: ModelState,
    rows: ContactRows,
    events: ContactEvents,
    guess: Array,
    slab: tuple[float, bool],
    halts: BoolArray,
) -> ImpulseSlip:
    """Slip of the rows at the start of a slab.

    ``guess`` (n, d) are the velocities expected at its end; ``slab`` is its length [s], and true if bodies have come to
    rest at its start; the rows ``halts`` (m,) are known not to go on slipping.
    """
    span, rested = slab
    shear, v0 = rows.shear, now.start.velocity
    m, d = len(rows.node), model.shape[1]
    none = np.zeros(m, bool)
    if not shear.count:
        return ImpulseSlip(span=span, velocity=np.zeros((m, d)), moves=none, onward=none, rested=none)
    velocity = np.where(rows.near[:, None], shear.slip(span * v0) / span, 0.0)
    tools = float(np.abs(shear.moved).max(initial=0.0)) / span
    fast = np.linalg.norm(velocity, axis=1) > MOVES * max(model.space.greatest(v0), tools)
    held = now.closed & (now.span > 0.0) & ~now.sliding
    moves = fast & ~held
    lasting = now.closed & events.closed & ~np.isfinite(events.touch)
    out = ImpulseSlip(
        span=span,
        velocity=velocity,
        moves=moves,
        onward=moves & lasting & ~halts if shear.tangents.shape[1] > 1 else none,
        rested=_come_to_rest(now, rows, velocity) if rested else none,
    )
    return out.halted(rows, guess) or out


def _come_to_rest(now: ModelState, rows: ContactRows, velocity: Array) -> BoolArray:
    """Rows (m,) of contacts whose friction has no power at the start, with the slip velocities (m, d) there [m/s]."""
    out = np.zeros(len(rows.node), bool)
    if now.slip is None:
        return out
    power, usual = (np.abs(np.einsum("md,md->m", now.traction, w)) for w in (velocity, now.slip))
    for contact in np.unique(rows.contact[now.sliding]).tolist():
        here = rows.contact == contact
        out[here] = power[here].sum() <= RESTED * usual[here].sum()
    return out


def closed_fractions(closed: BoolArray, events: ContactEvents) -> Array:
    """Fractions (m,) of a slab in which rows are closed; ``closed`` (m,) are those closed at its start."""
    begin = np.where(closed & ~np.isfinite(events.touch), 0.0, events.touch)
    end = np.where(events.closed, 1.0, np.where(np.isfinite(events.release), events.release, begin))
    return np.nan_to_num(np.maximum(end - begin, 0.0))


def steady_push(now: ModelState, rows: ContactRows, solution: Solution, span: float) -> Array | float:
    """Nodal forces (n, d) of friction without impacts: mean forces of the rows that were closed at the start [N]."""
    shear, m = rows.shear, len(rows.node)
    if not shear.count:
        return 0.0
    mean = shear.vectors(shear.components(solution.last.impulse[m:])) / span
    return shear.spread(np.where(now.closed[:, None], mean, 0.0))


def impulse_friction(
    model: Model, now: ModelState, rows: ContactRows, solution: Solution, slip: ImpulseSlip, pressure: Array
) -> FrictionResult:
    """Friction over a slab; ``pressure`` (m,) are the normal forces at its end [N].

    Each row dissipates the work of its impulse over the mean slip velocity; rows that stick throughout, none.
    """
    shear, m, h = rows.shear, len(rows.node), slip.span
    if not shear.count:
        return FrictionResult.none(rows, model.shape)
    law = solution.last.system.contact.conditions.slipping
    impulse = shear.vectors(shear.components(solution.last.impulse[m:]))
    last = shear.slip(h * solution.last.q) / h
    sliding = solution.last.active[m:] | slip.turned(last)
    mean = 0.5 * (np.where(rows.near[:, None], shear.slip(h * now.start.velocity) / h, 0.0) + last)
    lost = -np.einsum("md,md->m", impulse, mean)
    traction = impulse * np.asarray(law.unit)[:, None]
    speed, size = np.linalg.norm(last, axis=1), np.linalg.norm(traction, axis=1)
    most = np.where(sliding, law.friction.resistance(speed, pressure)[0], law.friction.limit(pressure))
    return FrictionResult(
        traction=traction * np.minimum(1.0, most / np.where(size > 0.0, size, np.inf))[:, None],
        sliding=sliding & (pressure > 0.0),
        mean=impulse / h,
        push=shear.spread(impulse / h),
        work=float(np.sum(impulse * shear.moved)) / h,
        dissipation=float(np.maximum(lost[slip.moves | sliding], 0.0).sum()),
        slip=mean,
    )
