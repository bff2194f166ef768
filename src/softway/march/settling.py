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
from softway.solve.normal import greatest
from softway.solve.system import SlabSystem
from softway.typing import Array, BoolArray

SLIGHT = 1e-5
"""Unbalanced force away from touches, relative to the greatest internal force, that may be left to the next slab."""
WORN = 0.25
"""Share of the unbalanced forces left by a correction beyond which, if one was not enough, the stiffness is renewed."""
CORRECTIONS = 10
"""Corrections of a slab at most."""


def settled(
    system: SlabSystem,
    still: Still,
    guess: tuple[Array, Array],
    first: tuple[Array, BoolArray],
    carry: Carry,
    method: Explicit,
) -> tuple[Iterate, Array, int]:
    """The nodes without inertia at the end of the slab, the displacement (n, d) there, and how many iterations those
    near a touch took.

    ``guess`` are q and the displacement at the end (n, d); ``first`` are impulses of the contact rows and which are
    active to begin with.

    Raises
    ------
    NoConvergence
        If those near a touch find no equilibrium.
    """
    (q, u1), still = guess, still.during(system.model)
    free = system.path.rows.along(q)
    found = touched(system, still, u1, first[1])
    if found is not None:
        carry = chosen(system, still, found, carry)
    near = None if found is None else carry.near
    if near is None or len(near.nodes) < still.nodes.sum():
        q, u1, carry = _followed(system, still, (q, u1), near, carry, method)
    if near is None:
        return iterate(system, q, 0.0, first, carry, free), u1, 1
    return balanced(system, still, (q, u1), first, (near, carry), free, method)


def watched(carry: Carry, still: Still, missing: Array) -> Carry:
    """The carry with the share of the unbalanced forces that one correction left, by those ``missing`` (f,) [N]."""
    skin = carry.skin
    if skin is None or skin.before == 0.0:
        return carry
    return replace(carry, skin=replace(skin, share=_beyond(missing, still, carry.near) / skin.before, before=0.0))


def _followed(
    system: SlabSystem,
    still: Still,
    guess: tuple[Array, Array],
    near: Near | None,
    carry: Carry,
    method: Explicit,
) -> tuple[Array, Array, Carry]:
    """q and u1 (n, d) with all nodes without inertia corrected under the contact forces at the start.

    One correction is enough where it is expected to leave little, by what the last ones left.
    """
    (q, u1), skin, model, h = guess, carry.skin, system.model, system.path.span
    if skin is None or skin.worn:
        skin = Skin(origin=Origin.of(system, u1))
        carry = replace(carry, factorisations=carry.factorisations + 1)
    factor = skin.factor or still.factored(model, skin.origin, crude=True)[0]
    outer = pushed(still, model.load, system.first, system.pressure, system.traction)
    allowed, least = SLIGHT * greatest(system.start.force), 0.5 * h * method.tolerance * greatest(q)
    share, before, whole = skin.share, 0.0, np.zeros(len(still.where))
    for count in range(CORRECTIONS):
        missing = still.of(still.layer.force(u1)) - outer
        if not np.isfinite(missing).all():
            raise NoConvergence("the nodes without inertia cannot follow: a cell is inverted")
        most = _beyond(missing, still, near)
        share = most / before if count and before > 0.0 else share
        back = -factor.solve(missing)
        u1, whole, before = still.moved(u1, back), whole + back, most
        if share * most <= allowed or greatest(back) <= least:
            break
    once = count == 0
    skin = replace(skin, factor=factor, share=share, before=before if once else 0.0, worn=not once and share > WORN)
    return still.moved(q, 2.0 / h * whole), u1, replace(carry, skin=skin)


def _beyond(missing: Array, still: Still, near: Near | None) -> float:
    """Greatest of the forces (f,) on the components without inertia, beyond the nodes near a touch."""
    if near is not None:
        n, d = still.light.shape
        missing = missing[~among(near.nodes, n).ravel()[still.where // d]]
    return greatest(missing)
