"""The contact reaction of nodes with inertia: the multiplier that keeps the closed rows at rest.

    M a = load - f + G^T lambda,   G a = 0      =>      lambda = (G M^-1 G^T)^-1 G M^-1 (f - load)

and the mass-consistent jump ``J = -M^-1 G^T (G M^-1 G^T)^-1 G v``.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.kernels.dense import shared
from softway.model import Model
from softway.solve.frozen import Frozen, freeze
from softway.solve.linear import SuperLU
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reaction:
    """The mass matrix of the free components, factored, with the contact rows."""

    model: Model
    mass: Frozen

    def multiplier(self, force: Array, closed: BoolArray) -> Array:
        """Normal reaction (m,) of the closed rows for the internal force (n, d); zero on the others [N]."""
        index = np.flatnonzero(closed & self.model.candidates.reachable(self.model.free))
        out = np.zeros(len(closed))
        if len(index):
            pull = self.mass.rows @ self.mass.solve((force - self.model.load)[self.model.free])
            out[index] = shared(self.mass.delassus(index), pull[index])
        return out

    def jump(self, approach: Array, closed: BoolArray) -> tuple[Array, Array]:
        """Velocity jump (n, d) and impulses (m,) that bring the closed rows from ``approach`` (m,) to rest."""
        index = np.flatnonzero(closed & self.model.candidates.reachable(self.model.free))
        out, impulse = np.zeros(self.model.shape), np.zeros(len(closed))
        if len(index):
            impulse[index] = shared(self.mass.delassus(index), -approach[index])
            out[self.model.free] = self.mass.solve(self.mass.rows.T @ impulse)
        return out, impulse


def reaction(model: Model) -> Reaction:
    """Factor the mass of a model whose nodes all carry inertia."""
    d = model.shape[1]
    keep = np.flatnonzero(model.free.ravel())
    mass = sp.csc_array(sp.kron(model.mass, sp.eye_array(d), format="csc")[keep][:, keep])
    return Reaction(model=model, mass=freeze(mass, model.candidates.matrix(model.free), SuperLU()))
