"""Several slabs (time steps) in one compiled call."""

import numpy as np

from softway.arrays import Array
from softway.kernels.jit.by_address import packed
from softway.kernels.slab.apart import apart
from softway.kernels.slab.march import slabs
from softway.kernels.slab.tables import ITERATIONS, MET, SUMS, Bodies, Course, Rows, Work
from softway.kernels.slab.works import WORKS
from softway.marching.slab.compiled_model import CompiledModel
from softway.marching.slab.slab_batch import SlabBatch, contractions
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.scene import State
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
    if not (steady and known and max(memory.taken.last, default=0) <= USUAL * WORN):
        return None
    tables = compiled.tables(now)
    left = (march_state.settings.until - now.time) / compiled.span - AHEAD
    wanted = int(min(left, TOGETHER, max(1, NUMBERS // (8 * now.start.displacement.size))))
    if tables is None or wanted < 1:
        return None
    course = new_course(model, now, wanted, compiled.span)
    account = march_state.account
    start = account.energy_start - account.dissipation - account.remeshing
    told = np.array([start, account.work_external, account.energy_error])
    work, surfaces = new_work(tables.bodies, tables.rows), tables.surfaces
    given = (tables.bodies, tables.rows, tables.operator, course, work, *(() if surfaces is None else (surfaces,)))
    arrays = [packed(each) for each in given]
    places = np.array([each.ctypes.data for each in arrays])
    parts = np.array([0 if surfaces is None else apart().address])
    count = slabs(places, parts, compiled.tolerance, told, wanted)
    if not count:
        return None
    iterations = tuple(int(i) for i in course.sums[:count, ITERATIONS].tolist())
    return SlabBatch(
        model=model,
        begun=march_state,
        memory=memory,
        course=course,
        iterations=iterations,
        contractions=contractions(course.sums[:count], iterations),
        rows=tables.contact_rows,
        scalars={part.name: 0.0 for part in model.parts},
        states={0: before},
    )


def new_course(model: Model, now: ModelState, wanted: int, span: float) -> Course:
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


def new_work(bodies: Bodies, rows: Rows) -> Work:
    """Work space of a call."""
    size, groups = len(bodies.heavy), int(bodies.group.max()) + 1
    fields = np.zeros((5, size))
    return Work(
        q=fields[0],
        x=fields[1],
        before=fields[2],
        after=fields[3],
        push=fields[4],
        row=np.zeros(len(rows.offset)),
        group=np.zeros((groups, 3)),
        works=np.zeros((len(bodies.floor), WORKS)),
    )
