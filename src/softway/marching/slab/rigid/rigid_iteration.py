"""Rigid bodies in a slab (time step) of solids: from their motion to that of carried nodes and tools, and from the
forces of the solids to the motion that follows.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import RigidMotion
from softway.marching.results.slab_result import SlabResult
from softway.marching.slab.rigid.carried_motion import CarriedMotion, Response
from softway.marching.slab.rigid.rigid_forces import carriers, forces_on_rigid
from softway.marching.state.model_state import ModelState
from softway.model.field import StopsInSlab
from softway.model.model import Model
from softway.model.rigid.rigid_bodies import RigidBodies, RigidSlab
from softway.model.rigid.rigid_state import RigidState
from softway.model.slab import Slab
from softway.solve.stagnation import Stagnation

AGREES = 1e-12
"""Difference of the motions, relative to the greatest motion, at which they agree."""
ROUNDING = 4.0 * float(np.finfo(float).eps)
"""Difference of the motions, relative to the extent, that is rounding."""
PATIENCE = 4
"""Iterations without progress after which motions that nearly agree are taken."""
NEARLY = 1e-9
"""Difference of such motions, relative to the greatest motion."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Answer:
    """Rigid bodies under the forces of a solution of the solids.

    Parameters
    ----------
    after, motion, seen
        Slab of the rigid bodies, their motions (n, 6), and those that the carried nodes had [m].
    others
        (b, 4, 3) mean forces of the solids on them elsewhere than at carried nodes.
    change, scale
        Greatest difference from the motions that the solids saw, and greatest motion [m].
    joint
        True if the iteration of the solids has moved the carried nodes with the bodies.
    """

    after: RigidSlab
    motion: Array
    seen: Array
    others: Array
    change: float
    scale: float
    joint: bool

    def agrees(self, seen: Stagnation, least: float) -> bool:
        """True if the solids saw the motion that follows, up to rounding, of which ``least`` [m] are certain."""
        if self.change <= max(AGREES * self.scale, least):
            return True
        return seen.since >= PATIENCE and self.change <= NEARLY * self.scale


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidIteration:
    """Motions of the rigid bodies (n, 6) in a slab, in units of the extent and of radians times the extent [m].

    Changes below ``least`` are rounding errors; bodies are ``touched`` if a contact may be with one of them.
    """

    model: Model
    rigid: RigidBodies
    before: RigidState
    slab: Slab
    extent: float
    least: float
    touched: bool

    @classmethod
    def of(cls, model: Model, now: ModelState, slab: Slab) -> "RigidIteration":
        """Iteration of a slab from a state."""
        assert model.rigid is not None and now.rigid is not None
        extent = max(model.rigid.extent(now.rigid), model.extent(now.start.displacement))
        return cls(
            model=model,
            rigid=model.rigid,
            before=now.rigid,
            slab=slab,
            extent=extent,
            least=ROUNDING * extent,
            touched=any(contact.opponent in model.rigid.mechanism.bodies for contact in model.scene.contacts),
        )

    def feels(self, found: Answer, stops: StopsInSlab, waited: int) -> bool:
        """True if the solids felt the ``stops`` as they are, up to rounding, or have ``waited`` for it long enough."""
        scale = float(np.abs(found.after.state.energy).sum() + np.abs(found.after.state.work).sum())
        return waited >= PATIENCE or found.after.stops.agrees(stops, AGREES, ROUNDING * scale)

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

    def motions(self, x: Array) -> dict[str, RigidMotion]:
        """Motions of the bodies by name, from x (n, 6)."""
        return self.rigid.motions(self.before, x / self.unit, self.slab.start, self.slab.end)

    def moving(self, x: Array) -> Model:
        """Model whose rigid bodies have the motions x (n, 6)."""
        return self.model.with_motions(self.motions(x))

    def follower(
        self, moving: Model, now: ModelState, x: Array, others: Array, response: Response | None
    ) -> CarriedMotion | None:
        """Carried nodes in the motions x (n, 6), with the forces of the solids on the bodies elsewhere."""
        if not carriers(moving):
            return None
        return CarriedMotion(
            base=moving,
            u=now.start.displacement,
            span=self.slab.span,
            extent=self.extent,
            follow=self.follow,
            motions=self.motions,
            before=self.before.given,
            others=others,
            x=2.0 / self.slab.span * x.ravel(),
            response=response,
        )

    def answer(self, out: SlabResult, now: ModelState, x: Array) -> Answer:
        """Rigid bodies under the forces of the solids, which saw them in the motions x (n, 6)."""
        given = forces_on_rigid(out.system.model, now, self.slab, out)
        after, carried = self.after(given), out.solution.last.system.follower
        motion, seen = self.motion(after), x
        others = np.zeros_like(given)
        if isinstance(carried, CarriedMotion):
            seen, others = carried.ways(carried.x), given - carried.forces(out.solution.end) + carried.others
        change = max(float(np.abs(motion - one).max()) for one in ((x, seen) if self.touched else (seen,)))
        scale, joint = float(np.abs(motion).max()), float(np.abs(seen - x).max()) > self.least
        return Answer(after=after, motion=motion, seen=seen, others=others, change=change, scale=scale, joint=joint)

    def response(self, out: SlabResult) -> Response | None:
        """Response of the carried nodes, by the operator of a solution; None without them."""
        carried, frozen = out.solution.last.system.follower, out.solution.last.memory.frozen
        return None if frozen is None or not isinstance(carried, CarriedMotion) else carried.prepared(frozen).response
