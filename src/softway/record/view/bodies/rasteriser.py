"""Drawing of deformed bodies as small flat triangles in parallel projection, from back to front, with lighting."""

from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array
from softway.record.read.surface_mesh import Skin
from softway.record.view.bodies.body_placement import BodyPlacement
from softway.record.view.bodies.surroundings import Camera, edges, strokes
from softway.record.view.style import library, lit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def paint(axis: "Axes", skin: Skin, place: BodyPlacement, view: Camera, colours: Array) -> None:
    """Draw the small triangles with their ``colours`` (t, 3) and the outlines, from back to front."""
    triangles, rgb = view.seen(skin.spread(place.points)), colours
    if skin.mesh.dim == 3:
        triangles, rgb = _lit(triangles, rgb)
    lines, dashes = _outlines(skin, place, view)
    pieces = np.concatenate([triangles, lines, dashes])
    groups = np.repeat([0, 1, 2], [len(triangles), len(lines), len(dashes)])
    colours = np.concatenate([rgb, np.zeros((len(lines), 3)), np.full((len(dashes), 3), 0.1)])
    order = np.argsort(pieces[:, :, 2].mean(axis=1), kind="stable")
    polygons = library().collections.PolyCollection(
        pieces[order][:, :, :2],
        facecolors=colours[order],
        edgecolors=colours[order],
        linewidths=np.array([0.7, 0.45, 0.75])[groups[order]],
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
