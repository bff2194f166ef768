"""The deformed bodies, coloured by a field, at one instant or several."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from softway.bodies.motion import Placed
from softway.errors import InputError
from softway.record.frames import Cells, Frame
from softway.record.look import STANDARD, Look
from softway.record.run import Run
from softway.record.summary import contacts_of
from softway.record.surface import MOST, Skin, skin_of
from softway.record.view_field import Colour, Range, colour_of, range_of
from softway.record.view_paint import paint
from softway.record.view_place import Placing, placing
from softway.record.view_scene import Camera, camera, ground, ruler
from softway.record.view_style import canvas, library, scaled
from softway.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 7.6
"""Of the picture [inches]."""
LASTING = ("plastic_strain", "dissipation")
"""Fields that only grow: they are shown at the end."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shown:
    """What is drawn of one frame; nodal ``values`` (n,) of the field."""

    frame: Frame
    tools: Mapping[str, Placed]
    place: Placing
    values: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stage:
    """What all frames of a picture share: skin, field with its range, the eye, the factor by which deformations are
    enlarged, the corners ``box`` (2, 2) of all that is seen of the bodies, and those in space ``bounds`` (2, 3).
    """

    cells: Cells
    skin: Skin
    colour: Colour
    range: Range
    view: Camera
    factor: float
    box: Array
    bounds: Array

    def shown(self, frame: Frame) -> Shown:
        """A frame, placed so that the bodies touch what they really touch."""
        tools = self.cells.obstacles(frame.time)
        place = placing(self.cells, frame, tools, self.factor)
        return Shown(frame=frame, tools=tools, place=place, values=self.colour.at_nodes(self.cells, frame))

    def to_scale(self) -> "Stage":
        """The same without enlargement."""
        return replace(self, factor=1.0)

    @property
    def mapped(self):  # type: ignore[no-untyped-def]  # a mappable of Matplotlib
        """Colours of the values."""
        factor, _ = self.colour.label(self.range.scale)
        high = factor * self.range.high or 1.0
        return library().cm.ScalarMappable(library().colors.Normalize(factor * self.range.low, high), self.range.map)

    def draw(self, axis: "Axes", shown: Shown) -> None:
        """Draw one frame with the obstacles and a ruler."""
        ground(axis, self.skin, shown.place.points, shown.tools, self.view)
        factor, _ = self.colour.label(self.range.scale)
        values = factor * self.skin.spread(shown.values).mean(axis=1)
        paint(axis, self.skin, shown.place, self.view, self.mapped.to_rgba(values)[:, :3])
        axis.set_aspect("equal")
        axis.set_axis_off()

    def bar(self, figure: "Figure", axes: "Sequence[Axes]") -> None:
        """The scale of the colours beside the pictures."""
        peaked = {(False, False): "neither", (True, False): "max", (True, True): "both"}
        extend = peaked[self.range.peaked, self.range.peaked and self.range.low < 0.0]
        bar = figure.colorbar(self.mapped, ax=list(axes), shrink=0.8, pad=0.02, aspect=28, extend=extend)
        bar.set_label(self.colour.label(self.range.scale)[1])
        bar.outline.set_visible(False)  # type: ignore[operator]


def bodies(run: Run, look: Look = STANDARD) -> "Figure":
    """The bodies coloured by a field, the floor, and the undeformed outline; a panel for each instant."""
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


def stage_of(run: Run, colour: Colour, numbers: Sequence[int], most: int = MOST) -> Stage:
    """What some frames share; they are read one after the other, none is kept."""
    cells = run.fields.cells
    factors, spots, corners, values = [], [], [], []
    for number in numbers:
        frame = run.fields[number]
        place = placing(cells, frame, cells.obstacles(frame.time))
        low, high = place.points.min(axis=0), place.points.max(axis=0)
        factors.append(place.factor)
        corners.append(np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T)
        values.append(np.quantile(colour.at_nodes(cells, frame), np.linspace(0.0, 1.0, 1001)))
        spots.append((float(frame.contact_force.sum()), number))
    frame = run.fields[max(spots)[1]]
    tools = cells.obstacles(frame.time)
    place = placing(cells, frame, tools, min(factors))
    view = camera(cells, place.points, tools, _focus(place, frame))
    everywhere = np.concatenate(corners)
    seen = view.seen(everywhere)[:, :2]
    return Stage(
        cells=cells,
        skin=skin_of(cells, most),
        colour=colour,
        range=range_of(np.concatenate(values)),
        view=view,
        factor=min(factors),
        box=np.array([seen.min(axis=0), seen.max(axis=0)]),
        bounds=np.array([everywhere.min(axis=0), everywhere.max(axis=0)]),
    )


def caption(figure: "Figure", run: Run, stage: Stage, shown: Sequence[Shown], when: str) -> None:
    """Title above, and below it what is shown."""
    enlarged = "to scale" if shown[0].place.factor == 1.0 else f"enlarged {shown[0].place.factor:g} times"
    missing = f" Not drawn: {', '.join(stage.cells.lost)}." if stage.cells.lost else ""
    title = run.provenance.get("title", "") or "Deformed body"
    figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
    dashed = "; dashed: undeformed shape" if any(one.place.shaped.any() for one in shown) else ""
    time = f"t = {instant(shown[0].frame.time)}{when}. " if len(shown) == 1 else ""
    greatest = max((one.values for one in shown), key=lambda values: float(np.abs(values).max()))
    figure.supxlabel(
        f"{time}Deformation {enlarged}{dashed}.\n{_most(stage.colour, greatest)}{missing}",
        x=0.01,
        ha="left",
        fontsize=8.5,
    )


def nearest(run: Run, time: float) -> int:
    """Number of the frame next to a time [s].

    Raises
    ------
    InputError
        If the run does not reach it.
    """
    times = run.fields.times
    if not times[0] - 1e-9 * times[-1] <= time <= times[-1] * (1.0 + 1e-9):
        problem = f"{instant(time)} is outside of the run"
        raise InputError("--at", problem, f"a time from {instant(times[0])} to {instant(times[-1])}")
    return int(np.argmin(np.abs(times - time)))


def _chosen(run: Run, look: Look, colour: Colour) -> tuple[list[int], str]:
    """Numbers of the frames, and what is special about their time."""
    if look.times:
        return [nearest(run, time) for time in look.times], ""
    if colour.name in LASTING:
        return [len(run.fields) - 1], ", the end"
    frame = _strained(run)
    contact = " in contact" if run.fields[frame].contact_force.any() else ""
    return [frame], f", at the greatest strain energy{contact}"


def _fit(figure: "Figure", axes: "Sequence[Axes]", stage: Stage, look: Look, grid: tuple[int, int]) -> None:
    """The same window in every panel, a ruler, and a figure without empty margins."""
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


def _focus(place: Placing, frame: Frame) -> Array | None:
    """Centre (3,) of the contact forces, if there are any."""
    force = frame.contact_force
    return np.average(place.points, axis=0, weights=force) if force.any() else None


def instant(time: float) -> str:
    """A time [s] in words."""
    factor, unit = scaled(time, "s")
    return f"{factor * time:.4g} {unit}"


def _most(colour: Colour, values: Array) -> str:
    """The field and its greatest value in words."""
    greatest = float(values[np.argmax(np.abs(values))])
    factor, label = colour.label(abs(greatest))
    unit = label.rpartition(" [")[2].rstrip("]") if colour.kind.unit else ""
    how = "mean of the cells at a node, " if colour.kind.on == "cells" else ""
    most = "at most" if greatest >= 0.0 else "greatest"
    word = colour.word[0].upper() + colour.word[1:]
    return f"{word}: {how}{most} {factor * greatest:.3g} {unit}".rstrip() + "."


def _strained(run: Run) -> int:
    """Number of the frame with the greatest strain energy, out of those in contact if there are any."""
    history = run.history
    row = np.searchsorted(history["time"], run.fields.times * (1.0 - 1e-12))
    forces = [history[f"contact.{c}.force_n"][row] for c in contacts_of(history)]
    touching = np.sum(forces, axis=0) > 0.0
    strain = history["energy_strain"][row]
    return int(np.argmax(np.where(touching, strain, -1.0) if touching.any() else strain))
