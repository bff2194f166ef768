"""Which node may touch which obstacle, at any deformation: exact gaps, and their linear form at a configuration."""

from dataclasses import dataclass

import numpy as np

from softway.contact.candidates import Candidates
from softway.space.curved import Shape
from softway.space.obstacles import HalfSpace
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pairs:
    """Nodes against obstacles, one row each.

    Parameters
    ----------
    node, contact
        (m,) node of the model and number of the contact.
    points
        (m, d) reference positions of the nodes [m].
    shapes
        The obstacle of each contact.
    reference
        The linear form at the reference configuration.
    """

    node: IntArray
    contact: IntArray
    points: Array
    shapes: tuple[Shape, ...]
    reference: Candidates

    @property
    def flat(self) -> bool:
        """Whether every obstacle is a half-space, so that one linear form serves everywhere."""
        return all(isinstance(s, HalfSpace) for s in self.shapes)

    def gap(self, u: Array) -> Array:
        """Exact gap (m,) at the displacement ``u`` (n, d) [m]."""
        if self.flat:
            return self.reference.gap(u)
        x, out = self.points + u[self.node], np.empty(len(self.node))
        for k, shape in enumerate(self.shapes):
            out[self.contact == k] = shape.gap(x[self.contact == k])
        return out

    def at(self, u: Array) -> Candidates:
        """The rows linear in the displacement, exact in value and normal at ``u`` (n, d)."""
        if self.flat:
            return self.reference
        return linear(self.node, self.contact, self.points, u[self.node], self.shapes, self.reference.labels)


def linear(
    node: IntArray, contact: IntArray, points: Array, u: Array, shapes: tuple[Shape, ...], labels: tuple[str, ...]
) -> Candidates:
    """Rows (m,) whose gap and normal are exact at the displacements ``u`` (m, d) of their nodes."""
    x = points + u
    gap, normal = np.empty(len(node)), np.empty_like(points)
    for k, shape in enumerate(shapes):
        here = contact == k
        gap[here], normal[here] = shape.gap(x[here]), shape.normal_at(x[here])
    offset = gap - np.einsum("mi,mi->m", normal, u)
    return Candidates(node=node, contact=contact, normal=normal, offset=offset, labels=labels)
