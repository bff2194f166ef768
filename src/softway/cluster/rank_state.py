"""State of a march on a rank, and on all nodes: every field in the order of the nodes and points of the model."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.internal_force.material_state import MaterialState
from softway.cluster.changed_state import Change, changed_state
from softway.cluster.own_gradients import declared, owned
from softway.contact.contact_rows import ContactRows
from softway.marching.state.march_state import MarchState
from softway.model.model import Model
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankNumbers:
    """Numbers of nodes and points between a rank and the whole model.

    Parameters
    ----------
    held
        What the rank holds.
    shape
        Shape (N, d) of nodal fields of the model.
    corner
        (e a,) number in the model of each node of the rank's cells of each solid.
    per_cell
        Number of points of a cell of each solid.
    first
        First node of each solid in the model.
    """

    held: Holding
    shape: tuple[int, int]
    corner: tuple[IntArray, ...]
    per_cell: tuple[int, ...]
    first: tuple[int, ...]

    def points(self, solid: int, cells: IntArray) -> IntArray:
        """Points (k q,) of cells (k,) of a solid."""
        q = self.per_cell[solid]
        return (cells[:, None] * q + np.arange(q)).ravel()


def rank_numbers(model: Model, held: Holding) -> RankNumbers:
    """Numbers of a rank of a model whose solids have cells of one type."""
    blocks = [next(iter(part.mesh.blocks.values())) for part in model.parts]
    points = [len(part.internal.sampling.volume) // len(cells) for part, cells in zip(model.parts, blocks, strict=True)]
    first = tuple(part.nodes.start for part in model.parts)
    corner = [cells[mine].ravel() + at for cells, mine, at in zip(blocks, held.cells, first, strict=True)]
    return RankNumbers(held=held, shape=model.shape, corner=tuple(corner), per_cell=tuple(points), first=first)


def on_rank(state: MarchState, numbers: RankNumbers) -> MarchState:
    """March state of what a rank holds."""
    held = numbers.held

    def material(solid: int, whole: MaterialState) -> MaterialState:
        nodes = numbers.corner[solid] - numbers.first[solid]
        return whole.part(nodes, numbers.points(solid, held.cells[solid]))

    change = Change(
        nodal=lambda field: np.ascontiguousarray(field[held.nodes]),
        material=material,
        rows=lambda rows: _renumbered(rows, held.local, len(held.nodes)),
        operator=owned,
    )
    return changed_state(state, change)


def on_all(state: MarchState, numbers: RankNumbers, ranks: Ranks, more: Array) -> tuple[MarchState, Array] | None:
    """March state of the model on rank 0, and a nodal field ``more`` (n, d); None on the others."""
    nodal: list[Array] = [more]
    material: list[tuple[int, MaterialState]] = []
    taken = Change(
        nodal=lambda field: _kept(nodal, field),
        material=lambda solid, mine: _kept(material, (solid, mine))[1],
        rows=lambda rows: rows,
        operator=lambda operator: operator,
    )
    changed_state(state, taken)
    nodal += [_of_corners(numbers, solid, mine.displacement) for solid, mine in material]
    whole = _gathered_fields(ranks, numbers, nodal)
    points = [_gathered_points(ranks, numbers, solid, mine) for solid, mine in material]
    if ranks.rank:
        return None
    count = len(nodal) - len(material)
    placed = iter(whole[1:count])
    states = iter(_placed_states(numbers, material, points, whole[count:]))
    given = Change(
        nodal=lambda field: next(placed),
        material=lambda solid, mine: next(states),
        rows=lambda rows: _renumbered(rows, lambda nodes: numbers.held.nodes[nodes], numbers.shape[0]),
        operator=declared,
    )
    return changed_state(state, given), whole[0]


def _kept(store: list[Any], value: Any) -> Any:
    """The value, which the store keeps."""
    store.append(value)
    return value


def _of_corners(numbers: RankNumbers, solid: int, values: Array) -> Array:
    """Field (n, d) of local nodes from values (e a, d) at the nodes of the cells of a solid."""
    out = np.zeros((len(numbers.held.nodes), values.shape[1]))
    out[numbers.held.local(numbers.corner[solid])] = values
    return out


def _gathered_fields(ranks: Ranks, numbers: RankNumbers, fields_: list[Array]) -> list[Array]:
    """Fields (N, d) of all nodes on rank 0, from local ones (n, d); empty on the others."""
    held = numbers.held
    values = ranks.collected(np.concatenate([f[held.own] for f in fields_], axis=1))
    where = ranks.collected(held.nodes[held.own])
    if ranks.rank:
        return []
    out = np.empty((numbers.shape[0], len(fields_) * numbers.shape[1]))
    for nodes, own in zip(where, values, strict=True):
        out[nodes] = own
    return [np.ascontiguousarray(f) for f in np.split(out, len(fields_), axis=1)]


def _gathered_points(ranks: Ranks, numbers: RankNumbers, solid: int, mine: MaterialState) -> Array | None:
    """Values (P, k) of a state at all points of a solid on rank 0; None on the others."""
    held = numbers.held
    cells, counted = held.cells[solid], np.flatnonzero(held.counted[solid])
    stacked = np.concatenate([a.reshape(len(mine.stored), -1) for a in _arrays(mine).values()], axis=1)
    values = ranks.collected(stacked[numbers.points(solid, counted)])
    where = ranks.collected(numbers.points(solid, cells[counted]))
    if ranks.rank:
        return None
    out = np.empty((sum(map(len, where)), stacked.shape[1]))
    for points, own in zip(where, values, strict=True):
        out[points] = own
    return out


def _placed_states(
    numbers: RankNumbers, material: list[tuple[int, MaterialState]], points: list[Array | None], moved: list[Array]
) -> list[MaterialState]:
    """States of all points of the solids, from their values and displacements."""
    found = []
    for (solid, mine), values, u in zip(material, points, moved, strict=True):
        assert values is not None
        arrays, ends = _arrays(mine), 0
        whole: dict[str, Any] = {}
        for name, some in arrays.items():
            width = int(np.prod(some.shape[1:]))
            whole[name] = np.ascontiguousarray(values[:, ends : ends + width]).reshape(len(values), *some.shape[1:])
            ends += width
        own = slice(numbers.first[solid], (*numbers.first, numbers.shape[0])[solid + 1])
        law = {name: whole.pop(f"law {name}") for name in mine.law}
        found.append(replace(mine, displacement=np.ascontiguousarray(u[own]), law=law, **whole))
    return found


def _arrays(state: MaterialState) -> dict[str, Array]:
    """Arrays (p, ...) of a state at its points, by name."""
    law = {f"law {name}": values for name, values in state.law.items()}
    named = {f.name: getattr(state, f.name) for f in fields(state) if f.name not in ("displacement", "law")}
    return {**law, **{name: value for name, value in named.items() if isinstance(value, np.ndarray)}}


def _renumbered(rows: ContactRows, number: Callable[[IntArray], IntArray], n: int) -> ContactRows:
    """Contact rows on other numbers of n nodes."""
    d, m = rows.normal.shape[1], len(rows.node)
    G, w = rows.gradient, rows.shear.weights
    node, component = np.divmod(G.indices.astype(np.int64), d)
    gradient = sp.csr_array((G.data, number(node) * d + component, G.indptr), shape=(m, n * d))
    weights = sp.csr_array((w.data, number(w.indices.astype(np.int64)), w.indptr), shape=(w.shape[0], n))
    return replace(rows, node=number(rows.node), gradient=gradient, shear=replace(rows.shear, weights=weights))
