"""The nodes without inertia in a slab of central differences, and what keeps them from equilibrium."""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from softway.bodies.layer import Layer
from softway.bodies.past import during, remembering
from softway.contact.candidates import Candidates
from softway.model import Model
from softway.solve.carry import Origin
from softway.solve.linear import Factor
from softway.solve.operators.factored import MANY, cost, suited
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Still:
    """Components (n, d) without inertia that no support holds, and the cells around their nodes.

    ``nodes`` (n,) are these nodes, ``where`` (f,) the places of the components in a field (n, d) as it is stored.
    """

    light: BoolArray
    layer: Layer
    nodes: BoolArray = field(init=False)
    where: IntArray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", self.light.any(axis=1))
        object.__setattr__(self, "where", np.flatnonzero(self.light))

    def of(self, values: Array) -> Array:
        """The components (f,) of a field (n, d)."""
        return values.ravel().take(self.where)

    def moved(self, values: Array, change: Array) -> Array:
        """A field (n, d) whose components are changed by so much (f,)."""
        out = values.copy()
        out.ravel()[self.where] += change
        return out

    def during(self, model: Model) -> "Still":
        """The same in the slab in which the bodies of the model stand."""
        return replace(self, layer=self.layer.during(model.parts)) if remembering(model.parts) else self

    def factored(self, model: Model, origin: Origin, crude: bool = False) -> tuple[Factor, float]:
        """The factor of their stiffness as it was somewhere, and its price in iterations.

        A ``crude`` one, for corrections whose remainder is known, is of single precision where that is cheaper.
        """
        then = self.layer.during(during(model.parts, origin.memory, origin.span))
        matrix = then.tangent(origin.at, self.light)
        single = crude and not model.linear and matrix.shape[0] >= MANY
        factor = suited(matrix.shape[0], "single" if single else "double").factor(matrix)
        return factor, cost(factor, matrix.shape[0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Followed:
    """The components that those without inertia follow: their places ``where`` (k,) in a field (n, d) as it is stored,
    and their ``weights`` (k, f).
    """

    where: IntArray
    weights: sp.csr_array

    @classmethod
    def of(cls, model: Model, still: Still) -> "Followed":
        """Those of a model."""
        each = sp.csr_array(sp.kron(model.follow, sp.eye_array(model.shape[1]), format="csr"))
        weights = sp.csr_array(each[still.where].T)
        where = np.flatnonzero(np.diff(weights.indptr))
        return cls(where=where, weights=sp.csr_array(weights[where]))


def pushed(still: Still, load: Array, rows: Candidates, pressure: Array | None, traction: Array | None = None) -> Array:
    """Forces (f,) of loads (n, d) and of contact, (m,) and (m, d) on rows, on components without inertia [N]."""
    out = still.of(load)
    if pressure is not None and pressure.any():
        out += still.of(rows.spread(pressure, load.shape))
    return out if traction is None or rows.shear is None else out + still.of(rows.shear.spread(traction))


def handed(followed: Followed, still: Still, force: Array, outer: Array) -> tuple[Array, Array]:
    """The internal force (n, d) with what keeps components without inertia from equilibrium with the ``outer`` forces
    (f,) handed to the nodes that they follow, and that, (f,) [N].
    """
    missing, out = still.of(force) - outer, force.copy()
    flat = out.ravel()
    flat[still.where] = outer
    flat[followed.where] += followed.weights @ missing
    return out, missing
