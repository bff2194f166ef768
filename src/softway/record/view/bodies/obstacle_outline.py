"""Drawing of curved obstacles: filled areas in the plane; triangles or ray tracing in space."""

from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.obstacles.primitives import Cavity
from softway.obstacles.triangulated import Facets, Surface
from softway.record.view.style import library, lit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GREY, LINE = 0.90, "#666666"
VEIL = 0.35
"""Opacity of an obstacle in front of the bodies."""
BACK, FRONT = 0, 4
"""Drawing order of obstacles behind the bodies and in front of them."""
PIXELS = 560
STEPS = 160
MARGIN = 0.3
"""Margin around the bodies in which plane obstacles are drawn, relative to the diagonal."""


def draw(axis: "Axes", tool: PlacedShape, points: Array, axes: Array) -> None:
    """Draw the part of the obstacle near the body (n, 3), seen along the third row of ``axes`` (3, 3).

    A spatial obstacle that hides the place where it is nearest to the body is drawn over the body, half transparent.
    """
    seen = points @ axes.T
    if tool.dim < 3:
        _filled(axis, tool, seen[:, :2])
        return
    nearest = points[int(np.argmin(tool.gap(points)))]
    order = FRONT if float(tool.normal_at(nearest[None])[0] @ axes[2]) < 0.0 else BACK
    middle, reach = 0.5 * (seen.min(axis=0) + seen.max(axis=0)), 0.75 * float(np.linalg.norm(np.ptp(seen, axis=0)))
    facets = _facets(tool)
    if facets is not None:
        _triangles(axis, facets @ axes.T, np.array([middle[:2] - reach, middle[:2] + reach]), order)
        return
    x = middle[0] + reach * np.linspace(-1.0, 1.0, PIXELS)
    y = middle[1] + reach * np.linspace(-1.0, 1.0, PIXELS)
    plane = np.stack(np.meshgrid(x, y), axis=-1)
    image = _traced(tool, plane, axes, middle[2] + 4.0 * reach, 8.0 * reach)
    rows, columns = np.flatnonzero(image[..., 3].any(axis=1)), np.flatnonzero(image[..., 3].any(axis=0))
    if len(rows) > 1 and len(columns) > 1:
        part = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        extent = (x[columns[0]], x[columns[-1]], y[rows[0]], y[rows[-1]])
        image[..., 3] *= VEIL if order == FRONT else 1.0
        axis.imshow(image[part], extent=extent, origin="lower", interpolation="bilinear", zorder=order)


def _filled(axis: "Axes", tool: PlacedShape, points: Array) -> None:
    """Fill the area that a plane obstacle covers around the points (n, 2)."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = MARGIN * float(np.linalg.norm(high - low))
    x, y = (np.linspace(a - margin, b + margin, PIXELS) for a, b in zip(low, high, strict=True))
    gap = tool.gap(np.stack(np.meshgrid(x, y), axis=-1))
    rows, columns = np.flatnonzero((gap < 0.0).any(axis=1)), np.flatnonzero((gap < 0.0).any(axis=0))
    if len(rows):
        part = np.s_[max(rows[0] - 1, 0) : rows[-1] + 2, max(columns[0] - 1, 0) : columns[-1] + 2]
        x, y, gap = x[part[1]], y[part[0]], gap[part]
        axis.contourf(x, y, gap, levels=[gap.min() - 1.0, 0.0], colors=[str(GREY)], zorder=0)
        axis.contour(x, y, gap, levels=[0.0], colors=[LINE], linewidths=1.2, zorder=1)


def _facets(tool: PlacedShape) -> Array | None:
    """Corners (f, 3, 3) of the triangles of a spatial tool, oriented towards free space; None for other shapes.

    For an open surface the back sides are included.
    """
    hollow = isinstance(tool.shape, Cavity)
    shape = tool.shape.of if isinstance(tool.shape, Cavity) else tool.shape
    shape = shape.facets if isinstance(shape, Surface) else shape
    if not isinstance(shape, Facets) or shape.dim < 3:
        return None
    corners = tool.pose.place(shape.points)[shape.cells]
    back = corners[:, ::-1]
    return (back if hollow else corners) if shape.closed else np.concatenate([corners, back])


def _triangles(axis: "Axes", corners: Array, window: Array, order: int) -> None:
    """Draw the triangles (f, 3, 3) that face the viewer and lie in the window (2, 2), with lighting."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    shown = (normal[:, 2] > 0.0) & (corners[..., :2].max(axis=1) > window[0]).all(axis=1)
    shown &= (corners[..., :2].min(axis=1) < window[1]).all(axis=1)
    far = np.flatnonzero(shown)[np.argsort(corners[shown][..., 2].mean(axis=1), kind="stable")]
    if not len(far):
        return
    flat, colour = corners[far][..., :2], np.repeat(_lit(normal[far])[:, None], 3, axis=1)
    matplotlib = library()
    edge, alpha = (LINE, VEIL) if order == FRONT else (colour, None)
    found = matplotlib.collections.PolyCollection(
        flat, facecolors=colour, edgecolors=edge, alpha=alpha, linewidths=0.4, zorder=order
    )
    found.set_in_layout(False)
    axis.add_collection(found, autolim=False)
    found.set_clip_path(matplotlib.patches.Rectangle(window[0], *(window[1] - window[0]), transform=axis.transData))
    axis.update_datalim(np.clip(flat.reshape(-1, 2), *window))


def _traced(tool: PlacedShape, plane: Array, axes: Array, start: float, depth: float) -> Array:
    """Colours (h, w, 4) of the shape by ray tracing: the first point of zero gap on each ray from ``start`` on.

    A ray may always advance by the gap.  Rays that do not hit the shape within the depth are transparent.
    """
    eye = axes[2]
    ray = plane.reshape(-1, 2) @ axes[:2] + start * eye
    way, gap = np.zeros(len(ray)), tool.gap(ray)
    inside = gap < 0.0
    for _ in range(STEPS):
        under_way: BoolArray = (way < depth) & (gap > 1e-4 * depth)
        if not under_way.any():
            break
        way[under_way] += gap[under_way]
        gap[under_way] = tool.gap(ray[under_way] - way[under_way, None] * eye)
    place = ray - way[:, None] * eye
    image = np.ones((len(ray), 4))
    image[:, :3] = _lit(tool.normal_at(place) @ axes.T)[:, None]
    image[:, 3] = (way < depth) & (np.abs(gap) < 1e-3 * depth) & ~inside
    return image.reshape(*plane.shape[:2], 4)


def _lit(normal: Array) -> Array:
    """Brightness (k,) of surfaces with the normals (k, 3) in the axes of the picture."""
    return np.asarray(np.clip(GREY * np.clip(0.82 + 0.18 * lit(normal), 0.0, 1.08), 0.0, 1.0))
