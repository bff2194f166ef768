"""Return map of friction: from a trial force to the force of the law."""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.friction_rows import FrictionRows
from softway.contact.tangential_rows import TangentialRows

ITERATIONS = 100
"""Iterations of the scalar equation; bisection alone would take about 60."""
STEEPEST = 1e3
"""Greatest ratio of tangential to normal force: laws independent of the pressure fade where a row is released."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlipConditions:
    """Conditions of one slab on the slip of contact rows, in the units of the multipliers.

    The slip of a row is ``y = T z - shift``, its mean speed ``speed_factor |y|``.  A law that depends on the speed
    takes the one at the end of the slab, ``(1 + ahead) speed_factor |y| - ahead before``, extrapolated from the mean
    speed ``before`` of the previous slab.

    Parameters
    ----------
    friction
        Friction laws.
    shift
        (m, k) shift of the slip.
    speed_factor
        Speed per unit of the slip y.
    unit
        Force per unit of the multipliers, for all rows or for each (m,).
    ahead, before
        Extrapolation of the speed, see above; ``before`` (m,) [m/s].
    sliding
        (m,) rows that slip at the start of the slab, not yet at rest: they stick up to the slip resistance at zero
        speed instead of the stick limit.
    stick_at_any_force
        True if the other rows stick at any force.  Then there may be no forces: a row that sticks would have to pull,
        and would overlap if released (Painleve 1895, C. R. Acad. Sci. Paris 121, 112).
    slip_at_limit
        True if the other rows slip with their stick limit as resistance.  Then there are forces for every compliance.
    way
        (m, d) directions of the slip in the previous slab times its extrapolation, zero for rows that did not slip;
        None if no direction can turn.
    turning
        (m, k) the same along the tangents (``turning_slip.py``).
    given
        (m,) normal multipliers known beforehand, which press a row in addition to those that are solved for, in rows
        whose ``unit`` is that of the time in which they are closed; None if there are none.
    undriven
        (m, k) unit directions of the slip at the start, along which no force may push; zero for rows without such a
        condition, None if there are none.
    """

    friction: FrictionRows
    shift: Array
    speed_factor: float
    unit: float | Array
    ahead: float
    before: Array
    sliding: BoolArray
    stick_at_any_force: bool = False
    slip_at_limit: bool = False
    way: Array | None = None
    turning: Array | None = None
    given: Array | None = None
    undriven: Array | None = None

    @property
    def frictionless(self) -> bool:
        """True if no row may stick or slip."""
        return self.shift.size == 0

    def subset(self, which: IntArray) -> "SlipConditions":
        """Subset of the rows."""
        if self.frictionless:
            return self
        return replace(
            self,
            friction=self.friction.subset(which),
            shift=self.shift[which],
            before=self.before[which],
            sliding=self.sliding[which],
            way=None if self.way is None else self.way[which],
            turning=None if self.turning is None else self.turning[which],
            unit=self.unit[which] if isinstance(self.unit, np.ndarray) else self.unit,
            given=None if self.given is None else self.given[which],
            undriven=None if self.undriven is None else self.undriven[which],
        )

    def pressing(self, pressed: Array) -> Array:
        """Normal multipliers (m,) that press the rows, with those known beforehand."""
        return pressed if self.given is None else np.maximum(pressed + self.given, 0.0)

    def with_slipping(self, which: BoolArray) -> "SlipConditions":
        """Conditions with the rows ``which`` (m,) counted as slipping at the start."""
        return self if self.frictionless else replace(self, sliding=self.sliding | which)

    def limit(self, pressed: Array) -> Array:
        """Greatest multiplier (m,) of sticking rows under normal multipliers (m,)."""
        if self.stick_at_any_force:
            return np.where(self.sliding, self.resistance(np.zeros(len(pressed)), pressed)[0], np.inf)
        at_rest = self._at_rest(pressed)
        if not self.sliding.any():
            return at_rest
        return np.where(self.sliding, self.resistance(np.zeros(len(at_rest)), pressed)[0], at_rest)

    def _at_rest(self, pressed: Array) -> Array:
        """Stick limit (m,) of rows under normal multipliers (m,)."""
        pressed = self.pressing(pressed)
        return np.minimum(self.friction.limit(self.unit * pressed) / self.unit, self._most(pressed))

    def _most(self, pressed: Array) -> Array:
        """Greatest multipliers (m,) under total normal multipliers (m,); infinite where ``unit`` fades with contact."""
        return STEEPEST * pressed if self.given is None else np.full(len(pressed), np.inf)

    def drops(self, pressed: Array) -> bool:
        """True if friction is lower in slip than at rest, under normal multipliers (m,)."""
        force = self.unit * self.pressing(pressed)
        return bool((self.friction.resistance(np.zeros(len(force)), force)[0] < self.friction.limit(force)).any())

    def resistance(self, slip: Array, pressed: Array) -> tuple[Array, Array, Array]:
        """Multiplier (m,) of slips ``|y|`` (m,), with its derivatives with respect to slip and normal multiplier."""
        late = (1.0 + self.ahead) * self.speed_factor * slip - self.ahead * self.before
        pressed = self.pressing(pressed)
        value, slope, pressure_slope = self.friction.resistance(np.maximum(late, 0.0), self.unit * pressed)
        with np.errstate(invalid="ignore"):
            change = np.where(late >= 0.0, slope * ((1.0 + self.ahead) * self.speed_factor / self.unit), 0.0)
        change, value = np.nan_to_num(change, nan=0.0, posinf=np.inf, neginf=-np.inf), value / self.unit
        if self.given is not None:
            pressure_slope = np.where(pressed > 0.0, pressure_slope, 0.0)
        most = self._most(pressed)
        lifted = value > most
        if lifted.any():
            value = np.where(lifted, most, value)
            change = np.where(lifted, 0.0, change)
            pressure_slope = np.where(lifted, STEEPEST, pressure_slope)
        if not self.slip_at_limit:
            return value, change, pressure_slope
        limit = np.minimum(self.friction.limit(self.unit * pressed) / self.unit, most)
        secant = limit / np.where(pressed > 0.0, pressed, np.inf)
        return (
            np.where(self.sliding, value, limit),
            np.where(self.sliding, change, 0.0),
            np.where(self.sliding, pressure_slope, secant),
        )


NO_SLIP = SlipConditions(
    friction=FrictionRows(laws=(), contact=np.zeros(0, int), area=np.zeros(0)),
    shift=np.zeros((0, 0)),
    speed_factor=0.0,
    unit=1.0,
    ahead=0.0,
    before=np.zeros(0),
    sliding=np.zeros(0, bool),
)
"""Conditions of rows without friction."""


def slip_conditions(law: SlipConditions, shear: TangentialRows, fixed: Array, span: float) -> SlipConditions:
    """Slip conditions of a slab with the slip ``span/2 (T z - shift)``; ``fixed`` (n, d) are given components of z."""
    if law.frictionless:
        return law
    shift = shear.flat(2.0 / span * shear.moved - shear.weights @ fixed)
    return replace(law, shift=shift, turning=turned(law.way, shear))


def turned(way: Array | None, shear: TangentialRows) -> Array | None:
    """Directions (m, k) along the tangents, of the same length as those in space (m, d); zero across the surface."""
    if way is None:
        return None
    flat = shear.flat(way)
    size = np.linalg.norm(flat, axis=1)
    return flat * (np.linalg.norm(way, axis=1) / np.where(size > 0.0, size, np.inf))[:, None]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReturnedForces:
    """Forces of the law for a trial.

    Parameters
    ----------
    force
        (m,) along the trial.
    slips
        (m,) rows that slip.
    steep, pressure_slope
        (m,) derivatives of the force with respect to the trial and to the normal multiplier.
    """

    force: Array
    slips: BoolArray
    steep: Array
    pressure_slope: Array


def return_map(law: SlipConditions, trial: Array, pressed: Array, stiffness: Array) -> ReturnedForces:
    """Solve ``resistance(y) + stiffness y = trial`` for the slip y >= 0 of each row (m,); rows below the limit stick.

    Newton's method within a bracket, halved where a step leaves it or exceeds half of the step before the last; exact
    in one step where the resistance is linear in the speed.
    """
    slips = trial > law.limit(pressed)
    low, high = np.zeros(len(trial)), np.where(slips, trial / stiffness, 0.0)
    force, change, pressure_slope = law.resistance(low, pressed)
    slip = np.clip((trial - force) / stiffness, 0.0, high)
    longest = (np.full(len(trial), np.inf), np.full(len(trial), np.inf))
    for _ in range(ITERATIONS):
        force, change, pressure_slope = law.resistance(slip, pressed)
        excess = force + stiffness * slip - trial
        low, high = np.where(excess < 0.0, slip, low), np.where(excess >= 0.0, slip, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            better = slip - excess / (change + stiffness)
        inside = np.isfinite(better) & (better >= low) & (better <= high)
        moved = np.where(inside & (np.abs(better - slip) <= 0.5 * longest[0]), better, 0.5 * (low + high))
        longest = longest[1], np.abs(moved - slip)
        done = np.abs(moved - slip) <= 1e-15 * np.maximum(moved, trial / stiffness)
        slip = np.where(slips, moved, 0.0)
        if done[slips].all():
            break
    force, change, pressure_slope = law.resistance(slip, pressed)
    with np.errstate(invalid="ignore"):
        steep = np.where(np.isinf(change), 1.0, change / (change + stiffness))
    force = np.where(slips, np.where(np.isinf(change), np.maximum(trial - stiffness * slip, 0.0), force), trial)
    return ReturnedForces(force=force, slips=slips, steep=steep, pressure_slope=pressure_slope * (1.0 - steep))


def undriven(law: SlipConditions, trial: Array) -> tuple[Array, Array | None]:
    """Trials (c, k) without their part along the slip at the start, and the directions (c, k) of the parts left out.

    The directions are zero where nothing is left out, and None for a law without such a condition.
    """
    if law.undriven is None:
        return trial, None
    part = np.maximum(np.einsum("ck,ck->c", trial, law.undriven), 0.0)[:, None]
    return trial - part * law.undriven, np.where(part > 0.0, law.undriven, 0.0)
