"""Penalty method with Newton's method: springs replace the contact conditions, and every iteration factors anew.

    M (q - v0) + h/2 (f0 + f1 - 2 load) = h G^T k d,    u1 = u0 + h/2 (v0 + q)

``d`` is the depth max(-gap, 0) at the end of the slab, its mean at the two ends, or the secant of its square.
Every node has mass. The energy includes the energy stored in the springs.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from softway.arrays import Array
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import SlabContacts
from softway.contact.slab_motion.trajectory import bent
from softway.errors import NoConvergence, positive
from softway.marching.state.step_control import StepControl
from softway.model.model import Model
from softway.solve.stagnation import Stagnation
from softway.studies.race.springs import Workshop, squeezed

HALVINGS = 8
"""Greatest number of halvings of a Newton step; then the step is accepted."""
GROWTH = 2.0
"""Growth of the residual in an iteration above which the step is halved."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Penalty:
    """Newton's method with penalty springs and the trapezoidal rule.

    Parameters
    ----------
    stiffness
        Stiffness of the springs in units of E A / l, with the plane-wave modulus E, and the area A and edge length l
        at the node.
    mean
        Force of the springs over a slab. ``last``: the force at the end; it dissipates energy and needs the fewest
        iterations. ``ends``: the mean of both ends; it gains energy where the springs are stiff for the slab length.
        ``secant``: the secant of the stored energy, which conserves energy.
    tolerance
        Change of velocity, relative to the greatest velocity, below which an iterate is accepted.
    limit
        Greatest number of iterations; then the slab is tried again with half the length.

    Examples
    --------
    >>> Penalty(stiffness=10.0).limit
    40
    """

    stiffness: float = 50.0
    mean: Literal["secant", "ends", "last"] = "last"
    tolerance: float = 1e-11
    limit: int = 40

    def __post_init__(self) -> None:
        positive(stiffness=self.stiffness, tolerance=self.tolerance, limit=self.limit)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pressed:
    """State of a penalty march at the end of a slab.

    ``displacement``, ``velocity``, ``acceleration`` and internal ``force`` (n, d); ``pressure`` (m,) spring forces [N];
    ``energy`` [J] including the springs; ``work`` [J] of loads, tools and supports since the start; ``gap`` [m] the
    smallest gap; ``iterations`` and ``rejected`` tries of the slab; ``factorisations`` since the start.
    """

    time: float
    displacement: Array
    velocity: Array
    acceleration: Array
    force: Array
    pressure: Array
    energy: float
    work: float
    gap: float
    iterations: int = 0
    factorisations: int = 0
    rejected: int = 0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Penalised:
    """Fixed data of a penalty march; ``springs`` (m,) are stiffnesses [N/m]."""

    model: Model
    method: Penalty
    control: StepControl
    springs: Array


def depths(rows: ContactRows, u: Array) -> tuple[Array, float]:
    """Depth (m,) of the contact rows, minus infinity without a near opponent, and the smallest gap [m]."""
    gap = np.where(rows.near, rows.gap(u), np.inf)
    return -gap, float(gap.min(initial=np.inf))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Slab:
    """Data of a slab: start, end, contact pairs, and contact rows and depths (m,) at the start."""

    rules: Penalised
    now: Pressed
    end: float
    pairs: SlabContacts
    first: ContactRows
    before: Array

    @property
    def span(self) -> float:
        return self.end - self.now.time

    @property
    def load(self) -> Array:
        """Mean loads (n, d) over the slab [N]."""
        return self.rules.model.loads.mean(self.now.time, self.end)

    def displaced(self, q: Array) -> Array:
        """Displacement (n, d) at the end."""
        return self.now.displacement + 0.5 * self.span * (self.now.velocity + q) + self.bent

    @property
    def bent(self) -> Array | float:
        """Displacement (n, d) of supports beyond that of linear velocities."""
        return bent(self.rules.model.bends(self.now.time, self.end), self.span)

    def look(self, q: Array) -> "_Look":
        """Evaluate the forces at the end of the slab and over it."""
        rules, u = self.rules, self.displaced(q)
        energy, force = rules.model.energy_and_force(u)
        rows = self.pairs.at(u)
        after, gap = depths(rows, u)
        depth = np.maximum(after, 0.0)
        if rules.method.mean == "secant":
            unseen = ~np.isfinite(self.before) | ~np.isfinite(after)
            mean, slope = squeezed(np.where(unseen, -depth, self.before), np.where(unseen, depth, after))
        elif rules.method.mean == "last":
            mean, slope = depth, np.where(depth > 0.0, 1.0, 0.0)
        else:
            mean = 0.5 * (np.maximum(self.before, 0.0) + depth)
            slope = np.where(depth > 0.0, 0.5, 0.0)
        h, push = self.span, rows.spread(rules.springs * mean, u.shape)
        forces = 0.5 * (self.now.force + force) - self.load - push
        left = rules.model.mass @ (q - self.now.velocity) + h * forces
        return _Look(
            rows=rows,
            force=force,
            mean=rules.springs * mean,
            stiffness=rules.springs * slope,
            pressure=rules.springs * depth,
            energy=float(energy.sum()) + 0.5 * float(rules.springs @ depth**2),
            gap=gap,
            left=rules.model.dofs.forces(left),
            reaction=rules.model.supported(left / h),
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Look:
    """Forces of an iterate: contact rows, internal force (n, d), mean spring force and its slope (m,), spring forces at
    the end (m,), momentum residual ``left`` of the unknowns (f,), and support reactions (n, d).
    """

    rows: ContactRows
    force: Array
    mean: Array
    stiffness: Array
    pressure: Array
    energy: float
    gap: float
    left: Array
    reaction: Array


def solved(rules: Penalised, now: Pressed, end: float, shop: Workshop) -> tuple[Pressed, Workshop]:
    """Solve one slab by Newton's method, starting from the extrapolated velocity.

    Raises
    ------
    NoConvergence
        If the iteration does not converge.
    """
    model, method, h = rules.model, rules.method, end - now.time
    q = now.velocity + h * now.acceleration
    q = q - model.supported(q) + model.prescribed(end)
    coasting = now.displacement + 0.5 * h * (now.velocity + q) + bent(model.bends(now.time, end), h)
    pairs = model.contacts.meet(now.displacement, coasting, now.time, end)
    first = pairs.start(now.displacement)
    before, _ = depths(first, now.displacement)
    slab = _Slab(rules=rules, now=now, end=end, pairs=pairs, first=first, before=before)
    look, seen, change = slab.look(q), Stagnation(), np.inf
    for count in range(1, method.limit + 1):
        pressed = np.flatnonzero(look.stiffness)
        rows = look.rows.matrix(model.dofs)[pressed]
        matrix = model.inertia_and_stiffness(slab.displaced(q), 0.25 * h**2)
        factor, shop = shop.factored(matrix, rows, 0.5 * h**2 * look.stiffness[pressed])
        step = model.dofs.nodes(-factor.solve(look.left))
        q, look = _searched(slab, q, step, look)
        scale = max(np.abs(q).max(initial=0.0), np.abs(now.velocity).max(initial=0.0), 1e-300)
        change = float(np.abs(step).max(initial=0.0)) / scale
        seen = seen.after(change)
        if change <= method.tolerance * (1.0 if seen.since < 6 else 1e3):
            return replace(_arrived(slab, q, look), iterations=count), shop
    raise NoConvergence(f"{method.limit} iterations leave a relative change of {change:.1e}")


def _searched(slab: _Slab, q: Array, step: Array, look: _Look) -> tuple[Array, _Look]:
    """Line search along the step (n, d): halve it until the residual grows by no more than ``GROWTH``.

    Raises
    ------
    NoConvergence
        If cells are inverted for every step length.
    """
    share, length = 1.0, float(np.linalg.norm(look.left))
    for halvings in range(HALVINGS + 1):
        new = q + share * step
        found = slab.look(new)
        shorter = halvings == HALVINGS or np.linalg.norm(found.left) <= GROWTH * length
        if np.isfinite(found.left).all() and shorter:
            return new, found
        share *= 0.5
    raise NoConvergence("the iteration left the admissible configurations (inverted cell or overflow)")


def _arrived(slab: _Slab, q: Array, look: _Look) -> Pressed:
    """State at the end of the slab, with energy and work."""
    model, now, u1 = slab.rules.model, slab.now, slab.displaced(q)
    tools = 0.5 * float(look.mean @ (slab.first.tool_motion + look.rows.tool_motion))
    moved = float(np.sum((slab.load + look.reaction) * (u1 - now.displacement)))
    bends = float(np.sum(model.mass @ ((q - now.velocity) / slab.span) * slab.bent))
    return Pressed(
        time=slab.end,
        displacement=u1,
        velocity=q,
        acceleration=(q - now.velocity) / slab.span,
        force=look.force,
        pressure=look.pressure,
        energy=look.energy + float(model.kinetic(q).sum()),
        work=now.work + tools + moved - bends,
        gap=look.gap,
    )
