"""Internal force of a rank: its cells are evaluated one by one, and added at its own nodes in the order of all cells.

The cells of a rank overlap those of its neighbours, so that the forces on its own nodes are complete.  Their sum has
the same order on every partition: a node sees the same numbers in the same order.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Section
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce, elastic_force
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, SlabForce
from softway.meshes.mesh import Mesh
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding
from softway.ranks.space import totalled


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankForce:
    """Elastic force on the own nodes of a rank, zero on its copies of others; see
    :class:`~softway.bodies.internal_force.body_force.BodyForce`.

    Parameters
    ----------
    cells
        Force of the cells with nodes of their own, (e a, d).
    corner
        (e a,) local node of each of their nodes.
    adding
        (n, e a) sums at own nodes, in the order of the cells.
    lanes
        (e,) place of the energy of each cell that the rank counts.
    ranks
        The ranks.
    sampling
        Strain operator between local nodes and the points of the cells.
    """

    cells: ElasticForce
    corner: IntArray
    adding: sp.csr_array
    lanes: IntArray
    ranks: Ranks
    sampling: StrainOperator

    @property
    def linear(self) -> bool:
        """True if the tangent is constant."""
        return self.cells.linear

    @property
    def path_dependent(self) -> bool:
        """False: the force depends on the displacement alone."""
        return False

    @property
    def state(self) -> None:
        """None: an elastic body has no material state."""

    @property
    def section(self) -> Section:
        """Section of the elements."""
        return self.cells.section

    def during(self, state: object, span: float) -> "RankForce":
        """The force itself: it does not depend on the slab."""
        return self

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy of the body [J], a sum over all ranks, and force (n, d) [N]."""
        work = self.cells.work
        assert isinstance(work, KernelEvaluation)
        energies, force = work.energies_and_force(self._at(u))
        return float(totalled(self.ranks, energies[self.lanes].reshape(-1, 1))[0]), self._added(force)

    def end_force(self, u: Array) -> tuple[float, Array, None]:
        """:meth:`energy_and_force`, and None: the body has no viscosity."""
        return *self.energy_and_force(u), None

    def force(self, u: Array) -> Array:
        """Force (n, d) [N]."""
        return self._added(self.cells.force(self._at(u)))

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return self._added(self.cells.tangent_product(self._at(u), self._at(w)))

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks (n, d, d) [N/m] of the tangent."""
        return self._added(self.cells.tangent_diagonal_blocks(self._at(u)))

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force (n, d) averaged along the chord [N]; None for rules without a chord."""
        if not isinstance(rule, AverageField | DiscreteGradient):
            return None
        found = self.cells.slab_average(rule, self._at(u0), self._at(u1))
        return None if found is None else self._added(found)

    def tangent(self, u: Array) -> csc_array:
        """Refused: no matrix is assembled over ranks."""
        raise NotImplementedError("no matrix is assembled over ranks")

    def committed(self, u: Array) -> None:
        """None: an elastic body has no material state."""

    def stored_energy(self, state: object, energy: float) -> float:
        """The ``energy`` [J] itself: all of it is stored."""
        return energy

    def dissipated_energy(self, state: object) -> float:
        """Zero [J]."""
        return 0.0

    def stored_viscous_force(self, state: object) -> None:
        """None: the body has no viscosity."""

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points of the body."""
        return -float(self.ranks.greatest(np.array([-self.cells.volume_ratio(self._at(u))]))[0])

    def _at(self, u: Array) -> Array:
        """Values (e a, ...) at the nodes of the cells of a field (n, ...)."""
        return np.take(u, self.corner, axis=0)

    def _added(self, values: Array) -> Array:
        """Values (n, ...) at own nodes from those (e a, ...) of the cells."""
        return np.asarray(self.adding @ values.reshape(len(values), -1)).reshape(-1, *values.shape[1:])


def rank_force(internal: ElasticForce, whole: Mesh, held: Holding, ranks: Ranks) -> RankForce:
    """Force of a rank from that of the whole body; see :class:`RankForce`."""
    ((kind, all_cells),) = whole.blocks.items()
    nodes = all_cells[held.cells]
    corner, n = held.local(nodes.ravel()), len(held.nodes)
    numbered = np.arange(nodes.size).reshape(nodes.shape)
    apart = Mesh(points=whole.points[nodes.ravel()], blocks={kind: numbered})
    force = elastic_force(apart, internal.material, internal.section)
    assert isinstance(force.work, KernelEvaluation)
    onto = sp.csr_array((np.ones(len(corner)), corner, np.arange(len(corner) + 1)), shape=(len(corner), n))
    return RankForce(
        cells=force,
        corner=corner,
        adding=_adding(corner, held.own, n),
        lanes=force.work.lanes[: len(nodes)][held.counted],
        ranks=ranks,
        sampling=replace(force.sampling, table=sp.csr_array(force.sampling.table @ onto)),
    )


def _adding(corner: IntArray, own: IntArray, n: int) -> sp.csr_array:
    """Sums (n, e a) at own nodes of the values at the nodes of the cells, in their order; nothing at other nodes."""
    mask = np.zeros(n, bool)
    mask[own] = True
    mine = np.flatnonzero(mask[corner])
    order = mine[np.argsort(corner[mine], kind="stable")]
    start = np.concatenate([[0], np.cumsum(np.bincount(corner[mine], minlength=n))])
    return sp.csr_array((np.ones(len(order)), order, start), shape=(n, len(corner)))
