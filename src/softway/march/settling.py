"""Equilibrium of the nodes without inertia at the end of a slab of central differences, where the others have arrived.

All of them follow the nodes with inertia by one correction on their frozen stiffness; those near a touch then settle
under the contact conditions.  What the others are left with is handed to the nodes that they follow, and corrected in
the next slab (docs/theory/explicit.md).
"""

from dataclasses import replace

import numpy as np

from softway.errors import NoConvergence
from softway.march.near import among, balanced, chosen, iterate, touched
from softway.march.still import Still, pushed
from softway.solve.carry import Carry, Near, Origin, Skin
from softway.solve.driver import Iterate
from softway.solve.explicit import Explicit
from softway.solve.system import SlabSystem
from softway.typing import Array, BoolArray

WORN = 0.25
"""Share of the unbalanced forces that a correction may leave before its stiffness is made anew."""
SLIGHT = 1e-3
"""Unbalanced force, relative to the greatest internal force, that never asks for a new stiffness."""


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
    still, free, u1 = still.during(system.model), system.path.rows.along(q), system.path.end(q)
    found = touched(system, still, u1, first[1])
    if found is not None:
        carry = chosen(system, still, found, carry)
    near = None if found is None else carry.near
    if near is None or len(near.nodes) < still.nodes.sum():
        q, u1, carry = _followed(system, still, (q, u1), near, carry)
    if near is None:
        return iterate(system, q, 0.0, first, carry, free), 1
    return balanced(system, still, (q, u1), first, (near, carry), free, method)


def watched(carry: Carry, still: Still, missing: Array, force: Array) -> Carry:
    """The carry that knows whether the stiffness of all is worn, by what a slab leaves ``missing`` (f,) [N]."""
    if carry.skin is None or carry.skin.before == 0.0:
        return carry
    most = _greatest(missing, still, carry.near)
    worn = most > WORN * carry.skin.before and most > SLIGHT * max(float(force.max()), -float(force.min()))
    return replace(carry, skin=replace(carry.skin, worn=worn, before=0.0))


def _followed(
    system: SlabSystem, still: Still, guess: tuple[Array, Array], near: Near | None, carry: Carry
) -> tuple[Array, Array, Carry]:
    """q and u1 (n, d) with all nodes without inertia moved by one correction under the contact forces at the start."""
    (q, u1), skin, model = guess, carry.skin, system.model
    if skin is None or skin.worn:
        skin = Skin(origin=Origin.of(system, u1))
        carry = replace(carry, factorisations=carry.factorisations + 1)
    factor = skin.factor or still.factored(model, skin.origin)[0]
    missing = still.of(still.layer.force(u1)) - still.of(model.load)
    if system.pressure is not None and system.pressure.any():
        missing -= still.of(pushed(system.first, system.pressure, system.traction, model.shape))
    if not np.isfinite(missing).all():
        raise NoConvergence("the nodes without inertia cannot follow: a cell is inverted")
    back = -factor.solve(missing)
    skin = replace(skin, factor=factor, before=_greatest(missing, still, near))
    return still.moved(q, 2.0 / system.path.span * back), still.moved(u1, back), replace(carry, skin=skin)


def _greatest(missing: Array, still: Still, near: Near | None) -> float:
    """Greatest of the forces (f,) on the components without inertia, beyond the nodes near a touch."""
    if near is not None:
        n, d = still.light.shape
        missing = missing[~among(near.nodes, n).ravel()[still.where // d]]
    return float(np.abs(missing).max(initial=0.0))
