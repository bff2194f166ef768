"""One slab of central differences: free flight of the nodes with inertia, equilibrium of the contact nodes.

    v = v0 + h/2 a0,    x1 = x0 + h v,    v1 = v + h/2 a1,    M a = load - f        nodes with inertia
    f(x1) = load + G^T p,   gap(x1) >= 0,  p >= 0                                   nodes without

Contact pushes nodes without inertia only, so that no impact happens at any instant (docs/theory/explicit.md).
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.bodies.layer import Layer, layer
from softway.contact.timing import Energy
from softway.errors import InputError, NoConvergence
from softway.march.control import require_slow
from softway.march.massless import equations, outcome
from softway.march.outcome import Outcome
from softway.march.rub import first_impulses
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.carry import Carry, Origin
from softway.solve.correction import corrected
from softway.solve.driver import Iterate, Solution
from softway.solve.explicit import Explicit
from softway.solve.frozen import Frozen
from softway.solve.inertia import Inertia, inertia
from softway.solve.linear import Factor, SuperLU
from softway.solve.system import SlabSystem
from softway.solve.values import Evaluation
from softway.time.slab import Slab
from softway.typing import Array, BoolArray, IntArray

WORN = 8
"""Iterations of the equilibrium after which the next slab renews its operator."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Central:
    """What central differences need all through a march: the inverse mass and the cells around the contact nodes."""

    inertia: Inertia
    layer: Layer
    light: BoolArray


def central(model: Model) -> Central:
    """Prepare central differences.

    Raises
    ------
    InputError
        If contact pushes nodes that carry inertia.
    """
    if not isinstance(model.timing, Energy) or model.timing.located:
        raise InputError("solver", "Explicit with contact nodes that carry inertia", "the timing Energy")
    still = ~model.massive
    return Central(inertia=inertia(model), layer=layer(model.parts, still), light=model.free & still[:, None])


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
    slope = central.inertia.acceleration(push - start.force)
    moving = start.velocity + h * slope
    mean = np.where(model.massive[:, None], 0.5 * (start.velocity + moving), start.velocity)
    coasting = start.displacement + h * mean
    pairs = model.encounters.meet(start.displacement, coasting, slab.start, slab.end)
    require_slow(model, pairs, coasting, approach)
    system = replace(equations(model, now, slab, pairs, None), balanced=False)
    central = replace(central, layer=central.layer.during(model.parts))
    q = np.where(model.free, np.where(model.massive[:, None], moving, 2.0 * start.velocity), system.given)
    it, count = _settled(system, central, q, first_impulses(now, slab, system.path.rows), carry, method)
    end = _evaluated(system, it, model.load - push)
    solution = Solution(last=it, end=end, predicted=it.free, iterations=count, contraction=0.0)
    out = outcome(model, now, slab, system, solution, pairs.found)
    last = central.inertia.acceleration(push - end.force)
    velocity = np.where(model.massive[:, None] & model.free, start.velocity + 0.5 * h * (slope + last), out.velocity)
    return replace(out, velocity=velocity, acceleration=(velocity - start.velocity) / h), it.carry


def _settled(
    system: SlabSystem, central: Central, q: Array, first: tuple[Array, BoolArray], carry: Carry, method: Explicit
) -> tuple[Iterate, int]:
    """The last iterate of the contact nodes on their way to equilibrium, and how many there were."""
    impulse, active = first
    scale = float(np.abs(q).max(initial=1e-300))
    carry = _prepared(system, central, system.path.end(q), carry)
    frozen, predicted = carry.frozen, q
    assert frozen is not None
    for count in range(1, method.limit + 1):
        end = _looked(system, central, q)
        system = system.steadied(end.displacement, active, count)
        if not np.isfinite(end.residual).all():
            break
        step = corrected(system, frozen, q, end, impulse, active)
        change = float(np.abs(step.q - q).max(initial=0.0))
        q, impulse, active = step.q, step.impulse, step.active
        if change <= method.tolerance * scale:
            it = Iterate(
                q=q,
                change=change,
                impulse=impulse,
                active=active,
                free=(end.near or system.path.rows).along(predicted),
                carry=replace(carry, stale=count > WORN),
                system=system,
                sound=True,
            )
            return it, count
    raise NoConvergence(f"{method.limit} iterations do not bring the contact nodes to rest")


def _looked(system: SlabSystem, central: Central, q: Array) -> Evaluation:
    """What moves the contact nodes at q (n, d); the nodes with inertia have arrived."""
    u1 = system.path.end(q)
    force = central.layer.force(u1)
    residual = 0.5 * system.path.span * np.where(central.light, force - system.model.load, 0.0)
    near = None if system.pairs is None else system.pairs.at(u1)
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
        near=near,
    )


def _evaluated(system: SlabSystem, it: Iterate, shock: Array) -> Evaluation:
    """The whole body at the end of the slab; ``shock`` (n, d) is the force of the bulk viscosities [N]."""
    end = replace(system, pairs=it.system.pairs).evaluate(it.q, it.impulse)
    moved = end.displacement - system.start.displacement
    mean = 0.5 * (system.start.force + end.force) + shock
    return replace(end, mean_force=mean, lost=system.model.totals(shock * moved))


@dataclass(frozen=True, slots=True, eq=False)
class _Light:
    """The factored stiffness of the contact nodes as an operator on all free components: it moves no others.

    ``where`` (k,) are the components that it moves.
    """

    factor: Factor | None
    where: IntArray

    @property
    def bytes(self) -> int:
        """Bytes of the factor."""
        return 0 if self.factor is None else self.factor.bytes

    def solve(self, b: Array) -> Array:
        """Solution (f,) or (f, k)."""
        out = np.zeros_like(b)
        if self.factor is not None:
            out[self.where] = self.factor.solve(np.ascontiguousarray(b[self.where]))
        return out


def _prepared(system: SlabSystem, central: Central, u: Array, carry: Carry) -> Carry:
    """The carry with the stiffness of the contact nodes factored."""
    serves = not carry.stale and abs(carry.span / system.path.span - 1.0) < 1e-9
    if carry.origin is not None and serves:
        if carry.frozen is not None:
            return carry
        return replace(carry, frozen=_frozen(system, central, carry.origin).filled(carry.batches))
    origin = Origin.of(system, u)
    return replace(
        carry,
        frozen=_frozen(system, central, origin),
        origin=origin,
        span=system.path.span,
        stale=False,
        factorisations=carry.factorisations + 1,
    )


def _frozen(system: SlabSystem, central: Central, origin: Origin) -> Frozen:
    """The stiffness of the contact nodes as it was somewhere, factored."""
    where = np.flatnonzero(central.light[system.model.free])
    matrix = origin.stiffness(system.model).operator(origin.at)
    factor = SuperLU().factor(sp.csc_array(matrix[where][:, where])) if len(where) else None
    return Frozen(_Light(factor, where), system.directions())
