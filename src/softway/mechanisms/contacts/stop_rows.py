"""Stops of a mechanism in its present state: gaps, velocities, slabs (time steps) with closed stops, and collisions.

The impulses of closed stops obey the laws of contact on places over the slab, and with those at its end on velocities
(docs/theory/mechanisms.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import NumericsError
from softway.kernels.multibody.slab import prepare_joints
from softway.kernels.multibody.tables import Space
from softway.kernels.rigid_contact import closed_stops
from softway.kernels.rigid_contact.contact import collide, collide_at_once
from softway.kernels.rigid_contact.tables import StopTable
from softway.kernels.rigid_course.stops import try_slab
from softway.mechanisms.arrays import Arrays


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
        none = np.zeros(len(self.rows), bool) if smooth is None else smooth
        used: int = try_slab(*self.tables, self.table, none, span, extent)
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
        stays = np.zeros(len(self.rows), bool)
        if not closed_stops.take_contact_slab(*self.tables, self.table, span, extent, told, rebound, stays):
            raise lost_velocities(time)
        return stays

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
    def tables(self) -> tuple[object, ...]:
        """Tables of the mechanism for the compiled slabs."""
        return self.it.bodies, self.it.joints, self.it.springs, self.it.motion, self.room

    @property
    def table(self) -> StopTable:
        """Table of the stops for the compiled slabs."""
        return StopTable(*(getattr(self, name) for name in StopTable._fields))

    def closed_rows(self) -> tuple[IntArray, Array]:
        """Rows (m,) of the closed stops, and their coefficients of friction (c, q)."""
        rows, friction = closed_stops.closed_rows(self.table)
        return rows, friction

    def coefficients(self) -> Array:
        """Coefficients of friction (s, q) at present, those at rest of stops that do not slide."""
        return np.asarray(closed_stops.coefficients(self.table))

    def _table(self, impulse: Array) -> Array:
        """Impulses (c, d) of stops."""
        return impulse.reshape(-1, self.rows.shape[1])

    @property
    def tangential(self) -> slice:
        """Numbers of the rows of the sliding among those of a stop."""
        d, q = self.rows.shape[1], self.friction.shape[1]
        return slice(1, d if q == 1 else q)

    def hold(self) -> None:
        """Set the groups that the ground holds by joints or closed stops."""
        closed_stops.hold(self.it.bodies, self.it.joints, self.table)

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
        return np.asarray(closed_stops.velocities(self.it.joints, self.it.motion, self.room, self.table))

    def slips(self) -> Array:
        """Velocities (s, t) of the sliding, against surfaces that may move themselves [m/s]."""
        return self._velocities()[:, self.tangential]

    def slid(self, span: float) -> Array:
        """Displacements (s, t) of the sliding in a slab of this length that was tried [m]."""
        rows, out = self.rows[:, self.tangential], np.zeros(self.rows[:, self.tangential].shape)
        for side in range(self.room.G.shape[1]):
            out += np.einsum("stc,stc->st", self.room.G[rows, side], self.room.z[self.it.joints.sides[rows, side]])
        return out - span * self.room.rate[rows]

    def see_sliding(self, noise: float) -> None:
        """Note which stops slide or turn; velocities below ``noise`` [m/s] are none of located stops."""
        closed_stops.see_sliding(self.it.motion, self.table, self._velocities(), noise, np.ones(len(self.rows), bool))

    def excess(self) -> Array:
        """Kinetic energies (g,) of the groups over the energies that they have to have, up to their potentials [J]."""
        return np.asarray(closed_stops.excess(self.it.bodies, self.it.motion))

    def lose(self, lost: Array, pushed: Array) -> None:
        """Book energies (g,) of the groups that stops dissipated [J], in the ratio of normal impulses (s,)."""
        closed_stops.lose(self.it.bodies, self.it.joints, self.it.motion, self.table, lost, pushed)


def lost_velocities(time: float) -> NumericsError:
    """Error of a slab from a time on whose end has no velocities."""
    return NumericsError("no velocities satisfy the laws of contact at the closed stops", time, "a shorter step")
