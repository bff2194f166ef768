"""States of a mechanism after some slabs (time steps), one by one and in groups that were compiled together."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.rigid_course.course import (
    DISSIPATION,
    INDEPENDENT,
    ITERATIONS,
    KINETIC,
    MOMENTUM,
    POTENTIAL,
    SPIN,
    WORK,
    Course,
)
from softway.mechanisms.arrays import MechanismState
from softway.mechanisms.members.stops import StopEvent


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyState:
    """State of a rigid body.

    Parameters
    ----------
    centre
        (d,) place of the centre [m].
    rotation
        (d, d) rotation from the start.
    velocity
        (d,) velocity of the centre [m/s].
    spin
        Angular velocity [rad/s], (1,) in the plane and (3,) in space.
    """

    centre: Array
    rotation: Array
    velocity: Array
    spin: Array

    def point(self, start: Array, centre: Array) -> Array:
        """Place (d,) of the point that was at ``start`` when the centre was at ``centre``."""
        return np.asarray(self.centre + self.rotation @ (np.asarray(start) - np.asarray(centre)))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MechanismStep:
    """State of a mechanism after some slabs, with its balances.

    Parameters
    ----------
    time
        [s].
    bodies
        State of each body.
    energy_kinetic, energy_potential
        [J].
    work, dissipation
        Work of forces, torques and motors, and energy dissipated by dampers, impacts and friction since the start [J].
    energy_error
        Energy minus that at the start, minus work, plus dissipation [J].
    momentum, spin
        (3,) total momentum [kg m/s], and angular momentum about the origin [kg m^2/s].
    joints, joint_velocity
        Greatest error of the joints since the last step [m], and of their velocities [m/s]; directions count as such.
    iterations
        Iterations since the last step.
    scalar
        Greatest change of the scalar of the energy from 1 since the last step.
    independent
        Number of the rows of joints that do not depend on others.
    events
        Events of the stops since the last step.
    closed
        Names of the closed stops.
    motors
        Torque [N m] or force [N] of each motor, the mean over the last slab.
    march_state
        Function that returns the state from which :func:`~softway.mechanisms.march` continues with the same bits.
    """

    time: float
    bodies: Mapping[str, BodyState]
    energy_kinetic: float
    energy_potential: float
    work: float
    dissipation: float
    energy_error: float
    momentum: Array
    spin: Array
    joints: float
    joint_velocity: float
    iterations: int
    scalar: float
    independent: int
    events: tuple[StopEvent, ...] = ()
    closed: tuple[str, ...] = ()
    motors: Mapping[str, float] = field(default_factory=dict)
    march_state: Callable[[], MechanismState]

    @property
    def closed_stops(self) -> int:
        """Number of the closed stops."""
        return len(self.closed)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MechanismGroup:
    """States of a mechanism, of which each is some slabs after that before.

    Parameters
    ----------
    course
        Table of the k states.
    time
        (k,) [s].
    slabs
        (k,) numbers of slabs marched so far.
    initial
        Energy at the start of the march [J].
    dim
        Number of dimensions.
    names, stops, motors
        Names of the bodies, the stops, and the joints of the motors.
    events
        Events of the stops since the state before, for each state.
    reached
        Function that returns the state of the march after the k-th of them.
    """

    course: Course
    time: Array
    slabs: IntArray
    initial: float
    dim: int
    names: tuple[str, ...]
    stops: tuple[str, ...]
    motors: tuple[str, ...]
    events: Sequence[Sequence[StopEvent]]
    reached: Callable[[int], MechanismState]

    def __len__(self) -> int:
        return len(self.time)

    @property
    def energy_kinetic(self) -> Array:
        """(k,) [J]."""
        return self.course.sums[:, KINETIC]

    @property
    def energy_potential(self) -> Array:
        """(k,) [J]."""
        return self.course.sums[:, POTENTIAL]

    @property
    def work(self) -> Array:
        """(k,) work since the start [J]."""
        return self.course.sums[:, WORK]

    @property
    def dissipation(self) -> Array:
        """(k,) energy dissipated since the start [J]."""
        return self.course.sums[:, DISSIPATION]

    @property
    def momentum(self) -> Array:
        """(3, k) total momentum [kg m/s]."""
        return self.course.sums[:, MOMENTUM:SPIN].T

    @property
    def spin(self) -> Array:
        """(3, k) angular momentum about the origin [kg m^2/s]."""
        return self.course.sums[:, SPIN:].T

    @property
    def joints(self) -> Array:
        """(k,) greatest errors of the joints [m]."""
        return self.course.told[:, 0]

    @property
    def joint_velocity(self) -> Array:
        """(k,) greatest errors of their velocities [m/s]."""
        return self.course.told[:, 1]

    @property
    def iterations(self) -> IntArray:
        """(k,) iterations since the state before."""
        return self.course.counts[:, ITERATIONS]

    @property
    def closed_stops(self) -> IntArray:
        """(k,) numbers of the closed stops."""
        return np.asarray(self.course.closed.sum(axis=1))

    def steps(self) -> Iterator[MechanismStep]:
        """Each of the states."""
        return map(self.step, range(len(self)))

    @property
    def energy_error(self) -> Array:
        """(k,) energy minus that at the start, minus work, plus dissipation [J]."""
        sums = self.course.sums
        return np.asarray(sums[:, KINETIC] + sums[:, POTENTIAL] - self.initial - sums[:, WORK] + sums[:, DISSIPATION])

    def bodies(self, k: int) -> dict[str, BodyState]:
        """State of each body in the k-th state."""
        return bodies_in(self.course, k, self.names, self.dim)

    def step(self, k: int) -> MechanismStep:
        """The k-th of the states."""
        sums, told, counts = self.course.sums[k], self.course.told[k].tolist(), self.course.counts[k].tolist()
        numbers = sums.tolist()
        return MechanismStep(
            time=float(self.time[k]),
            bodies=self.bodies(k),
            energy_kinetic=numbers[KINETIC],
            energy_potential=numbers[POTENTIAL],
            work=numbers[WORK],
            dissipation=numbers[DISSIPATION],
            energy_error=float(self.energy_error[k]),
            momentum=sums[MOMENTUM:SPIN],
            spin=sums[SPIN:],
            joints=told[0],
            joint_velocity=told[1],
            iterations=counts[ITERATIONS],
            scalar=told[2],
            independent=counts[INDEPENDENT],
            events=tuple(self.events[k]),
            closed=tuple(name for name, shut in zip(self.stops, self.course.closed[k], strict=True) if shut),
            motors=dict(zip(self.motors, self.course.motors[k].tolist(), strict=True)),
            march_state=partial(self.reached, k),
        )


def bodies_in(table: Course, k: int, names: Sequence[str], dim: int) -> dict[str, BodyState]:
    """State of each body in a row of a table, in ``dim`` dimensions."""
    spin = slice(2, 3) if dim == 2 else slice(3)
    return {
        name: BodyState(
            centre=table.centre[k, b, :dim],
            rotation=table.rotation[k, b, :dim, :dim],
            velocity=table.velocity[k, b, :dim],
            spin=table.spin[k, b, spin],
        )
        for b, name in enumerate(names)
    }
