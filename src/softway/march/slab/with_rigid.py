"""Slab (time step) of solids and rigid bodies: their motions and forces in turn, until both agree.

The solids see the rigid bodies as tools in a motion, and push them; with these forces the rigid bodies have another
motion.  The contraction of this iteration is about the mass of the cells at the contact over that of the rigid body;
mixing the last motions takes care of light bodies (docs/theory/contact/rigid_bodies.md).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import CarriedNodes
from softway.errors import NoConvergence
from softway.march.model_state import ModelState
from softway.march.results.slab_result import SlabResult
from softway.march.rules.slab_rule import Attempt, SlabRule
from softway.march.slab.carried_response import Probing
from softway.march.slab.rigid_forces import forces_on_rigid
from softway.mechanisms.members.stops import StopEvent
from softway.model.model import Model
from softway.model.rigid_bodies import RigidBodies, RigidSlab
from softway.model.rigid_state import RigidState
from softway.model.slab import Slab
from softway.solve.methods.anderson import Anderson
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.stagnation import Stagnation

DEPTH = 6
"""Number of last motions that are mixed."""
AGREES = 1e-12
"""Difference of the motions, relative to the greatest motion, at which they agree."""
ROUNDING = 4.0 * float(np.finfo(float).eps)
"""Difference of the motions, relative to the extent, that is rounding."""
PATIENCE = 4
"""Iterations without progress after which motions that nearly agree are taken."""
NEARLY = 1e-9
"""Difference of such motions, relative to the greatest motion."""
LIMIT = 40
"""Greatest number of iterations."""
ROUGH, SHARE = 1e-5, 0.003
"""Greatest tolerance of the solids, and tolerance relative to the difference of the motions, while they disagree."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoupledSlab:
    """Slab of solids, with the state of the rigid bodies at its end that belongs to the forces on them, and the events
    of their stops.
    """

    out: SlabResult
    rigid: RigidState
    memory: OperatorMemory
    events: tuple[StopEvent, ...]


def coupled_slabs(
    rule: SlabRule, model: Model, now: ModelState, slab: Slab, memory: OperatorMemory, attempt: Attempt
) -> Iterator[CoupledSlab]:
    """Solutions of a slab, each more accurate than the previous one.

    Raises
    ------
    NoConvergence, TooFast
        If the motions do not come to agree, or as for the rule of the solids.
    """
    it = _Iteration.of(model, now, slab)
    x = it.follow(it.before.given)
    mixing, seen, closest, iterations = Anderson(DEPTH), Stagnation(), np.inf, 0
    step: Array | None = None
    attempt = replace(attempt, tolerance=ROUGH)
    for _ in range(LIMIT):
        out, memory = next(rule.solve(it.moving(x), now, slab, memory, attempt))
        iterations += out.iterations
        given = forces_on_rigid(out.system.model, now, slab, out)
        after = it.after(given)
        found = it.motion(after)
        change, scale = float(np.abs(found - x).max()), float(np.abs(found).max())
        seen = seen.after(change, it.least)
        agrees = change <= max(AGREES * scale, it.least) or (seen.since >= PATIENCE and change <= NEARLY * scale)
        if agrees and change < 0.5 * closest and attempt.tolerance <= AGREES:
            closest = change
            whole = replace(out, iterations=iterations)
            yield CoupledSlab(out=whole, rigid=after.state, memory=memory, events=after.events)
        if closest < np.inf and (seen.since >= PATIENCE or change <= it.least):
            return
        step = it.newton(out, given) if step is None else step
        x = mixing.mix(x.ravel(), x.ravel() + step @ (found - x).ravel()).reshape(x.shape)
        guess, tolerance = replace(out.solution.last.guess, near=True), 0.0 if agrees else SHARE * change / scale
        attempt = replace(attempt, guess=guess, tolerance=min(tolerance, ROUGH))
    if closest == np.inf:
        raise NoConvergence(f"rigid bodies and solids do not agree on their motion: {change:.1e} of {scale:.1e} m")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Iteration:
    """Motions of the rigid bodies (n, 6) in a slab, in units of the extent and of radians times the extent [m].

    Changes below ``least`` are rounding errors.
    """

    model: Model
    rigid: RigidBodies
    before: RigidState
    slab: Slab
    extent: float
    least: float

    @classmethod
    def of(cls, model: Model, now: ModelState, slab: Slab) -> "_Iteration":
        """Iteration of a slab from a state."""
        assert model.rigid is not None and now.rigid is not None
        extent = max(model.rigid.extent(now.rigid), model.extent(now.start.displacement))
        least = ROUNDING * extent
        return cls(model=model, rigid=model.rigid, before=now.rigid, slab=slab, extent=extent, least=least)

    @property
    def unit(self) -> Array:
        """Units (6,) of motions."""
        return np.array([1.0] * 3 + [self.extent] * 3)

    def after(self, given: Array) -> RigidSlab:
        """Slab of the rigid bodies with mean forces ``given`` (b, 4, 3)."""
        return self.rigid.slab(self.before, self.slab.start, self.slab.span, given)

    def follow(self, given: Array) -> Array:
        """Motions (n, 6) with mean forces ``given`` (b, 4, 3)."""
        return self.motion(self.after(given))

    def motion(self, after: RigidSlab) -> Array:
        """Motions (n, 6) over a slab of the rigid bodies."""
        return self.rigid.moved(self.before, after.state) * self.unit

    def moving(self, x: Array) -> Model:
        """Model whose rigid bodies have the motions x (n, 6)."""
        motions = self.rigid.motions(self.before, x / self.unit, self.slab.start, self.slab.end)
        return self.model.with_motions(motions)

    def newton(self, out: SlabResult, given: Array) -> Array:
        """Matrix (6 n, 6 n) that makes Newton's step of the difference of two motions, with the solids frozen."""
        size, frozen = 6 * len(self.before.place), out.solution.last.memory.frozen
        if frozen is None or not any(isinstance(support, CarriedNodes) for support, _ in self.model.driven):
            return np.eye(size)
        probing = Probing(
            model=out.system.model,
            frozen=frozen,
            u=out.solution.end.displacement,
            span=self.slab.span,
            extent=self.extent,
        )
        return np.asarray(np.linalg.inv(np.eye(size) - probing.response(given, self.follow)))
