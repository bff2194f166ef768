"""Temperature of solids on a rank: rows of its own nodes, and the loads, contacts and dissipation at them.

Rows, capacities and functions of heat are those of the whole model, cut to what the rank holds, so that their numbers
and their order are those of the model (docs/theory/solver/ranks.md).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.heated_nodes import HeatedNodes
from softway.bodies.discretised import DiscreteSolid
from softway.cluster.cells.piece_force import joined_sampling
from softway.cluster.cells.pieces import Piece, pieces_of
from softway.cluster.cells.rank_force import RankForce
from softway.cluster.rank_contacts import rank_surface
from softway.heat.coupled.solid_temperature import SolidTemperature
from softway.heat.coupled.strain.expansion import Expansion
from softway.heat.coupled.strain.free_strain import FreeStrain
from softway.heat.heat_model import HeatModel, HeatPart, HeatSurface
from softway.model.model import Model
from softway.ranks.interface import Exchange
from softway.ranks.partition import Holding
from softway.ranks.space import RankSpace, Shares


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldHeat:
    """Nodes with heat on a rank.

    Parameters
    ----------
    local
        (k,) their numbers among the n nodes of the rank.
    number
        (k,) their numbers among the K nodes with heat of the model.
    place
        (K,) the number here of each of these; -1 for others.
    own
        (k,) True for own nodes.
    """

    local: IntArray
    number: IntArray
    place: IntArray
    own: BoolArray

    def cut(self, matrix: sp.csr_array, rows: IntArray) -> sp.csr_array:
        """Some ``rows`` (r,) of a matrix (R, K), on the nodes here: (r, k)."""
        out = sp.csr_array(matrix[rows])
        out.sort_indices()
        return sp.csr_array((out.data, self.place[out.indices], out.indptr), shape=(len(rows), len(self.local)))


def rank_temperature(
    whole: SolidTemperature, model: Model, parts: Sequence[DiscreteSolid], held: Holding, space: RankSpace
) -> SolidTemperature:
    """Temperature on a rank, from that of the whole ``model``, which has to be admitted, and the solids of the rank."""
    heat = held_heat(whole, held)
    expansion = whole.moduli.free
    free = FreeStrain(
        reference=expansion.reference[heat.number], liquid=expansion.liquid[heat.number],
        coefficient=expansion.coefficient[heat.number], melting=expansion.melting[heat.number],
    )  # fmt: skip
    contacts = tuple(
        replace(rows, node=held.local(rows.node), surfaces=tuple(rank_surface(s, held) for s in rows.surfaces))
        for rows in whole.contacts.contacts
    )
    heated = HeatedNodes(number=heat.local, count=len(held.nodes))
    exchange = replace(
        whole.contacts, contacts=contacts, part_of=whole.contacts.part_of[held.nodes], heated=heated,
        effusivity=whole.contacts.effusivity[held.nodes],
    )  # fmt: skip
    pieces = pieces_of(model)
    return replace(
        whole,
        model=_rank_heat(whole.model, heat, space),
        heated=heated,
        moduli=replace(whole.moduli, free=free),
        contacts=exchange,
        dissipations=tuple(_at_points(one, pieces, held, volume=one.volume) for one in whole.dissipations),
        points=tuple(_at_points(one, pieces, held) for one in whole.points),
        expansions=tuple(_expansion(one, pieces, parts, held) for one in whole.expansions),
    )


def held_heat(whole: SolidTemperature, held: Holding) -> HeldHeat:
    """Nodes with heat that a rank holds."""
    found = np.searchsorted(whole.nodes, held.nodes)
    here = np.isin(held.nodes, whole.nodes, assume_unique=True)
    local, number = np.flatnonzero(here), found[here]
    place = np.full(len(whole.nodes), -1)
    place[number] = np.arange(len(local))
    own = np.zeros(len(held.nodes), bool)
    own[held.own] = True
    return HeldHeat(local=local, number=number, place=place, own=own[local])


def _rank_heat(whole: HeatModel, heat: HeldHeat, space: RankSpace) -> HeatModel:
    """Conduction on a rank."""
    assert whole.conduction is not None and whole.capacity is not None
    held = tuple((load, _placed(nodes, heat)) for load, nodes in whole.held)
    ours = _among(space, heat.local, space.shares.length)
    free = np.ones(len(heat.local), bool)
    for _, nodes in held:
        free[nodes] = False
    return replace(
        whole,
        parts=tuple(_part(part, heat) for part in whole.parts),
        cells=(),
        mass=whole.mass[heat.number],
        pattern=cast(Any, None),
        surfaces=tuple(_surface(one, heat) for one in whole.surfaces),
        sources=tuple((load, volume[heat.number]) for load, volume in whole.sources),
        held=held,
        initial=whole.initial[heat.number],
        latent=whole.latent[heat.number],
        n_cells=0,
        conduction=_own_rows(whole.conduction, heat),
        capacity=whole.capacity[heat.number],
        space=ours,
        free_space=_among(ours, np.flatnonzero(free), len(free)),
    )


def _placed(nodes: IntArray, heat: HeldHeat) -> IntArray:
    """Those of some nodes (j,) of the model that are here."""
    found = heat.place[nodes]
    return found[found >= 0]


def _part(part: HeatPart, heat: HeldHeat) -> HeatPart:
    """Conductor with its nodes here."""
    first, last = np.searchsorted(heat.number, [part.nodes.start, part.nodes.stop]).tolist()
    nodes = slice(first, last)
    return replace(part, mesh=cast(Any, None), nodes=nodes, kept=np.arange(last - first), places=nodes)


def _surface(surface: HeatSurface, heat: HeldHeat) -> HeatSurface:
    """Points of a surface at which an own node takes part."""
    own = np.zeros(len(heat.place), bool)
    own[heat.number[heat.own]] = True
    mine = np.flatnonzero(surface.points @ own.astype(float) != 0.0)
    return replace(surface, points=heat.cut(surface.points, mine), areas=surface.areas[mine])


def _own_rows(matrix: sp.csr_array, heat: HeldHeat) -> sp.csr_array:
    """Rows (k, k) of own nodes; those of copies have an empty diagonal, for capacities."""
    mine = np.flatnonzero(heat.own)
    own = heat.cut(matrix, heat.number[mine]).tocoo()
    copies = np.flatnonzero(~heat.own)
    rows, columns = np.concatenate([mine[own.row], copies]), np.concatenate([own.col, copies])
    data, k = np.concatenate([own.data, np.zeros(len(copies))]), len(heat.local)
    order = np.lexsort((columns, rows))
    start = np.searchsorted(rows[order], np.arange(k + 1))
    return sp.csr_array((data[order], columns[order], start), shape=(k, k))


def _among(space: RankSpace, nodes: IntArray, count: int) -> RankSpace:
    """Space of some ``nodes`` (k,) of ``count``, ascending, with their exchange."""
    assert space.exchange is not None
    place = np.full(count, -1)
    place[nodes] = np.arange(len(nodes))

    def cut(pairs: Mapping[int, IntArray]) -> dict[int, IntArray]:
        found = {other: place[some] for other, some in pairs.items()}
        return {other: some[some >= 0] for other, some in found.items() if (some >= 0).any()}

    own = place[space.shares.own]
    solids = tuple(slice(*np.searchsorted(nodes, [one.start, one.stop]).tolist()) for one in space.solids)
    return RankSpace(
        ranks=space.ranks,
        shares=Shares(ranks=space.ranks, own=own[own >= 0], length=len(nodes)),
        solids=solids,
        exchange=Exchange(send=cut(space.exchange.send), receive=cut(space.exchange.receive)),
    )


def _at_points(one: Any, pieces: tuple[Piece, ...], held: Holding, **arrays: Array) -> Any:
    """Functions of heat at the points of the rank's cells, on the local nodes, with other arrays (p,) there."""
    points = _points(_piece(pieces, one.solid, one.region), one.values, pieces, held)
    values = _local(sp.csr_array(one.values[points]), one.nodes, slice(0, len(held.nodes)), held)
    cut = {name: a[points] for name, a in arrays.items()}
    return replace(one, nodes=np.arange(len(held.nodes)), values=values, **cut)


def _expansion(one: Expansion, pieces: tuple[Piece, ...], parts: Sequence[DiscreteSolid], held: Holding) -> Expansion:
    """Expansion of the rank's cells, on its nodes of the solid."""
    k = _piece(pieces, one.number, one.region)
    part = parts[one.number]
    (force,) = (p for p in cast(RankForce, part.internal).pieces if p.region == one.region)
    points = _points(k, one.values, pieces, held)
    numbers = np.arange(one.nodes.start, one.nodes.stop) if isinstance(one.nodes, slice) else one.nodes
    return replace(
        one,
        cells=np.arange(len(held.cells[k])),
        nodes=part.nodes,
        values=_local(sp.csr_array(one.values[points]), numbers, part.nodes, held),
        sampling=joined_sampling((force,)),
        directions=one.directions if len(one.directions) == 1 else one.directions[points],
        compiled=None,
    )


def _piece(pieces: tuple[Piece, ...], solid: int, region: str) -> int:
    """Number of the piece of a solid in a region."""
    return next(k for k, piece in enumerate(pieces) if (piece.solid, piece.region) == (solid, region))


def _points(k: int, values: sp.csr_array, pieces: tuple[Piece, ...], held: Holding) -> IntArray:
    """Points (p,) of the rank's cells among those of a piece, which have the ``values`` (P, ...)."""
    each = values.shape[0] // len(pieces[k].corners)
    return np.asarray((held.cells[k][:, None] * each + np.arange(each)).ravel())


def _local(values: sp.csr_array, nodes: IntArray, local: slice, held: Holding) -> sp.csr_array:
    """Values (p, n) on the nodes ``local`` of the rank, from those (p, k) on some ``nodes`` of the model."""
    columns = held.local(nodes[values.indices]) - local.start
    return sp.csr_array((values.data, columns, values.indptr), shape=(values.shape[0], local.stop - local.start))
