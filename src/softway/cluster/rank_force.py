"""Internal force of a rank: its cells are evaluated one by one, and added at its own nodes in the order of all cells.

The cells of a rank overlap those of its neighbours, so that the forces on its own nodes are complete.  Their sum has
the same order on every partition: a node sees the same numbers in the same order.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
import scipy.sparse as sp
from scipy.sparse import csc_array

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import Section
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.assembled import force_of
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, SlabForce
from softway.cluster.cell_energies import CellForce, cell_energies_and_force, of_cells, point_totals
from softway.cluster.stored_rows import RowTable, row_table
from softway.laws.law import Damped, Material
from softway.meshes.mesh import Mesh
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding
from softway.ranks.space import totalled


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankForce:
    """Force on the own nodes of a rank, zero on its copies of others; see
    :class:`~softway.bodies.internal_force.body_force.BodyForce`.

    Material states are those of its cells, with the displacement (e a, d) of their nodes.

    Parameters
    ----------
    cells
        Force of the cells with nodes of their own, (e a, d).
    corner
        (e a,) local node of each of their nodes.
    adding
        (n, e a) sums at own nodes, in the order of the cells.
    counted
        (e,) True for the cells whose energy the rank counts.
    ranks
        The ranks.
    sampling
        Strain operator between local nodes and the points of the cells.
    table
        Places of the blocks of the cells in the rows of own nodes.
    """

    cells: CellForce
    corner: IntArray
    adding: sp.csr_array
    counted: BoolArray
    ranks: Ranks
    sampling: StrainOperator
    table: RowTable

    @property
    def linear(self) -> bool:
        """True if the tangent is constant."""
        return self.cells.linear

    @property
    def path_dependent(self) -> bool:
        """True if the force depends on a material state."""
        return self.cells.path_dependent

    @property
    def state(self) -> MaterialState | None:
        """Material state of the cells at the start of the slab; None for an elastic body."""
        return self.cells.state

    @property
    def section(self) -> Section:
        """Section of the elements."""
        return self.cells.section

    def during(self, state: MaterialState | None, span: float) -> "RankForce":
        """Force in a slab of length ``span`` [s] that starts from a state of the cells; the force itself without."""
        return self if state is None else replace(self, cells=self.cells.during(state, span))

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Energy of the body [J], a sum over all ranks, and force (n, d) [N]."""
        energies, force = cell_energies_and_force(self.cells, self._at(u))
        total = float(totalled(self.ranks, energies[self.counted].reshape(-1, 1))[0])
        return total if np.isfinite(total) else np.inf, self._added(force)

    def end_force(self, u: Array) -> tuple[float, Array, Array | None]:
        """:meth:`energy_and_force`, and the part of the force due to the mean rate; None without viscosity."""
        energy, force = self.energy_and_force(u)
        viscous = self.cells.end_force(self._at(u))[2] if self._viscous else None
        return energy, force, None if viscous is None else self._added(viscous)

    def force(self, u: Array) -> Array:
        """Force (n, d) [N]."""
        return self._added(self.cells.force(self._at(u)))

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return self._added(self.cells.tangent_product(self._at(u), self._at(w)))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks (n, d, d) [N/m] of the tangent."""
        return self._added(self.cells.tangent_diagonal_blocks(self._at(u)))

    def stored_rows(self, u: Array, factor: float, viscous_factor: float) -> sp.bsr_array:
        """Rows (n d, n d) at own nodes of ``factor`` times the tangent and its viscous part [N/m]."""
        at = self._at(u)
        values = np.asarray(self.cells.tangent(at).data)
        values *= factor
        viscous = self.cells.viscous_tangent(at) if viscous_factor > 0.0 else None
        if viscous is not None:
            values += factor * viscous_factor * viscous.data
        (table,), d = self.cells.sampling.rows, u.shape[1]
        a = table.shape[2]
        return self.table.rows(values.reshape(-1, a, d, a, d))

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force (n, d) averaged along the chord [N]; None for rules without a chord."""
        if not isinstance(rule, AverageField | DiscreteGradient):
            return None
        found = self.cells.slab_average(rule, self._at(u0), self._at(u1))
        return None if found is None else self._added(found)

    def tangent(self, u: Array) -> csc_array:
        """Refused: no matrix is assembled over ranks."""
        raise NotImplementedError("no matrix is assembled over ranks")

    def committed(self, u: Array) -> MaterialState | None:
        """Material state of the cells at the end of the slab; None for an elastic body."""
        return self.cells.committed(self._at(u))

    def stored_energy(self, state: MaterialState | None, energy: float) -> float:
        """Stored energy [J] of the body in a state of the cells; ``energy`` [J] without one."""
        return energy if state is None else self._summed(state.stored)

    def dissipated_energy(self, state: MaterialState | None) -> float:
        """Energy dissipated from the start of the march up to a state of the cells [J]."""
        return 0.0 if state is None else self._summed(state.dissipated)

    def stored_viscous_force(self, state: MaterialState | None) -> Array | None:
        """Viscous part of the force in a state of the cells, (n, d) [N]; None without viscosity."""
        found = self.cells.stored_viscous_force(state)
        return None if found is None else self._added(found)

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points of the body."""
        return -float(self.ranks.greatest(np.array([-self.cells.volume_ratio(self._at(u))]))[0])

    @property
    def _viscous(self) -> bool:
        """True if a part of the stress is due to the mean rate."""
        return isinstance(self.cells.material, Damped)

    def _summed(self, density: Array) -> float:
        """Energy of the body [J] from densities (p,) at the points of the cells."""
        mine = point_totals(self.cells, density)[self.counted]
        return float(totalled(self.ranks, mine.reshape(-1, 1))[0])

    def _at(self, u: Array) -> Array:
        """Values (e a, ...) at the nodes of the cells of a field (n, ...)."""
        return np.take(u, self.corner, axis=0)

    def _added(self, values: Array) -> Array:
        """Values (n, ...) at own nodes from those (e a, ...) of the cells."""
        return np.asarray(self.adding @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeclaredForce:
    """What the force of a rank is made of: law and section of a solid."""

    material: Material
    section: Section


def declared(part: DiscreteSolid) -> DeclaredForce:
    """Law and section of a solid of one material."""
    cells = of_cells(part)
    return DeclaredForce(material=cells.material, section=cells.section)


def rank_force(part: DiscreteSolid, number: int, held: Holding, ranks: Ranks) -> RankForce:
    """Force of a rank from what is :func:`declared` of the solid with this number; see :class:`RankForce`."""
    ((kind, all_cells),) = part.mesh.blocks.items()
    internal = cast(DeclaredForce, part.internal)
    nodes = all_cells[held.cells[number]]
    first, last = np.searchsorted(held.nodes, [part.nodes.start, part.nodes.stop])
    corner, n = held.local(nodes.ravel() + part.nodes.start) - first, int(last - first)
    own = np.zeros(n, bool)
    own[held.own[(held.own >= first) & (held.own < last)] - first] = True
    numbered = np.arange(nodes.size).reshape(nodes.shape)
    apart = Mesh(points=part.mesh.points[nodes.ravel()], blocks={kind: numbered})
    force = force_of(apart, internal.material, internal.section, part.dilatation)
    assert isinstance(force, CellForce)
    onto = sp.csr_array((np.ones(len(corner)), corner, np.arange(len(corner) + 1)), shape=(len(corner), n))
    return RankForce(
        cells=_lean(force),
        corner=corner,
        adding=_adding(corner, own),
        counted=held.counted[number],
        ranks=ranks,
        sampling=replace(force.sampling, table=sp.csr_array(force.sampling.table @ onto)),
        table=row_table(corner.reshape(nodes.shape), own),
    )


def stored_rows(
    parts: Sequence[DiscreteSolid], u: Array, factor: float, viscous_factor: float
) -> tuple[sp.bsr_array, ...]:
    """Rows of each solid of a rank, see :meth:`RankForce.stored_rows`."""
    forces = [(cast(RankForce, part.internal), u[part.nodes]) for part in parts]
    return tuple(force.stored_rows(own, factor, viscous_factor) for force, own in forces)


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
