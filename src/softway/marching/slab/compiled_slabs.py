"""Several slabs (time steps) in one compiled call, and the steps that they make."""

from collections.abc import Iterator, Mapping

import numpy as np

from softway.arrays import Array
from softway.errors import heed
from softway.kernels.slab.march import slabs
from softway.kernels.slab.tables import (
    CLOSED_POWER,
    COMPLEMENTARITY,
    COUNT,
    ERROR,
    FIRST,
    FORCE,
    GAP,
    ITERATIONS,
    KINETIC,
    LAST,
    MET,
    MOMENTUM,
    POWER,
    SPIN,
    STRAIN,
    SUMS,
    UNCLOSED,
    WORK,
    Course,
    Work,
)
from softway.kernels.slab.works import WORKS
from softway.marching.results.step import Certificate, ContactLedger, Ledger, Report, Step
from softway.marching.results.trying import watched
from softway.marching.slab.compiled_model import CompiledModel
from softway.marching.slab.slab_batch import BatchStates, SlabBatch
from softway.marching.slab.slab_step import Stepper
from softway.marching.state.march_state import EnergyAccount, MarchState
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.scene import State
from softway.model.slab import Slab
from softway.solve.methods.iteration import contraction
from softway.solve.operators.operator_memory import USUAL, WORN, OperatorMemory

TOGETHER, NUMBERS = 256, 200_000
"""Greatest number of slabs in a call, and of numbers of their states."""
AHEAD = 2.0
"""Slabs at the end of a march that are not compiled: the last one ends at a given instant."""


def next_batch(
    compiled: CompiledModel, march_state: MarchState, before: State, memory: OperatorMemory
) -> SlabBatch | None:
    """Slabs from a march state on, up to one in which something happens; None if that is the next one.

    The state alone decides which slabs are compiled, so that a resumed march has the same bits.
    """
    now, history, model = march_state.state, march_state.step_history, compiled.model
    steady = history.length == history.span == compiled.span and not (history.halted or history.energy_along_motion)
    known = memory.origin is not None and not memory.stale and memory.serves(compiled.span)
    if not (steady and known and max(memory.taken.last, default=0) <= USUAL * WORN) or now.rows is not None:
        return None
    operator = compiled.operator(now.pressure > 0.0)
    left = (march_state.settings.until - now.time) / compiled.span - AHEAD
    wanted = int(min(left, TOGETHER, max(1, NUMBERS // (8 * now.start.displacement.size))))
    if operator is None or wanted < 1:
        return None
    course = _course(model, now, wanted, compiled.span)
    account = march_state.account
    start = account.energy_start - account.dissipation - account.remeshing
    told = np.array([start, account.work_external, account.energy_error])
    work = _work(compiled)
    count = slabs(compiled.bodies, compiled.rows, operator, course, work, compiled.tolerance, told, wanted)
    if not count:
        return None
    iterations = tuple(int(i) for i in course.sums[:count, ITERATIONS].tolist())
    return SlabBatch(
        model=model, begun=march_state, memory=memory, course=course, iterations=iterations, states={0: before}
    )


def _course(model: Model, now: ModelState, wanted: int, span: float) -> Course:
    """Room for states of so many slabs, the first one given."""
    size, m = now.start.displacement.size, len(now.pressure)

    def room(first: Array, length: int) -> Array:
        out = np.empty((wanted + 1, length))
        out[0] = first.ravel()
        return out

    time = np.empty(wanted + 1)
    time[0] = now.time
    for s in range(wanted):
        time[s + 1] = time[s] + span
    supported = not model.space.every(model.dofs.unsupported)
    return Course(
        time=time,
        u=room(now.start.displacement, size),
        v=room(now.start.velocity, size),
        slope=room(now.acceleration, size),
        force=room(now.start.force, size),
        pressure=room(now.pressure, m),
        energy=room(now.start.energy, len(now.start.energy)),
        support=np.empty((wanted if supported else 0, size)),
        sums=np.empty((wanted, SUMS)),
        met=np.empty((wanted, len(model.contacts.labels), MET)),
    )


def _work(compiled: CompiledModel) -> Work:
    """Work space of a call."""
    size, groups = len(compiled.bodies.heavy), int(compiled.bodies.group.max()) + 1
    fields = np.zeros((5, size))
    return Work(
        q=fields[0],
        x=fields[1],
        before=fields[2],
        after=fields[3],
        push=fields[4],
        row=np.zeros(len(compiled.rows.offset)),
        group=np.zeros((groups, 3)),
        works=np.zeros((len(compiled.bodies.floor), WORKS)),
    )


def steps(stepper: Stepper, found: SlabBatch) -> Iterator[Step]:
    """Steps of a batch; each asks as often if the march is cancelled as if it were solved alone."""
    course, model, begun, memory = found.course, found.model, found.begun, found.memory
    pairs, scalars = model.contacts.rest(model.displacement, 0.0).found, {p.name: 0.0 for p in model.parts}
    labels, count, error = model.contacts.labels, len(found.iterations), begun.account.energy_error
    time, sums, met = course.time.tolist(), course.sums[:count].tolist(), course.met[:count].tolist()
    _told(stepper, found)
    for k, (row, iterations) in enumerate(zip(sums, found.iterations, strict=True)):
        slab = Slab(start=time[k], end=time[k + 1], weight=begun.settings.weight)
        for _ in range(0 if stepper.cancel is None else 1 + iterations):
            heed(stepper.cancel, slab.start)
        contacts = {label: _contact(c) for label, c in zip(labels, met[k], strict=True)}
        report = Report(
            iterations=iterations,
            pairs=pairs,
            factorisations=memory.factorisations,
            renewals=memory.renewals,
            passes=1,
            contraction=contraction(row[FIRST], row[LAST], iterations),
            scalars=scalars,
        )
        yield Step(
            model=model,
            slab=slab,
            ledger=_ledger(begun.account, row, course.sums[k], contacts),
            certificate=_certificate(row, error, contacts),
            events=(),
            report=report,
            states=BatchStates(batch=found, number=k),
        )
        error = row[ERROR]


def _contact(met: list[float]) -> ContactLedger:
    """Audit of a contact from its sums."""
    return ContactLedger(
        force_n=met[FORCE], force_t=0.0, min_gap=met[GAP], power_residual=met[CLOSED_POWER], count=int(met[COUNT])
    )


def _ledger(account: EnergyAccount, row: list[float], sums: Array, contacts: Mapping[str, ContactLedger]) -> Ledger:
    """Ledger after a slab from its sums, as numbers and as an array."""
    return Ledger(
        energy_kinetic=row[KINETIC],
        energy_strain=row[STRAIN],
        work_external=row[WORK],
        dissipation=account.dissipation,
        energy_error=row[ERROR],
        momentum=sums[MOMENTUM : MOMENTUM + 3],
        spin=sums[SPIN : SPIN + 3],
        contacts=contacts,
        remeshing=account.remeshing,
    )


def _certificate(row: list[float], error: float, contacts: Mapping[str, ContactLedger]) -> Certificate:
    """Certificate of a slab from its sums; ``error`` is that of the energy balance before it [J]."""
    return Certificate(
        min_gap=min((c.min_gap for c in contacts.values()), default=np.inf),
        min_force=0.0,
        complementarity=row[COMPLEMENTARITY],
        power_residual=row[POWER],
        momentum_error=row[UNCLOSED],
        energy_error=row[ERROR] - error,
    )


def _told(stepper: Stepper, found: SlabBatch) -> None:
    """Tell that slabs begin: one call computes all of them."""
    slab = found.begun.slabs + 1
    watched(stepper.trying, slab, found.begun.state.time, float(found.course.time[1] - found.course.time[0]))
