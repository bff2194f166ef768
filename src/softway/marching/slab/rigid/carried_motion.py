"""Motion of the rigid bodies that carry nodes of the solids, as a part of the solids' own iteration.

A light body that carries a heavy solid would overshoot by the ratio of their masses if motions and forces were found
in turn.  With the frozen operator the solid is condensed to the bodies: every iterate moves them and the nodes that
they carry to where the forces after this very motion put them (docs/theory/contact/rigid_bodies.md).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import CarriedNodes, RigidMotion
from softway.marching.slab.rigid.rigid_forces import carried_nodes, carriers, fields, forces_on_carriers
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_values import Evaluation

SMALL = 1e-6
"""Size of a probing motion, relative to the extent."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Response:
    """Answers of the solids, condensed with an operator, to motions and of the bodies to forces.

    Parameters
    ----------
    coupling
        (f, b) forces on the unknowns by unit displacements along the :func:`fields` [N/m]: also the products of the
        fields with the forces on carried nodes by a displacement of the unknowns.
    answer
        (f, c) change of the unknowns by a motion.
    newton
        (c, c) motion by the difference between the motion that follows and the one that was assumed.
    """

    coupling: Array
    answer: Array
    newton: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CarriedMotion:
    """Motions of the rigid bodies over a slab, as velocities x (6 n,) [m/s].

    Parameters
    ----------
    base
        Model whose rigid bodies have the motions of the first iterate.
    u, span, extent
        (n, d) displacement at the start [m], length of the slab [s], and length that makes rotations ways [m].
    follow
        Motions (n, 6) of the bodies under mean forces (b, 4, 3), in metres, rotations times the extent.
    motions
        Motions of the bodies by name, from x (n, 6) in the same units.
    before, others
        (b, 4, 3) mean forces of the solids on the bodies in the slab before, and elsewhere than at carried nodes.
    x
        (6 n,) present motion.
    response
        Response with the operator of the iteration; None before it is prepared.
    """

    base: Model
    u: Array
    span: float
    extent: float
    follow: Callable[[Array], Array]
    motions: Callable[[Array], Mapping[str, RigidMotion]]
    before: Array
    others: Array
    x: Array
    response: Response | None = None

    @property
    def carried(self) -> list[CarriedNodes]:
        """Nodes that rigid bodies carry."""
        return carried_nodes(self.base)

    @property
    def model(self) -> Model:
        """Model whose carried nodes have this motion."""
        motions = self.motions(self.ways(self.x))
        moved = (
            (replace(s, motion=motions[s.by]) if isinstance(s, CarriedNodes) else s, where)
            for s, where in self.base.driven
        )
        return replace(self.base, driven=tuple(moved))

    def at(self, x: Array) -> "CarriedMotion":
        """Motion with another x (6 n,)."""
        return replace(self, x=x)

    def ways(self, x: Array) -> Array:
        """Ways (n, 6) in the slab [m], from x (6 n,)."""
        return np.asarray(0.5 * self.span * x.reshape(-1, 6))

    def given(self, given: Array) -> Array:
        """Values (n, d) of q on supported components, with the motion x on carried nodes."""
        motions, out = self.motions(self.ways(self.x)), given.copy()
        for one in self.carried:
            out[one.nodes] = 2.0 * replace(one, motion=motions[one.by]).at(0.0).reshape(len(one.nodes), -1)
        return out

    def forces(self, end: Evaluation) -> Array:
        """Mean forces (b, 4, 3) of the solids on the bodies in an iterate."""
        held = end.mean_force - self.base.slab_load(end.scalar)
        return self.others + forces_on_carriers(self.base, self.carried, -held)

    def answered(self, q: Array, step: Array, end: Evaluation) -> tuple[Array, Array]:
        """Next unknowns (f,) and motion (6 n,)."""
        assert self.response is not None
        by_step = self.response.coupling.T @ (-0.25 * self.span * (step - q))
        found = self.follow(self.forces(end) + self._on_bodies(by_step)).ravel() * (2.0 / self.span)
        change = self.response.newton @ (found - self.x)
        return step + self.response.answer @ change, self.x + change

    def prepared(self, frozen: FrozenOperator) -> "CarriedMotion":
        """Motion with the response by an operator; one of the same slab is kept."""
        if self.response is not None:
            return self
        model, half = self.base, 0.5 * self.span
        n, d = model.shape
        basis = np.concatenate([fields(model, k, self.carried) for k in carriers(model)], axis=1)
        pushed = np.asarray(model.tangent(self.u) @ basis)
        coupling = np.stack([model.dofs.forces(one.reshape(n, d)) for one in pushed.T], axis=1)
        answer = -half * frozen.solve(coupling)
        stiffness = basis.T @ pushed + half * coupling.T @ answer
        moved = self._along_fields()
        response = Response(
            coupling=coupling,
            answer=half * answer @ moved,
            newton=np.asarray(np.linalg.inv(np.eye(self.x.size) - self._following(-0.5 * stiffness @ moved))),
        )
        return replace(self, response=response)

    def _along_fields(self) -> Array:
        """Displacements (b, 6 n) along the :func:`fields` by unit motions of the bodies."""
        d, rigid, bodies = self.base.shape[1], self.base.rigid, carriers(self.base)
        assert rigid is not None
        out = np.zeros((len(bodies), 1 + d, d, self.x.size))
        for row, k in enumerate(bodies):
            motion = next(one.motion for one in self.carried if rigid.number(one.by) == k)
            middle = 0.5 * (motion.turned(motion.begin) + motion.turned(motion.end))
            for c in range(3):
                axis = np.eye(3)[c]
                out[row, 0, :, 6 * k + c] = axis[:d]
                out[row, 1:, :, 6 * k + 3 + c] = np.cross(axis, middle.T)[:d, :d] / self.extent
        return out.reshape(-1, self.x.size)

    def _following(self, pushes: Array) -> Array:
        """Derivative (c, c) of the motion that follows by a motion that pushes by (b, c) along the fields."""
        first, size, out = self.follow(self.before), SMALL * self.extent, np.zeros((self.x.size,) * 2)
        for c in np.flatnonzero(pushes.any(axis=0)):
            push = self._on_bodies(pushes[:, c])
            out[:, c] = (self.follow(self.before + size * push) - first).ravel() / size
        return out

    def _on_bodies(self, along: Array) -> Array:
        """Forces (b, 4, 3) on the bodies, from their products (b,) with the fields."""
        d, out = self.base.shape[1], np.zeros_like(self.others)
        out[carriers(self.base), : 1 + d, :d] = along.reshape(-1, 1 + d, d)
        return out
