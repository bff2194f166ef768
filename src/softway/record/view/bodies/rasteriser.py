"""Drawing of deformed bodies as small flat triangles in parallel projection, from back to front, with lighting."""

from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array
from softway.record.read.surface_mesh import Skin
from softway.record.view.bodies.body_placement import BodyPlacement
from softway.record.view.bodies.surroundings import Camera, edges, sides, strokes
from softway.record.view.style import library, lit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


MESH = (0.36, 0.36, 0.36)
"""Colour of the edges of cells."""


def paint(axis: "Axes", skin: Skin, place: BodyPlacement, view: Camera, colours: Array, edged: bool = False) -> None:
    """Draw the small triangles with their ``colours`` (t, 3) and the outlines, with ``edged`` the edges of the cells,
    too, from back to front.
    """
    triangles, rgb = view.seen(skin.spread(place.points)), colours
    if skin.mesh.dim == 3:
        triangles, rgb = _lit(triangles, rgb)
    lines, dashes = _outlines(skin, place, view)
    inner = _edges(skin, place, view) if edged else lines[:0]
    pieces = np.concatenate([triangles, lines, dashes, inner])
    groups = np.repeat([0, 1, 2, 3], [len(triangles), len(lines), len(dashes), len(inner)])
    grey = np.tile(MESH, (len(inner), 1))
    colours = np.concatenate([rgb, np.zeros((len(lines), 3)), np.full((len(dashes), 3), 0.1), grey])
    order = np.argsort(pieces[:, :, 2].mean(axis=1), kind="stable")
    polygons = library().collections.PolyCollection(
        pieces[order][:, :, :2],
        facecolors=colours[order],
        edgecolors=colours[order],
        linewidths=np.array([0.7, 0.45, 0.75, 0.25])[groups[order]],
        capstyle="butt",
        zorder=3,
    )
    axis.add_collection(polygons)


def _lit(triangles: Array, rgb: Array) -> tuple[Array, Array]:
    """Triangles that face the viewer, and their colours with lighting."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    front = normal[:, 2] > 0.0
    light = 0.86 + 0.18 * lit(normal[front])
    return triangles[front], np.clip(rgb[front] * light[:, None], 0.0, 1.0)


def _edges(skin: Skin, place: BodyPlacement, view: Camera) -> Array:
    """Edges of the visible cells: triangles without width, shifted to the viewer by less than the outlines."""
    size = float(np.linalg.norm(np.ptp(skin.mesh.points, axis=0)))
    kinds = [sides(p.facets, 3 if p.facets.shape[1] in (3, 6) else 4).reshape(-1, 3) for p in skin.patches]
    lines = np.unique(np.concatenate([np.zeros((0, 3), int), *kinds]), axis=0)
    straight = bool((lines[:, 0] == lines[:, 1]).all())
    dash = strokes(place.points, lines, size if straight else size / 90.0).reshape(-1, 2, 3)
    return view.seen(dash)[:, [0, 1, 1]] + np.array([0.0, 0.0, 0.003 * size])


def _outlines(skin: Skin, place: BodyPlacement, view: Camera) -> tuple[Array, Array]:
    """Edges of the deformed body and dashes of the undeformed one: triangles without width, shifted to the viewer."""
    size = float(np.linalg.norm(np.ptp(skin.mesh.points, axis=0)))
    found = []
    for points, every in ((place.points, 1), (place.shape, 2)):
        lines = edges(skin, points, view)
        lines = lines if every == 1 else lines[place.shaped[lines[:, 0]]]
        dash = strokes(points, lines, size / 90.0)[:, ::every].reshape(-1, 2, 3)
        flat = view.seen(dash)[:, [0, 1, 1]]
        found.append(flat + np.array([0.0, 0.0, 0.006 * size * every]))
    return found[0], found[1]
