"""Several slabs (time steps) in one compiled call."""

from collections.abc import Callable

import numpy as np

from softway.arrays import Array
from softway.contact.contact_rows import ContactRows
from softway.kernels.jit.by_address import packed
from softway.kernels.slab.apart import apart
from softway.kernels.slab.driven import driven
from softway.kernels.slab.friction import rubbing
from softway.kernels.slab.march import slabs
from softway.kernels.slab.tables import MET, SUMS, Bodies, Course, Rows, Work
from softway.kernels.slab.works import WORKS
from softway.marching.slab.compiled_model import CompiledModel, SlabTables
from softway.marching.slab.rows.driven import drives
from softway.marching.slab.rows.friction import friction_table
from softway.marching.slab.slab_batch import SlabBatch, most_slabs, told
from softway.marching.state.march_state import MarchState
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.scene import State
from softway.solve.operators.operator_memory import USUAL, WORN, OperatorMemory

SAME = 1e-9
"""Relative difference of the lengths of slabs that have the same operator."""


def next_batch(
    compiled: CompiledModel,
    march_state: MarchState,
    before: State,
    memory: OperatorMemory,
    end_after: Callable[[float], float],
) -> SlabBatch | None:
    """Slabs from a march state on, up to one in which something happens; None if that is the next one.

    ``end_after`` gives the end of a slab that begins at a time [s].

    The state alone decides which slabs are compiled, so that a resumed march has the same bits.
    """
    now, history, model = march_state.state, march_state.step_history, compiled.model
    steady = history.length == history.span == compiled.span and not (history.altered or history.energy_along_motion)
    known = memory.origin is not None and not memory.stale
    if not (steady and known and max(memory.taken.last, default=0) <= USUAL * WORN):
        return None
    span = compiled.span if memory.serves(compiled.span) else memory.span
    times = _times(compiled, march_state, span, end_after)
    tables = compiled.tables(now, span) if len(times) > 1 else None
    if tables is None:
        return None
    course = new_course(model, now, tables.contact_rows, times)
    count = _called(model, tables, course, march_state, compiled.tolerance)
    if not count:
        return None
    return SlabBatch.of(model, course, tables.contact_rows, count, (march_state, before, memory))


def _called(model: Model, tables: SlabTables, course: Course, march_state: MarchState, tolerance: float) -> int:
    """Fill a course with slabs, and return how many were computed."""
    work, surfaces = new_work(tables.bodies, tables.rows), tables.surfaces
    changing = drives(model, tables.contact_rows, course.time)
    rubs = friction_table(model, tables.contact_rows, tables.held, march_state)
    given = (tables.bodies, tables.rows, tables.operator, course, work, surfaces, changing, rubs)
    arrays = [None if each is None else packed(each) for each in given]
    places = np.array([0 if each is None else each.ctypes.data for each in arrays])
    optional = ((surfaces, apart), (changing, driven), (rubs, rubbing))
    parts = np.array([0 if own is None else part().address for own, part in optional])
    return int(slabs(places, parts, tolerance, told(march_state.account), len(course.time) - 1))


def _times(compiled: CompiledModel, march_state: MarchState, span: float, end_after: Callable[[float], float]) -> Array:
    """Ends (s + 1,) [s] of the next slabs of the length ``span`` [s], those of the solver for all models; not of the
    last ones of the march, which may be shorter.
    """
    times = [march_state.state.time]
    for _ in range(most_slabs(march_state, compiled.span)):
        end = end_after(times[-1]) if compiled.ends else times[-1] + compiled.span
        if abs((end - times[-1]) / span - 1.0) > SAME:
            break
        times.append(end)
    return np.array(times)


def new_course(model: Model, now: ModelState, rows: ContactRows, times: Array) -> Course:
    """Room for states at ``times`` (s + 1,), the first one given."""
    size, wanted = now.start.displacement.size, len(times) - 1
    pressure = np.concatenate([now.pressure, rows.shear.flat(now.traction).ravel()])

    def room(first: Array, length: int) -> Array:
        out = np.empty((wanted + 1, length))
        out[0] = first.ravel()
        return out

    supported = not model.space.every(model.dofs.unsupported)
    return Course(
        time=times,
        u=room(now.start.displacement, size),
        v=room(now.start.velocity, size),
        slope=room(now.acceleration, size),
        force=room(now.start.force, size),
        pressure=room(pressure, len(pressure)),
        energy=room(now.start.energy, len(now.start.energy)),
        scalar=np.zeros((wanted, len(model.parts))),
        support=np.empty((wanted if supported else 0, size)),
        sums=np.empty((wanted, SUMS)),
        met=np.zeros((wanted, len(model.contacts.labels), MET)),
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
        row=np.zeros(2 * len(rows.offset)),
        group=np.zeros((groups, 3)),
        works=np.zeros((len(bodies.floor), WORKS)),
    )
