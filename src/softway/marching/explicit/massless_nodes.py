"""Massless nodes in a slab of central differences, and their residual forces."""

from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.contact_layer import Layer
from softway.bodies.assembled.material_states import any_path_dependent, during
from softway.contact.contact_rows import ContactRows
from softway.model.model import Model
from softway.solve.linear.interface import Factor
from softway.solve.operators.factored import MANY, cost, suited
from softway.solve.operators.operator_memory import OperatorOrigin


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MasslessNodes:
    """Free massless components (n, d), and the cells around their nodes.

    ``nodes`` (n,) are these nodes, ``where`` (f,) the places of the components in a flat field (n d,).
    """

    light: BoolArray
    layer: Layer
    nodes: BoolArray = field(init=False)
    where: IntArray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", self.light.any(axis=1))
        object.__setattr__(self, "where", np.flatnonzero(self.light))

    def restrict(self, values: Array) -> Array:
        """Massless components (f,) of a field (n, d)."""
        return values.ravel().take(self.where)

    def moved(self, values: Array, change: Array) -> Array:
        """Field (n, d) with the massless components changed by ``change`` (f,)."""
        out = values.copy()
        out.ravel()[self.where] += change
        return out

    def during(self, model: Model) -> "MasslessNodes":
        """Massless nodes with the material states of the model in its slab."""
        return replace(self, layer=self.layer.during(model.parts)) if any_path_dependent(model.parts) else self

    def factored(self, model: Model, origin: OperatorOrigin, crude: bool = False) -> tuple[Factor, float]:
        """Factor of their stiffness at the origin of an operator, and its price in iterations.

        A ``crude`` factor, for corrections with a known residual, has single precision if that is cheaper.
        """
        then = self.layer.during(during(model.parts, origin.states, origin.span))
        matrix = then.tangent(origin.at, self.light)
        single = crude and not model.linear and matrix.shape[0] >= MANY
        factor = suited(matrix.shape[0], "single" if single else "double").factor(matrix)
        return factor, cost(factor, matrix.shape[0])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FollowedNodes:
    """Components that the massless ones follow: their places ``where`` (k,) in a flat field (n d,), and their
    ``weights`` (k, f).
    """

    where: IntArray
    weights: sp.csr_array

    @classmethod
    def of(cls, model: Model, still: MasslessNodes) -> "FollowedNodes":
        """Components of a model that its massless nodes follow."""
        each = sp.csr_array(sp.kron(model.follow, sp.eye_array(model.shape[1]), format="csr"))
        weights = sp.csr_array(each[still.where].T)
        where = np.flatnonzero(np.diff(weights.indptr))
        return cls(where=where, weights=sp.csr_array(weights[where]))


def pushed_nodes(still: MasslessNodes, load: Array, rows: ContactRows, pressure: Array, traction: Array) -> Array:
    """Forces (f,) of loads (n, d) and of contact, (m,) and (m, d) on rows, on massless components [N]."""
    out = still.restrict(load)
    if pressure.any():
        out += still.restrict(rows.spread(pressure, load.shape))
    return out + still.restrict(rows.shear.spread(traction)) if rows.shear.count else out


def handed_forces(followed: FollowedNodes, still: MasslessNodes, force: Array, outer: Array) -> tuple[Array, Array]:
    """Internal force (n, d) with the residual forces of massless components transferred to the nodes that they follow,
    and these residual forces (f,) [N].

    ``outer`` (f,) are the external forces on the massless components.
    """
    missing, out = still.restrict(force) - outer, force.copy()
    flat = out.ravel()
    flat[still.where] = outer
    flat[followed.where] += followed.weights @ missing
    return out, missing
