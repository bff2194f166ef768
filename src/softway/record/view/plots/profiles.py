"""Temperatures along bars at several instants."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from softway.record.read.frames import Frame
from softway.record.read.records import Records
from softway.record.view.bodies.bodies import instant, nearest
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
    """Figure of the temperature along the bars, at the wanted instants or at some of equal distance."""
    spread = np.linspace(0, len(run.fields) - 1, min(INSTANTS, len(run.fields))).round().astype(int).tolist()
    numbers = [nearest(run, time) for time in look.times] if look.times else spread
    figure, axis = _framed(run, look)
    shades = library().colormaps["viridis"](np.linspace(0.0, 0.9, len(numbers)))
    for number, shade in zip(numbers, shades, strict=True):
        _drawn(axis, run, run.fields[number], shade, instant(float(run.fields.times[number])))
    axis.legend(loc="best")
    return figure


def profile_film(run: Records, look: PictureOptions) -> "tuple[Figure, Callable[[int], None]]":
    """Figure of the temperature along the bars, and the function that draws a frame into it."""
    figure, axis = _framed(run, look)
    values = np.concatenate([frame["temperature"] for frame in run.fields])
    window = float(values.min()), float(values.max())
    margin = 0.05 * max(window[1] - window[0], 1.0)

    def draw(number: int) -> None:
        for line in list(axis.get_lines()):
            line.remove()
        frame = run.fields[number]
        _drawn(axis, run, frame, BLUE, "")
        axis.set_ylim(window[0] - margin, window[1] + margin)
        axis.set_title(instant(frame.time))

    return figure, draw


def _framed(run: Records, look: PictureOptions) -> "tuple[Figure, Axes]":
    """Figure with its title and axes."""
    figure = canvas(*(look.inches or (7.6, 4.2)))
    axis = figure.subplots()
    _, unit = scaled(run.fields.cells.reference[:, 0], "m")
    axis.set(xlabel=f"x [{unit}]", ylabel="temperature [K]")
    figure.suptitle(run.provenance.get("title", "") or "Conductors", x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure, axis


def _drawn(axis: "Axes", run: Records, frame: Frame, color: object, label: str) -> None:
    """Draw the temperature of every bar; the legend has a line once."""
    cells = run.fields.cells
    factor, _ = scaled(cells.reference[:, 0], "m")
    for body in range(len(cells.bodies)):
        own = np.unique(cells.connectivity[np.repeat(cells.body == body, np.diff(cells.offsets))])
        own = own[np.argsort(cells.reference[own, 0], kind="stable")]
        x = factor * cells.reference[own, 0]
        axis.plot(x, frame["temperature"][own], color=color, label=label if body == 0 else None)
