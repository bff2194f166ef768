"""Placement of a mesh in the scene: mirror, rotation, translation, and height of its lowest node."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Axisymmetric, Section
from softway.errors import InputError, within
from softway.meshes.adaptive.adapt import Adapting, adaption
from softway.meshes.adaptive.surfaces.lowest import lowest
from softway.meshes.adaptive.surfaces.surface import ROUND, rounded
from softway.meshes.cells import CELLS
from softway.meshes.generators.recipes import Ball, Cylinder, Disc, Divided, GradedDisc, MeshSource, Ring
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
class Mirror:
    """Mirror image in a plane; in 2D in a line.

    Parameters
    ----------
    normal
        Direction perpendicular to the plane, of any length; one number in one dimension.
    point
        Point of the plane [m]; empty for the point about which the mesh is placed.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> image = Placement(mirror=Mirror(normal=(1.0,), point=(0.0,))).applied(interval(1.0, cells=1))
    >>> image.points.ravel().tolist(), image.nodes("right").tolist()
    ([0.0, -1.0], [1])
    """

    normal: tuple[Pure, ...]
    point: tuple[Metre, ...] = ()

    def __post_init__(self) -> None:
        if not 0.0 < np.linalg.norm(np.asarray(self.normal, float)) < np.inf:
            raise InputError("normal", f"{list(self.normal)} is not a direction", "numbers that are not all zero")

    def applied(self, points: Array, about: Array) -> Array:
        """Mirror image (n, d) of points (n, d); ``about`` (d,) is the point about which they are placed.

        Raises
        ------
        InputError
            If the plane lies in a space of another dimension.
        """
        dim = points.shape[1]
        if len(self.normal) != dim or len(self.point) not in (0, dim):
            problem = f"a normal of {len(self.normal)} and a point of {len(self.point)} components in {dim}D"
            raise InputError("mirror", problem, f"{dim} components")
        n = np.asarray(self.normal, float) / np.linalg.norm(self.normal)
        through = np.asarray(self.point, float) if self.point else about
        return np.asarray(points - 2.0 * np.outer((points - through) @ n, n))


@dataclass(frozen=True, slots=True, kw_only=True)
class Placement:
    """Placement of a mesh in the scene: mirror and rotation, then translation.

    Bodies with equal placements about a common point are placed together, like one.

    Parameters
    ----------
    mirror
        Plane in which the mesh is mirrored first; the order of the nodes in the cells is turned over, tags stay.
    rotations
        Rotations about fixed axes, applied in order; three of them are Euler angles.
    about
        Point of the axes of the rotations [m]; empty for the centre of the bounding box of the mesh.
    translation
        Translation (d,) [m]; empty for none.
    bottom
        Coordinate of the lowest node along the last axis [m]; the body is moved along this axis after the rotations and
        the translation. That of the lowest place of its curved boundary if the mesh of the solid adapts.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> Placement(bottom=5.0).applied(interval(10.0, cells=2)).points.ravel()
    array([ 5., 10., 15.])
    """

    mirror: Mirror | None = None
    rotations: tuple[Rotation, ...] = ()
    about: tuple[Metre, ...] = ()
    translation: tuple[Metre, ...] | Metre = ()
    bottom: Metre | None = None

    def applied(self, mesh: Mesh, low: Callable[[Mesh], float] | None = None) -> Mesh:
        """Placed mesh; the mesh itself for the default placement.

        ``low`` gives the coordinate of ``bottom`` of a mesh in another place [m]; that of its lowest node without.
        """
        if self == Placement():
            return mesh
        dim = mesh.dim
        points, blocks = mesh.points, mesh.blocks
        if len(self.about) not in (0, dim):
            raise InputError("about", f"{len(self.about)} components in {dim}D", f"{dim} components, or none")
        about = np.asarray(self.about, float) if self.about else 0.5 * (points.min(axis=0) + points.max(axis=0))
        if self.mirror is not None:
            points = self.mirror.applied(points, about)
            blocks = {cell: nodes[:, _turned_over(cell)] for cell, nodes in blocks.items()}
        points = _turned(points, self.rotations, about)
        shift = np.atleast_1d(np.asarray(self.translation, float))
        if shift.size not in (0, dim):
            raise InputError("translation", f"{shift.size} components in {dim}D", f"{dim} components, or none")
        if shift.size:
            points = points + shift
        if self.bottom is not None:
            least = points[:, -1].min() if low is None else low(replace(mesh, points=points, blocks=blocks))
            points = points.copy()
            points[:, -1] += self.bottom - least
        return replace(mesh, points=points, blocks=blocks)


def placed(
    mesh: Mesh, own: Placement, group: tuple[Placement, ...], low: Callable[[Mesh], float] | None = None
) -> Mesh:
    """Mesh of a solid after its own placement and those of its groups; ``low`` as for :meth:`Placement.applied`.

    Raises
    ------
    InputError
        With the key, and the number of the group.
    """
    with within("place"):
        mesh = own.applied(mesh, low)
    for k, place in enumerate(group):
        with within(f"group[{k}]"):
            mesh = place.applied(mesh, low)
    return mesh


def in_place(
    mesh: Mesh, source: MeshSource | Mesh, places: tuple[Placement, ...], adapt: Adapting, section: Section | None
) -> Mesh:
    """Mesh of a solid after its placements.

    The bottom of a solid whose mesh adapts is that of its curved boundary.  The mesh of a round shape of softway keeps
    this boundary, which its nodes alone do not tell.

    Parameters
    ----------
    mesh
        The mesh before the placements.
    source
        What it was built from: a recipe, or the mesh.
    places
        Placement of the solid and those of its groups.
    adapt, section
        Of the solid.

    Raises
    ------
    InputError
        With the key of the placement, and the number of the group.
    """

    def surface(base: Mesh) -> Mesh:
        return with_surface(base, source, adapt, section)

    out = placed(mesh, places[0], places[1:], None if adaption(adapt) is None else lambda base: lowest(surface(base)))
    return surface(out) if is_round(source) else out


def with_surface(base: Mesh, source: MeshSource | Mesh, adapt: Adapting, section: Section | None) -> Mesh:
    """Base mesh with the smooth surface that its refinements follow; itself if it has one or stays as it is."""
    how = adaption(adapt)
    if how is None or base.rounding is not None:
        return base
    smooth = max(ROUND, how.smooth) if is_round(source) and how.smooth > 0.0 else how.smooth
    return rounded(base, smooth, isinstance(section, Axisymmetric))


def is_round(source: MeshSource | Mesh) -> bool:
    """True for the round shapes of softway."""
    recipe = source.mesh if isinstance(source, Divided) else source
    return isinstance(recipe, Disc | Cylinder | Ball | Ring | GradedDisc)


def _turned_over(cell: str) -> IntArray:
    """Order (a,) of the nodes of a cell in its mirror image: of a bar from the other end, others with the first two
    axes exchanged.
    """
    nodes = CELLS[cell].nodes
    image = 1.0 - nodes if CELLS[cell].dim == 1 else nodes[:, [1, 0, *range(2, CELLS[cell].dim)]]
    return np.asarray(np.argmin(np.abs(image[:, None] - nodes).sum(axis=2), axis=1))


def _turned(points: Array, rotations: tuple[Rotation, ...], centre: Array) -> Array:
    """Points (n, d) after the rotations about a centre (d,)."""
    dim = points.shape[1]
    if not rotations:
        return points
    total = np.eye(3)
    for k, rotation in enumerate(rotations):
        if dim == 1 or (dim == 2 and (rotation.axis[0] or rotation.axis[1])):
            remedy = "no rotation in 1D" if dim == 1 else "the axis [0, 0, 1] in 2D"
            raise InputError(f"rotations[{k}].axis", f"{list(rotation.axis)} leaves the space of the mesh", remedy)
        total = rotation.matrix() @ total
    turned: Array = (points - centre) @ total[:dim, :dim].T + centre
    return turned
