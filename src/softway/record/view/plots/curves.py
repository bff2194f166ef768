"""Panels of curves as an SVG drawing."""

from collections.abc import Sequence
from dataclasses import dataclass
from io import StringIO
from typing import TYPE_CHECKING, Literal

import numpy as np

from softway.arrays import Array
from softway.record.view.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, canvas, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST = 1500
"""Approximate maximum number of drawn points of a curve."""
OURS, OTHERS = (BLUE, RED, GREEN, PURPLE), ORANGE


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Curve:
    """Curve with the coordinates x and y (n,).

    ``kind`` is ``ours`` (a line), ``exact`` (black dashes), ``dots``, ``steps`` (means over intervals, with their ends
    x (n + 1,)) or ``other`` (a line from another source).
    """

    x: Array | Sequence[float]
    y: Array | Sequence[float]
    label: str = ""
    kind: Literal["ours", "exact", "dots", "steps", "other"] = "ours"


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Panel:
    """Curves in one pair of axes with a title and labels; ``log`` names the logarithmic axes: x, y or xy."""

    title: str
    x: str
    y: str
    curves: tuple[Curve, ...]
    log: Literal["", "x", "y", "xy"] = ""


def drawing(panels: Sequence[Panel]) -> str:
    """Draw the panels, two in a row, and return the SVG text.

    Examples
    --------
    >>> line = Curve(x=[0.0, 1.0], y=[0.0, 1.0], label="line")
    >>> drawing([Panel(title="A line", x="x", y="y", curves=(line,))]).startswith("<?xml")
    True
    """
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    with styled(**{"svg.hashsalt": "softway"}):
        figure = canvas(4.6 * columns, 3.0 * rows)
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for panel, axis in zip(panels, axes, strict=False):
            _draw(axis, panel)
        for axis in axes[len(panels) :]:
            axis.remove()
        text = StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def _draw(axis: "Axes", panel: Panel) -> None:
    mine = 0
    for curve in panel.curves:
        x, y = np.asarray(curve.x, float), np.asarray(curve.y, float)
        color = OURS[mine % len(OURS)]
        match curve.kind:
            case "exact":
                axis.plot(*_thinned(x, y), "--", color=BLACK, lw=1.1, zorder=4, label=curve.label)
            case "other":
                axis.plot(*_thinned(x, y), "-", color=OTHERS, lw=1.1, label=curve.label)
            case "dots":
                axis.plot(x, y, "o", color=color, ms=4.0, label=curve.label)
            case "steps":
                axis.stairs(y, x, color=color, lw=1.2, label=curve.label, baseline=None)
            case _:
                axis.plot(*_thinned(x, y), "-", color=color, label=curve.label)
        mine += curve.kind not in ("exact", "other")
    axis.set(title=panel.title, xlabel=panel.x, ylabel=panel.y)
    if "x" in panel.log:
        axis.set_xscale("log")
    if "y" in panel.log:
        axis.set_yscale("log")
    if any(curve.label for curve in panel.curves):
        axis.legend(loc="best")


def _thinned(x: Array, y: Array) -> tuple[Array, Array]:
    """Thin out a curve to about MOST points."""
    every = max(1, len(x) // MOST)
    return x[::every], y[::every]
