"""The deformed bodies, coloured by von Mises stress, at the instant of greatest strain energy.

Volumes are drawn by the painter's algorithm: small flat triangles of the surface in parallel projection, the far ones
first, shaded by a lamp beside the eye.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from softway.bodies.motion import Placed
from softway.record.frames import Cells, Frame
from softway.record.run import Run
from softway.record.summary import contacts_of
from softway.record.surface import at_nodes, mesh_of, patches
from softway.record.view_place import Placing, placing
from softway.record.view_scene import Camera, camera, edges, ground, ruler, strokes
from softway.record.view_style import canvas, library, scaled
from softway.space.mesh import Mesh
from softway.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MAP = "viridis"
WIDTH = 7.6
"""Of the picture [inches]."""
LAMP = np.array([-0.35, 0.75, 0.6])
"""Direction to the lamp in the axes of the picture: right, up, towards the eye."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shown:
    """What is drawn; nodal stress (n,)."""

    frame: Frame
    cells: Cells
    tools: Mapping[str, Placed]
    place: Placing
    stress: Array


def bodies(run: Run) -> "Figure":
    """The bodies with their stress at the instant of greatest strain energy, the floor, and the undeformed outline."""
    shown = _shown(run)
    top = _top(shown.stress)
    colour, stress_unit = scaled(top, "Pa")
    figure = canvas(WIDTH, 6.0)
    axis = figure.subplots()
    view = camera(shown.cells, shown.place.points, shown.tools, _focus(shown))
    ground(axis, shown.cells, shown.place.points, shown.tools, view)
    norm = library().colors.Normalize(0.0, colour * top or 1.0)
    mapped = library().cm.ScalarMappable(norm, MAP)
    _paint(axis, shown, view, mapped, colour)
    ruler(axis, shown.cells.reference, view)
    axis.set_aspect("equal")
    axis.set_axis_off()
    axis.margins(0.02)
    peaked = "max" if top < shown.stress.max() else "neither"
    bar = figure.colorbar(mapped, ax=axis, shrink=0.8, pad=0.02, aspect=28, extend=peaked)
    bar.set_label(f"von Mises stress [{stress_unit}]")
    bar.outline.set_visible(False)  # type: ignore[operator]
    box = axis.dataLim
    figure.set_size_inches(WIDTH, float(np.clip(0.8 * WIDTH * box.height / box.width + 1.0, 3.4, 8.5)))
    _words(figure, run, shown)
    return figure


def _focus(shown: Shown) -> Array | None:
    """Centre (3,) of the contact forces, if there are any."""
    force = shown.frame.contact_force
    return np.average(shown.place.points, axis=0, weights=force) if force.any() else None


def _words(figure: "Figure", run: Run, shown: Shown) -> None:
    """Title above, and below it what is shown."""
    second, unit = scaled(shown.frame.time, "s")
    enlarged = "to scale" if shown.place.factor == 1.0 else f"enlarged {shown.place.factor:g} times"
    missing = f" Not drawn: {', '.join(shown.cells.lost)}." if shown.cells.lost else ""
    title = run.provenance.get("title", "") or "Deformed body"
    figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
    when = "at the greatest strain energy" + (" in contact" if shown.frame.contact_force.any() else "")
    dashed = "; dashed: undeformed shape" if shown.place.shaped.any() else ""
    figure.supxlabel(
        f"t = {second * shown.frame.time:.4g} {unit}, {when}. Deformation {enlarged}{dashed}.\n"
        f"Stress: mean of the cells at a node, at most {_stress(shown)}.{missing}",
        x=0.01,
        ha="left",
        fontsize=8.5,
    )


def _top(stress: Array) -> float:
    """Where the colours end [Pa]: at the greatest stress, or where a few nodes far above the others begin."""
    most, usual = float(stress.max()), float(np.percentile(stress, 99.0))
    return usual if most > 2.0 * usual > 0.0 else most


def _stress(shown: Shown) -> str:
    factor, unit = scaled(float(shown.stress.max()), "Pa")
    return f"{factor * shown.stress.max():.3g} {unit}"


def _shown(run: Run) -> Shown:
    """The frame of greatest strain energy in contact, placed so that the bodies touch what they really touch."""
    fields, cells = run.fields, run.fields.cells
    frame = fields[_strained(run)]
    tools, stress = cells.obstacles(frame.time), at_nodes(cells, frame.von_mises)
    return Shown(frame=frame, cells=cells, tools=tools, place=placing(cells, frame, tools), stress=stress)


def _strained(run: Run) -> int:
    """Number of the frame with the greatest strain energy, out of those in contact if there are any."""
    history = run.history
    row = np.searchsorted(history["time"], run.fields.times * (1.0 - 1e-12))
    forces = [history[f"contact.{c}.force_n"][row] for c in contacts_of(history)]
    touching = np.sum(forces, axis=0) > 0.0
    strain = history["energy_strain"][row]
    return int(np.argmax(np.where(touching, strain, -1.0) if touching.any() else strain))


def _paint(axis: "Axes", shown: Shown, view: Camera, mapped: object, colour: float) -> None:
    """Draw the small triangles and the outlines, far ones first."""
    mesh = mesh_of(shown.cells)
    corners, values = [], []
    for patch in patches(mesh):
        corners.append(view.seen(patch.spread(shown.place.points)))
        values.append(patch.spread(shown.stress).mean(axis=1))
    triangles, stress = np.concatenate(corners), np.concatenate(values)
    rgb = mapped.to_rgba(colour * stress)[:, :3]  # type: ignore[attr-defined]
    if mesh.dim == 3:
        triangles, rgb = _lit(triangles, rgb)
    lines, dashes = _outlines(shown, mesh, view)
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
    """The triangles that face the eye, and their colours under the lamp."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    front = normal[:, 2] > 0.0
    light = 0.86 + 0.18 * (normal[front] @ (LAMP / np.linalg.norm(LAMP)))
    return triangles[front], np.clip(rgb[front] * light[:, None], 0.0, 1.0)


def _outlines(shown: Shown, mesh: Mesh, view: Camera) -> tuple[Array, Array]:
    """Edges of the deformed body, dashes of the undeformed one: triangles without width, a hair nearer the eye."""
    size = float(np.linalg.norm(np.ptp(shown.cells.reference, axis=0)))
    found = []
    for points, every in ((shown.place.points, 1), (shown.place.shape, 2)):
        lines = edges(mesh, points, view)
        lines = lines if every == 1 else lines[shown.place.shaped[lines[:, 0]]]
        dash = strokes(points, lines, size / 90.0)[:, ::every].reshape(-1, 2, 3)
        flat = view.seen(dash)[:, [0, 1, 1]]
        found.append(flat + np.array([0.0, 0.0, 0.006 * size * every]))
    return found[0], found[1]
