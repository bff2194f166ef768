"""Response of the rigid bodies to their own motion, through the solids that they carry.

A light body that carries a heavy solid would overshoot by the ratio of their masses if motions and forces were found
in turn.  The derivative of the motion that follows with respect to the one that was assumed gives Newton's step; the
solid is condensed with its frozen operator (docs/theory/contact/rigid_bodies.md).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import CarriedNodes
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator

SMALL = 1e-6
"""Size of a probing motion, relative to the extent."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Probing:
    """What the response is computed from.

    Parameters
    ----------
    model
        Model with the motions of its rigid bodies in this slab.
    frozen
        Operator of the solids.
    u
        (n, d) displacement at the end of the slab [m].
    span
        Length of the slab [s].
    extent
        Scale of the motions [m].
    """

    model: Model
    frozen: FrozenOperator
    u: Array
    span: float
    extent: float

    def response(self, given: Array, follow: Callable[[Array], Array]) -> Array:
        """Derivative (6 n, 6 n) of the motion that follows.

        Parameters
        ----------
        given
            (b, 4, 3) mean forces on the rigid bodies.
        follow
            Motion (n, 6) of the bodies under such forces, in metres, rotations times the extent.
        """
        first = follow(given)
        out = np.zeros((first.size, first.size))
        carried = [s for s, _ in self.model.driven if isinstance(s, CarriedNodes)]
        rigid = self.model.rigid
        assert rigid is not None
        for k in sorted({rigid.number(s.by) for s in carried} - {len(rigid.it.names)}):
            for c in (0, 1, 5) if self.model.shape[1] == 2 else range(6):
                push = self._push(self._field([s for s in carried if rigid.number(s.by) == k], c), carried)
                size = SMALL * self.extent
                out[:, 6 * k + c] = (follow(given + size * push) - first).ravel() / size
        return out

    def _field(self, carried: list[CarriedNodes], c: int) -> Array:
        """Displacement (n, d) of carried nodes by a motion ``c`` of their body: a metre, or the angle 1 m / extent."""
        out, d = np.zeros(self.model.shape), self.model.shape[1]
        for one in carried:
            axis, arm = np.zeros(3), self._mean_arms(one)
            axis[c % 3] = 1.0
            moved = np.tile(axis, (len(arm), 1)) if c < 3 else np.cross(axis, arm) / self.extent
            out[one.nodes] = moved[:, :d]
        return out

    def _mean_arms(self, one: CarriedNodes) -> Array:
        """Means (k, 3) of the places of carried nodes at both ends of the slab, relative to the centre."""
        motion = one.motion
        ends = [motion.turned(time) for time in (motion.begin, motion.end)]
        return np.asarray(motion.arms(one.place) @ (0.5 * (ends[0] + ends[1])).T)

    def _push(self, moved: Array, carried: list[CarriedNodes]) -> Array:
        """Mean forces (b, 4, 3) of the solids on the bodies by a displacement (n, d) of carried nodes at the end."""
        model = self.model
        force = model.tangent_product(self.u, moved)
        q = model.dofs.nodes(self.frozen.solve(-0.5 * self.span * model.dofs.forces(force)))
        force = force + model.tangent_product(self.u, 0.5 * self.span * q)
        return forces_on_carriers(model, carried, -0.5 * force)


def forces_on_carriers(model: Model, carried: list[CarriedNodes], force: Array) -> Array:
    """Forces (b, 4, 3) on the rigid bodies by forces (n, d) at the nodes that they carry."""
    assert model.rigid is not None
    given = np.zeros((len(model.rigid.it.names) + 1, 4, 3))
    for one in carried:
        add_force(given[model.rigid.number(one.by)], one.motion.arms(one.place), force[one.nodes])
    return given[:-1]


def add_force(given: Array, arms: Array, force: Array) -> None:
    """Add forces (m, d) at the points ``arms`` (m, 3) of a body to ``given`` (4, 3)."""
    pull = np.zeros((len(force), 3))
    pull[:, : force.shape[1]] = force
    given[0] += pull.sum(axis=0)
    given[1:] += arms.T @ pull
