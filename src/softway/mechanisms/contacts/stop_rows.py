"""Stops of a mechanism in its present state: gaps, velocities, slabs (time steps) with closed stops, and collisions.

The impulses of closed stops obey the laws of contact on places over the slab, and with those at its end on velocities
(docs/theory/mechanisms.md).
"""

import itertools
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NumericsError
from softway.kernels.multibody.energy import close_energy, kinetic_energy
from softway.kernels.multibody.slab import prepare_joints, take_motion, tell_joints
from softway.kernels.multibody.tables import Space
from softway.kernels.multibody.velocities import row_velocities
from softway.kernels.rigid_contact.contact import SLIP, book_slab, collide, collide_at_once, solve_contact_slab
from softway.mechanisms.arrays import Arrays

NEAR = 1e-10
"""Gap relative to the extent at which a stop takes part in an impact."""
STILL = 1e-9
"""Velocity relative to the greatest at which a stop is closed after an impact."""
NOISE = 1e-12
"""Sliding relative to the extent, in a slab, that is rounding of a stop that sticks."""
GAINED = 1e-13
"""Gain of energy, relative to the energy, that is rounding."""
REBOUNDS = (1.0, 0.75, 0.5, 0.25, 0.0)
"""Parts of the rebound that are tried until the energy does not grow."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stops:
    """Stops of a mechanism in its present state.

    Parameters
    ----------
    it, room
        Arrays of the mechanism, and work space.
    rows
        (s, d) rows of the stops in the table of the joints: the normal one, the tangential ones if there is friction,
        and those of the turning if there is friction against it.
    restitution
        (s,) coefficients.
    friction, static
        (s, q) coefficients of friction in motion: against sliding, and lengths [m] against rolling and drilling; (s,)
        that against sliding at rest.
    located, names
        (s,) stops whose sliding begins and ends at located instants, and names of the stops.
    held
        (g,) groups that the ground holds by joints.
    closed, sliding
        (s,) stops that are closed, and those whose places of contact slide.
    turning
        (s, q - 1) stops whose bodies roll, and drill.
    told
        (s,) sliding of the closed located stops as the events say: 1, at rest 0, and -1 of open ones.
    spent, shut
        (s,) energies that they dissipated in the slab [J], and times in which they were closed [s].
    """

    it: Arrays
    room: Space
    rows: IntArray
    restitution: Array
    friction: Array
    static: Array
    located: BoolArray
    names: tuple[str, ...]
    held: IntArray
    closed: BoolArray
    sliding: BoolArray
    turning: BoolArray
    told: IntArray
    spent: Array
    shut: Array

    def tried(self, span: float, extent: float, smooth: BoolArray | None = None) -> int:
        """Solve a slab with the closed stops, without taking it; the number of iterations, 0 if it has no solution.

        Those that are ``smooth`` (s,) have no friction in it.
        """
        rows, friction = self.closed_rows()
        if smooth is not None:
            friction = np.where(smooth[self.closed, None], 0.0, friction)
        self.it.motion.impulse[self.rows[~self.closed].ravel()] = 0.0
        used: int = solve_contact_slab(*self._tables, rows, friction, span, extent)
        return used

    def taken(self, time: float, span: float, extent: float, told: Array, rebound: Array) -> BoolArray:
        """Take the slab that was tried; stops (s,) that are closed at its end, where they ``rebound`` (s,) [m/s].

        The energy that joints and stops took from the velocities at the end is given back, but not that of stops that
        slide or begin to stick.

        Raises
        ------
        NumericsError
            If no velocities at the end satisfy the laws of contact.
        """
        it, (rows, friction) = self.it, self.closed_rows()
        for k in np.flatnonzero(self.closed):
            lost = float(it.motion.work[1])
            book_slab(it.bodies, it.joints, it.motion, self.room, self.rows[k], span)
            self.spent[k] += it.motion.work[1] - lost
        self.shut[self.closed] += span
        take_motion(*self._tables, span)
        through = it.motion.impulse[rows]
        below = self.below_limit(through, friction)
        moving = np.concatenate([self.sliding[:, None], self.turning], axis=1)[self.closed] & (friction > 0.0)
        steady = bool((below & ~moving).all() and (self._table(through)[:, 0] > 0.0).all())
        steady = steady and not self.room.rate[rows].any()
        if not steady:
            told[2] = max(told[2], close_energy(it.bodies, it.springs, it.joints, it.motion, self.room))
        excess = self.excess()
        total = self._pushed(rows, friction, through, rebound[self.closed], extent / span)
        if total is None:
            raise NumericsError("no velocities satisfy the laws of contact at the closed stops", time, "a shorter step")
        if steady:
            told[2] = max(told[2], close_energy(it.bodies, it.springs, it.joints, it.motion, self.room))
        else:
            pushed = np.zeros(len(self.rows))
            pushed[self.closed] = self._table(total)[:, 0]
            self.lose(excess - self.excess(), pushed)
        tell_joints(it.joints, it.motion, self.room, told)
        closed, speed = self.closed.copy(), self.speeds()
        self.see_sliding(NOISE * extent / span, below[:, 0])
        closed[self.closed] = (self._table(total)[:, 0] > 0.0) | (
            (self.gaps()[self.closed] <= NEAR * extent)
            & (speed[self.closed] <= STILL * float(np.abs(it.motion.velocity).max()))
        )
        return closed & (rebound <= 0.0)

    def _pushed(self, rows: IntArray, friction: Array, through: Array, rebound: Array, speed: float) -> Array | None:
        """Push the closed stops at the end of a slab: their impulses (m,), those that acted ``through`` it included.

        If the energy grew, which rebounds with friction may cause, they are pushed with less rebound.  None if there is
        no solution.
        """
        it = self.it
        changed = (it.motion.velocity, it.motion.spin, it.motion.energy, it.motion.work)
        kept, excess = [array.copy() for array in changed], float(self.excess().sum())
        scale = excess + float(it.motion.energy.sum())
        for part in REBOUNDS if rebound.any() else REBOUNDS[-1:]:
            for array, before in zip(changed, kept, strict=True):
                array[:] = before
            total, tables = through.copy(), (it.bodies, it.joints, it.motion, self.room)
            solved = (
                collide(*tables, rows, friction, through, part * rebound, 0.0 * rebound, speed, total)
                if len(rows)
                else 1
            )
            if solved and float(self.excess().sum()) <= excess + GAINED * scale:
                return total
        return total if solved else None

    def collide(self, these: BoolArray, rebound: Array, lower: Array, speed: float, impulse: Array) -> bool:
        """Impact at some stops (s,) at once, which rebound with velocities (s,) [m/s] at least.

        Their normal impulses are ``lower`` (s,) at least, and are added to ``impulse`` (s,).  False if it has no
        solution.
        """
        rows = self.rows[these].ravel()
        none, found = np.zeros(len(rows)), np.zeros(len(rows))
        laws = self.coefficients()[these], none, rebound[these], lower[these], speed
        solved = collide(self.it.bodies, self.it.joints, self.it.motion, self.room, rows, *laws, found)
        impulse[these] += self._table(found)[:, 0]
        return bool(solved)

    def compress_and_expand(self, these: BoolArray, ratio: Array, speed: float, impulse: Array) -> bool:
        """Impact at some stops (s,) with ratios of the impulses of expansion and compression (Poisson).

        A single one in the plane is followed through its sliding.  False if it has no solution.
        """
        none, k = np.zeros(len(self.rows)), int(np.argmax(these))
        rows = self.rows[k, : self.tangential.stop]
        if len(rows) == 2 and these.sum() == 1 and not self.friction[k, 1:].any():
            found = np.zeros(2)
            tables = self.it.bodies, self.it.joints, self.it.motion, self.room
            solved = collide_at_once(*tables, rows, self.coefficients()[k, 0], ratio[k], found)
            impulse[k] += found[0]
            return bool(solved)
        compression = np.zeros(len(self.rows))
        if not self.collide(these, none, none, speed, compression):
            return False
        impulse += compression
        return self.collide(these, none, ratio * compression, speed, impulse)

    @property
    def _tables(self) -> tuple[object, ...]:
        return self.it.bodies, self.it.joints, self.it.springs, self.it.motion, self.room

    def closed_rows(self) -> tuple[IntArray, Array]:
        """Rows (m,) of the closed stops, and their coefficients of friction (c, q)."""
        return self.rows[self.closed].ravel(), self.coefficients()[self.closed]

    def coefficients(self) -> Array:
        """Coefficients of friction (s, q) at present, those at rest of stops that do not slide."""
        if not self.located.any():
            return self.friction
        found = self.friction.copy()
        at_rest = self.located & self.closed & ~self.sliding
        found[at_rest, 0] = self.static[at_rest]
        return found

    def _table(self, impulse: Array) -> Array:
        """Impulses (c, d) of stops."""
        return impulse.reshape(-1, self.rows.shape[1])

    @property
    def tangential(self) -> slice:
        """Numbers of the rows of the sliding among those of a stop."""
        d, q = self.rows.shape[1], self.friction.shape[1]
        return slice(1, d if q == 1 else q)

    def below_limit(self, impulse: Array, friction: Array) -> BoolArray:
        """Closed stops and blocks (c, q) whose friction is below its limit, or that have none."""
        table = self._table(impulse)
        return (self._sizes(table) < (1.0 - SLIP) * friction * table[:, :1]) | (friction == 0.0)

    def _sizes(self, table: Array) -> Array:
        """Magnitudes (c, q) of the blocks of rows (c, d) of stops."""
        if self.friction.shape[1] == 1:
            return np.linalg.norm(table[:, 1:], axis=1, keepdims=True)
        edges = (1, 2, 3) if self.friction.shape[1] == 2 else (1, 3, 5, 6)
        return np.stack([np.linalg.norm(table[:, i:j], axis=1) for i, j in itertools.pairwise(edges)], axis=1)

    def hold(self, supported: IntArray) -> None:
        """Groups that the ground holds by joints or closed stops."""
        joints, ground = self.it.joints, len(self.it.names)
        supported[:] = self.held
        for row in self.rows[self.closed, 0]:
            a, b = int(joints.a[row]), int(joints.b[row])
            if ground in (a, b):
                supported[self.it.bodies.group[min(a, b)]] = 1

    def gaps(self) -> Array:
        """Gaps (s,) at the end of the part that was tried [m]."""
        return self.room.g[self.rows[:, 0]]

    def at_state(self) -> Array:
        """Gaps (s,) at the present state [m]."""
        prepare_joints(self.it.bodies, self.it.joints, self.it.motion, self.room)
        return self.gaps()

    def speeds(self) -> Array:
        """Velocities (s,) of the gaps [m/s]."""
        return self._velocities()[:, 0]

    def _velocities(self) -> Array:
        """Velocities (s, d) of the gaps and of the sliding [m/s]."""
        out = np.zeros(len(self.room.g))
        row_velocities(self.it.joints, self.it.motion, self.room, out)
        return out[self.rows]

    def slips(self) -> Array:
        """Velocities (s, t) of the sliding, against surfaces that may move themselves [m/s]."""
        return self._velocities()[:, self.tangential]

    def slid(self, span: float) -> Array:
        """Displacements (s, t) of the sliding in a slab of this length that was tried [m]."""
        rows, out = self.rows[:, self.tangential], np.zeros(self.rows[:, self.tangential].shape)
        for side in range(self.room.G.shape[1]):
            out += np.einsum("stc,stc->st", self.room.G[rows, side], self.room.z[self.it.joints.sides[rows, side]])
        return out - span * self.room.rate[rows]

    def see_sliding(self, noise: float, held: BoolArray | None = None) -> None:
        """Note which stops slide or turn; velocities below ``noise`` [m/s] are none of located stops.

        After a slab these go on sliding, at whatever velocity, if friction has not ``held`` (c,) them.
        """
        sizes, motion = self._sizes(self._velocities()), self.it.motion
        moving = sizes[:, 0] > STILL * float(np.abs(motion.velocity).max())
        self.turning[:] = sizes[:, 1:] > STILL * float(np.abs(motion.spin).max())
        if self.located.any():
            moving &= ~self.located | (sizes[:, 0] > noise)
            if held is not None:
                on = self.located & self.sliding & self.closed
                on[self.closed] &= ~held
                moving |= on
        self.sliding[:] = moving

    def excess(self) -> Array:
        """Kinetic energies (g,) of the groups over the energies that they have to have, up to their potentials [J]."""
        out = -self.it.motion.energy
        kinetic_energy(self.it.bodies, self.it.motion, out)
        return out

    def lose(self, lost: Array, pushed: Array) -> None:
        """Book energies (g,) of the groups that stops dissipated [J], in the ratio of normal impulses (s,)."""
        self.it.motion.work[1] += float(lost.sum())
        self.it.motion.energy[:] -= lost
        first, other = self.it.joints.a[self.rows[:, 0]], self.it.joints.b[self.rows[:, 0]]
        group = self.it.bodies.group[np.where(first == len(self.it.names), other, first)]
        for g in np.flatnonzero(lost):
            here = np.flatnonzero(group == g)
            weight = pushed[here] if pushed[here].sum() > 0.0 else np.ones(len(here))
            self.spent[here] += lost[g] * weight / max(float(weight.sum()), 1e-300)
