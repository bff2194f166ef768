"""Internal force of the cells of one material on a rank: evaluated one by one, added in the order of all cells."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.assembled import force_of
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, SlabForce
from softway.cluster.cells.cell_energies import CellForce, cell_energies_and_force, point_totals
from softway.cluster.cells.pieces import Piece
from softway.cluster.cells.rank_mesh import local_nodes, own_mask
from softway.laws.law import Damped
from softway.meshes.mesh import Mesh
from softway.ranks.partition import Holding


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PieceForce:
    """Force of a piece of a solid on the own nodes of a rank, zero on its copies of others; all on the n local nodes of
    the solid.

    Material states are those of its cells, with the displacement (e a, d) of their nodes.

    Parameters
    ----------
    region
        Region of the material; empty in a solid of one material.
    cells
        Force of the cells with nodes of their own, (e a, d).
    corner
        (e a,) local node of each of their nodes.
    adding
        (n, e a) sums at own nodes, in the order of the cells.
    counted
        (e,) True for the cells whose energy the rank counts.
    """

    region: str
    cells: CellForce
    corner: IntArray
    adding: sp.csr_array
    counted: BoolArray

    def own(self, state: MaterialState | None) -> MaterialState | None:
        """State of the piece in that of the solid."""
        return state if state is None or not self.region else state.regions.get(self.region)

    def during(self, state: MaterialState | None, span: float) -> "PieceForce":
        """Force in a slab of length ``span`` [s] that starts from a ``state`` of the solid."""
        mine = self.own(state)
        return self if mine is None else replace(self, cells=self.cells.during(mine, span))

    def energies_and_force(self, u: Array) -> tuple[Array, Array]:
        """Energies (c,) of the counted cells [J], and force (n, d) [N]."""
        energies, force = cell_energies_and_force(self.cells, self._at(u))
        return energies[self.counted], self._added(force)

    def totals(self, density: Array) -> Array:
        """Energies (c,) of the counted cells [J] from densities (p,) at the points of all cells."""
        return point_totals(self.cells, density)[self.counted]

    def force(self, u: Array) -> Array:
        """Force (n, d) [N]."""
        return self._added(self.cells.force(self._at(u)))

    def viscous_force(self, u: Array) -> Array | None:
        """Part of the force due to the mean rate of the slab, (n, d) [N]; None without viscosity."""
        found = self.cells.end_force(self._at(u))[2] if isinstance(self.cells.material, Damped) else None
        return None if found is None else self._added(found)

    def stored_viscous_force(self, state: MaterialState | None) -> Array | None:
        """Viscous part of the force in a ``state`` of the solid, (n, d) [N]; None without viscosity."""
        found = self.cells.stored_viscous_force(self.own(state))
        return None if found is None else self._added(found)

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return self._added(self.cells.tangent_product(self._at(u), self._at(w)))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks (n, d, d) [N/m] of the tangent."""
        return self._added(self.cells.tangent_diagonal_blocks(self._at(u)))

    def matrices(self, u: Array, factor: float, viscous_factor: float) -> Array:
        """Matrices (e, a, d, a, d) of the cells, column before row: ``factor`` times tangent and viscous part [N/m]."""
        at = self._at(u)
        values = np.asarray(self.cells.tangent(at).data)
        values *= factor
        viscous = self.cells.viscous_tangent(at) if viscous_factor > 0.0 else None
        if viscous is not None:
            values += factor * viscous_factor * viscous.data
        (table,), d = self.cells.sampling.rows, u.shape[1]
        a = table.shape[2]
        return values.reshape(-1, a, d, a, d)

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force (n, d) averaged along the chord [N]; None for rules without a chord."""
        if not isinstance(rule, AverageField | DiscreteGradient):
            return None
        found = self.cells.slab_average(rule, self._at(u0), self._at(u1))
        return None if found is None else self._added(found)

    def committed(self, u: Array) -> MaterialState | None:
        """Material state of the cells at the end of the slab; None for an elastic material."""
        return self.cells.committed(self._at(u))

    def volume_ratio(self, u: Array) -> float:
        """Least det F over the points of the cells."""
        return self.cells.volume_ratio(self._at(u))

    def table(self) -> sp.csr_array:
        """Samples (p k, n) of the cells on local nodes."""
        count, n = len(self.corner), self.adding.shape[0]
        onto = sp.csr_array((np.ones(count), self.corner, np.arange(count + 1)), shape=(count, n))
        return sp.csr_array(self.cells.sampling.table @ onto)

    def _at(self, u: Array) -> Array:
        """Values (e a, ...) at the nodes of the cells of a field (n, ...)."""
        return np.take(u, self.corner, axis=0)

    def _added(self, values: Array) -> Array:
        """Values (n, ...) at own nodes from those (e a, ...) of the cells."""
        return np.asarray(self.adding @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:])


def piece_force(piece: Piece, part: DiscreteSolid, mine: IntArray, counted: BoolArray, held: Holding) -> PieceForce:
    """Force of the cells ``mine`` (e,) of a ``piece`` of a solid, of which the rank counts some (e,)."""
    ((kind, _),), corners = part.mesh.blocks.items(), piece.corners[mine]
    own = own_mask(part.nodes, held)
    corner = held.local(corners.ravel()) - local_nodes(part.nodes, held).start
    points = part.mesh.points[corners.ravel() - part.nodes.start]
    apart = Mesh(points=points, blocks={kind: np.arange(corners.size).reshape(corners.shape)})
    force = force_of(apart, piece.material, part.internal.section, part.dilatation)
    assert isinstance(force, CellForce)
    return PieceForce(
        region=piece.region, cells=_lean(force), corner=corner, adding=_adding(corner, own), counted=counted
    )


def joined_sampling(pieces: tuple[PieceForce, ...]) -> StrainOperator:
    """Strain operator between local nodes and the points of the cells of all pieces of a solid, one after another."""
    first = pieces[0].cells.sampling
    if len(pieces) == 1:
        return replace(first, table=pieces[0].table())
    some = [piece.cells.sampling for piece in pieces]
    return replace(
        first,
        volume=np.concatenate([each.volume for each in some]),
        table=sp.csr_array(sp.vstack([piece.table() for piece in pieces], format="csr")),
        rows=(np.concatenate([table for each in some for table in each.rows]),),
        dilatation=None,
    )


def _lean(force: CellForce) -> CellForce:
    """Force without the tables that matrices by arrays need, where kernels make them."""
    if not isinstance(force, ElasticForce) or not isinstance(force.work, KernelEvaluation):
        return force
    sampling, cells = force.sampling, force.work.cells
    pattern = replace(sampling.pattern, sums=sp.csr_array((0, 0)), order=np.empty(0, np.int32))
    plain = replace(force.plain, sampling=replace(sampling, pattern=pattern))
    return replace(force, plain=plain, work=replace(force.work, cells=replace(cells, pattern=pattern)))


def _adding(corner: IntArray, own: BoolArray) -> sp.csr_array:
    """Sums (n, e a) at own nodes of the values at the nodes of the cells, in their order; nothing at other nodes."""
    n, mine = len(own), np.flatnonzero(own[corner])
    order = mine[np.argsort(corner[mine], kind="stable")]
    start = np.concatenate([[0], np.cumsum(np.bincount(corner[mine], minlength=n))])
    return sp.csr_array((np.ones(len(order)), order, start), shape=(n, len(corner)))
