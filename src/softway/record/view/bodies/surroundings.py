"""Surroundings of the bodies in a picture: camera, floor with a shadow, outlines, ruler."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.obstacles.half_space import HalfSpace
from softway.record.read.cells import Cells
from softway.record.read.surface_mesh import Skin
from softway.record.view.bodies.obstacle_outline import draw
from softway.record.view.style import library, scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FLOOR, SHADOW, LINE = "#ececec", "#d3d3d3", "#8a8a8a"
SHARP = np.cos(np.radians(50.0))
"""Cosine of 50 degrees: a larger angle between the normals of two facets makes their common edge a feature edge."""


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """Parallel projection; the rows of ``axes`` (3, 3) are the directions right, up, and towards the viewer."""

    axes: Array

    def seen(self, points: Array) -> Array:
        """Coordinates of points (..., 3) in the axes of the picture."""
        return np.asarray(points @ self.axes.T)


def camera(cells: Cells, points: Array, tools: Mapping[str, PlacedShape], focus: Array | None = None) -> Camera:
    """Camera that shows plane bodies from the front, and volumes from 18 degrees above the first obstacle.

    The normal of the obstacle points upwards in the picture; a normal that points downwards in space is reversed.  Of
    four directions around the normal the one that shows the ``focus`` (3,) best is taken; the default focus is the
    lowest point.
    """
    if cells.dimension < 3:
        return Camera(np.eye(3))
    middle = points.mean(axis=0)
    up = next((tool.normal_at(middle) for tool in tools.values()), np.array([0.0, 0.0, 1.0]))
    up = -up if up[2] < -1e-9 else up
    side = np.cross(up, np.eye(3)[int(np.argmin(np.abs(up)))])
    side /= np.linalg.norm(side)
    across, rise = np.cross(up, side), np.radians(18.0)
    nearest = (points[int(np.argmin(points @ up))] if focus is None else focus) - middle
    levels = [np.cos(a) * side + np.sin(a) * across for a in np.radians([35.0, 125.0, 215.0, 305.0])]
    level = max(levels, key=lambda direction: round(float(nearest @ direction / np.ptp(points, axis=0).max()), 6))
    eye = np.cos(rise) * level + np.sin(rise) * up
    right = np.cross(up, eye) / np.linalg.norm(np.cross(up, eye))
    return Camera(np.array([right, np.cross(eye, right), eye]))


def ground(axis: "Axes", skin: Skin, points: Array, tools: Mapping[str, PlacedShape], view: Camera) -> None:
    """Draw each obstacle near the body: half-spaces as a plate with a shadow, or as a hatched band in the plane."""
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    for tool in tools.values():
        flat = plane(tool)
        if flat is None:
            draw(axis, tool, points, view.axes)
            continue
        point, normal = flat
        if ((points - point) @ normal).min() > 0.75 * size:
            continue
        centre = points.mean(axis=0) - ((points.mean(axis=0) - point) @ normal) * normal
        if skin.mesh.dim == 3:
            _plate(axis, skin, points, view, (normal, point, centre))
        else:
            _band(axis, normal, centre, 0.75 * size)


def plane(tool: PlacedShape) -> tuple[Array, Array] | None:
    """Point and normal, (3,) each, of a half-space in its present position; None for other shapes."""
    if not isinstance(tool.shape, HalfSpace):
        return None
    point, normal = np.zeros(3), np.zeros(3)
    point[: tool.dim] = tool.pose.place(np.atleast_1d(tool.shape.point))
    normal[: tool.dim] = tool.pose.turn(np.atleast_1d(tool.shape.normal))
    return point, normal


def _plate(axis: "Axes", skin: Skin, points: Array, view: Camera, plane: tuple[Array, Array, Array]) -> None:
    normal, point, centre = plane
    if normal @ view.axes[2] <= 0.0:
        return
    flat = points - ((points - point) @ normal)[:, None] * normal
    reach = 1.25 * np.linalg.norm(flat - centre, axis=1).max()
    first = view.axes[0] - (view.axes[0] @ normal) * normal
    first /= np.linalg.norm(first)
    angle = np.linspace(0.0, 2.0 * np.pi, 97)[:, None]
    rim = centre + reach * (np.cos(angle) * first + np.sin(angle) * np.cross(normal, first))
    axis.fill(*view.seen(rim).T[:2], facecolor=FLOOR, edgecolor="none", zorder=0)
    shadow = view.seen(skin.spread(flat))
    collection = library().collections.PolyCollection
    axis.add_collection(collection(shadow[:, :, :2], facecolors=SHADOW, edgecolors=SHADOW, linewidths=0.4, zorder=1))


def _band(axis: "Axes", normal: Array, centre: Array, reach: float) -> None:
    along = np.array([-normal[1], normal[0], 0.0])
    ends = centre + reach * np.array([[-1.0], [1.0]]) * along
    below = ends[::-1] - 0.12 * reach * normal
    corners = np.concatenate([ends, below])[:, :2]
    axis.fill(*corners.T, facecolor=FLOOR, edgecolor=LINE, hatch="////", lw=0.0, zorder=0)
    axis.plot(*ends[:, :2].T, color="#444444", lw=1.4, zorder=1)


def edges(skin: Skin, shape: Array, view: Camera) -> IntArray:
    """Nodes (k, 3) of the outlines of a shape (n, 3): first end, middle and last end of each line.

    The outlines of volumes are the visible sharp edges and the silhouette; those of plane bodies are the boundary.
    """
    if skin.mesh.dim == 2:
        return np.concatenate([f[:, [0, 0 if f.shape[1] == 2 else 2, 1]] for f in skin.boundary.values()])
    found, normals = [], []
    for name, facets in skin.boundary.items():
        c = 3 if name.startswith("tri") else 4
        normal = np.cross(shape[facets[:, 1]] - shape[facets[:, 0]], shape[facets[:, 2]] - shape[facets[:, 0]])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
        found.append(sides(facets, c).reshape(-1, 3))
        normals.append(np.repeat(normal, c, axis=0))
    side, normal = np.concatenate(found), np.concatenate(normals)
    order = np.lexsort(side.T)
    side, normal = side[order], normal[order]
    same = np.flatnonzero((side[1:] == side[:-1]).all(axis=1))
    one, other = normal[same], normal[same + 1]
    ahead, behind = one @ view.axes[2] > 0.0, other @ view.axes[2] > 0.0
    sharp = np.einsum("ki,ki->k", one, other) < SHARP
    return np.asarray(side[same[(sharp & (ahead | behind)) | (ahead != behind)]])


def strokes(points: Array, lines: IntArray, length: float) -> Array:
    """Straight pieces (k, p, 2, 3) of the lines (k, 3) through nodes at ``points``, each of about a given length."""
    first, middle, last = (points[lines[:, j]] for j in range(3))
    middle = np.where((lines[:, 0] == lines[:, 1])[:, None], 0.5 * (first + last), middle)
    mean = float(np.linalg.norm(last - first, axis=1).mean()) if len(lines) else 0.0
    t = np.linspace(0.0, 1.0, 2 * max(1, round(0.5 * mean / length)) + 1)[:, None]
    at = first[:, None] * (1 - t) * (1 - 2 * t) + middle[:, None] * 4 * t * (1 - t) + last[:, None] * t * (2 * t - 1)
    return np.stack([at[:, :-1], at[:, 1:]], axis=2)


def sides(facets: IntArray, corners: int) -> IntArray:
    """Nodes (f, corners, 3) of the sides: lower corner, middle node (for linear sides a corner), other corner."""
    ends = np.sort(np.stack([facets[:, :corners], np.roll(facets[:, :corners], -1, axis=1)], axis=-1), axis=-1)
    middle = facets[:, corners : 2 * corners] if facets.shape[1] > corners else ends[..., 0]
    return np.stack([ends[..., 0], middle, ends[..., 1]], axis=-1)


def ruler(axis: "Axes", reference: Array, corner: tuple[float, float]) -> None:
    """Draw a scale bar of round length below the lower left corner, since the axes have no numbers."""
    size = float(np.linalg.norm(np.ptp(reference, axis=0)))
    power = 10.0 ** np.floor(np.log10(0.4 * size))
    length = float(power * max(m for m in (1, 2, 5) if m * power <= 0.4 * size))
    factor, metre = scaled(length, "m")
    x, y = corner[0], corner[1] - 0.06 * size
    axis.plot([x, x + length], [y, y], color="#222222", lw=2.0, solid_capstyle="butt", zorder=5)
    axis.annotate(f"{factor * length:g} {metre}", (x, y), (0, -4), textcoords="offset points", va="top", fontsize=9)
