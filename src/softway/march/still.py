"""The nodes without inertia in a slab of central differences, and what keeps them from equilibrium."""

from dataclasses import dataclass, field, replace

import numpy as np

from softway.bodies.layer import Layer
from softway.bodies.past import during, remembering
from softway.contact.candidates import Candidates
from softway.model import Model
from softway.solve.carry import Origin
from softway.solve.linear import Factor
from softway.solve.operators.factored import cost, suited
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
        return values.ravel()[self.where]

    def moved(self, values: Array, change: Array) -> Array:
        """A field (n, d) whose components are changed by so much (f,)."""
        out = values.copy()
        out.ravel()[self.where] += change
        return out

    def during(self, model: Model) -> "Still":
        """The same in the slab in which the bodies of the model stand."""
        return replace(self, layer=self.layer.during(model.parts)) if remembering(model.parts) else self

    def factored(self, model: Model, origin: Origin) -> tuple[Factor, float]:
        """The factor of their stiffness as it was somewhere, and its price in iterations."""
        then = self.layer.during(during(model.parts, origin.memory, origin.span))
        matrix = then.tangent(origin.at, self.light)
        factor = suited(matrix.shape[0]).factor(matrix)
        return factor, cost(factor, matrix.shape[0])


def pushed(rows: Candidates, pressure: Array | None, traction: Array | None, shape: tuple[int, int]) -> Array:
    """Nodal forces (n, d) of contact forces (m,) and (m, d) on rows [N]."""
    out = np.zeros(shape) if pressure is None else rows.spread(pressure, shape)
    return out if traction is None or rows.shear is None else out + rows.shear.spread(traction)


def handed(model: Model, still: Still, force: Array, outer: Array) -> tuple[Array, Array]:
    """The internal force (n, d) with what keeps components without inertia from equilibrium with the ``outer`` forces
    (n, d) handed to the nodes that they follow, and that, (f,) [N].
    """
    missing, left = still.of(force) - still.of(outer), np.zeros_like(force)
    left.ravel()[still.where] = missing
    return np.asarray(still.moved(force, -missing) + model.follow.T @ left), missing
