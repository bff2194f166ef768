"""Temperatures and other fields along bars at several instants."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array
from softway.record.read.cells import Cells
from softway.record.read.frames import Frame
from softway.record.read.records import Records
from softway.record.view.bodies.bodies import instant, nearest
from softway.record.view.bodies.colour_field import FROM_LEAST, Colour, colour_of
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.style import BLUE, canvas, library, scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INSTANTS = 6
"""Number of instants by default."""


def is_of_bars(run: Records) -> bool:
    """True if all cells of the bodies are bars."""
    return set(run.fields.cells.blocks()) <= {"bar2", "bar3"}


def profiles(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of the temperature, or another wanted field, along the bars, at the wanted instants or at some of equal
    distance.

    Raises
    ------
    InputError
        If the run has no such field.
    """
    spread = np.linspace(0, len(run.fields) - 1, min(INSTANTS, len(run.fields))).round().astype(int).tolist()
    numbers = [nearest(run, time) for time in look.times] if look.times else spread
    frames = [run.fields[number] for number in numbers]
    figure, axis, curves = _framed(run, look, frames)
    shades = library().colormaps["viridis"](np.linspace(0.0, 0.9, len(numbers)))
    for frame, shade in zip(frames, shades, strict=True):
        _drawn(axis, curves, frame, shade, instant(frame.time))
    axis.legend(loc="best")
    return figure


def profile_film(run: Records, look: PictureOptions) -> "tuple[Figure, Callable[[int], None]]":
    """Figure of a field along the bars, and the function that draws a frame into it; errors as :func:`profiles`."""
    figure, axis, curves = _framed(run, look, run.fields)
    values = np.concatenate([curves.factor * curves.colour.of(frame) for frame in run.fields])
    window = float(values.min()), float(values.max())
    least = 1.0 if curves.colour.name in FROM_LEAST else 0.0
    margin = 0.05 * (max(window[1] - window[0], least) or 1.0)

    def draw(number: int) -> None:
        for line in list(axis.get_lines()):
            line.remove()
        frame = run.fields[number]
        _drawn(axis, curves, frame, BLUE, "")
        axis.set_ylim(window[0] - margin, window[1] + margin)
        axis.set_title(instant(frame.time))

    return figure, draw


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Curves:
    """Field of the bars, with the factors of its unit and of that of lengths."""

    cells: Cells
    colour: Colour
    factor: float
    metre: float

    def curve(self, body: int, frame: Frame) -> tuple[Array, Array]:
        """Places along a bar, and the values there: at its nodes, or at both ends of each of its cells."""
        cells, values = self.cells, self.factor * self.colour.of(frame)
        x, own = self.metre * cells.reference[:, 0], np.flatnonzero(cells.body == body)
        if self.colour.kind.on == "nodes":
            nodes = np.unique(cells.connectivity[np.repeat(cells.body == body, np.diff(cells.offsets))])
            nodes = nodes[np.argsort(x[nodes], kind="stable")]
            return x[nodes], values[nodes]
        along = x[cells.connectivity]
        first, last = (pick.reduceat(along, cells.offsets[:-1])[own] for pick in (np.minimum, np.maximum))
        ends = np.column_stack([first, last])
        order = np.argsort(ends.mean(axis=1), kind="stable")
        return ends[order].ravel(), np.repeat(values[own[order]], 2)


def _framed(run: Records, look: PictureOptions, frames: Iterable[Frame]) -> "tuple[Figure, Axes, _Curves]":
    """Figure with its title and axes, and the curves to draw."""
    colour, cells = colour_of(run, look.field), run.fields.cells
    figure = canvas(*(look.inches or (7.6, 4.2)))
    axis = figure.subplots()
    metre, unit = scaled(cells.reference[:, 0], "m")
    scale = max(float(np.abs(colour.of(frame)).max()) for frame in frames)
    plain = colour.name in FROM_LEAST
    factor, label = (1.0, f"{colour.word} [{colour.kind.unit}]") if plain else colour.label(scale)
    axis.set(xlabel=f"x [{unit}]", ylabel=label)
    figure.suptitle(run.provenance.get("title", "") or "Conductors", x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure, axis, _Curves(cells=cells, colour=colour, factor=factor, metre=metre)


def _drawn(axis: "Axes", curves: _Curves, frame: Frame, color: object, label: str) -> None:
    """Draw the field of every bar; the legend has a line once."""
    for body in range(len(curves.cells.bodies)):
        axis.plot(*curves.curve(body, frame), color=color, label=label if body == 0 else None)
