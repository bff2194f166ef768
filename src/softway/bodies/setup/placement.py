"""Placement of a mesh in the scene: rotation, translation, and height of its lowest node."""

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.meshes.mesh import Mesh
from softway.units import Metre, Pure

Radian = Annotated[float, "rad"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rotation:
    """Rotation by ``angle`` about ``axis`` (right-hand rule); in 2D the axis is z.

    Parameters
    ----------
    angle
        Angle of rotation [rad].
    axis
        Direction of the axis, of any length.

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
            raise InputError("axis", f"{list(self.axis)} is not a direction", "three numbers such as [0, 0, 1]")

    def matrix(self) -> Array:
        """Rotation matrix (3, 3) by Rodrigues' formula."""
        x, y, z = np.asarray(self.axis, float) / np.linalg.norm(self.axis)
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        turn: Array = np.eye(3) + np.sin(self.angle) * cross + (1.0 - np.cos(self.angle)) * (cross @ cross)
        return turn


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Placement of a mesh in the scene: rotation about the centre of its bounding box, then translation.

    Parameters
    ----------
    rotations
        Rotations about fixed axes, applied in order; three of them are Euler angles.
    translation
        Translation (d,) [m]; empty for none.
    bottom
        Coordinate of the lowest node along the last axis [m]; the body is moved along this axis after the rotations and
        the translation.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> Placement(bottom=5.0).applied(interval(10.0, cells=2)).points.ravel()
    array([ 5., 10., 15.])
    """

    rotations: tuple[Rotation, ...] = ()
    translation: tuple[Metre, ...] | Metre = ()
    bottom: Metre | None = None

    def applied(self, mesh: Mesh) -> Mesh:
        """Placed mesh; the mesh itself for the default placement."""
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
    """Points (n, d) after the rotations about the centre of their bounding box."""
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
