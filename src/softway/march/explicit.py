"""One slab of central differences: free flight of the nodes with inertia, equilibrium of the contact nodes.

    v = v0 + h/2 a0,    x1 = x0 + h v,    v1 = v + h/2 a1,    M a = load - f        nodes with inertia
    f(x1) = load + G^T p,   gap(x1) >= 0,  p >= 0                                   nodes without

Contact pushes nodes without inertia only, so that no impact happens at any instant (docs/theory/explicit.md).
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.layer import layer
from softway.contact.candidates import Candidates
from softway.contact.timing import Energy
from softway.errors import InputError
from softway.march.control import require_slow
from softway.march.massless import equations, outcome
from softway.march.outcome import Outcome
from softway.march.rub import first_impulses
from softway.march.settling import settled, watched
from softway.march.situation import Situation
from softway.march.still import Followed, Still, handed, pushed
from softway.model import Model
from softway.solve.carry import Carry
from softway.solve.driver import Iterate, Solution
from softway.solve.explicit import Explicit
from softway.solve.inertia import Inertia, inertia
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.time.slab import Slab
from softway.time.weight import moments
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Central:
    """What central differences need all through a march: the inverse mass, and the nodes without inertia."""

    inertia: Inertia
    still: Still
    followed: Followed
    light: IntArray
    held: BoolArray | None

    def sloped(self, force: Array, before: Array) -> Array:
        """Slope (n, d) of the velocity by a force (n, d).

        Nodes without inertia are expected to get faster by as much as in the slab before, whose slope was ``before``
        (n, d); it counts twice, for theirs is the mean velocity of a slab.
        """
        out = self.inertia.acceleration(force)
        out[self.light] = 2.0 * before[self.light]
        return out

    def guessed(self, system: SlabSystem, moving: Array, coasting: Array) -> tuple[Array, Array]:
        """q (n, d) and the displacement at the end, of the velocity and displacement there without contact.

        The velocity becomes the q.
        """
        moving[self.light] += system.start.velocity[self.light]
        if self.held is None:
            return moving, coasting
        q = np.where(self.held, system.given, moving)
        return q, system.path.end(q)

    def reached(self, q: Array, moving: Array) -> Array:
        """The velocity (n, d) at the end from q, and from that of the nodes with inertia, which becomes it."""
        out = moving if self.held is None else np.where(self.held, q, moving)
        out[self.light] = 0.5 * q[self.light]
        return out


def central(model: Model) -> Central:
    """Prepare central differences.

    Raises
    ------
    InputError
        If contact pushes nodes that carry inertia.
    """
    if not isinstance(model.timing, Energy) or model.timing.located:
        raise InputError("solver", "Explicit with contact nodes that carry inertia", "the timing Energy")
    light = ~model.massive
    still = Still(light=model.free & light[:, None], layer=layer(model.parts, light))
    return Central(
        inertia=inertia(model),
        still=still,
        followed=Followed.of(model, still),
        light=np.flatnonzero(light),
        held=None if model.free.all() else ~model.free,
    )


def solve_explicit(
    model: Model, now: Situation, slab: Slab, carry: Carry, method: Explicit, central: Central, approach: float
) -> tuple[Outcome, Carry]:
    """Solve the slab.

    Raises
    ------
    NoConvergence
        If the contact nodes find no equilibrium.
    """
    h, start = slab.span, now.start
    shock = model.shock_force(start.displacement, h * start.velocity, h)
    push = model.load if shock is None else model.load - shock
    opening = _opening(model, now, central)
    slope = central.sloped(push - opening, now.acceleration)
    moving = h * slope
    coasting = 0.5 * moving
    moving += start.velocity
    coasting += start.velocity
    coasting *= h
    coasting += start.displacement
    pairs = model.encounters.meet(start.displacement, coasting, slab.start, slab.end)
    require_slow(model, pairs, coasting, approach)
    system = replace(equations(model, now, slab, pairs, None), balanced=False)
    guess = central.guessed(system, moving, coasting)
    it, u1, count = settled(system, central.still, guess, first_impulses(now, slab, system.path.rows), carry, method)
    end = _evaluated(system, it, u1)
    closing, left = handed(central.followed, central.still, end.force, _outer(system, central.still, it, end.near))
    opening += closing
    opening *= 0.5
    end = replace(end, mean_force=opening)
    if shock is not None:
        lost = model.totals(shock * (end.displacement - start.displacement))
        end = replace(end, mean_force=end.mean_force + shock, lost=lost)
    solution = Solution(last=it, end=end, predicted=it.free, iterations=count, contraction=0.0)
    slope += central.inertia.acceleration(push - closing)
    slope *= 0.5 * h
    slope += start.velocity
    velocity = central.reached(it.q, slope)
    out = outcome(model, now, slab, system, solution, pairs.found, velocity)
    return out, watched(it.carry, central.still, left)


def _evaluated(system: SlabSystem, it: Iterate, u1: Array) -> Evaluation:
    """The whole body at the end of the slab, at the displacement (n, d)."""
    pairs, none = it.system.pairs, np.zeros(len(system.model.parts))
    energy, force = system.model.energy_and_force(u1)
    return Evaluation(
        residual=np.zeros_like(force),
        displacement=u1,
        force=force,
        energy=energy,
        mean_force=force,
        scalar=none,
        share=none,
        clipped=False,
        near=None if pairs is None else pairs.at(u1),
    )


def _opening(model: Model, now: Situation, central: Central) -> Array:
    """The internal force (n, d) at the start, with what nodes without inertia lack at those that they follow [N]."""
    start = now.start
    rows = now.rows or model.rows(start.displacement, now.time)
    outer = pushed(central.still, model.load_before, rows, now.pressure, now.traction)
    return handed(central.followed, central.still, start.force, outer)[0]


def _outer(system: SlabSystem, still: Still, it: Iterate, rows: Candidates | None) -> Array:
    """Forces (f,) of loads and contact at the end of the slab on components without inertia [N]."""
    rows = rows or system.path.rows
    m, carried = len(rows.node), it.impulse / (system.path.span * moments(system.weight)[1])
    traction = None if rows.shear is None else rows.shear.vectors(carried[m:].reshape(m, -1))
    return pushed(still, system.model.load, rows, carried[:m], traction)
