"""The nodes without inertia near a touch: which they are, and their equilibrium under the contact conditions."""

from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.layer import layer
from softway.contact.candidates import Candidates
from softway.errors import NoConvergence
from softway.march.still import Still
from softway.solve.carry import Carry, Near, Origin, Taken
from softway.solve.correction import corrected
from softway.solve.driver import Iterate
from softway.solve.explicit import Explicit
from softway.solve.frozen import Frozen, basis
from softway.solve.normal import greatest
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.typing import Array, BoolArray, IntArray

CLOSE, FAR = 0.5, 4.0
"""Gaps, in edges, within which a node has to be among those near a touch, and within which it is made one of them."""
MOST = 0.5
"""Share of the nodes without inertia beyond which all of them count as near a touch."""
SWIFT = 0.25
"""Share of the change before below which a change tells how far the iteration is from its end."""
USUAL = 3
"""Iterations of the nodes near a touch that a new factor hardly makes fewer."""


def touched(system: SlabSystem, still: Still, u1: Array, active: BoolArray) -> tuple[BoolArray, BoolArray] | None:
    """Nodes (n,) that have to be among those near a touch, and those that may be; None where nothing is near."""
    rows = system.path.rows if system.pairs is None else system.pairs.at(u1)
    if not len(rows.node):
        return None
    gap = np.where(rows.near, rows.gap(u1), np.inf) / system.model.edge[rows.node]
    closed = active[: len(gap)]
    wanted = _of(rows, closed | (gap < CLOSE), still)
    return (wanted, _of(rows, closed | (gap < FAR), still)) if wanted.any() else None


def _of(rows: Candidates, which: BoolArray, still: Still) -> BoolArray:
    """Nodes (n,) with light components that some rows (m,) feel."""
    n, d = still.light.shape
    out = np.zeros(n, bool)
    out[rows.gradient[np.flatnonzero(which)].indices // d] = True
    return out & still.nodes


def chosen(system: SlabSystem, still: Still, found: tuple[BoolArray, BoolArray], carry: Carry) -> Carry:
    """The carry with nodes near a touch that hold all that have to be among them."""
    wanted, taken = found
    near, n = carry.near, len(wanted)
    if near is None or (wanted & ~among(near.nodes, n)[:, 0]).any():
        every = still.nodes
        taken = still.layer.around(taken) & every
        near = Near(nodes=np.flatnonzero(every if taken.sum() > MOST * every.sum() else taken))
        carry = replace(carry, frozen=None, origin=None, batches=())
    if near.layer is None:
        whole = len(near.nodes) == still.nodes.sum()
        own = among(near.nodes, n)[:, 0]
        near = replace(near, layer=still.layer if whole else layer(system.model.parts, own))
    return replace(carry, near=near)


def balanced(
    system: SlabSystem,
    still: Still,
    guess: tuple[Array, Array],
    first: tuple[Array, BoolArray],
    chosen: tuple[Near, Carry],
    free: Array,
    method: Explicit,
) -> tuple[Iterate, Array, int]:
    """The last iterate of the nodes near a touch on their way to equilibrium, the displacement (n, d) at the end of the
    slab, and how many iterates there were.

    ``guess`` are q and the displacement at the end (n, d), ``free`` (m,) the normal motion without contact.

    Raises
    ------
    NoConvergence
        If there is no equilibrium in reach.
    """
    (whole, u1), near = guess, chosen[0]
    carry = _prepared(system, still, whole, chosen)
    frozen, scale = carry.frozen, max(greatest(whole), 1e-300)
    assert frozen is not None
    local = _Local.of(system, still, guess, near, frozen)
    live = local.live
    q, impulse, active = whole[local.nodes], first[0][live], first[1][live]
    change = 0.0
    for count in range(1, method.limit + 1):
        end = local.looked(q)
        local = replace(local, system=local.system.steadied(end.displacement, active, count))
        if not np.isfinite(end.residual).all():
            break
        step = corrected(local.system, frozen, q, end, impulse, active)
        before, change = change, float(np.abs(step.q - q).max(initial=0.0))
        same = local.system.live is not None and bool((step.active == active).all())
        q, impulse, active = step.q, step.impulse, step.active
        if change <= method.tolerance * scale or (same and _left(before, change) <= method.tolerance * scale):
            whole, u1 = whole.copy(), u1.copy()
            whole[local.nodes], u1[local.nodes] = q, local.placed(q)
            system = local.system if local.system.live is None else system
            carry = replace(carry, stale=_dear(carry, count))
            contact = local.all_rows(impulse, active, first)
            return iterate(system, whole, change, contact, carry, free), u1, count
    raise NoConvergence(f"{method.limit} iterations do not bring the contact nodes to rest")


def _inner(system: SlabSystem, still: Still, q: Array, near: Near) -> tuple[SlabSystem, Still]:
    """The equations of the nodes near a touch: all others have arrived at q (n, d), like driven supports."""
    moving = still.light & among(near.nodes, len(q))
    rows = replace(system.rows, unilateral=system.path.rows.reachable(moving))
    assert near.layer is not None
    around = Still(light=moving, layer=near.layer).during(system.model)
    return replace(system, model=replace(system.model, free=moving), given=q, rows=rows), around


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Local:
    """The equations of the nodes near a touch: of the ``nodes`` of their cells alone where the rows never change."""

    nodes: IntArray | slice
    live: IntArray | slice
    system: SlabSystem
    still: Still
    start: Array
    load: Array
    arrived: Array

    @classmethod
    def of(cls, system: SlabSystem, still: Still, guess: tuple[Array, Array], near: Near, frozen: Frozen) -> "_Local":
        """The equations where the other nodes have arrived at q and the displacement of the guess (n, d)."""
        (q, u1), place = guess, frozen.basis.place
        nodes: IntArray | slice = slice(None)
        live: IntArray | slice = slice(None)
        if system.pairs is None and place is not None:
            assert near.layer is not None
            nodes, inner = near.layer.alone()
            light = still.light[nodes] & among(near.nodes, len(q))[nodes]
            still = Still(light=light, layer=inner).during(system.model)
            live = np.flatnonzero(place >= 0)
            rows = replace(system.rows.part(live), unilateral=np.ones(len(live), bool))
            model = replace(system.model, free=light)
            system = replace(system, model=model, given=q[nodes], rows=rows, live=live)
        else:
            system, still = _inner(system, still, q, near)
        start, load = system.path.start[nodes], system.model.load[nodes]
        return cls(nodes=nodes, live=live, system=system, still=still, start=start, load=load, arrived=u1[nodes])

    def all_rows(self, impulse: Array, active: BoolArray, first: tuple[Array, BoolArray]) -> tuple[Array, BoolArray]:
        """Impulses and active rows of all rows: those without conditions carry nothing."""
        pressed, touching = np.zeros_like(first[0]), np.zeros_like(first[1])
        pressed[self.live], touching[self.live] = impulse, active
        return pressed, touching

    def placed(self, q: Array) -> Array:
        """Displacement (k, d) at the end of the slab."""
        still, out = self.still, self.arrived.copy()
        out.ravel()[still.where] = still.of(self.start) + 0.5 * self.system.path.span * still.of(q)
        return out

    def looked(self, q: Array) -> Evaluation:
        """What moves the nodes at q (k, d)."""
        still, h, u1 = self.still, self.system.path.span, self.placed(q)
        force = still.layer.force(u1)
        residual = np.zeros_like(force)
        residual.ravel()[still.where] = 0.5 * h * (still.of(force) - still.of(self.load))
        none = np.zeros(len(self.system.model.parts))
        return Evaluation(
            residual=residual,
            displacement=u1,
            force=force,
            energy=none,
            mean_force=force,
            scalar=none,
            share=none,
            clipped=False,
            near=None if self.system.pairs is None else self.system.pairs.at(u1),
        )


def _prepared(system: SlabSystem, still: Still, q: Array, chosen: tuple[Near, Carry]) -> Carry:
    """The carry with the stiffness of the nodes near a touch factored, whatever the length of the slab."""
    near, carry = chosen
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
        system, still = _inner(system, still, q, near)
        factor, price = still.factored(system.model, carry.origin)
        model = system.model
        directions = basis(system.path.rows, model.free, model.encounters.fixed, model.touchable)
        frozen = Frozen(factor, directions).filled(carry.batches)
        carry = replace(carry, frozen=frozen, price=price)
    assert carry.frozen is not None
    return replace(carry, frozen=carry.frozen.scaled(1.0 / system.share), span=system.path.span)


def _left(before: float, change: float) -> float:
    """How far an iteration is from its end, by its last two changes; infinite where they do not tell.

    >>> _left(1.0, 0.125), _left(0.0, 1.0)
    (0.017857142857142856, inf)
    """
    return change**2 / (before - change) if change < SWIFT * before else float("inf")


def _dear(carry: Carry, count: int) -> bool:
    """Whether a slab of so many iterations costs more than those since the factor did on average, with its price."""
    taken = carry.taken
    return count > USUAL and taken.slabs > 1 and count > (taken.total + carry.price) / taken.slabs


def iterate(
    system: SlabSystem, q: Array, change: float, contact: tuple[Array, BoolArray], carry: Carry, free: Array
) -> Iterate:
    """The iterate at q (n, d) with its impulses and active rows."""
    impulse, active = contact
    return Iterate(
        q=q, change=change, impulse=impulse, active=active, free=free, carry=carry, system=system, sound=True
    )


def among(nodes: IntArray, count: int) -> BoolArray:
    """Which of ``count`` nodes are among some, (count, 1)."""
    out = np.zeros((count, 1), bool)
    out[nodes] = True
    return out
