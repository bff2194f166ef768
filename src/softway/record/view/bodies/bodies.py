"""Picture of the deformed bodies, coloured by a field, at one or several instants."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.errors import InputError
from softway.record.read.cells import Cells
from softway.record.read.frames import Fields, Frame
from softway.record.read.records import Records
from softway.record.read.summary import contacts_of
from softway.record.read.surface_mesh import MOST, Skin, skin_of
from softway.record.view.bodies.body_placement import BodyPlacement, body_placement
from softway.record.view.bodies.colour_field import Colour, Range, colour_of, range_of
from softway.record.view.bodies.rasteriser import paint
from softway.record.view.bodies.surroundings import Camera, camera, ground, ruler
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.style import canvas, library, scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 7.6
"""Width of the picture [inches]."""
HEATED = "heat.content"
"""Column of runs in which solids have a temperature."""
KEPT = 4
"""Number of surfaces of different meshes that a picture keeps in memory."""
NOTHING = 1e-6
"""Work of stresses that are rounding, relative to the greatest strain energy."""
LASTING = ("plastic_strain", "dissipation")
"""Fields that never decrease; by default they are shown at the end of the run."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Surface:
    """Cells of a geometry, and their visible surface."""

    cells: Cells
    skin: Skin


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shown:
    """Drawn data of one frame on its surface, with the nodal ``values`` (n,) of the field."""

    frame: Frame
    surface: Surface
    tools: Mapping[str, PlacedShape]
    place: BodyPlacement
    values: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stage:
    """Common data of all frames of a picture: field and its range, camera, and enlargement of the deformation.

    ``cells`` are those of the first frame, ``surfaces`` gives the surface of the geometry with a number, and
    ``changing`` is True if there are several: then the edges of the cells are drawn, too.  ``box`` (2, 2) holds the
    corners of the bodies of all frames in the plane of the picture, ``bounds`` (2, 3) those in space.
    """

    cells: Cells
    surfaces: Callable[[int], Surface]
    changing: bool
    colour: Colour
    range: Range
    view: Camera
    factor: float
    box: Array
    bounds: Array

    def shown(self, frame: Frame) -> Shown:
        """Prepare a frame, with the bodies placed so that they touch where they really touch."""
        surface, tools = self.surfaces(frame.geometry), self.cells.obstacles(frame.time)
        place = body_placement(surface.cells, frame, tools, self.factor)
        values = self.colour.at_nodes(surface.cells, frame)
        return Shown(frame=frame, surface=surface, tools=tools, place=place, values=values)

    def to_scale(self) -> "Stage":
        """Copy without enlargement of the deformation."""
        return replace(self, factor=1.0)

    @property
    def mapped(self):  # type: ignore[no-untyped-def]  # a mappable of Matplotlib
        """Colour map of the values for Matplotlib."""
        factor, _ = self.colour.label(self.range.scale)
        high = factor * self.range.high or 1.0
        return library().cm.ScalarMappable(library().colors.Normalize(factor * self.range.low, high), self.range.map)

    def draw(self, axis: "Axes", shown: Shown) -> None:
        """Draw one frame with the obstacles and a ruler."""
        skin = shown.surface.skin
        ground(axis, skin, shown.place.points, shown.tools, self.view)
        factor, _ = self.colour.label(self.range.scale)
        values = factor * skin.spread(shown.values).mean(axis=1)
        paint(axis, skin, shown.place, self.view, self.mapped.to_rgba(values)[:, :3], self.changing)
        axis.set_aspect("equal")
        axis.set_axis_off()

    def bar(self, figure: "Figure", axes: "Sequence[Axes]") -> None:
        """Add the colour bar next to the panels."""
        peaked = {(False, False): "neither", (True, False): "max", (True, True): "both"}
        extend = peaked[self.range.peaked, self.range.peaked and self.range.low < 0.0]
        bar = figure.colorbar(self.mapped, ax=list(axes), shrink=0.8, pad=0.02, aspect=28, extend=extend)
        bar.set_label(self.colour.label(self.range.scale)[1])
        bar.outline.set_visible(False)  # type: ignore[operator]


def bodies(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of the bodies coloured by a field, the obstacles and the undeformed outlines; one panel per instant."""
    colour = colour_of(run, look.field)
    numbers, when = _chosen(run, look, colour)
    stage = stage_of(run, colour, numbers)
    shown = [stage.shown(run.fields[number]) for number in numbers]
    columns = 1 if len(shown) == 1 else min(len(shown), 4)
    rows = -(-len(shown) // columns)
    figure = canvas(WIDTH, 6.0)
    axes = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axis, one in zip(axes, shown, strict=False):
        stage.draw(axis, one)
        if len(shown) > 1:
            axis.set_title(instant(one.frame.time), fontsize=9.5, fontweight="normal", loc="center")
    for axis in axes[len(shown) :]:
        axis.remove()
    _fit(figure, axes[: len(shown)], stage, look, (rows, columns))
    stage.bar(figure, axes[: len(shown)])
    caption(figure, run, stage, shown, when)
    return figure


def stage_of(run: Records, colour: Colour, numbers: Sequence[int], most: int = MOST) -> Stage:
    """Collect the common data of some frames; the frames are read one by one and not kept in memory."""
    fields = run.fields
    factors, spots, corners, values = [], [], [], []
    for number, (frame, cells) in zip(numbers, fields.with_cells(numbers), strict=True):
        place = body_placement(cells, frame, cells.obstacles(frame.time))
        low, high = place.points.min(axis=0), place.points.max(axis=0)
        factors.append(place.factor)
        corners.append(np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T)
        values.append(np.quantile(colour.at_nodes(cells, frame), np.linspace(0.0, 1.0, 1001)))
        spots.append((float(frame.contact_force.sum()), number))
    frame = fields[max(spots)[1]]
    cells = fields.cells_of(frame)
    tools = cells.obstacles(frame.time)
    place = body_placement(cells, frame, tools, min(factors))
    view = camera(cells, place.points, tools, _focus(place, frame))
    everywhere = np.concatenate(corners)
    seen = view.seen(everywhere)[:, :2]
    return Stage(
        cells=fields.cells,
        surfaces=lru_cache(maxsize=KEPT)(partial(_surface, fields, most)),
        changing=bool(fields.geometries.any()),
        colour=colour,
        range=range_of(np.concatenate(values), colour.name),
        view=view,
        factor=min(factors),
        box=np.array([seen.min(axis=0), seen.max(axis=0)]),
        bounds=np.array([everywhere.min(axis=0), everywhere.max(axis=0)]),
    )


def _surface(fields: Fields, most: int, geometry: int) -> Surface:
    """Surface of the geometry with a number, divided into about ``most`` small triangles."""
    cells = fields.geometry(geometry)
    return Surface(cells=cells, skin=skin_of(cells, most))


def caption(figure: "Figure", run: Records, stage: Stage, shown: Sequence[Shown], when: str) -> None:
    """Write the title above the picture, and the description below it."""
    enlarged = "to scale" if shown[0].place.factor == 1.0 else f"enlarged {shown[0].place.factor:g} times"
    missing = f" Not drawn: {', '.join(stage.cells.lost)}." if stage.cells.lost else ""
    title = run.provenance.get("title", "") or ("Conductors" if run.of_heat else "Deformed body")
    figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
    still = run.of_heat
    dashed = "; dashed: undeformed shape" if any(one.place.shaped.any() for one in shown) else ""
    time = f"t = {instant(shown[0].frame.time)}{when}. " if len(shown) == 1 else ""
    greatest = max((one.values for one in shown), key=lambda values: float(np.abs(values).max()))
    figure.supxlabel(
        f"{time}{'' if still else f'Deformation {enlarged}{dashed}.'}\n{_most(stage.colour, greatest)}{missing}",
        x=0.01,
        ha="left",
        fontsize=8.5,
    )


def nearest(run: Records, time: float) -> int:
    """Number of the frame nearest to a time [s].

    Raises
    ------
    InputError
        If the time is outside of the run.
    """
    times = run.fields.times
    if not times[0] - 1e-9 * times[-1] <= time <= times[-1] * (1.0 + 1e-9):
        problem = f"{instant(time)} is outside of the run"
        raise InputError("--at", problem, f"a time from {instant(times[0])} to {instant(times[-1])}")
    return int(np.argmin(np.abs(times - time)))


def _chosen(run: Records, look: PictureOptions, colour: Colour) -> tuple[list[int], str]:
    """Numbers of the frames, and a note on their instant for the caption."""
    if look.times:
        return [nearest(run, time) for time in look.times], ""
    if colour.name in LASTING or run.of_heat:
        return [len(run.fields) - 1], ", end of the run"
    if HEATED in run.history:
        frame, what = _stressed(run), "von Mises stress"
        if frame is None:
            return [len(run.fields) - 1], ", end of the run"
    else:
        frame, what = _strained(run), "strain energy"
    contact = " in contact" if run.fields[frame].contact_force.any() else ""
    return [frame], f", at the largest {what}{contact}"


def _fit(figure: "Figure", axes: "Sequence[Axes]", stage: Stage, look: PictureOptions, grid: tuple[int, int]) -> None:
    """Set the same window in every panel, add a ruler, and fit the size of the figure to its content."""
    low, high = np.array(axes[0].dataLim.min), np.array(axes[0].dataLim.max)
    if len(axes) > 1:
        margin = 0.12 * float(np.linalg.norm(np.ptp(stage.box, axis=0)))
        low, high = stage.box[0] - margin, stage.box[1] + margin
    ruler(axes[0], stage.cells.reference, (low[0], low[1]))
    low = np.array([low[0], min(low[1], axes[0].dataLim.y0)])
    width, height = high - low
    for axis in axes:
        axis.set_xlim(low[0] - 0.02 * width, high[0] + 0.02 * width)
        axis.set_ylim(low[1] - 0.02 * height, high[1] + 0.02 * height)
    rows, columns = grid
    tall = 0.8 * WIDTH * rows * height / (columns * width) + 1.0 + 0.2 * (rows if len(axes) > 1 else 0)
    figure.set_size_inches(*(look.inches or (WIDTH, float(np.clip(tall, 3.4 if len(axes) == 1 else 2.0, 8.5)))))


def _focus(place: BodyPlacement, frame: Frame) -> Array | None:
    """Centre (3,) of the contact forces; None without contact."""
    force = frame.contact_force
    return np.average(place.points, axis=0, weights=force) if force.any() else None


def instant(time: float) -> str:
    """Time [s] as a text with a unit prefix."""
    factor, unit = scaled(time, "s")
    return f"{factor * time:.4g} {unit}"


def _most(colour: Colour, values: Array) -> str:
    """Name of the field and its largest value as a text."""
    greatest = float(values[np.argmax(np.abs(values))])
    factor, label = colour.label(abs(greatest))
    unit = label.rpartition(" [")[2].rstrip("]") if colour.kind.unit else ""
    how = "mean of the cells at a node, " if colour.kind.on == "cells" else ""
    most = "maximum" if greatest >= 0.0 else "largest magnitude"
    word = colour.word[0].upper() + colour.word[1:]
    return f"{word}: {how}{most} {factor * greatest:.3g} {unit}".rstrip() + "."


def _strained(run: Records) -> int:
    """Number of the frame with the largest strain energy, among the frames in contact if there are any."""
    row, touching = _in_contact(run)
    return int(np.argmax(np.where(touching, run.history["energy_strain"][row], -1.0)))


def _stressed(run: Records) -> int | None:
    """The same with the largest von Mises stress, of solids with a temperature; None if all stresses are rounding.

    Their strain energy is less than none where they expand freely.
    """
    row, touching = _in_contact(run)
    stress, moved = np.full(len(row), -1.0), 0.0
    for k in np.flatnonzero(touching).tolist():
        frame = run.fields[k]
        stress[k] = np.nanmax(frame.von_mises, initial=0.0)
        moved = max(moved, float(np.abs(frame.displacement).max()))
    largest = float(np.abs(run.history["energy_strain"][row]).max())
    extents = np.sort(np.ptp(run.fields.cells.reference, axis=0))[::-1][: run.fields.cells.dimension]
    work = float(stress.max()) * moved * float(np.prod(extents[1:]))
    return None if work < NOTHING * largest else int(np.argmax(stress))


def _in_contact(run: Records) -> tuple[IntArray, BoolArray]:
    """Lines (t,) of the history of the frames, and the frames (t,) in contact; all frames if there are none."""
    history = run.history
    row = np.searchsorted(history["time"], run.fields.times * (1.0 - 1e-12))
    forces = [history[f"contact.{c}.force_n"][row] for c in contacts_of(history)]
    touching = np.sum(forces, axis=0) > 0.0
    return row, touching if touching.any() else np.ones(len(row), bool)
