"""Where a body stands: its mesh turned, moved, and set above a level."""

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from softway.errors import InputError
from softway.space.mesh import Mesh
from softway.typing import Array
from softway.units import Metre, Pure

Radian = Annotated[float, "rad"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rotation:
    """A turn by ``angle`` about ``axis`` (right hand rule); in 2D the axis is z.

    Parameters
    ----------
    angle
        [rad].
    axis
        Direction, of any length.

    Examples
    --------
    >>> Rotation(angle=np.pi / 2).matrix().round(12)[:2, :2]
    array([[ 0., -1.],
           [ 1.,  0.]])
    """

    angle: Radian
    axis: tuple[Pure, Pure, Pure] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        if len(self.axis) != 3 or not np.linalg.norm(self.axis) > 0.0:
            raise InputError("axis", f"{list(self.axis)} is no direction", "three numbers such as [0, 0, 1]")

    def matrix(self) -> Array:
        """Rotation matrix (3, 3) by Rodrigues' formula."""
        x, y, z = np.asarray(self.axis, float) / np.linalg.norm(self.axis)
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        turn: Array = np.eye(3) + np.sin(self.angle) * cross + (1.0 - np.cos(self.angle)) * (cross @ cross)
        return turn


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """How a mesh is set into the scene: turned about the centre of its bounding box, then moved.

    Parameters
    ----------
    rotations
        Turns about fixed axes, applied in order; three of them are Euler angles.
    translation
        Shift (d,) [m]; empty for none.
    bottom
        If given: after the turns and the shift, the body is moved along its last axis until its lowest node has this
        coordinate [m].

    Examples
    --------
    >>> from softway.space.shapes import interval
    >>> Placement(bottom=5.0).applied(interval(10.0, cells=2)).points.ravel()
    array([ 5., 10., 15.])
    """

    rotations: tuple[Rotation, ...] = ()
    translation: tuple[Metre, ...] | Metre = ()
    bottom: Metre | None = None

    def applied(self, mesh: Mesh) -> Mesh:
        """The mesh in its place; the same mesh if nothing is to be done."""
        if self == Placement():
            return mesh
        dim = mesh.dim
        points = _turned(mesh.points, self.rotations)
        shift = np.atleast_1d(np.asarray(self.translation, float))
        if shift.size not in (0, dim):
            raise InputError("translation", f"{shift.size} components in {dim}D", f"{dim} components, or none")
        if shift.size:
            points = points + shift
        if self.bottom is not None:
            points = points.copy()
            points[:, -1] += self.bottom - points[:, -1].min()
        return replace(mesh, points=points)


def _turned(points: Array, rotations: tuple[Rotation, ...]) -> Array:
    """Points (n, d) after the turns about the centre of their bounding box."""
    dim = points.shape[1]
    if not rotations:
        return points
    total = np.eye(3)
    for k, rotation in enumerate(rotations):
        if dim == 1 or (dim == 2 and (rotation.axis[0] or rotation.axis[1])):
            remedy = "no rotation in 1D" if dim == 1 else "the axis [0, 0, 1] in 2D"
            raise InputError(f"rotations[{k}].axis", f"{list(rotation.axis)} leaves the space of the mesh", remedy)
        total = rotation.matrix() @ total
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    turned: Array = (points - centre) @ total[:dim, :dim].T + centre
    return turned
