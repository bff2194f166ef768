"""State of a march on a rank, and on all nodes: every field in the order of the nodes of the model."""

from dataclasses import replace

import numpy as np

from softway.arrays import Array
from softway.marching.state.march_state import MarchState
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding


def on_rank(state: MarchState, held: Holding) -> MarchState:
    """March state of what a rank holds."""
    return _with_fields(state, [field[held.nodes] for field in nodal_fields(state)])


def on_all(state: MarchState, held: Holding, ranks: Ranks, more: Array) -> tuple[MarchState, Array] | None:
    """March state of all nodes on rank 0, and a field ``more`` (n, d); None on the others."""
    fields = [*nodal_fields(state), more]
    found = collected(ranks, held, np.concatenate(fields, axis=1))
    if found is None:
        return None
    *of_state, last = np.split(found, np.cumsum([f.shape[1] for f in fields])[:-1], axis=1)
    return _with_fields(state, of_state), last


def collected(ranks: Ranks, held: Holding, field: Array) -> Array | None:
    """Field (N, k) of all nodes on rank 0, from the local ones (n, k); None on the others."""
    values, numbers = ranks.collected(field[held.own]), ranks.collected(held.nodes[held.own])
    if ranks.rank:
        return None
    out = np.empty((sum(map(len, numbers)), field.shape[1]))
    for nodes, own in zip(numbers, values, strict=True):
        out[nodes] = own
    return out


def nodal_fields(state: MarchState) -> list[Array]:
    """Nodal fields (n, d) of a march state of an elastic body."""
    start = state.state.start
    fields = [start.displacement, start.velocity, start.force, state.state.acceleration]
    return fields if state.memory.origin is None else [*fields, state.memory.origin.at]


def _with_fields(state: MarchState, fields: list[Array]) -> MarchState:
    """March state with other :func:`nodal_fields`."""
    displacement, velocity, force, acceleration, *at = (np.ascontiguousarray(f) for f in fields)
    start = replace(state.state.start, displacement=displacement, velocity=velocity, force=force)
    memory, origin = state.memory, state.memory.origin
    if origin is not None:
        memory = replace(memory, origin=replace(origin, at=at[0]))
    return replace(state, state=replace(state.state, start=start, acceleration=acceleration), memory=memory)
