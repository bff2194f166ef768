"""Elastic energy at the nodes of solids whose moduli depend on the temperature, and the forces of a part of it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.errors import InputError
from softway.heat.coupled.strain.expansion import pieces, point_values


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Elastic:
    """Elements of one law with a stored energy.

    Parameters
    ----------
    solid
        Name of the solid.
    cells
        (e,) their numbers in the solid.
    nodes
        (k,) their nodes among those of all solids.
    values
        (p, k) shape functions at the quadrature points.
    internal
        Their internal force.
    """

    solid: str
    cells: IntArray
    nodes: IntArray
    values: csr_array
    internal: ElasticForce

    def stress(self, weight: Array, u: Array) -> Array:
        """Mean Cauchy stress (e, 3, 3) [Pa] of the law times weights (n,) of the nodes, at ``u`` (n, d)."""
        plain = self.internal.plain
        sigma, ratio = plain.points.cauchy(plain.derivatives(u[self.nodes]))
        weighted = (self.values @ weight[self.nodes])[:, None, None] * sigma
        return plain.sampling.cell_means(weighted, ratio * plain.sampling.volume)


@dataclass(frozen=True, slots=True, eq=False)
class StoredEnergies:
    """Solids with n nodes at a displacement: of each term that (k, d) of its nodes, the energy (p,) [J/m^3] and the
    flux (p, m, D) [Pa].
    """

    terms: tuple[Elastic, ...]
    own: tuple[Array, ...]
    found: tuple[tuple[Array, Array], ...]
    n: int

    def nodal(self) -> Array:
        """Energy (n,) at the nodes [J]."""
        out = np.zeros(self.n)
        for it, (energy, _) in zip(self.terms, self.found, strict=True):
            out[it.nodes] += it.values.T @ (it.internal.sampling.volume * energy)
        return out

    def force(self, weight: Array, dim: int) -> Array:
        """Forces (n, d) [N] of the energy times weights (n,) of the nodes."""
        out = np.zeros((self.n, dim))
        for it, own, (_, flux) in zip(self.terms, self.own, self.found, strict=True):
            at = (it.values @ weight[it.nodes])[:, None, None]
            out[it.nodes] += it.internal.sampling.nodal(at * flux, own)
        return out


def stored_energies(terms: tuple[Elastic, ...], u: Array) -> StoredEnergies:
    """Energies of some ``terms`` at the displacement ``u`` (n, d) [m]."""
    own = tuple(u[it.nodes] for it in terms)
    plain = (it.internal.plain for it in terms)
    found = tuple(p.points.energy_and_flux(p.derivatives(mine)) for p, mine in zip(plain, own, strict=True))
    return StoredEnergies(terms, own, found, len(u))


def elastic_terms(part: DiscreteSolid) -> Iterator[Elastic]:
    """Elements of the laws of a solid whose moduli depend on the temperature.

    Raises
    ------
    InputError
        If a law has no stored energy.
    """
    whole = point_values(part)
    for region, cells, nodes, points, internal, law in pieces(part):
        if not isinstance(internal, ElasticForce):
            problem = f"moduli of {type(law).__name__}{f' in {region}' if region else ''}, which has a history"
            raise InputError("thermal.stiffness", problem, "none, or a law with a stored energy such as Hencky")
        yield Elastic(
            solid=part.name, cells=cells, nodes=nodes + part.nodes.start, values=csr_array(whole[points][:, nodes]),
            internal=internal,
        )  # fmt: skip
