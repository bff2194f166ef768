"""The contact reaction of nodes with inertia: the multiplier that keeps the closed rows at rest.

    M a = load - f + G^T lambda,   G a = 0      =>      lambda = (G M^-1 G^T)^-1 G M^-1 (f - load)

and the mass-consistent jump ``J = -M^-1 G^T (G M^-1 G^T)^-1 G v``.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.contact.candidates import Candidates
from softway.model import Model
from softway.solve.along import Along
from softway.solve.frozen import Frozen, basis, freeze
from softway.solve.linear import SuperLU
from softway.solve.normal import balance
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reaction:
    """The mass matrix of the free components, factored, with the contact directions."""

    model: Model
    mass: Frozen

    def multiplier(self, rows: Candidates, force: Array, closed: BoolArray) -> Array:
        """Normal reaction (m,) of the closed rows for the internal force (n, d); zero on the others [N]."""
        index, active = self._active(rows, closed)
        out = np.zeros(len(closed))
        if len(index):
            pull = self.mass.solve((force - self.model.load)[self.model.free])
            out[index] = balance(self.mass, active, active.along(self.mass.sense(pull)))[0]
        return out

    def jump(self, rows: Candidates, approach: Array, closed: BoolArray) -> tuple[Array, Array]:
        """Velocity jump (n, d) and impulses (m,) that bring the closed rows from ``approach`` (m,) to rest."""
        index, active = self._active(rows, closed)
        out, impulse = np.zeros(self.model.shape), np.zeros(len(closed))
        if len(index):
            impulse[index], push = balance(self.mass, active, -approach[index])
            out[self.model.free] = self.mass.solve(self.mass.basis.directions @ push.directions)
        return out, impulse

    def _active(self, rows: Candidates, closed: BoolArray) -> tuple[IntArray, Along]:
        """The closed rows that can move (k,), along the directions."""
        index = np.flatnonzero(closed & rows.reachable(self.model.free))
        return index, self.mass.coefficients(rows, self.model.free).part(index)


def reaction(model: Model) -> Reaction:
    """Factor the mass of a model whose nodes all carry inertia."""
    d = model.shape[1]
    keep = np.flatnonzero(model.free.ravel())
    mass = sp.csc_array(sp.kron(model.mass, sp.eye_array(d), format="csc")[keep][:, keep])
    directions = basis(model.rows(model.displacement), model.free, model.encounters.fixed, model.touchable)
    return Reaction(model=model, mass=freeze(mass, directions, SuperLU()))
