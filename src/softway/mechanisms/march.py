"""March of a mechanism: slabs (time steps) in compiled loops."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.kernels.multibody.energy import kinetic_energy, potential_energy
from softway.kernels.multibody.slab import begin
from softway.kernels.multibody.tables import Space, space
from softway.kernels.multibody.velocities import project_velocities
from softway.mechanisms.arrays import Arrays, MechanismState, arrays, captured, changing, restore
from softway.mechanisms.contacts.impacts import StopMarch
from softway.mechanisms.contacts.stop_start import stop_march
from softway.mechanisms.driven import require_free_motions
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.stops import StopEvent
from softway.mechanisms.newton import march_on
from softway.mechanisms.welds import Welded, welded
from softway.units import Second

MOST = 1e15
"""Number of slabs that no march takes."""


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
        Function that returns the state from which :func:`march` continues with the same bits; to be called before the
        next step is computed.
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


def march(
    mechanism: Mechanism, *, until: Second, step: Second, every: int = 1, state: MechanismState | None = None
) -> Iterator[MechanismStep]:
    """March a mechanism; yields the state at the start, and after every ``every`` slabs and at the end.

    Positions and velocities satisfy the joints at the end of every slab.  The energy of conservative mechanisms,
    momentum and angular momentum are kept.  Velocities at the start that the joints do not allow are replaced by the
    nearest ones in the norm of the mass.

    Parameters
    ----------
    mechanism
        Bodies, joints and springs.
    until
        End [s].
    step
        Length of a slab [s], shortened to divide the duration evenly.
    every
        Slabs between two steps that are yielded.
    state
        State of an earlier march of the mechanism with the same ``until`` and ``step``, ``march_state()`` of one of its
        steps: the march continues from there, and yields only later states.

    Raises
    ------
    InputError
        Before the first step: for wrong input, or the state of another march.
    NumericsError
        If a slab has no solution at any length.

    Examples
    --------
    >>> from softway.mechanisms import Mechanism, Rigid, Rod
    >>> mass = Rigid(mass=1.0, centre=(1.0, 0.0))
    >>> rod = Rod(between=("ground", "mass"), ends=((0.0, 0.0), (1.0, 0.0)))
    >>> pendulum = Mechanism(bodies={"mass": mass}, joints={"rod": rod}, gravity=(0.0, -9.81))
    >>> last = list(march(pendulum, until=1.0, step=0.01))[-1]
    >>> abs(last.energy_error) < 1e-12, abs(float(np.hypot(*last.bodies["mass"].centre)) - 1.0) < 1e-13
    (True, True)
    """
    mechanism.require_cold()
    if not (np.isfinite(until) and until > 0.0):
        raise InputError("until", f"{until:g} s is not positive", "a time after the start")
    if not (np.isfinite(step) and 0.0 < step <= until):
        raise InputError("step", f"{step:g} s is not positive, or longer than the march", f"at most {until:g} s")
    if every < 1:
        raise InputError("every", f"{every}", "1 or more")
    if not until / step < MOST:
        raise InputError("step", f"{until / step:.3g} slabs of {step:.3g} s", "an earlier end, or longer slabs")
    joined, slabs = welded(mechanism), int(np.ceil(until / step * (1.0 - 1e-12)))
    it = arrays(joined.mechanism)
    room, stops = space(it.joints, len(it.names), len(it.bodies.jointed)), None
    if joined.mechanism.stops:
        stops = stop_march(it, room, joined.mechanism)
    tables = changing(it, room, {} if stops is None else stops.changing)
    if state is not None:
        restore(tables, state, until / slabs)
    capture = partial(_march_state, it, tables, until / slabs)
    told_of = partial(_step, mechanism, joined, it, room, stops, capture)
    return _steps(it, room, stops, until, slabs, every, state, told_of)


def _steps(
    it: Arrays,
    room: Space,
    stops: StopMarch | None,
    until: float,
    slabs: int,
    every: int,
    state: MechanismState | None,
    told_of: Callable[..., MechanismStep],
) -> Iterator[MechanismStep]:
    """States of the march."""
    told, h, done, iterations = np.zeros(3), until / slabs, 0, 0
    if state is None:
        initial = _begun(it, room)
        yield told_of(0, 0.0, initial, told, 0, [] if stops is None else stops.start(h, it.reach(h)))
    else:
        initial, done = state.energy, state.slabs
    while done < slabs:
        told[:], events = 0.0, list[StopEvent]()
        iterations, goal = 0, min(slabs, done + every)
        while done < goal:
            extent = it.reach(h)
            if stops is not None:
                more, used = stops.slab(done * h, h, extent, told)
                events += more
                done, iterations = done + 1, iterations + used
                continue
            iterations += march_on(it, room, done * h, h, goal - done, told)
            done = goal
        yield told_of(done, until if done == slabs else done * h, initial, told, iterations, events)


def _begun(it: Arrays, room: Space) -> float:
    """Bring the velocities at the start to what the joints allow; the energy [J]."""
    begin(it.bodies, it.joints, it.springs, it.motion, room)
    require_free_motions(it, room)
    project_velocities(it.bodies, it.joints, it.motion, room)
    begin(it.bodies, it.joints, it.springs, it.motion, room)
    return float(it.motion.energy.sum())


def _step(
    mechanism: Mechanism,
    joined: Welded,
    it: Arrays,
    room: Space,
    stops: StopMarch | None,
    capture: Callable[..., MechanismState],
    slabs: int,
    time: float,
    initial: float,
    told: Array,
    iterations: int,
    events: Sequence[StopEvent],
) -> MechanismStep:
    """State as it is yielded."""
    motion, total = it.motion, _energies(it, room)
    mass = it.bodies.mass[:, None]
    turned = np.einsum("nij,njk,nk->ni", room.R0, it.bodies.inertia, motion.spin)
    return MechanismStep(
        time=time,
        bodies={name: body_state(mechanism, joined, it, room, name) for name in mechanism.bodies},
        energy_kinetic=total[0],
        energy_potential=total[1],
        work=float(motion.work[0]),
        dissipation=float(motion.work[1]),
        energy_error=total[0] + total[1] - initial - float(motion.work[0]) + float(motion.work[1]),
        momentum=np.asarray((mass * motion.velocity).sum(axis=0)),
        spin=np.asarray((mass * np.cross(motion.place, motion.velocity) + turned).sum(axis=0)),
        joints=float(told[0]),
        joint_velocity=float(told[1]),
        iterations=iterations,
        scalar=float(told[2]),
        independent=int((room.pivot > 0.0).sum()),
        events=tuple(events),
        closed=() if stops is None else stops.closed,
        motors={
            it.joint_of[k]: force for k, force in zip(it.joints.drives.row, room.drive[:, 2].tolist(), strict=True)
        },
        march_state=partial(capture, float(motion.time[0]), slabs, time, initial),
    )


def _energies(it: Arrays, room: Space) -> tuple[float, float]:
    """Kinetic and potential energy [J]."""
    kinetic, potential = (np.zeros(len(it.bodies.jointed)) for _ in range(2))
    kinetic_energy(it.bodies, it.motion, kinetic)
    potential_energy(it.bodies, it.springs, it.joints.angles, it.motion, room.R0, potential)
    return float(kinetic.sum()), float(potential.sum())


def _march_state(
    it: Arrays,
    tables: Mapping[str, Array | IntArray | BoolArray],
    span: float,
    now: float,
    slabs: int,
    time: float,
    energy: float,
) -> MechanismState:
    """State of the march, if it has not gone on."""
    if it.motion.time[0] != now:
        raise InputError("march_state", f"the march has gone on since {time:g} s", "ask before the next step")
    return captured(tables, slabs, time, span, energy)


def body_state(mechanism: Mechanism, joined: Welded, it: Arrays, room: Space, name: str) -> BodyState:
    """State of a body, which may be welded to others or to the ground."""
    dim, motion, whole = mechanism.dim, it.motion, joined.part_of[name]
    k = it.names.index(whole) if whole in it.names else len(it.names)
    spin, arm = room.R0[k] @ motion.spin[k], np.zeros(3)
    arm[:dim] = mechanism.bodies[name].centre
    if k < len(it.names):
        arm[:dim] -= joined.mechanism.bodies[whole].centre
    arm = room.R0[k] @ arm
    return BodyState(
        centre=(motion.place[k] + arm)[:dim],
        rotation=room.R0[k, :dim, :dim].copy(),
        velocity=(motion.velocity[k] + np.cross(spin, arm))[:dim],
        spin=spin[2:] if dim == 2 else spin,
    )
