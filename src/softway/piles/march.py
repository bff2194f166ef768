"""March of a pile: slabs (time steps) in compiled loops."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import rotations
from softway.errors import InputError, NumericsError
from softway.kernels.pile import tables
from softway.kernels.pile.slab import pile_slab
from softway.piles.arrays import ball_tables, laws, motion, require_apart, wall_tables
from softway.piles.pile import Pile
from softway.piles.state import PileState
from softway.piles.turns import turned
from softway.units import Second

FARTHEST = 0.5
"""Part of the smallest radius that a ball moves in a slab at most; longer slabs are divided."""
HALVINGS = 12
"""Halvings of a slab whose gaps cannot be closed."""
PARTS = 1e6
"""Number of parts of a slab that no march takes."""
MOST = 1e15
"""Number of slabs that no march takes."""
SWEEPS = 30
"""Sweeps for the friction, for places and for velocities each, by default."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PileStep:
    """State of a pile after some slabs, with its balances.

    Parameters
    ----------
    time
        [s].
    centres, velocities
        (n, d) [m], [m/s].
    turns
        (n, 4) rotations from the start as unit quaternions, scalar first.
    spins
        Angular velocities [rad/s], (n, 1) of discs and (n, 3) of balls.
    energy_kinetic, energy_potential
        [J].
    dissipation
        Energy dissipated by impacts and friction since the start [J].
    energy_error
        Energy minus that at the start, plus dissipation, which is the work of the contacts [J].
    momentum, spin
        (3,) total momentum [kg m/s], and angular momentum about the origin [kg m^2/s].
    overlap
        Greatest overlap at the end of a slab since the last step [m].
    slip_error
        Greatest velocity by which a contact misses the law of friction since the last step [m/s].
    unfinished
        Number of slabs since the last step whose sweeps ended before the friction met its law to the tolerance.
    touches
        Number of contacts that closed since the last step.
    closed
        Number of closed contacts.
    slabs, sweeps
        Numbers since the last step.
    state
        State from which :func:`march` continues with the same bits.
    """

    time: float
    centres: Array
    turns: Array
    velocities: Array
    spins: Array
    energy_kinetic: float
    energy_potential: float
    dissipation: float
    energy_error: float
    momentum: Array
    spin: Array
    overlap: float
    slip_error: float
    unfinished: int
    touches: int
    closed: int
    slabs: int
    sweeps: int
    state: PileState

    def march_state(self) -> PileState:
        """State from which :func:`march` continues with the same bits."""
        return self.state

    @property
    def rotations(self) -> Array:
        """Rotations (n, d, d) from the start."""
        dim = self.centres.shape[1]
        return rotations(self.turns)[:, :dim, :dim]


def march(
    pile: Pile,
    *,
    until: Second,
    step: Second,
    every: int = 1,
    sweeps: int = SWEEPS,
    state: PileState | None = None,
) -> Iterator[PileStep]:
    """March a pile; yields the state at the start, and after every ``every`` slabs and at the end.

    No balls overlap at the end of a slab by more than 1e-10 of the smallest radius.  Contacts obey Coulomb's law to a
    velocity of 2e-10 of the smallest radius per slab, unless the sweeps end before: ``slip_error`` and ``unfinished``
    tell.

    Parameters
    ----------
    pile
        Balls and walls.
    until
        End [s].
    step
        Length of a slab [s], shortened to divide the duration evenly.  A slab in which a ball would move by more than
        half the smallest radius is divided.
    every
        Slabs between two steps that are yielded.
    sweeps
        Greatest number of sweeps for the friction, for places and for velocities each.
    state
        State of a step of an earlier march with the same input: the march continues from there, and yields only later
        steps.

    Raises
    ------
    InputError
        Before the first step: for wrong input, balls that overlap, or the state of another march.
    NumericsError
        If the gaps of a slab cannot be closed at any length.

    Examples
    --------
    >>> from softway.piles import Balls, Pile, Wall, march
    >>> ball = Balls(centres=[[0.0, 0.5, 0.0]], radius=0.1, density=1000.0)
    >>> floor = Wall(point=(0.0, 0.0, 0.0), normal=(0.0, 1.0, 0.0))
    >>> pile = Pile(balls=ball, walls=(floor,), gravity=(0.0, -9.81, 0.0))
    >>> start, last = march(pile, until=1.0, step=0.01, every=100)
    >>> last.centres.round(9).tolist(), last.touches, last.closed, last.unfinished
    ([[0.0, 0.1, 0.0]], 1, 1, 0)
    """
    if not (np.isfinite(until) and until > 0.0):
        raise InputError("until", f"{until:g} s is not positive", "a time after the start")
    if not (np.isfinite(step) and 0.0 < step <= until):
        raise InputError("step", f"{step:g} s is not positive, or longer than the march", f"at most {until:g} s")
    for name, number in (("every", every), ("sweeps", sweeps)):
        if number < 1:
            raise InputError(name, f"{number}", "1 or more")
    if not until / step < MOST:
        raise InputError("step", f"{until / step:.3g} slabs of {step:.3g} s", "an earlier end, or longer slabs")
    given = ball_tables(pile), wall_tables(pile), laws(pile, sweeps)
    slabs = int(np.ceil(until / step * (1.0 - 1e-12)))
    if state is None:
        begin = _start(given, *motion(pile), until / slabs)
        require_apart(*given[:2], begin.place)
    else:
        begin = state.writable(pile.balls.count, len(pile.walls), slabs)
    return _steps(pile, given, begin, until, slabs, every, state is None)


Tables = tuple[tables.Balls, tables.Walls, tables.Laws]


def _start(given: Tables, place: Array, velocity: Array, length: float) -> PileState:
    """State at the start."""
    state = PileState(
        time=0.0,
        slabs=0,
        place=place,
        velocity=velocity,
        turn=np.tile([1.0, 0.0, 0.0, 0.0], (len(place), 1)),
        pairs=np.zeros((0, 2), np.int64),
        impulse=np.zeros((0, 4)),
        closed=np.zeros(0, np.int64),
        length=length,
        told=np.zeros(tables.TOLD),
        initial=0.0,
    )
    return replace(state, initial=sum(_energies(given, state)))


def _steps(
    pile: Pile, given: Tables, state: PileState, until: float, slabs: int, every: int, first: bool
) -> Iterator[PileStep]:
    """Steps of the march from a state on, which is yielded if it is the ``first``."""
    h = until / slabs
    if first:
        yield _step(pile, given, state)
    for done in range(state.slabs + 1, slabs + 1):
        state = _slab(given, state, (done - 1) * h, h)
        state = replace(state, time=until if done == slabs else done * h, slabs=done)
        if done % every == 0 or done == slabs:
            yield _step(pile, given, state)
            state = state.fresh


def _slab(given: Tables, state: PileState, time: float, h: float, halvings: int = 0) -> PileState:
    """Take a slab, or its parts, in which no ball moves too far."""
    balls, _, law = given
    fastest = float(np.linalg.norm(state.velocity[:, :3], axis=1).max()) + h * float(np.linalg.norm(law.gravity))
    parts = h * fastest / (FARTHEST * float(balls.radius[:-1].min()))
    if not parts < PARTS:
        raise NumericsError(f"a ball moves at {fastest:.3g} m/s", time, "slower balls, or a shorter step")
    if parts > 1.0:
        number = int(np.ceil(parts))
        for k in range(number):
            state = _slab(given, state, time + k * h / number, h / number, halvings)
        return state
    taken = _taken(given, state, h)
    if taken is not None:
        return taken
    if halvings == HALVINGS:
        raise NumericsError(f"the gaps of a slab of {h:.3g} s cannot be closed", time, "a shorter step")
    for k in range(2):
        state = _slab(given, state, time + 0.5 * k * h, 0.5 * h, halvings + 1)
    return state


def _taken(given: Tables, state: PileState, h: float) -> PileState | None:
    """State after a slab; None if its gaps cannot be closed."""
    told, memory = state.told.copy(), state.memory
    told[tables.SLIP] = 0.0
    if h != state.length:
        memory = memory._replace(impulse=memory.impulse * (h / state.length))
    place, velocity, memory, closed = pile_slab(h, *given, state.place, state.velocity, memory, told)
    if not closed:
        return None
    told[tables.UNFINISHED] += told[tables.SLIP] > 2.0 * given[2].tolerance / h
    told[tables.SLIP] = max(told[tables.SLIP], state.told[tables.SLIP])
    told[tables.SLABS] += 1
    turn = turned(state.turn, 0.5 * h * (state.velocity[:-1, 3:] + velocity[:-1, 3:]))
    pairs, impulse, shut = memory
    return replace(
        state,
        place=place,
        velocity=velocity,
        turn=turn,
        pairs=pairs,
        impulse=impulse,
        closed=shut,
        length=h,
        told=told,
    )


def _energies(given: Tables, state: PileState) -> tuple[float, float]:
    """Kinetic and potential energy [J]."""
    balls, _, law = given
    square = np.square(state.velocity)
    kinetic = 0.5 * float(balls.mass @ square[:, :3].sum(axis=1) + balls.inertia @ square[:, 3:].sum(axis=1))
    return kinetic, -float(balls.mass[:-1] @ (state.place @ law.gravity))


def _step(pile: Pile, given: Tables, state: PileState) -> PileStep:
    """State as it is yielded."""
    dim, told, (kinetic, potential) = pile.balls.dim, state.told, _energies(given, state)
    momentum = given[0].mass[:-1, None] * state.velocity[:-1, :3]
    turning = given[0].inertia[:-1, None] * state.velocity[:-1, 3:]
    return PileStep(
        time=state.time,
        centres=state.place[:, :dim].copy(),
        turns=state.turn,
        velocities=state.velocity[:-1, :dim].copy(),
        spins=state.velocity[:-1, 5:].copy() if dim == 2 else state.velocity[:-1, 3:].copy(),
        energy_kinetic=kinetic,
        energy_potential=potential,
        dissipation=float(told[tables.DISSIPATION]),
        energy_error=kinetic + potential - state.initial + float(told[tables.DISSIPATION]),
        momentum=momentum.sum(axis=0),
        spin=(np.cross(state.place, momentum) + turning).sum(axis=0),
        overlap=float(told[tables.OVERLAP]),
        slip_error=float(told[tables.SLIP]),
        unfinished=int(told[tables.UNFINISHED]),
        touches=int(told[tables.TOUCHES]),
        closed=int(told[tables.CLOSED]),
        slabs=int(told[tables.SLABS]),
        sweeps=int(told[tables.SWEEPS]),
        state=state.fresh,
    )
