"""Balance of angular momentum of a group of bodies over a slab, closed by one vector."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.assembled.vector_space import VectorSpace
from softway.model.model import Model
from softway.solve.equations.end_forces import EndForces


def middle(model: Model, ends: EndForces, members: BoolArray) -> Array:
    """Positions (n, d) in the middle of the slab, relative to the mean of the nodes of a group."""
    here = members[model.part_of]
    x = model.points + 0.5 * (ends.u0 + ends.u1)
    return np.asarray(x - model.space.among(here).sums(x[here]) / model.space.total(here))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SpinBalance:
    """Rotations (k) of one group: force fields (k, n, d), inertia (k, k), torque (k,) and its derivative to a (k,)."""

    space: VectorSpace
    fields: Array
    inertia: Array
    torque: Array
    slope: Array

    def solve(self, torque: Array) -> Array:
        """Vector b (k,) for a torque."""
        return np.asarray(np.linalg.lstsq(self.inertia, torque, rcond=1e-12)[0]) if len(torque) else torque

    def work(self, moving: Array) -> Array:
        """Work (k,) of the unit fields."""
        return self.space.works(self.fields, moving)

    def force(self, b: Array) -> Array:
        """Force field (n, d) of a vector b (k,)."""
        return np.einsum("k,kni->ni", b, self.fields)


def spin_balance(model: Model, ends: EndForces, members: BoolArray) -> SpinBalance:
    """Rotations of the bodies of a group."""
    here, x = members[model.part_of], middle(model, ends, members)
    arm = np.zeros_like(x)
    weight = np.asarray(model.mass.sum(axis=1)).reshape(-1, 1)
    for part in (p for p, inside in zip(model.parts, members, strict=True) if inside):
        rows, space = part.nodes, model.space.among(part.nodes)
        arm[rows] = x[rows] - space.sums(weight[rows] * x[rows]) / space.total(weight[rows])
    fields = np.array([model.mass @ f for f in _turned(arm)]).reshape(-1, *arm.shape)
    inner = here & model.massive
    rigid = model.against_tool[model.contacts.contact]
    tools = [rows.spread(np.where(rigid & rows.near, p, 0.0), model.shape) for _, rows, p in ends.both]
    for k, (at, force) in enumerate(((ends.rows0, ends.shear0), (ends.rows1, ends.shear1))):
        if at.shear.count:
            tools[k] = tools[k] + at.shear.spread(np.where((rigid & at.near)[:, None], force, 0.0))
    tools[0], tools[1] = tools[0] + model.load_before, tools[1] + model.load
    outer = (here & ~model.massive)[:, None] * (0.5 * (tools[0] + tools[1]))
    torque = moment(model.space, x, np.where(inner[:, None], ends.mean, outer))
    change = np.where(inner[:, None], ends.f1 - ends.f0, (here & ~model.massive)[:, None] * (tools[1] - tools[0]))
    return SpinBalance(
        space=model.space,
        fields=fields,
        inertia=np.array([moment(model.space, x, f) for f in fields]).reshape(len(fields), len(fields)).T,
        torque=torque,
        slope=moment(model.space, x, change),
    )


def _turned(arm: Array) -> Array:
    """Fields (k, n, d) ``e_k x arm`` of the unit rotations: none in 1D, one in the plane, three in space."""
    n, d = arm.shape
    if d == 1:
        return np.zeros((0, n, d))
    if d == 2:
        return np.stack([np.column_stack([-arm[:, 1], arm[:, 0]])])
    return np.stack([np.cross(e, arm) for e in np.eye(3)])


def moment(space: VectorSpace, x: Array, force: Array) -> Array:
    """Moment (k,) of forces (n, d) at positions (n, d): none in 1D, one in the plane, three in space.

    Examples
    --------
    >>> from softway.bodies.assembled.vector_space import LocalSpace
    >>> moment(LocalSpace(()), np.array([[1.0, 0.0]]), np.array([[0.0, 2.0]]))
    array([2.])
    """
    both = space.products(x, force)
    pairs = ((), ((0, 1),), ((1, 2), (2, 0), (0, 1)))[x.shape[1] - 1]
    return np.array([both[i, j] - both[j, i] for i, j in pairs])
