"""Solids with a temperature at a displacement: what their strain stores, and its forces."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.material_states import MaterialStates
from softway.heat.coupled.strain.expansion import Expansion, Strained, strained
from softway.heat.coupled.strain.stored import ElasticTerm, StoredEnergies, stored_energies


def beside_law(potentials: Array) -> Array:
    """What potentials (2, ...) add to those of the law itself, whose energy and force the motion has.

    Examples
    --------
    >>> beside_law(np.array([[-10.0], [0.75]])).tolist()
    [[-10.0], [-0.25]]
    """
    return np.stack([potentials[0], potentials[1] - 1.0])


@dataclass(frozen=True, slots=True, eq=False)
class Deformed:
    """Solids with n nodes at a displacement."""

    strained: Strained
    stored: StoredEnergies

    def amounts(self) -> Array:
        """Energy that a free strain of one would take and elastic energy, (2, n) at the nodes [J]."""
        return np.stack([self.strained.held(), self.stored.nodal()])

    def forces(self, potentials: Array, dim: int) -> Array:
        """Forces (c, n, d) [N] that each of the potentials (c, 2, n) adds to those of the law."""
        out = self.strained.forces(-potentials[:, 0], dim)
        if self.stored.terms:
            for one, potential in zip(out, potentials, strict=True):
                one += self.stored.force(beside_law(potential)[1], dim)
        return out

    def force(self, potentials: Array, dim: int) -> Array:
        """Forces (n, d) [N] that potentials (2, n) add to those of the law."""
        found: Array = self.forces(potentials[None], dim)[0]
        return found


def deformed(
    expansions: tuple[Expansion, ...], elastic: tuple[ElasticTerm, ...], u: Array, states: MaterialStates
) -> Deformed:
    """Solids in material states at the displacement ``u`` (n, d) [m]."""
    return Deformed(strained(expansions, u, states), stored_energies(elastic, u, states))


def added_stress(
    terms: tuple[tuple[Expansion, ...], tuple[ElasticTerm, ...]],
    solid: str,
    cells: int,
    potentials: Array,
    u: Array,
    states: MaterialStates,
) -> Array:
    """Mean stress (cells, 3, 3) [Pa] that potentials (2, n) add to that of the law of a ``solid``, at the displacement
    ``u`` (n, d) [m] of all solids in material states; of expansions and elastic ``terms``.
    """
    expansions, elastic = terms
    out = np.zeros((cells, 3, 3))
    for expansion in expansions:
        if expansion.solid == solid:
            out[expansion.cells] = expansion.stress(-potentials[0], potentials[1], u, states)
    for term in elastic:
        if term.solid == solid:
            out[term.cells] += term.stress(beside_law(potentials)[1], u, states)
    return out
