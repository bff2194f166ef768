"""Rigid bodies of a model: their state, and their slabs (time steps) under the forces of the solids.

The solids see a rigid body as a tool with a motion; the rigid bodies feel minus the same mean forces at the mean places
of the points that these act on (docs/theory/contact/rigid_bodies.md).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import RigidMotion, RigidShape, quaternion, rotation_vector, rotations
from softway.errors import InputError, NoConvergence, NumericsError
from softway.kernels.multibody.angles import angles_at
from softway.kernels.multibody.energy import kinetic_energy, potential_energy
from softway.kernels.multibody.slab import begin
from softway.kernels.multibody.velocities import project_velocities
from softway.kernels.rigid_course.course import course, note_bodies
from softway.mechanisms.arrays import Arrays, arrays
from softway.mechanisms.driven import require_free_motions
from softway.mechanisms.members.joints import GROUND
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.stops import StopEvent
from softway.mechanisms.newton import march_on
from softway.mechanisms.step import BodyState, bodies_in
from softway.mechanisms.welds import Welded, parts_of, welded
from softway.model.field import StopsInSlab
from softway.model.rigid.rigid_state import RigidState, at_work


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidEnergies:
    """Energies of rigid bodies [J]: kinetic, stored in springs, and the potential of their weight."""

    kinetic: float
    springs: float
    weight: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidSlab:
    """Slab of the rigid bodies: the state at its end, the events of their stops, and what these did."""

    state: RigidState
    events: tuple[StopEvent, ...]
    stops: StopsInSlab


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidBodies:
    """Rigid bodies with their joints, springs and motors; ``it`` are the arrays of the ``joined`` mechanism."""

    mechanism: Mechanism
    joined: Welded
    it: Arrays

    def start(self, span: float | None = None) -> RigidState:
        """State at the start; velocities satisfy the joints and, for a slab of length ``span`` [s], the stops.

        Raises
        ------
        InputError
            If a stop is overlapped, or motors move what joints determine.
        """
        work = at_work(self.joined.mechanism, self.it)
        it, room = work.it, work.room
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        require_free_motions(it, room)
        project_velocities(it.bodies, it.joints, it.motion, room)
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        if work.stops is not None and span is not None:
            work.stops.start(span, it.reach(span))
        return work.state(np.zeros(2))

    def allowed(self, velocity: Array, spin: Array) -> Array:
        """Velocities and angular velocities (n, 6) that the joints leave of these (3,) of all bodies, at the start."""
        work = at_work(self.joined.mechanism, self.it)
        it, room = work.it, work.room
        it.motion.velocity[:-1], it.motion.spin[:-1] = velocity, spin
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        room.rate[:] = 0.0
        project_velocities(it.bodies, it.joints, it.motion, room)
        return np.concatenate([it.motion.velocity, it.motion.spin], axis=1)

    def state_of(self, found: Mapping[str, BodyState], time: float) -> RigidState:
        """State with these states of the bodies at a time [s]; angles of joints are within half a turn.

        Bodies that approach at a stop that they touch strike it in the slab that follows.

        Raises
        ------
        InputError
            If bodies are missing.
        """
        names, start = self.mechanism.bodies.keys(), self.start()
        if found.keys() != names:
            raise InputError("state", f"rigid bodies {sorted(found)}", f"a state with {sorted(names)}")
        for name in names:
            k, own, body = self.number(name), found[name], self.mechanism.bodies[name]
            if k == len(self.it.names):
                continue
            turn, spin, d = np.eye(3), np.zeros(3), self.mechanism.dim
            turn[:d, :d] = own.rotation
            spin[3 - len(own.spin) :] = own.spin
            whole = self.joined.mechanism.bodies[self.it.names[k]]
            arm = np.zeros(3)
            arm[:d] = np.subtract(whole.centre, body.centre)
            start.place[k, :d] = own.centre + (turn @ arm)[:d]
            start.velocity[k, :d] = own.velocity + np.cross(spin, turn @ arm)[:d]
            start.turn[k], start.spin[k] = quaternion(turn), turn.T @ spin
        work = at_work(self.joined.mechanism, self.it, start)
        it, room = work.it, work.room
        still = np.tile(np.eye(3), (len(start.place), 1, 1))
        angles_at(it.joints.angles, still, rotations(start.turn), it.motion.angle, room.turn)
        begin(it.bodies, it.joints, it.springs, it.motion, room)
        it.motion.time[0] = time
        if work.stops is not None:
            work.stops.start(1.0, it.reach(1.0), impacts=False)
        return work.state(np.zeros(2))

    def slab(self, state: RigidState, time: float, span: float, given: Array) -> RigidSlab:
        """Slab of length ``span`` [s] from a state, with the mean forces ``given`` (n - 1, 4, 3) by solids.

        Raises
        ------
        NoConvergence
            If the slab has no solution.
        """
        work, told, events = at_work(self.joined.mechanism, self.it, state), np.zeros(3), list[StopEvent]()
        work.room.given[:] = given
        try:
            if work.stops is None:
                march_on(work.it, work.room, time, span, 1, told)
            else:
                events = work.stops.slab(time, span, work.it.reach(span), told)[0]
        except NumericsError as error:
            raise NoConvergence(str(error)) from None
        return RigidSlab(state=work.state(told[:2]), events=tuple(events), stops=work.stops_in_slab(span))

    def motions(self, before: RigidState, moved: Array, start: float, end: float) -> dict[str, RigidMotion]:
        """Motion of each body over a slab from a state, with the displacements and rotation vectors (n, 6)."""
        turned, out = rotations(before.turn), {}
        for name in self.mechanism.bodies:
            k, whole = self.number(name), self.joined.part_of[name]
            centre = np.zeros(3)
            if whole != GROUND:
                centre[: self.mechanism.dim] = self.joined.mechanism.bodies[whole].centre
            rate = np.concatenate([before.velocity[k], turned[k] @ before.spin[k]])
            out[name] = RigidMotion(
                begin=start,
                end=end,
                centre=centre,
                place=before.place[k],
                rotation=turned[k],
                moved=moved[k],
                rate=rate,
                dim=self.mechanism.dim,
            )
        return out

    def moved(self, before: RigidState, after: RigidState) -> Array:
        """Displacements and rotation vectors (n, 6) from one state to another."""
        first, last = rotations(before.turn), rotations(after.turn)
        turns = [rotation_vector(b @ a.T) for a, b in zip(first, last, strict=True)]
        return np.concatenate([after.place - before.place, np.array(turns)], axis=1)

    def coasting_motions(self) -> dict[str, RigidMotion]:
        """Motions of the bodies from the start on, with the velocities there."""
        state = self.start()
        return self.motions(state, np.zeros((len(state.place), 6)), 0.0, 0.0)

    def shapes(self, motions: Mapping[str, RigidMotion]) -> dict[str, RigidShape]:
        """Shapes of the bodies that have one, in their motions."""
        bodies = self.mechanism.bodies
        return {n: RigidShape(shape=s, motion=m) for n, m in motions.items() if (s := bodies[n].shape) is not None}

    def number(self, name: str) -> int:
        """Number of the body that a body is part of; the last for the ground."""
        whole = self.joined.part_of[name]
        return len(self.it.names) if whole == GROUND else self.it.names.index(whole)

    def extent(self, state: RigidState) -> float:
        """Extent of the rigid bodies, the scale of rounding [m]."""
        return replace(self.it, motion=state.motion()).reach(0.0)

    def bodies(self, state: RigidState) -> dict[str, BodyState]:
        """State of each body."""
        work, parts = (
            at_work(self.joined.mechanism, self.it, state),
            parts_of(self.mechanism, self.joined, self.it.names),
        )
        table = course(1, 1, *parts, 0, 0)
        note_bodies(work.it.motion, work.room, table, 0)
        return bodies_in(table, 0, tuple(self.mechanism.bodies), self.mechanism.dim)

    def energies(self, state: RigidState) -> RigidEnergies:
        """Energies in a state."""
        it, motion, groups = self.it, state.motion(), len(self.it.bodies.jointed)
        kinetic, both = np.zeros(groups), np.zeros(groups)
        kinetic_energy(it.bodies, motion, kinetic)
        potential_energy(it.bodies, it.springs, it.joints.angles, motion, rotations(state.turn), both)
        weight = -float((it.bodies.mass[:, None] * state.place @ it.bodies.gravity[:, None]).sum())
        return RigidEnergies(kinetic=float(kinetic.sum()), springs=float(both.sum()) - weight, weight=weight)

    def momenta(self, state: RigidState) -> tuple[Array, Array]:
        """Momenta (n, 3) [kg m/s], and angular momenta (n, 3) about the origin [kg m^2/s]."""
        it, mass = self.it, self.it.bodies.mass[:, None]
        turned = np.einsum("nij,njk,nk->ni", rotations(state.turn), it.bodies.inertia, state.spin)
        return mass * state.velocity, np.asarray(mass * np.cross(state.place, state.velocity) + turned)


def rigid_bodies(mechanism: Mechanism) -> RigidBodies:
    """Prepare the rigid bodies of a scene.

    Raises
    ------
    InputError
        For what a mechanism refuses.
    """
    joined = welded(mechanism)
    return RigidBodies(mechanism=mechanism, joined=joined, it=arrays(joined.mechanism))
