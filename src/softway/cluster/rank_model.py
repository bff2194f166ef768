"""Model of a rank: the arrays of a model on the nodes and cells that the rank holds."""

from dataclasses import replace
from typing import Any, cast

import numpy as np

from softway.arrays import IntArray
from softway.bodies.assembled.nodal_loads import DeadLoads
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import NodalDofs
from softway.bodies.internal_force.body_force import BodyForce
from softway.cluster.cells.pieces import Piece, pieces_of
from softway.cluster.cells.rank_force import DeclaredForce, rank_force
from softway.cluster.cells.rank_mesh import local_nodes, rank_mesh
from softway.cluster.own_rows import columns, own_rows
from softway.cluster.rank_contacts import rank_contacts, rank_friction
from softway.cluster.rank_temperature import rank_temperature
from softway.heat.coupled.solid_temperature import temperatures_of
from softway.meshes.mesh import Mesh
from softway.model.model import Model
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding, bisected, holding, owners
from softway.ranks.space import RankSpace, Shares


def held_by(model: Model, ranks: Ranks) -> Holding:
    """What a rank holds of a model: all nodes that may touch, and those of the rows of its own nodes, too."""
    cells = [piece.corners for piece in pieces_of(model)]
    centres = np.concatenate([model.points[some].mean(axis=1) for some in cells])
    rank_of = np.split(bisected(centres, ranks.size), np.cumsum([len(some) for some in cells])[:-1])
    owner = owners(cells, rank_of, model.shape[0])
    mine = np.flatnonzero(owner == ranks.rank)
    seen = [columns(matrix, mine) for matrix in (model.mass, model.follow, model.passing)]
    seen.append(np.array([part.nodes.start for part in model.parts]))  # temperatures are told from those of these nodes
    return holding(ranks, cells, owner, np.concatenate([model.touchable, *seen]))


def rank_model(model: Model, held: Holding, ranks: Ranks) -> Model:
    """Model of a rank from the whole model, which has to be admitted
    (:func:`~softway.cluster.admitted.require_several`).
    """
    nodes, pieces = held.nodes, pieces_of(model)
    space, dofs = rank_space(model, held, ranks), NodalDofs(model.dofs.free[nodes])
    loads = DeadLoads(
        fields=tuple((ramp, f[nodes]) for ramp, f in model.loads.fields), shape=(len(nodes), model.shape[1])
    )
    matrices: Any = {name: own_rows(getattr(model, name), held) for name in ("mass", "passing")}
    matrices["follow"] = own_rows(model.follow, held, space)
    parts = tuple(_part(model, k, pieces, held, ranks) for k in range(len(model.parts)))
    fields = tuple(rank_temperature(one, model, parts, held, space) for _, one in temperatures_of(model.companions))
    names = ("massive", "part_of", "load", "load_before", "weight", "displacement", "velocity", "edge")
    return replace(
        model,
        parts=parts,
        dofs=dofs,
        loads=loads,
        contacts=rank_contacts(model.contacts, held, space),
        friction=rank_friction(model, held),
        touchable=held.local(model.touchable),
        driven=tuple((support, where[nodes]) for support, where in model.driven),
        space=space,
        companions=fields,
        total=cast(Any, None),
        **matrices,
        **{name: getattr(model, name)[nodes] for name in names},
    )


def without_tables(model: Model) -> Model:
    """Model without the tables of its cells and the matrix of all solids, of which no :func:`rank_model` is made."""
    sections = [DeclaredForce(section=part.internal.section) for part in model.parts]
    parts = [replace(p, internal=cast(BodyForce, own)) for p, own in zip(model.parts, sections, strict=True)]
    return replace(model, parts=tuple(parts), total=cast(Any, None))


def rank_space(model: Model, held: Holding, ranks: Ranks) -> RankSpace:
    """Vector space of what a rank holds."""
    free, n = model.dofs.free[held.nodes], len(held.nodes)
    own = np.zeros(free.shape, bool)
    own[held.own] = True
    mine: IntArray = np.flatnonzero(own[free])
    solids = tuple(local_nodes(part.nodes, held) for part in model.parts)
    unknowns = RankSpace(ranks=ranks, shares=Shares(ranks=ranks, own=mine, length=int(free.sum())))
    shares = Shares(ranks=ranks, own=held.own, length=n)
    return RankSpace(ranks=ranks, shares=shares, solids=solids, exchange=held.exchange, unknowns=unknowns)


def _part(model: Model, solid: int, pieces: tuple[Piece, ...], held: Holding, ranks: Ranks) -> DiscreteSolid:
    """Solid of a rank."""
    part = model.parts[solid]
    nodes = local_nodes(part.nodes, held)
    return replace(
        part,
        mesh=cast(Mesh, rank_mesh(solid, part, pieces, held)),
        nodes=nodes,
        internal=cast(BodyForce, rank_force(solid, part, pieces, held, ranks)),
        dofs=NodalDofs(model.dofs.free[held.nodes[nodes]]),
    )
