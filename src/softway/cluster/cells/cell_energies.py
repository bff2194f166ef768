"""Energies of cells one by one: sums over them have the same bits for every distribution of the cells."""

import numpy as np

from softway.arrays import Array
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce

CellForce = ElasticForce | InelasticForce
"""Force of cells of one type with nodes of their own."""


def cell_energies_and_force(cells: CellForce, u: Array) -> tuple[Array, Array]:
    """Energy (e,) of each cell [J] and forces (e a, d) [N] of :meth:`BodyForce.energy_and_force
    <softway.bodies.internal_force.body_force.BodyForce.energy_and_force>` at u (e a, d) [m].

    With a history the energies are those of the state that the cells reach, and what they dissipate on the way.
    """
    if isinstance(cells, InelasticForce):
        after = cells.committed(u)
        taken = after.stored + (after.dissipated - cells.state.dissipated)
        return point_totals(cells, taken), cells.force(u)
    if isinstance(cells.work, KernelEvaluation):
        energies, force = cells.work.energies_and_force(u)
        return energies[cells.work.lanes[: _count(cells)]], force
    return point_totals(cells, cells.plain.points.energy(cells.plain.derivatives(u))), cells.force(u)


def point_totals(cells: CellForce, density: Array) -> Array:
    """Sums (e,) over the points of each cell of a density (p,) times their volume."""
    return np.asarray((density * cells.sampling.volume).reshape(_count(cells), -1).sum(axis=1))


def _count(cells: CellForce) -> int:
    """Number e of cells."""
    (table,) = cells.sampling.rows
    return len(table)
