"""The return map of friction: from a trial force to what the law lets through."""

from dataclasses import dataclass, replace

import numpy as np

from softway.contact.rubbing import Rubbing
from softway.contact.shear import Shear
from softway.typing import Array, BoolArray, IntArray

ITERATIONS = 100
"""Iterations of the scalar equation; bisection alone would take about 60."""
STEEPEST = 1e3
"""Greatest tangential force over the normal one: laws without regard to the pressure fade where a row lifts off."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Slipping:
    """Conditions of one slab on the slip of contact rows, in the units of the multipliers.

    The slip of a row is ``y = T z - shift``, its mean speed ``pace |y|``.  A law that depends on the speed takes the
    one at the end of the slab, ``(1 + ahead) pace |y| - ahead before``: extrapolated from the mean speed ``before`` of
    the slab before.

    Parameters
    ----------
    rubbing
        The laws.
    shift
        (m, k).
    pace
        Speed per unit of y.
    unit
        Force per unit of the multipliers.
    ahead, before
        See above; ``before`` (m,) [m/s].
    sliding
        (m,) rows that slip at the start of the slab: they are held by the resistance at rest, not by the limit.
    held
        Whether the other rows are held at any force.
    """

    rubbing: Rubbing
    shift: Array
    pace: float
    unit: float
    ahead: float
    before: Array
    sliding: BoolArray
    held: bool = False

    def part(self, which: IntArray) -> "Slipping":
        """Some of the rows."""
        return replace(
            self,
            rubbing=self.rubbing.part(which),
            shift=self.shift[which],
            before=self.before[which],
            sliding=self.sliding[which],
        )

    def going(self, which: BoolArray) -> "Slipping":
        """The same where some rows (m,) slip already."""
        return replace(self, sliding=self.sliding | which)

    def limit(self, pressed: Array) -> Array:
        """Multiplier (m,) that holds rows under normal multipliers (m,)."""
        if self.held:
            return np.where(self.sliding, self.resistance(np.zeros(len(pressed)), pressed)[0], np.inf)
        held = np.minimum(self.rubbing.limit(self.unit * pressed) / self.unit, STEEPEST * pressed)
        if not self.sliding.any():
            return held
        return np.where(self.sliding, self.resistance(np.zeros(len(held)), pressed)[0], held)

    def drops(self, pressed: Array) -> bool:
        """Whether friction is less in slip than at rest, under normal multipliers (m,)."""
        force = self.unit * pressed
        return bool((self.rubbing.resistance(np.zeros(len(force)), force)[0] < self.rubbing.limit(force)).any())

    def resistance(self, slip: Array, pressed: Array) -> tuple[Array, Array, Array]:
        """Multiplier (m,) of slips ``|y|`` (m,), and its derivatives to the slip and to the normal multiplier."""
        late = (1.0 + self.ahead) * self.pace * slip - self.ahead * self.before
        value, slope, share = self.rubbing.resistance(np.maximum(late, 0.0), self.unit * pressed)
        with np.errstate(invalid="ignore"):
            change = np.where(late >= 0.0, slope * ((1.0 + self.ahead) * self.pace / self.unit), 0.0)
        change, value = np.nan_to_num(change, nan=0.0, posinf=np.inf, neginf=-np.inf), value / self.unit
        lifted = value > STEEPEST * pressed
        if not lifted.any():
            return value, change, share
        return (
            np.where(lifted, STEEPEST * pressed, value),
            np.where(lifted, 0.0, change),
            np.where(lifted, STEEPEST, share),
        )


def during(law: Slipping | None, shear: Shear | None, fixed: Array, span: float) -> Slipping | None:
    """The conditions on the slip over a slab, ``span/2 (T z - shift)``; ``fixed`` (n, d) are given components of z."""
    if law is None or shear is None:
        return None
    return replace(law, shift=shear.flat(2.0 / span * shear.moved - shear.weights @ fixed))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Returned:
    """What the law answers to a trial: ``force`` (m,) along it, whether it ``slips`` (m,), how the force changes with
    the trial, ``steep`` (m,), and with the normal multiplier, ``share`` (m,).
    """

    force: Array
    slips: BoolArray
    steep: Array
    share: Array


def returned(law: Slipping, trial: Array, pressed: Array, stiffness: Array) -> Returned:
    """Solve ``resistance(y) + stiffness y = trial`` for the slip y >= 0 of each row (m,); stick where it is held.

    Newton's method within a bracket; exact in one step where the resistance is linear in the speed.
    """
    slips = trial > law.limit(pressed)
    low, high = np.zeros(len(trial)), np.where(slips, trial / stiffness, 0.0)
    force, change, share = law.resistance(low, pressed)
    slip = np.clip((trial - force) / stiffness, 0.0, high)
    for _ in range(ITERATIONS):
        force, change, share = law.resistance(slip, pressed)
        excess = force + stiffness * slip - trial
        low, high = np.where(excess < 0.0, slip, low), np.where(excess >= 0.0, slip, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            better = slip - excess / (change + stiffness)
        inside = np.isfinite(better) & (better >= low) & (better <= high)
        moved = np.where(inside, better, 0.5 * (low + high))
        done = np.abs(moved - slip) <= 1e-15 * np.maximum(moved, trial / stiffness)
        slip = np.where(slips, moved, 0.0)
        if done[slips].all():
            break
    force, change, share = law.resistance(slip, pressed)
    with np.errstate(invalid="ignore"):
        steep = np.where(np.isinf(change), 1.0, change / (change + stiffness))
    force = np.where(slips, np.where(np.isinf(change), np.maximum(trial - stiffness * slip, 0.0), force), trial)
    return Returned(force=force, slips=slips, steep=steep, share=share * (1.0 - steep))
