"""Stops of a mechanism in its present state: gaps, velocities, slabs (time steps) with closed stops, and collisions.

The impulses of closed stops obey the laws of contact on places over the slab, and with those at its end on velocities
(docs/theory/mechanisms.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NumericsError
from softway.kernels.multibody.energy import close_energy, kinetic_energy
from softway.kernels.multibody.slab import prepare_joints, take_motion, tell_joints
from softway.kernels.multibody.tables import Space
from softway.kernels.multibody.velocities import row_velocities
from softway.kernels.rigid_contact.contact import book_slab, collide, collide_at_once, compliances, solve_contact_slab
from softway.mechanisms.arrays import Arrays

NEAR = 1e-10
"""Gap relative to the extent at which a stop takes part in an impact."""
STILL = 1e-9
"""Velocity relative to the greatest at which a stop is closed after an impact."""
SLIP = 1e-9
"""Friction, relative to its limit, that is rounding below it."""
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
        (s, d) rows of the stops in the table of the joints: the normal one, and the tangential ones if there is
        friction.
    restitution, friction
        (s,) coefficients.
    names
        Names of the stops.
    held
        (g,) groups that the ground holds by joints.
    closed, sliding
        (s,) stops that are closed, and those whose places of contact slide.
    """

    it: Arrays
    room: Space
    rows: IntArray
    restitution: Array
    friction: Array
    names: tuple[str, ...]
    held: IntArray
    closed: BoolArray
    sliding: BoolArray

    def tried(self, span: float, extent: float, smooth: BoolArray | None = None) -> int:
        """Solve a slab with the closed stops, without taking it; the number of iterations, 0 if it has no solution.

        Those that are ``smooth`` (s,) have no friction in it.
        """
        rows, friction = self._closed_rows()
        if smooth is not None:
            friction = np.where(smooth[self.closed], 0.0, friction)
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
        it, (rows, friction) = self.it, self._closed_rows()
        book_slab(it.bodies, it.joints, it.motion, self.room, rows, span)
        take_motion(*self._tables, span)
        through = it.motion.impulse[rows]
        normal, tangential = self._split(through)
        sticks = ~self.sliding[self.closed] & (tangential < (1.0 - SLIP) * friction * normal)
        steady = bool(((normal > 0.0) & ((friction == 0.0) | sticks)).all())
        if not steady:
            told[2] = max(told[2], close_energy(it.bodies, it.springs, it.joints, it.motion, self.room))
        excess = self.excess()
        total = self._pushed(rows, friction, through, rebound[self.closed], extent / span)
        if total is None:
            raise NumericsError("no velocities satisfy the laws of contact at the closed stops", time, "a shorter step")
        if steady:
            told[2] = max(told[2], close_energy(it.bodies, it.springs, it.joints, it.motion, self.room))
        else:
            self.lose(excess - self.excess())
        tell_joints(it.joints, it.motion, self.room, told)
        closed, speed = self.closed.copy(), self.speeds()
        self.see_sliding()
        closed[self.closed] = (self._split(total)[0] > 0.0) | (
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
        laws = self.friction[these], none, rebound[these], lower[these], speed
        solved = collide(self.it.bodies, self.it.joints, self.it.motion, self.room, rows, *laws, found)
        impulse[these] += self._split(found)[0]
        return bool(solved)

    def compress_and_expand(self, these: BoolArray, ratio: Array, speed: float, impulse: Array) -> bool:
        """Impact at some stops (s,) with ratios of the impulses of expansion and compression (Poisson).

        A single one in the plane is followed through its sliding.  False if it has no solution.
        """
        none, rows = np.zeros(len(self.rows)), self.rows[these].ravel()
        if len(rows) == 2 and these.sum() == 1:
            found = np.zeros(2)
            k = int(np.argmax(these))
            tables = self.it.bodies, self.it.joints, self.it.motion, self.room
            solved = collide_at_once(*tables, rows, self.friction[k], ratio[k], found)
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

    def _closed_rows(self) -> tuple[IntArray, Array]:
        """Rows (m,) of the closed stops, and their coefficients of friction."""
        return self.rows[self.closed].ravel(), self.friction[self.closed]

    def _split(self, impulse: Array) -> tuple[Array, Array]:
        """Normal impulses of stops, and magnitudes of the tangential ones."""
        table = impulse.reshape(-1, self.rows.shape[1])
        return table[:, 0], np.linalg.norm(table[:, 1:], axis=1)

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

    def jammed(self) -> IntArray:
        """Closed stops (k,) whose sliding has no continuous course at the present state.

        A normal force with its friction would not push the places of contact apart, ``W_nn - mu W_nt <= 0`` (Painleve).
        """
        moving = np.flatnonzero(self.closed & self.sliding & (self.friction > 0.0))
        if not len(moving):
            return moving
        found = []
        for k, slip in zip(moving, self._velocities()[moving, 1:], strict=True):
            W = compliances(self.it.joints, self.room, self.rows[k])[0]
            if W[0, 0] - self.friction[k] * float(W[0, 1:] @ slip) / float(np.linalg.norm(slip)) <= 0.0:
                found.append(k)
        return np.array(found, dtype=np.int64)

    def see_sliding(self) -> None:
        """Note which stops slide."""
        speed = np.linalg.norm(self._velocities()[:, 1:], axis=1)
        self.sliding[:] = speed > STILL * float(np.abs(self.it.motion.velocity).max())

    def excess(self) -> Array:
        """Kinetic energies (g,) of the groups over the energies that they have to have, up to their potentials [J]."""
        out = -self.it.motion.energy
        kinetic_energy(self.it.bodies, self.it.motion, out)
        return out

    def lose(self, lost: Array) -> None:
        """Book energies (g,) of the groups that stops dissipated [J]."""
        self.it.motion.work[1] += float(lost.sum())
        self.it.motion.energy[:] -= lost
