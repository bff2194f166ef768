"""Equilibrium of the massless nodes at the end of a slab of central differences.

All massless nodes follow the nodes with inertia by one correction with their frozen stiffness.  Those near contact are
then iterated to equilibrium under the contact conditions.  The residual forces of the others act on the nodes that they
follow, and are corrected in the next slab (docs/theory/solver/explicit.md).
"""

from dataclasses import replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.assembled.vector_space import VectorSpace
from softway.errors import NoConvergence
from softway.marching.explicit.contact_patch import among, balanced, chosen_nodes, iterate, touched_nodes
from softway.marching.explicit.massless_nodes import MasslessNodes, pushed_nodes
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.iteration import Iterate
from softway.solve.operators.operator_memory import Near, OperatorMemory, OperatorOrigin, Skin

SLIGHT = 1e-5
"""Residual force away from contact, relative to the greatest internal force, that is left to the next slab."""
WORN = 0.25
"""Fraction of the residual forces after a correction, above which the stiffness is renewed if one was not enough."""
CORRECTIONS = 10
"""Greatest number of corrections in a slab."""


def solve_contact_nodes(
    system: SlabEquations,
    still: MasslessNodes,
    guess: tuple[Array, Array],
    first: tuple[Array, BoolArray],
    memory: OperatorMemory,
    method: Explicit,
) -> tuple[Iterate, Array, int]:
    """Solve for the massless nodes at the end of the slab: iterate, displacement (n, d), and number of iterations near
    contact.

    ``guess`` are q and the displacement at the end (n, d); ``first`` are the initial impulses of the contact rows and
    the initially active rows.

    Raises
    ------
    NoConvergence
        If the nodes near contact have no equilibrium.
    """
    (q, u1), still = guess, still.during(system.model)
    free = system.path.rows.normal_component(q)
    found = touched_nodes(system, still, u1, first[1])
    if found is not None:
        memory = chosen_nodes(system, still, found, memory)
    near = None if found is None else memory.near
    if near is None or len(near.nodes) < still.nodes.sum():
        q, u1, memory = _followed(system, still, (q, u1), near, memory, method)
    if near is None:
        return iterate(system, q, 0.0, first, memory, free), u1, 1
    return balanced(system, still, (q, u1), first, (near, memory), free, method)


def with_remaining(space: VectorSpace, memory: OperatorMemory, still: MasslessNodes, missing: Array) -> OperatorMemory:
    """Operator memory with the fraction of the residual forces after one correction; ``missing`` (f,) is left [N]."""
    skin = memory.skin
    if skin is None or skin.before == 0.0:
        return memory
    remaining = _beyond(space, missing, still, memory.near) / skin.before
    return replace(memory, skin=replace(skin, remaining=remaining, before=0.0))


def _followed(
    system: SlabEquations,
    still: MasslessNodes,
    guess: tuple[Array, Array],
    near: Near | None,
    memory: OperatorMemory,
    method: Explicit,
) -> tuple[Array, Array, OperatorMemory]:
    """Correct all massless nodes under the contact forces at the start of the slab: q and u1 (n, d).

    One correction is enough if its residual is expected to be small from the previous corrections.
    """
    (q, u1), skin, model, h = guess, memory.skin, system.model, system.path.span
    if skin is None or skin.worn:
        skin = Skin(origin=OperatorOrigin.of(system, u1))
        memory = replace(memory, factorisations=memory.factorisations + 1)
    factor = skin.factor or still.factored(model, skin.origin, crude=True)[0]
    initial, space = system.contact.initial, model.space
    outer = pushed_nodes(still, model.load, initial.rows, initial.pressure, initial.traction)
    allowed, least = SLIGHT * space.greatest(system.start.force), 0.5 * h * method.tolerance * space.greatest(q)
    ratio, before, total = skin.remaining, 0.0, np.zeros(len(still.where))
    for count in range(CORRECTIONS):
        missing = still.restrict(still.layer.force(u1)) - outer
        if not space.every(np.isfinite(missing)):
            raise NoConvergence("the massless nodes have no equilibrium: a cell is inverted")
        most = _beyond(space, missing, still, near)
        ratio = most / before if count and before > 0.0 else ratio
        back = -factor.solve(missing)
        u1, total, before = still.moved(u1, back), total + back, most
        if ratio * most <= allowed or space.greatest(back) <= least:
            break
    once = count == 0
    skin = replace(skin, factor=factor, remaining=ratio, before=before if once else 0.0, worn=not once and ratio > WORN)
    return still.moved(q, 2.0 / h * total), u1, replace(memory, skin=skin)


def _beyond(space: VectorSpace, missing: Array, still: MasslessNodes, near: Near | None) -> float:
    """Greatest of the forces (f,) on the massless components, except at nodes near contact."""
    if near is not None:
        n, d = still.light.shape
        missing = missing[~among(near.nodes, n).ravel()[still.where // d]]
    return space.greatest(missing)
