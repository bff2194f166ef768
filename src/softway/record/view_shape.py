"""Obstacles without a flat face in a picture: filled in the plane, traced along the line of sight in space."""

from typing import TYPE_CHECKING

import numpy as np

from softway.space.curved import Shape
from softway.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GREY, LINE = 0.90, "#666666"
PIXELS = 560
LAMP = np.array([-0.35, 0.75, 0.6]) / np.linalg.norm([-0.35, 0.75, 0.6])


def draw(axis: "Axes", shape: Shape, points: Array, axes: Array) -> None:
    """Draw the part of the obstacle near the body (n, 3) as seen along the third row of ``axes`` (3, 3)."""
    seen = points @ axes.T
    middle, reach = 0.5 * (seen.min(axis=0) + seen.max(axis=0)), 0.75 * float(np.linalg.norm(np.ptp(seen, axis=0)))
    x = middle[0] + reach * np.linspace(-1.0, 1.0, PIXELS)
    y = middle[1] + reach * np.linspace(-1.0, 1.0, PIXELS)
    plane = np.stack(np.meshgrid(x, y), axis=-1)
    if shape.dim < 3:
        gap = shape.gap(plane[..., : shape.dim])
        if gap.min() < 0.0:
            axis.contourf(x, y, gap, levels=[gap.min() - 1.0, 0.0], colors=[str(GREY)], zorder=0)
            axis.contour(x, y, gap, levels=[0.0], colors=[LINE], linewidths=1.2, zorder=1)
        return
    image = _traced(shape, plane, axes, middle[2] + 4.0 * reach, 8.0 * reach)
    rows, columns = np.flatnonzero(image[..., 3].any(axis=1)), np.flatnonzero(image[..., 3].any(axis=0))
    if len(rows) > 1 and len(columns) > 1:
        part = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        extent = (x[columns[0]], x[columns[-1]], y[rows[0]], y[rows[-1]])
        axis.imshow(image[part], extent=extent, origin="lower", interpolation="bilinear", zorder=0)


def _traced(shape: Shape, plane: Array, axes: Array, start: float, depth: float) -> Array:
    """Colours (h, w, 4) of the shape: the first point of each ray, from ``start`` away from the eye, with no gap.

    A ray may always advance by the gap; those that have not arrived after the depth see nothing.
    """
    eye = axes[2]
    ray = plane @ axes[:2] + start * eye
    way = np.zeros(plane.shape[:2])
    inside = shape.gap(ray) < 0.0
    for _ in range(160):
        way = np.minimum(way + np.maximum(shape.gap(ray - way[..., None] * eye), 0.0), depth)
    place = ray - way[..., None] * eye
    hit = (way < depth) & (np.abs(shape.gap(place)) < 1e-3 * depth) & ~inside
    light = 0.82 + 0.18 * (shape.normal_at(place) @ axes.T @ LAMP)
    image = np.empty((*hit.shape, 4))
    image[..., :3] = (GREY * np.clip(light, 0.0, 1.08))[..., None].clip(0.0, 1.0)
    image[..., 3] = hit
    return image
