"""Accelerations from forces by the inverse mass matrix, with divisions where it is diagonal."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.model.model import Model
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.linear.interface import Factor


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MassSolver:
    """Inverse of the mass on the free components of the nodes with inertia.

    Parameters
    ----------
    inverse
        (n, d) reciprocals of uncoupled diagonal masses; zero elsewhere.
    coupled
        For each set of components with the same free nodes: the components, the nodes (k,), their factored mass.
    """

    inverse: Array
    coupled: tuple[tuple[IntArray, IntArray, Factor], ...]

    def acceleration(self, force: Array) -> Array:
        """Acceleration (n, d) by a force (n, d); zero on supports and on massless nodes."""
        out = self.inverse * force
        for components, nodes, factor in self.coupled:
            place = np.ix_(nodes, components)
            out[place] = factor.solve(np.ascontiguousarray(force[place]))
        return np.asarray(out)


def mass_solver(model: Model) -> MassSolver:
    """:class:`MassSolver` of a model."""
    mass = sp.csr_array(model.mass)
    lone = (np.diff(sp.csr_array(mass - sp.diags_array(mass.diagonal())).tocsr().indptr) == 0) | ~model.massive
    moving = model.free & model.massive[:, None]
    with np.errstate(divide="ignore"):
        inverse = np.where(moving & lone[:, None], 1.0 / mass.diagonal()[:, None], 0.0)
    sets, of = np.unique(moving & ~lone[:, None], axis=1, return_inverse=True)
    coupled = []
    for k, mask in enumerate(sets.T):
        nodes = np.flatnonzero(mask)
        if len(nodes):
            factor = SuperLU().factor(sp.csc_array(mass[nodes][:, nodes]))
            coupled.append((np.flatnonzero(of.ravel() == k), nodes, factor))
    return MassSolver(inverse=inverse, coupled=tuple(coupled))
