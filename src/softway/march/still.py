"""Equilibrium of the nodes without inertia at the end of a slab of central differences, where the others have arrived.

All of them follow the nodes with inertia by one correction on their frozen stiffness; those near a touch then settle
under the contact conditions.  What the others are left with is handed to the nodes that they follow, and corrected in
the next slab (docs/theory/explicit.md).
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.layer import Layer, layer
from softway.bodies.past import during
from softway.contact.candidates import Candidates
from softway.errors import NoConvergence
from softway.model import Model
from softway.solve.carry import Carry, Near, Origin, Skin, Taken
from softway.solve.correction import corrected
from softway.solve.driver import Iterate
from softway.solve.explicit import Explicit
from softway.solve.frozen import Frozen, basis
from softway.solve.linear import Factor
from softway.solve.operators.factored import cost, suited
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.typing import Array, BoolArray, IntArray

CLOSE, FAR = 0.5, 2.0
"""Gaps, in edges, within which a node has to be among those near a touch, and within which it is made one of them."""
MOST = 0.5
"""Share of the nodes without inertia beyond which all of them count as near a touch."""
WORN = 0.25
"""Share of the unbalanced forces that a correction may leave before its stiffness is made anew."""
SLIGHT = 1e-3
"""Unbalanced force, relative to the greatest internal force, that never asks for a new stiffness."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Still:
    """Components (n, d) without inertia that no support holds, and the cells around their nodes."""

    light: BoolArray
    layer: Layer

    def during(self, model: Model) -> "Still":
        """The same in the slab in which the bodies of the model stand."""
        return replace(self, layer=self.layer.during(model.parts))

    def factored(self, model: Model, origin: Origin) -> tuple[Factor, float]:
        """The factor of their stiffness as it was somewhere, and its price in iterations."""
        then = self.layer.during(during(model.parts, origin.memory, origin.span))
        matrix = then.tangent(origin.at, self.light)
        factor = suited(matrix.shape[0]).factor(matrix)
        return factor, cost(factor, matrix.shape[0])


def settled(
    system: SlabSystem, still: Still, q: Array, first: tuple[Array, BoolArray], carry: Carry, method: Explicit
) -> tuple[Iterate, int]:
    """The nodes without inertia at the end of the slab, and how many iterations those near a touch took.

    ``q`` (n, d) is a guess, ``first`` are impulses of the contact rows and which are active to begin with.

    Raises
    ------
    NoConvergence
        If those near a touch find no equilibrium.
    """
    still, free = still.during(system.model), system.path.rows.along(q)
    touched = _touched(system, still, q, first[1])
    if touched is not None:
        carry = _chosen(system, still, touched, carry)
    near = None if touched is None else carry.near
    if near is None or len(near.nodes) < still.light.any(axis=1).sum():
        q, carry = _followed(system, still, q, near, carry)
    if near is None:
        return _iterate(system, q, 0.0, first, carry, free), 1
    moving = still.light & _among(near.nodes, len(q))
    rows = replace(system.rows, unilateral=system.path.rows.reachable(moving))
    inner = replace(system, model=replace(system.model, free=moving), given=q, rows=rows)
    assert near.layer is not None
    around = Still(light=moving, layer=near.layer).during(system.model)
    return _iterated(inner, around, q, first, _prepared(inner, around, carry), free, method)


def pushed(rows: Candidates, pressure: Array | None, traction: Array | None, shape: tuple[int, int]) -> Array:
    """Nodal forces (n, d) of contact forces (m,) and (m, d) on rows [N]."""
    out = np.zeros(shape) if pressure is None else rows.spread(pressure, shape)
    return out if traction is None or rows.shear is None else out + rows.shear.spread(traction)


def handed(model: Model, light: BoolArray, force: Array, outer: Array) -> tuple[Array, Array]:
    """The internal force (n, d) with what keeps the ``light`` components from equilibrium with the ``outer`` forces
    (n, d) handed to the nodes that they follow, and that, (n, d) [N].
    """
    left = np.where(light, force - outer, 0.0)
    return np.asarray(force - left + model.follow.T @ left), left


def watched(carry: Carry, left: Array, force: Array) -> Carry:
    """The carry that knows whether the stiffness of all is worn, by what a slab ``left`` (n, d) unbalanced [N]."""
    if carry.skin is None or carry.skin.before == 0.0:
        return carry
    most = _greatest(left, carry.near)
    worn = most > max(WORN * carry.skin.before, SLIGHT * float(np.abs(force).max(initial=0.0)))
    return replace(carry, skin=replace(carry.skin, worn=worn, before=0.0))


def _touched(system: SlabSystem, still: Still, q: Array, active: BoolArray) -> tuple[BoolArray, BoolArray] | None:
    """Nodes (n,) that have to be among those near a touch, and those that are taken to be; None where nothing is near."""
    u1 = system.path.end(q)
    rows = system.path.rows if system.pairs is None else system.pairs.at(u1)
    if not len(rows.node):
        return None
    gap = np.where(rows.near, rows.gap(u1), np.inf) / system.model.edge[rows.node]
    closed = active[: len(gap)]
    wanted = _of(rows, closed | (gap < CLOSE), still)
    return (wanted, still.layer.around(_of(rows, closed | (gap < FAR), still))) if wanted.any() else None


def _of(rows: Candidates, which: BoolArray, still: Still) -> BoolArray:
    """Nodes (n,) with light components that some rows (m,) feel."""
    n, d = still.light.shape
    out = np.zeros(n, bool)
    out[rows.gradient[np.flatnonzero(which)].indices // d] = True
    return np.asarray(out & still.light.any(axis=1))


def _chosen(system: SlabSystem, still: Still, touched: tuple[BoolArray, BoolArray], carry: Carry) -> Carry:
    """The carry with nodes near a touch that hold all that have to be among them."""
    wanted, taken = touched
    near, n = carry.near, len(wanted)
    if near is None or (wanted & ~_among(near.nodes, n)[:, 0]).any():
        every = still.light.any(axis=1)
        taken = taken & every
        near = Near(nodes=np.flatnonzero(every if taken.sum() > MOST * every.sum() else taken))
        carry = replace(carry, frozen=None, origin=None, batches=())
    if near.layer is None:
        whole = len(near.nodes) == still.light.any(axis=1).sum()
        chosen = _among(near.nodes, n)[:, 0]
        near = replace(near, layer=still.layer if whole else layer(system.model.parts, chosen))
    return replace(carry, near=near)


def _followed(system: SlabSystem, still: Still, q: Array, near: Near | None, carry: Carry) -> tuple[Array, Carry]:
    """q with all nodes without inertia moved by one correction under the contact forces of the slab's start."""
    skin, u1, model = carry.skin, system.path.end(q), system.model
    if skin is None or skin.worn:
        skin = Skin(origin=Origin.of(system, u1))
        carry = replace(carry, factorisations=carry.factorisations + 1)
    factor = skin.factor or still.factored(model, skin.origin)[0]
    push = pushed(system.first, system.pressure, system.traction, model.shape)
    left = np.where(still.light, still.layer.force(u1) - model.load - push, 0.0)
    if not np.isfinite(left).all():
        raise NoConvergence("the nodes without inertia cannot follow: a cell is inverted")
    out = q.copy()
    out[still.light] -= 2.0 / system.path.span * factor.solve(left[still.light])
    return out, replace(carry, skin=replace(skin, factor=factor, before=_greatest(left, near)))


def _greatest(left: Array, near: Near | None) -> float:
    """Greatest force (n, d) beyond the nodes near a touch."""
    far = left if near is None else np.where(_among(near.nodes, len(left)), 0.0, left)
    return float(np.abs(far).max(initial=0.0))


def _prepared(system: SlabSystem, still: Still, carry: Carry) -> Carry:
    """The carry with the stiffness of the nodes near a touch factored, whatever the length of the slab."""
    if carry.origin is None or carry.stale:
        carry = replace(
            carry,
            frozen=None,
            origin=Origin.of(system, system.start.displacement),
            batches=(),
            stale=False,
            factorisations=carry.factorisations + 1,
            taken=Taken(),
        )
    if carry.frozen is None:
        assert carry.origin is not None
        factor, price = still.factored(system.model, carry.origin)
        model = system.model
        directions = basis(system.path.rows, model.free, model.encounters.fixed, model.touchable, few=True)
        frozen = Frozen(factor, directions).filled(carry.batches)
        carry = replace(carry, frozen=frozen, price=price)
    assert carry.frozen is not None
    return replace(carry, frozen=carry.frozen.scaled(1.0 / system.share), span=system.path.span)


def _iterated(
    system: SlabSystem,
    still: Still,
    q: Array,
    first: tuple[Array, BoolArray],
    carry: Carry,
    free: Array,
    method: Explicit,
) -> tuple[Iterate, int]:
    """The last iterate of the nodes near a touch on their way to equilibrium, and how many there were."""
    impulse, active = first
    scale = float(np.abs(q).max(initial=1e-300))
    frozen, arrived = carry.frozen, system.path.end(q)
    assert frozen is not None
    for count in range(1, method.limit + 1):
        end = _looked(system, still, q, arrived)
        system = system.steadied(end.displacement, active, count)
        if not np.isfinite(end.residual).all():
            break
        step = corrected(system, frozen, q, end, impulse, active)
        change = float(np.abs(step.q - q).max(initial=0.0))
        q, impulse, active = step.q, step.impulse, step.active
        if change <= method.tolerance * scale:
            return _iterate(system, q, change, (impulse, active), carry, free), count
    raise NoConvergence(f"{method.limit} iterations do not bring the contact nodes to rest")


def _looked(system: SlabSystem, still: Still, q: Array, arrived: Array) -> Evaluation:
    """What moves the nodes near a touch at q (n, d); the others have ``arrived`` (n, d)."""
    light, h = still.light, system.path.span
    u1 = arrived.copy()
    u1[light] = system.path.start[light] + 0.5 * h * q[light]
    force = still.layer.force(u1)
    residual = np.zeros_like(force)
    residual[light] = 0.5 * h * (force[light] - system.model.load[light])
    none = np.zeros(len(system.model.parts))
    return Evaluation(
        residual=residual,
        displacement=u1,
        force=force,
        energy=none,
        mean_force=force,
        scalar=none,
        share=none,
        clipped=False,
        near=None if system.pairs is None else system.pairs.at(u1),
    )


def _iterate(
    system: SlabSystem, q: Array, change: float, contact: tuple[Array, BoolArray], carry: Carry, free: Array
) -> Iterate:
    impulse, active = contact
    return Iterate(
        q=q, change=change, impulse=impulse, active=active, free=free, carry=carry, system=system, sound=True
    )


def _among(nodes: IntArray, count: int) -> BoolArray:
    """Which of ``count`` nodes are among some, (count, 1)."""
    out = np.zeros((count, 1), bool)
    out[nodes] = True
    return out
