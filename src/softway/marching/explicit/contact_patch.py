"""Massless nodes near contact: their choice, and their equilibrium under the contact conditions."""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.assembled.contact_layer import layer
from softway.bodies.dof_map import NodalDofs
from softway.contact.contact_rows import ContactRows
from softway.errors import NoConvergence
from softway.marching.explicit.massless_nodes import MasslessNodes
from softway.solve.constraints.compliance import FrozenOperator, row_basis
from softway.solve.equations.slab_contact import FixedContact
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_values import Evaluation
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.contact_step import contact_step
from softway.solve.methods.iteration import Iterate, resolved_speed
from softway.solve.operators.operator_memory import IterationCount, Near, OperatorMemory, OperatorOrigin

CLOSE, FAR = 0.5, 4.0
"""Gaps, in edges, below which a node must be in the set near contact, and below which it is added to a new set."""
MOST = 0.5
"""Fraction of the massless nodes above which all of them are in the set near contact."""
SWIFT = 0.25
"""Ratio of successive changes below which they give an estimate of the remaining error."""
USUAL = 3
"""Number of iterations that a new factor does not reduce."""


def touched_nodes(
    system: SlabEquations, still: MasslessNodes, u1: Array, active: BoolArray
) -> tuple[BoolArray, BoolArray] | None:
    """Nodes (n,) that must be in the set near contact, and nodes that may be in it; None if nothing is near."""
    rows = system.contact.at(u1)
    if not len(rows.node):
        return None
    gap = np.where(rows.near, rows.gap(u1), np.inf) / system.model.edge[rows.node]
    closed = active[: len(gap)]
    wanted = _of(rows, closed | (gap < CLOSE), still)
    return (wanted, _of(rows, closed | (gap < FAR), still)) if wanted.any() else None


def _of(rows: ContactRows, which: BoolArray, still: MasslessNodes) -> BoolArray:
    """Massless nodes (n,) with a coefficient in the rows ``which`` (m,)."""
    n, d = still.light.shape
    out = np.zeros(n, bool)
    out[rows.gradient[np.flatnonzero(which)].indices // d] = True
    return out & still.nodes


def chosen_nodes(
    system: SlabEquations, still: MasslessNodes, found: tuple[BoolArray, BoolArray], memory: OperatorMemory
) -> OperatorMemory:
    """Operator memory with a set of nodes near contact that contains all required nodes."""
    wanted, taken = found
    near, n = memory.near, len(wanted)
    if near is None or (wanted & ~among(near.nodes, n)[:, 0]).any():
        every = still.nodes
        taken = still.layer.around(taken) & every
        near = Near(nodes=np.flatnonzero(every if taken.sum() > MOST * every.sum() else taken))
        memory = replace(memory, frozen=None, origin=None, batches=())
    if near.layer is None:
        complete = len(near.nodes) == still.nodes.sum()
        own = among(near.nodes, n)[:, 0]
        near = replace(near, layer=still.layer if complete else layer(system.model.parts, own))
    return replace(memory, near=near)


def balanced(
    system: SlabEquations,
    still: MasslessNodes,
    guess: tuple[Array, Array],
    first: tuple[Array, BoolArray],
    chosen: tuple[Near, OperatorMemory],
    free: Array,
    method: Explicit,
) -> tuple[Iterate, Array, int]:
    """Equilibrium of the nodes near contact: last iterate, displacement (n, d) at the end of the slab, and number of
    iterations.

    ``guess`` are q and the displacement at the end (n, d), ``free`` (m,) the normal motion without contact.

    Raises
    ------
    NoConvergence
        If the iteration does not converge.
    """
    (q_all, u1), near, space = guess, chosen[0], system.model.space
    memory = _prepared(system, still, q_all, chosen)
    frozen, enough = memory.frozen, max(method.tolerance * space.greatest(q_all), resolved_speed(system))
    assert frozen is not None
    local = _Local.of(system, still, guess, near, frozen)
    live = local.live
    q, impulse, active = q_all[local.nodes], first[0][live], first[1][live]
    change = 0.0
    for count in range(1, method.limit + 1):
        end = local.evaluate(q)
        local = replace(local, system=local.system.with_kept_facets_after(end.displacement, active, count))
        if not space.every(np.isfinite(end.residual)):
            break
        step = contact_step(local.system, frozen, q, end, impulse, active)
        before, change = change, space.greatest(step.q - q)
        same = local.partial and bool((step.active == active).all())
        q, impulse, active = step.q, step.impulse, step.active
        scale = max(space.greatest(q_all), 1e-300)
        system.effort.iterated(count, change / scale, int(np.count_nonzero(impulse[: len(end.rows.node)])))
        if change <= enough or (same and _left(before, change) <= enough):
            q_all, u1 = q_all.copy(), u1.copy()
            q_all[local.nodes], u1[local.nodes] = q, local.placed(q)
            system = system if local.partial else local.system
            memory = replace(memory, stale=_dear(memory, count))
            contact = local.all_rows(impulse, active, first)
            return iterate(system, q_all, change, contact, memory, free), u1, count
    raise NoConvergence(f"the equilibrium of the contact nodes does not converge in {method.limit} iterations")


def _inner(system: SlabEquations, still: MasslessNodes, q: Array, near: Near) -> tuple[SlabEquations, MasslessNodes]:
    """Equations of the nodes near contact: all other nodes are at q (n, d), like driven supports."""
    moving = still.light & among(near.nodes, len(q))
    conditions = replace(system.contact.conditions, unilateral=system.path.rows.reachable(NodalDofs(moving)))
    contact = system.contact.with_conditions(conditions)
    assert near.layer is not None
    around = MasslessNodes(light=moving, layer=near.layer).during(system.model)
    return replace(system, model=replace(system.model, dofs=NodalDofs(moving)), given=q, contact=contact), around


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Local:
    """Equations of the nodes near contact, restricted to the ``nodes`` of their cells if the rows never change."""

    nodes: IntArray | slice
    live: IntArray | slice
    system: SlabEquations
    still: MasslessNodes
    start: Array
    load: Array
    arrived: Array

    @classmethod
    def of(
        cls, system: SlabEquations, still: MasslessNodes, guess: tuple[Array, Array], near: Near, frozen: FrozenOperator
    ) -> "_Local":
        """Equations with the other nodes at q and the displacement of the guess (n, d)."""
        (q, u1), place = guess, frozen.basis.place
        nodes: IntArray | slice = slice(None)
        live: IntArray | slice = slice(None)
        if isinstance(contact := system.contact, FixedContact) and place is not None:
            assert near.layer is not None
            nodes, inner = near.layer.alone()
            light = still.light[nodes] & among(near.nodes, len(q))[nodes]
            still = MasslessNodes(light=light, layer=inner).during(system.model)
            live = np.flatnonzero(place >= 0)
            conditions = replace(contact.conditions.subset(live), unilateral=np.ones(len(live), bool))
            model = replace(system.model, dofs=NodalDofs(light))
            contact = replace(contact, conditions=conditions, live=live)
            system = replace(system, model=model, given=q[nodes], contact=contact)
        else:
            system, still = _inner(system, still, q, near)
        start, load = system.path.start[nodes], system.model.load[nodes]
        return cls(nodes=nodes, live=live, system=system, still=still, start=start, load=load, arrived=u1[nodes])

    @property
    def partial(self) -> bool:
        """True if only some of the rows have conditions."""
        return not isinstance(self.live, slice)

    def all_rows(self, impulse: Array, active: BoolArray, first: tuple[Array, BoolArray]) -> tuple[Array, BoolArray]:
        """Impulses and active rows of all rows; rows without conditions have no impulse."""
        pressed, touching = np.zeros_like(first[0]), np.zeros_like(first[1])
        pressed[self.live], touching[self.live] = impulse, active
        return pressed, touching

    def placed(self, q: Array) -> Array:
        """Displacement (k, d) at the end of the slab."""
        still, out = self.still, self.arrived.copy()
        out.ravel()[still.where] = still.restrict(self.start) + 0.5 * self.system.path.span * still.restrict(q)
        return out

    def evaluate(self, q: Array) -> Evaluation:
        """Evaluate the equations at q (k, d)."""
        still, h, u1 = self.still, self.system.path.span, self.placed(q)
        force = still.layer.force(u1)
        residual = np.zeros_like(force)
        residual.ravel()[still.where] = 0.5 * h * (still.restrict(force) - still.restrict(self.load))
        none = np.zeros(len(self.system.model.parts))
        return Evaluation(
            residual=residual,
            displacement=u1,
            force=force,
            energy=none,
            mean_force=force,
            scalar=none,
            missing_work=none,
            clipped=False,
            rows=self.system.contact.at(u1),
        )


def _prepared(
    system: SlabEquations, still: MasslessNodes, q: Array, chosen: tuple[Near, OperatorMemory]
) -> OperatorMemory:
    """Operator memory with the factored stiffness of the nodes near contact, for any slab length."""
    near, memory = chosen
    if memory.origin is None or memory.stale:
        memory = replace(
            memory,
            frozen=None,
            origin=OperatorOrigin.of(system, system.start.displacement),
            batches=(),
            stale=False,
            factorisations=memory.factorisations + 1,
            taken=IterationCount(),
        )
    if memory.frozen is None:
        assert memory.origin is not None
        system, still = _inner(system, still, q, near)
        factor, price = still.factored(system.model, memory.origin)
        model = system.model
        directions = row_basis(system.path.rows, model.dofs, model.contacts.fixed, model.touchable)
        frozen = FrozenOperator(factor, directions).filled(memory.batches)
        memory = replace(memory, frozen=frozen, price=price)
    assert memory.frozen is not None
    return replace(memory, frozen=memory.frozen.scaled(1.0 / system.stiffness_factor), span=system.path.span)


def _left(before: float, change: float) -> float:
    """Estimate of the remaining error of an iteration from its last two changes; infinite without estimate.

    >>> _left(1.0, 0.125), _left(0.0, 1.0)
    (0.017857142857142856, inf)
    """
    return change**2 / (before - change) if change < SWIFT * before else float("inf")


def _dear(memory: OperatorMemory, count: int) -> bool:
    """True if ``count`` iterations exceed the mean of the slabs since the last factor, including its price."""
    taken = memory.taken
    return count > USUAL and taken.slabs > 1 and count > (taken.total + memory.price) / taken.slabs


def iterate(
    system: SlabEquations,
    q: Array,
    change: float,
    contact: tuple[Array, BoolArray],
    memory: OperatorMemory,
    free: Array,
) -> Iterate:
    """Iterate at q (n, d) with its impulses and active rows."""
    impulse, active = contact
    return Iterate(
        q=q, change=change, impulse=impulse, active=active, free=free, memory=memory, system=system, sound=True
    )


def among(nodes: IntArray, count: int) -> BoolArray:
    """Mask (count, 1) of the ``nodes`` (k,)."""
    out = np.zeros((count, 1), bool)
    out[nodes] = True
    return out
