"""Matrix of a slab: inertia and stiffness of the unknowns."""

from dataclasses import dataclass

import scipy.sparse as sp

from softway.arrays import Array
from softway.model.model import Model
from softway.solve.linear.pattern import sum_within


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabMatrix:
    """Matrix ``M + stiffness_factor K(u)`` of a model with its history variables at the start of the slab.

    Parameters
    ----------
    model
        Model in the slab.
    stiffness_factor
        Factor of the stiffness [s^2].
    viscous_factor
        Additional weight of the viscous stiffness, exact for nodes with inertia.
    positive_definite
        True if its factor has to be that of a positive definite matrix, see
        :func:`~softway.solve.operators.positive_definite.positive_definite_factor`.
    damping
        (f, f) additional stiffness, of dashpots over the slab; None without.
    """

    model: Model
    stiffness_factor: float
    viscous_factor: float
    positive_definite: bool = False
    damping: sp.csc_array | None = None

    def operator(self, u: Array, secant: bool = False) -> sp.csc_array:
        """Matrix (f, f) at the displacement u (n, d), symmetric positive definite near equilibrium."""
        matrix = self.model.inertia_and_stiffness(u, self.stiffness_factor, secant, self.viscous_factor)
        return matrix if self.damping is None else sum_within(matrix, self.stiffness_factor * self.damping)
