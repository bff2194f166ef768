"""Successive compiled slabs (time steps), and their states, which are made when they are asked for."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from softway.arrays import Array
from softway.contact.contact_rows import ContactRows
from softway.kernels.slab.tables import ERROR, FIRST, ITERATIONS, LAST, LOST, WORK, Course
from softway.marching.slab.rows.driven import rows_at
from softway.marching.slab.rows.friction import slip_velocity
from softway.marching.state.march_state import EnergyAccount, MarchState
from softway.marching.state.model_state import ModelState, split_states
from softway.mechanisms.step import BodyState
from softway.model.model import Model
from softway.model.scene import State
from softway.solve.equations.slab_values import SlabStart
from softway.solve.methods.iteration import contraction
from softway.solve.operators.operator_memory import OperatorMemory

TOGETHER = 256
"""Greatest number of slabs in a batch."""
NUMBERS = 1_000_000
"""Greatest number of numbers of the states in a call."""
AHEAD = 2.0
"""Slabs at the end of a march that are in no batch: the last one ends at a given instant."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabBatch:
    """Successive compiled slabs.

    Parameters
    ----------
    model
        The model.
    begun
        State of the march before the first of them, ``memory`` with its operator.
    course, iterations
        States and sums of the slabs, and number of iterations of each.
    contractions
        Mean ratio of successive changes in each slab.
    rows
        Contact rows, the same in all slabs.
    states
        States that were asked for, by the number of slabs before them.
    lengths
        Length of the slab after each of them [s]; by default that of the march.
    shapes
        Least shape of the cells after each of them (slabs,); None where it is not known.
    worn
        True if the last of them has worn the operator.
    """

    model: Model
    begun: MarchState
    memory: OperatorMemory
    course: Course
    iterations: tuple[int, ...]
    contractions: tuple[float, ...]
    rows: ContactRows
    states: dict[int, State]
    lengths: tuple[float, ...] = ()
    shapes: Array | None = None
    worn: bool = False

    @classmethod
    def of(
        cls,
        model: Model,
        course: Course,
        rows: ContactRows,
        count: int,
        begun: tuple[MarchState, State, OperatorMemory],
        *,
        lengths: tuple[float, ...] = (),
        shapes: Array | None = None,
        worn: bool = False,
    ) -> "SlabBatch":
        """The first ``count`` slabs of a course on contact rows, from a march state on, with the state of the bodies
        and the memory before them.
        """
        sums, (march_state, before, memory) = course.sums[:count], begun
        iterations = tuple(int(i) for i in sums[:, ITERATIONS].tolist())
        return cls(
            model=model,
            begun=march_state,
            memory=memory,
            course=course,
            iterations=iterations,
            contractions=_contractions(sums, iterations),
            rows=rows,
            states={0: before},
            lengths=lengths,
            shapes=shapes,
            worn=worn,
        )

    @property
    def pairs(self) -> int:
        """Pairs of the contact search of each slab."""
        return int(np.count_nonzero(self.rows.near))

    def state(self, count: int) -> State:
        """State after so many slabs; made when it is asked for, and then kept."""
        if count not in self.states:
            self.states[count] = split_states(self.model, self._state(count))
        return self.states[count]

    def memory_after(self, count: int) -> OperatorMemory:
        """Operator memory after so many slabs."""
        taken = self.memory.taken.with_slabs(self.iterations[:count])
        return replace(self.memory, taken=taken, stale=self.worn and count == len(self.iterations))

    def march_state(self, count: int) -> MarchState:
        """State of the march after so many slabs."""
        if not count:
            return self.begun
        begun, sums = self.begun, self.course.sums[count - 1]
        length = self.lengths[count - 1] if self.lengths else begun.step_history.span
        history = replace(begun.step_history, length=length, recent_rejections=0.0, smooth=0)
        return replace(
            begun,
            state=self._state(count),
            account=self._account(sums),
            step_history=history,
            memory=self.memory_after(count).bare(),
            slabs=begun.slabs + count,
        )

    def _account(self, sums: Array) -> EnergyAccount:
        """Energy account after a slab with these sums."""
        return replace(
            self.begun.account,
            work_external=float(sums[WORK]),
            energy_error=float(sums[ERROR]),
            dissipation=float(sums[LOST]),
        )

    def _state(self, count: int) -> ModelState:
        """State of the model after so many slabs."""
        course, shape, first = self.course, self.model.shape, self.begun.state
        before, time = (float(course.time[k]) for k in (count - 1, count))
        m, rows, u0 = len(first.pressure), self.rows, course.u[count - 1]
        pressure, shear = course.pressure[count][:m], course.pressure[count][m:]
        moved = (course.u[count] - u0).reshape(shape)
        start = SlabStart(
            displacement=course.u[count].reshape(shape),
            velocity=course.v[count].reshape(shape),
            force=course.force[count].reshape(shape),
            energy=course.energy[count],
            states=(),
            viscous=None,
        )
        return ModelState(
            time=time,
            start=start,
            acceleration=course.slope[count].reshape(shape),
            closed=pressure > 0.0,
            pressure=pressure,
            traction=rows.shear.vectors(rows.shear.components(shear)) if len(shear) else np.zeros_like(first.traction),
            sliding=first.sliding if len(shear) else np.zeros_like(first.sliding),
            slip=slip_velocity(self.model, rows, moved, (before, time)),
            rows=rows_at(self.model, self.rows, time) if self.model.contacts.paired else None,
            span=time - before,
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BatchMotion:
    """Motion after a slab of a batch, see :class:`~softway.marching.results.step_states.Motion`."""

    displacement: Mapping[str, Array]
    velocity: Mapping[str, Array]
    fields: Mapping[str, Mapping[str, Array]] = field(default_factory=dict)
    rigid: Mapping[str, BodyState] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BatchStates:
    """States of the slab ``number`` of a batch, see :class:`~softway.marching.results.step_states.StepStates`."""

    batch: SlabBatch
    number: int

    @property
    def before(self) -> State:
        """State at the start."""
        return self.batch.state(self.number)

    @property
    def after(self) -> State:
        """State at the end."""
        return self.batch.state(self.number + 1)

    @property
    def march_state(self) -> MarchState:
        """State of the march after the slab."""
        return self.batch.march_state(self.number + 1)

    @property
    def motion(self) -> BatchMotion:
        """Motion at the end."""
        model, course, k = self.batch.model, self.batch.course, self.number + 1
        u, v = (field[k].reshape(model.shape) for field in (course.u, course.v))
        return BatchMotion(displacement=model.split(u), velocity=model.split(v))

    @property
    def reactions(self) -> Mapping[str, Array]:
        """Body -> (n, d) mean force of the supports on the nodes [N]."""
        model, support = self.batch.model, self.batch.course.support
        return model.split(support[self.number].reshape(model.shape) if len(support) else np.zeros(model.shape))


def _contractions(sums: Array, iterations: tuple[int, ...]) -> tuple[float, ...]:
    """Mean ratios of successive changes, from the sums of slabs and their numbers of iterations."""
    changes = sums[:, (FIRST, LAST)].tolist()
    return tuple(contraction(first, last, n) for (first, last), n in zip(changes, iterations, strict=True))


def told(account: EnergyAccount) -> Array:
    """Energy at the start, external work, error and dissipated energy (4,), for the kernels [J]."""
    start = account.energy_start - account.remeshing
    return np.array([start, account.work_external, account.energy_error, account.dissipation])


def most_slabs(march_state: MarchState, span: float) -> int:
    """Greatest number of slabs of the length ``span`` [s] in a call; less than one at the end of a march."""
    now = march_state.state
    left = (march_state.settings.until - now.time) / span - AHEAD
    return int(min(left, TOGETHER, max(1, NUMBERS // (8 * now.start.displacement.size))))
