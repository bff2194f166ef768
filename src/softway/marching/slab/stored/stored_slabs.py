"""Several slabs (time steps) of stored energies in one compiled call."""

import numpy as np

from softway.arrays import Array
from softway.kernels.slab.stored.march import stored_slabs
from softway.kernels.slab.stored.tables import BALANCE, DEAR, Search
from softway.kernels.slab.tables import Course
from softway.marching.slab.compiled_slabs import new_course, new_work
from softway.marching.slab.slab_batch import SlabBatch, most_slabs, told
from softway.marching.slab.stored.stored_model import StoredModel, Tables
from softway.marching.state.march_state import MarchState
from softway.meshes.cell_shapes import FLAT
from softway.model.scene import State
from softway.solve.equations.energy_balance import SLIGHT
from softway.solve.operators.operator_memory import USUAL, WORN, IterationCount, OperatorMemory

MOST = 60
"""Greatest number of iterations of a compiled slab."""
CLEAR = 1.0 + 1e-9
"""Shape of a cell, relative to that of a flat one, above which it certainly is not flat."""


def next_stored(
    stored: StoredModel, march_state: MarchState, before: State, memory: OperatorMemory
) -> SlabBatch | None:
    """Slabs from a march state on, up to one in which something happens; None if that is the next one.

    The state alone decides which slabs are compiled, so that a resumed march has the same bits.
    """
    now, history, model = march_state.state, march_state.step_history, stored.model
    steady = history.length == history.span == stored.span and not (history.altered or history.energy_along_motion)
    if not (steady and _known(memory, stored.span)) or now.rows is not None:
        return None
    wanted = most_slabs(march_state, stored.span)
    if wanted < 1 or _shape(stored, now.start.displacement) <= CLEAR * FLAT:
        return None
    found = _computed(stored, march_state, memory, wanted)
    if found is None:
        return None
    course, computed, worn = found
    shapes = np.array([_shape(stored, course.u[k + 1].reshape(model.shape)) for k in range(computed)])
    count = int(np.argmax([*(shapes <= CLEAR * FLAT), True]))
    if not count:
        return None
    begun, worn = (march_state, before, memory), worn and count == computed
    return SlabBatch.of(model, course, stored.contact_rows, count, begun, shapes=shapes[:count], worn=worn)


def _computed(
    stored: StoredModel, march_state: MarchState, memory: OperatorMemory, wanted: int
) -> tuple[Course, int, bool] | None:
    """Course with up to so many slabs, the number of those computed, and whether the last one has worn the operator;
    None without an operator.
    """
    now = march_state.state
    assert memory.origin is not None
    mixed = memory.mixed if memory.frozen is None else memory.frozen.basis.place is None
    found = stored.operator(memory.origin, now.pressure > 0.0, mixed)
    if found is None:
        return None
    operator, turning, factor = found
    times = np.cumsum([now.time, *(stored.span for _ in range(wanted))])
    course = new_course(stored.model, now, stored.contact_rows, times)
    search = _search(stored, march_state, memory)
    work = new_work(stored.bodies, stored.rows)
    tables = Tables.of((stored.bodies, stored.rows, operator, course, work, search, turning))
    with factor.limited():
        computed = int(stored_slabs(tables.places, told(march_state.account), wanted))
    return None if factor.failed else (course, computed, bool(search.taken[DEAR]))


def _known(memory: OperatorMemory, span: float) -> bool:
    """True if the operator of a march is known, serves its slabs and is not shifted."""
    origin = memory.origin
    return origin is not None and not (memory.stale or origin.positive_definite) and memory.serves(span)


def _shape(stored: StoredModel, u: Array) -> float:
    """Least shape of the cells at the displacement ``u`` (n, d)."""
    return stored.watched.least(u) if stored.watched.blocks else np.inf


def _search(stored: StoredModel, march_state: MarchState, memory: OperatorMemory) -> Search:
    """Work space of the iterations of a call, and the numbers that decide on them."""
    method, (N, m), taken = stored.method, (len(stored.bodies.heavy), len(stored.rows.offset)), memory.taken
    depth, groups = method.depth, int(stored.bodies.group.max()) + 1
    scalar = march_state.settings.control.scalar
    return Search(
        solids=stored.solids.places,
        balance=np.zeros((groups, BALANCE)),
        residuals=np.zeros((depth, N)),
        values=np.zeros((depth, N + m)),
        gram=np.zeros((depth, depth)),
        last=np.zeros(2 * N + m),
        small=np.zeros((3, max(depth, 3), max(depth, 3))),
        kept=np.zeros(2, np.int64),
        changes=np.zeros(min(method.limit, MOST)),
        limits=np.array([method.tolerance, memory.price, USUAL, WORN, scalar, SLIGHT]),
        taken=_taken(taken),
    )


def _taken(taken: IterationCount) -> np.ndarray:
    last = (0, 0, *taken.last)[-2:]
    return np.array([taken.slabs, taken.total, taken.least, *last, 0], np.int64)
