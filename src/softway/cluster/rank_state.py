"""State of a march on a rank, and on all nodes: every field in the order of the nodes and points of the model."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.internal_force.material_state import MaterialState
from softway.cluster.cells.pieces import pieces_of
from softway.cluster.cells.rank_mesh import local_nodes
from softway.cluster.changed_state import Change, changed_state
from softway.cluster.own_gradients import declared, owned
from softway.contact.contact_rows import ContactRows
from softway.marching.state.march_state import MarchState
from softway.model.model import Model
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PieceNumbers:
    """Numbers of a piece of a solid (:class:`~softway.cluster.cells.pieces.Piece`).

    Parameters
    ----------
    solid, region
        Number of the solid, and region.
    nodes
        (k,) nodes of the piece, numbered in the model.
    corner
        (e a,) number in the model of each node of the rank's cells.
    per_cell
        Number of points of a cell.
    """

    solid: int
    region: str
    nodes: IntArray
    corner: IntArray
    per_cell: int

    def points(self, cells: IntArray) -> IntArray:
        """Points (k q,) of cells (k,)."""
        return (cells[:, None] * self.per_cell + np.arange(self.per_cell)).ravel()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankNumbers:
    """Numbers of nodes and points between a rank and the whole model.

    Parameters
    ----------
    held
        What the rank holds.
    shape
        Shape (N, d) of nodal fields of the model.
    pieces
        Pieces of the solids.
    solids
        Nodes of each solid in the model.
    """

    held: Holding
    shape: tuple[int, int]
    pieces: tuple[PieceNumbers, ...]
    solids: tuple[slice, ...]

    def piece(self, solid: int, region: str) -> int:
        """Number of the piece of a solid in a region."""
        return next(k for k, piece in enumerate(self.pieces) if (piece.solid, piece.region) == (solid, region))


def rank_numbers(model: Model, held: Holding) -> RankNumbers:
    """Numbers of a rank of a model whose solids have cells of one type."""
    per_cell = []
    for part in model.parts:
        ((_, cells),) = part.mesh.blocks.items()
        per_cell.append(len(part.internal.sampling.volume) // len(cells))
    found = tuple(
        PieceNumbers(
            solid=piece.solid,
            region=piece.region,
            nodes=piece.nodes,
            corner=piece.corners[mine].ravel(),
            per_cell=per_cell[piece.solid],
        )
        for piece, mine in zip(pieces_of(model), held.cells, strict=True)
    )
    solids = tuple(part.nodes for part in model.parts)
    return RankNumbers(held=held, shape=model.shape, pieces=found, solids=solids)


def on_rank(state: MarchState, numbers: RankNumbers) -> MarchState:
    """March state of what a rank holds."""
    held = numbers.held

    def of_piece(number: int, whole: MaterialState) -> MaterialState:
        piece = numbers.pieces[number]
        return whole.part(np.searchsorted(piece.nodes, piece.corner), piece.points(held.cells[number]))

    def material(solid: int, whole: MaterialState) -> MaterialState:
        if not whole.regions:
            return of_piece(numbers.piece(solid, ""), whole)
        own = numbers.solids[solid]
        u = whole.displacement[held.nodes[local_nodes(own, held)] - own.start]
        regions = {name: of_piece(numbers.piece(solid, name), some) for name, some in whole.regions.items()}
        return replace(whole, displacement=u, regions=regions)

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
    states: list[tuple[int, MaterialState]] = []
    taken = Change(
        nodal=lambda field: _kept(nodal, field),
        material=lambda solid, mine: _kept(states, (solid, mine))[1],
        rows=lambda rows: rows,
        operator=lambda operator: operator,
    )
    changed_state(state, taken)
    pieces = [found for solid, mine in states for found in _pieces(numbers, solid, mine)]
    count = len(nodal)
    nodal += [_of_corners(numbers, number, mine.displacement) for number, mine in pieces]
    nodal += [_of_solid(numbers, solid, mine.displacement) for solid, mine in states if mine.regions]
    whole = _gathered_fields(ranks, numbers, nodal)
    points = [_gathered_points(ranks, numbers, number, mine) for number, mine in pieces]
    if ranks.rank:
        return None
    placed = iter(whole[1:count])
    moved, of_solids = whole[count : count + len(pieces)], iter(whole[count + len(pieces) :])
    gathered = iter(_placed_states(numbers, pieces, points, moved))

    def material(solid: int, mine: MaterialState) -> MaterialState:
        if not mine.regions:
            return next(gathered)
        u = np.ascontiguousarray(next(of_solids)[numbers.solids[solid]])
        return replace(mine, displacement=u, regions={name: next(gathered) for name in mine.regions})

    given = Change(
        nodal=lambda field: next(placed),
        material=material,
        rows=lambda rows: _renumbered(rows, lambda nodes: numbers.held.nodes[nodes], numbers.shape[0]),
        operator=declared,
    )
    return changed_state(state, given), whole[0]


def _pieces(numbers: RankNumbers, solid: int, mine: MaterialState) -> list[tuple[int, MaterialState]]:
    """Number and state of each piece of a solid with a history."""
    states = mine.regions or {"": mine}
    return [(numbers.piece(solid, region), state) for region, state in states.items()]


def _of_solid(numbers: RankNumbers, solid: int, values: Array) -> Array:
    """Field (n, d) of local nodes from values (k, d) at those of a solid."""
    out = np.zeros((len(numbers.held.nodes), values.shape[1]))
    out[local_nodes(numbers.solids[solid], numbers.held)] = values
    return out


def _kept(store: list[Any], value: Any) -> Any:
    """The value, which the store keeps."""
    store.append(value)
    return value


def _of_corners(numbers: RankNumbers, piece: int, values: Array) -> Array:
    """Field (n, d) of local nodes from values (e a, d) at the nodes of the cells of a piece."""
    out = np.zeros((len(numbers.held.nodes), values.shape[1]))
    out[numbers.held.local(numbers.pieces[piece].corner)] = values
    return out


def _gathered_fields(ranks: Ranks, numbers: RankNumbers, fields_: list[Array]) -> list[Array]:
    """Fields (N, d) of all nodes on rank 0, from local ones (n, d); empty on the others."""
    held = numbers.held
    values = ranks.collected(np.concatenate([f[held.own] for f in fields_], axis=1))
    where = ranks.collected(held.nodes[held.own])
    if ranks.rank:
        return []
    ends = np.cumsum([f.shape[1] for f in fields_])
    out = np.empty((numbers.shape[0], ends[-1]))
    for nodes, own in zip(where, values, strict=True):
        out[nodes] = own
    return [np.ascontiguousarray(f) for f in np.split(out, ends[:-1], axis=1)]


def _gathered_points(ranks: Ranks, numbers: RankNumbers, number: int, mine: MaterialState) -> Array | None:
    """Values (P, k) of a state at all points of a piece on rank 0; None on the others."""
    held, piece = numbers.held, numbers.pieces[number]
    cells, counted = held.cells[number], np.flatnonzero(held.counted[number])
    stacked = np.concatenate([a.reshape(len(mine.stored), -1) for a in _arrays(mine).values()], axis=1)
    values = ranks.collected(stacked[piece.points(counted)])
    where = ranks.collected(piece.points(cells[counted]))
    if ranks.rank:
        return None
    out = np.empty((sum(map(len, where)), stacked.shape[1]))
    for points, own in zip(where, values, strict=True):
        out[points] = own
    return out


def _placed_states(
    numbers: RankNumbers, pieces: list[tuple[int, MaterialState]], points: list[Array | None], moved: list[Array]
) -> list[MaterialState]:
    """States of all points of the pieces, from their values and displacements."""
    found = []
    for (number, mine), values, u in zip(pieces, points, moved, strict=True):
        assert values is not None
        arrays, ends = _arrays(mine), 0
        whole: dict[str, Any] = {}
        for name, some in arrays.items():
            width = int(np.prod(some.shape[1:]))
            whole[name] = np.ascontiguousarray(values[:, ends : ends + width]).reshape(len(values), *some.shape[1:])
            ends += width
        law = {name: whole.pop(f"law {name}") for name in mine.law}
        found.append(
            replace(mine, displacement=np.ascontiguousarray(u[numbers.pieces[number].nodes]), law=law, **whole)
        )
    return found


def _arrays(state: MaterialState) -> dict[str, Array]:
    """Arrays (p, ...) of a state at its points, by name."""
    law = {f"law {name}": values for name, values in state.law.items()}
    named = {f.name: getattr(state, f.name) for f in fields(state) if f.name not in ("displacement", "law", "regions")}
    return {**law, **{name: value for name, value in named.items() if isinstance(value, np.ndarray)}}


def _renumbered(rows: ContactRows, number: Callable[[IntArray], IntArray], n: int) -> ContactRows:
    """Contact rows on other numbers of n nodes."""
    d, m = rows.normal.shape[1], len(rows.node)
    G, w = rows.gradient, rows.shear.weights
    node, component = np.divmod(G.indices.astype(np.int64), d)
    gradient = sp.csr_array((G.data, number(node) * d + component, G.indptr), shape=(m, n * d))
    weights = sp.csr_array((w.data, number(w.indices.astype(np.int64)), w.indptr), shape=(w.shape[0], n))
    return replace(rows, node=number(rows.node), gradient=gradient, shear=replace(rows.shear, weights=weights))
