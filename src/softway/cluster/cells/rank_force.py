"""Internal force of a rank: the sum over the materials of a solid, each with the cells that the rank computes.

The cells of a rank overlap those of its neighbours, so that the forces on its own nodes are complete.  Their sum has
the same order on every partition: a node sees the same numbers in the same order.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import Section
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.material_state import MaterialState, regional_history
from softway.bodies.internal_force.slab_average import SlabForce
from softway.cluster.cells.piece_force import PieceForce, joined_sampling, piece_force
from softway.cluster.cells.pieces import Piece, of_solid
from softway.cluster.cells.rank_mesh import own_mask
from softway.cluster.cells.stored_rows import RowTable, row_table
from softway.ranks.interface import Ranks
from softway.ranks.partition import Holding
from softway.ranks.space import totalled


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RankForce:
    """Force on the own nodes of a rank, zero on its copies of others: what a march over ranks asks of a
    :class:`~softway.bodies.internal_force.body_force.BodyForce`, with :meth:`stored_rows` in place of a matrix.

    Parameters
    ----------
    pieces
        Forces of the materials of the solid.
    ranks
        The ranks.
    sampling
        Strain operator between local nodes and the points of the cells.
    table
        Places of the blocks of the cells in the rows of own nodes.
    """

    pieces: tuple[PieceForce, ...]
    ranks: Ranks
    sampling: StrainOperator
    table: RowTable

    @property
    def linear(self) -> bool:
        """True if the tangent is constant."""
        return all(piece.cells.linear for piece in self.pieces)

    @property
    def path_dependent(self) -> bool:
        """True if the force depends on a material state."""
        return any(piece.cells.path_dependent for piece in self.pieces)

    @property
    def state(self) -> MaterialState | None:
        """Material state of the cells at the start of the slab; None for an elastic body."""
        found = {p.region: p.cells.state for p in self.pieces if p.cells.state is not None}
        shape = self.sampling.table.shape[1], self.pieces[0].cells.sampling.rows[0].shape[3]
        return self._of_solid(found, np.zeros(shape), 0.0)

    @property
    def section(self) -> Section:
        """Section of the elements."""
        return self.pieces[0].cells.section

    def during(self, state: MaterialState | None, span: float) -> "RankForce":
        """Force in a slab of length ``span`` [s] that starts from a state of the cells; the force itself without."""
        return self if state is None else replace(self, pieces=tuple(p.during(state, span) for p in self.pieces))

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Energy of the body [J], a sum over all ranks, and force (n, d) [N]."""
        found = [piece.energies_and_force(u) for piece in self.pieces]
        total = self._summed([energies for energies, _ in found])
        return total if np.isfinite(total) else np.inf, _sum([force for _, force in found])

    def end_force(self, u: Array) -> tuple[float, Array, Array | None]:
        """:meth:`energy_and_force`, and the part of the force due to the mean rate; None without viscosity."""
        return *self.energy_and_force(u), self._some(lambda piece: piece.viscous_force(u))

    def force(self, u: Array) -> Array:
        """Force (n, d) [N]."""
        return _sum([piece.force(u) for piece in self.pieces])

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent with w (n, d) [m]."""
        return _sum([piece.tangent_product(u, w) for piece in self.pieces])

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks (n, d, d) [N/m] of the tangent."""
        return _sum([piece.tangent_diagonal_blocks(u) for piece in self.pieces])

    def stored_rows(self, u: Array, factor: float, viscous_factor: float) -> sp.bsr_array:
        """Rows (n d, n d) at own nodes of ``factor`` times the tangent and its viscous part [N/m]."""
        return self.table.rows((piece.matrices(u, factor, viscous_factor) for piece in self.pieces), u.shape[1])

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force (n, d) averaged along the chord [N]; None for rules without a chord."""
        return self._some(lambda piece: piece.slab_average(rule, u0, u1))

    def committed(self, u: Array) -> MaterialState | None:
        """Material state of the cells at the end of the slab; None for an elastic body."""
        found = {p.region: state for p in self.pieces if (state := p.committed(u)) is not None}
        elastic = [p for p in self.pieces if not p.cells.path_dependent]
        energy = self._summed([p.energies_and_force(u)[0] for p in elastic]) if found and elastic else 0.0
        return self._of_solid(found, u.copy(), energy)

    def stored_energy(self, state: MaterialState | None, energy: float) -> float:
        """Stored energy [J] of the body in a state of the cells; ``energy`` [J] without one."""
        if state is None:
            return energy
        found = [p.totals(own.stored) for p in self.pieces if (own := p.own(state)) is not None]
        return self._summed(found) + state.elastic

    def dissipated_energy(self, state: MaterialState | None) -> float:
        """Energy dissipated from the start of the march up to a state of the cells [J]."""
        found = [p.totals(own.dissipated) for p in self.pieces if (own := p.own(state)) is not None]
        return self._summed(found) if found else 0.0

    def stored_viscous_force(self, state: MaterialState | None) -> Array | None:
        """Viscous part of the force in a state of the cells, (n, d) [N]; None without viscosity."""
        return self._some(lambda piece: piece.stored_viscous_force(state))

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points of the body."""
        least = min(piece.volume_ratio(u) for piece in self.pieces)
        return -float(self.ranks.greatest(np.array([-least]))[0])

    def _of_solid(self, states: dict[str, MaterialState], u: Array, elastic: float) -> MaterialState | None:
        """State of the solid at u (n, d) from those of its materials with a history; None without any.

        ``elastic`` is the stored energy of the other materials [J].
        """
        if not states or "" in states:
            return states.get("")
        return regional_history(u, states, elastic)

    def _summed(self, energies: Sequence[Array]) -> float:
        """Energy of the body [J] from those of the counted cells of some pieces."""
        return float(totalled(self.ranks, np.concatenate(energies).reshape(-1, 1))[0])

    def _some(self, of: Callable[[PieceForce], Array | None]) -> Array | None:
        """Field (n, d) from those pieces that have one; None if none has."""
        found = [field for piece in self.pieces if (field := of(piece)) is not None]
        return _sum(found) if found else None


def _sum(fields: Sequence[Array]) -> Array:
    """Sum of fields, one after another."""
    out = fields[0]
    for field in fields[1:]:
        out = out + field
    return out


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeclaredForce:
    """What a rank reads of the force of a whole solid: its section."""

    section: Section


def rank_force(solid: int, part: DiscreteSolid, pieces: tuple[Piece, ...], held: Holding, ranks: Ranks) -> RankForce:
    """Force of a rank for the solid with this number, of which it reads no tables; see :class:`RankForce`."""
    numbers = of_solid(pieces, solid)
    found = tuple(piece_force(pieces[k], part, held.cells[k], held.counted[k], held) for k in numbers)
    corners = [piece.corner.reshape(-1, pieces[numbers[0]].corners.shape[1]) for piece in found]
    return RankForce(
        pieces=found, ranks=ranks, sampling=joined_sampling(found), table=row_table(corners, own_mask(part.nodes, held))
    )


def stored_rows(
    parts: Sequence[DiscreteSolid], u: Array, factor: float, viscous_factor: float
) -> tuple[sp.bsr_array, ...]:
    """Rows of each solid of a rank, see :meth:`RankForce.stored_rows`."""
    forces = [(cast(RankForce, part.internal), u[part.nodes]) for part in parts]
    return tuple(force.stored_rows(own, factor, viscous_factor) for force, own in forces)
