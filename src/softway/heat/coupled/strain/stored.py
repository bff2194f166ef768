"""Elastic energy at the nodes of solids whose moduli depend on the temperature, and the forces of a part of it."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import MaterialStates, own_state
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce
from softway.bodies.internal_force.material_state import MaterialState
from softway.errors import InputError, within
from softway.heat.coupled.strain.expansion import pieces, point_values
from softway.kernels.linalg import tensors
from softway.laws.bulk import J2, NortonHoff
from softway.laws.law import Material, Scalable


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

    def energy_and_flux(self, u: Array, states: MaterialStates) -> tuple[Array, Array]:
        """Energy (p,) [J/m^3] and flux (p, m, D) [Pa] at the displacement ``u`` (n, d) of all solids."""
        plain = self.internal.plain
        return plain.points.energy_and_flux(plain.derivatives(u[self.nodes]))

    def stress(self, weight: Array, u: Array, states: MaterialStates) -> Array:
        """Mean Cauchy stress (e, 3, 3) [Pa] of the law times weights (n,) of the nodes, at ``u`` (n, d)."""
        plain = self.internal.plain
        sigma, ratio = plain.points.cauchy(plain.derivatives(u[self.nodes]))
        weighted = (self.values @ weight[self.nodes])[:, None, None] * sigma
        return plain.sampling.cell_means(weighted, ratio * plain.sampling.volume)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Historic:
    """Elements of one law with a history; parameters as of :class:`Elastic`.

    Parameters
    ----------
    number, region
        Number of the solid, and name of its region; empty for a solid of one law.
    """

    solid: str
    number: int
    region: str
    cells: IntArray
    nodes: IntArray
    values: csr_array
    internal: InelasticForce

    def energy_and_flux(self, u: Array, states: MaterialStates) -> tuple[Array, Array]:
        """Energy (p,) [J/m^3] stored since the start of the march, and flux (p, m, D) [Pa], in the states."""
        state = own_state(states, self.number, self.region)
        H, F = self._gradients(state)
        return state.stored, self.internal.points.body_flux(_elastic_stress(state), F, H, state.eigenstrain)

    def stress(self, weight: Array, u: Array, states: MaterialStates) -> Array:
        """Mean Cauchy stress (e, 3, 3) [Pa] of the law times weights (n,) of the nodes, in the states."""
        state, sampling = own_state(states, self.number, self.region), self.internal.sampling
        weighted = (self.values @ weight[self.nodes])[:, None, None] * _elastic_stress(state)
        return sampling.cell_means(weighted, tensors.determinant(self._gradients(state)[1]) * sampling.volume)

    def _gradients(self, state: MaterialState) -> tuple[Array, Array]:
        """Displacement derivatives (p, m, D) and deformation gradients (p, 3, 3) of a state."""
        H = self.internal.sampling.derivatives(state.displacement)
        return H, self.internal.points.gradient(H, state.lateral)


ElasticTerm = Elastic | Historic


def _elastic_stress(state: MaterialState) -> Array:
    """Stress (p, 3, 3) without the viscous part, whose viscosity has no factor [Pa]."""
    return state.stress if state.viscous is None else state.stress - state.viscous


@dataclass(frozen=True, slots=True, eq=False)
class StoredEnergies:
    """Solids with n nodes at a displacement: of each term that (k, d) of its nodes, the energy (p,) [J/m^3] and the
    flux (p, m, D) [Pa].
    """

    terms: tuple[ElasticTerm, ...]
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


def stored_energies(terms: tuple[ElasticTerm, ...], u: Array, states: MaterialStates) -> StoredEnergies:
    """Energies of some ``terms`` in material states at the displacement ``u`` (n, d) [m]."""
    own = tuple(u[it.nodes] for it in terms)
    return StoredEnergies(terms, own, tuple(it.energy_and_flux(u, states) for it in terms), len(u))


def elastic_terms(number: int, part: DiscreteSolid, least: float) -> Iterator[ElasticTerm]:
    """Elements of the laws of the solid of this ``number``, whose moduli have a factor of the temperature.

    Parameters
    ----------
    number, part
        The solid.
    least
        Least factor in its table.

    Raises
    ------
    InputError
        If a law with a history knows no factor of its moduli, or its stress falls faster than the least ones allow.
    """
    whole = point_values(part)
    for region, cells, nodes, points, internal, law in pieces(part):
        place = {"solid": part.name, "cells": cells, "nodes": nodes + part.nodes.start}
        values = csr_array(whole[points][:, nodes])
        if isinstance(internal, ElasticForce):
            yield Elastic(**place, values=values, internal=internal)
        else:
            _require_scalable(law, region, least)
            assert isinstance(internal, InelasticForce)
            yield Historic(**place, number=number, region=region, values=values, internal=internal)


def _require_scalable(law: Material, region: str, least: float) -> None:
    """Refuse laws with a history whose moduli cannot have a factor down to the ``least``."""
    if not isinstance(law, Scalable):
        problem = f"{type(law).__name__}{f' in {region}' if region else ''} knows no factor of its moduli"
        known = "J2, Maxwell, Kelvin, Hypoelastic, or one with a stored energy"
        own = "softening of its consistency" if isinstance(law, NortonHoff) else "none"
        raise InputError("thermal.stiffness", problem, f"{own}, or {known}")
    if isinstance(law, J2):
        with within(f"material.{region}" if region else "material"):
            replace(law, E=least * law.E, kinematic=least * law.kinematic)
