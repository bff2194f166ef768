"""Bars in one picture: how their ends move, and the paths of all nodes in the x-t plane."""

from typing import TYPE_CHECKING

import numpy as np

from softway.record.run import Run
from softway.record.view_style import BLACK, CYCLE, GREEN, RED, canvas, scaled
from softway.space.obstacles import HalfSpace
from softway.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 60
"""Greatest number of paths drawn."""


def paths(run: Run) -> "Figure":
    """Positions of the ends over time, and the x-t diagram of the nodes with touches and releases.

    Bars in the plane or in space are shown by the coordinate along which they are longest.
    """
    cells, fields = run.fields.cells, run.fields
    axis = int(np.argmax(np.ptp(cells.reference, axis=0)))
    track = np.array([frame.points[:, axis] for frame in fields])
    times = fields.times
    (second, unit), (metre, length) = scaled(times, "s"), scaled(track, "m")
    figure = canvas(9.0, 4.4)
    left, right = figure.subplots(1, 2)
    title = run.provenance.get("title", "")
    figure.suptitle(title or "Paths", x=0.01, ha="left", fontsize=12, fontweight="bold")
    letter = "xyz"[axis]
    _ends(left, second * times, metre * track, cells.reference[:, axis], letter)
    left.set(title="Ends", xlabel=f"time [{unit}]", ylabel=f"position {letter} [{length}]")
    order = np.argsort(cells.reference[:, axis])
    chosen = order[np.unique(np.linspace(0, len(order) - 1, min(MOST, len(order))).astype(int))]
    right.plot(metre * track[:, chosen], second * times, color="#7f9db9", lw=0.8)
    _marks(right, run, axis, second, metre)
    right.set(title=f"Paths of {len(chosen)} nodes", xlabel=f"position {letter} [{length}]", ylabel=f"time [{unit}]")
    right.set_ylim(bottom=second * times[0])
    for name, tool in cells.obstacles.items():
        if isinstance(tool, HalfSpace) and axis < tool.dim and abs(np.atleast_1d(tool.normal)[axis]) > 0.99:
            place = metre * float(np.atleast_1d(tool.point)[axis])
            left.axhline(place, color=BLACK, lw=2.0, alpha=0.5, label=name)
            right.axvline(place, color=BLACK, lw=2.0, alpha=0.5)
    left.legend(loc="best")
    return figure


def _ends(left: "Axes", times: Array, track: Array, reference: Array, letter: str) -> None:
    for node, color, word in zip((np.argmin(reference), np.argmax(reference)), CYCLE, ("lower", "upper"), strict=False):
        left.plot(times, track[:, node], color=color, label=f"end at {word} {letter}")


def _marks(right: "Axes", run: Run, axis: int, second: float, metre: float) -> None:
    events = run.events
    for kind, color, marker in (("touch", RED, "v"), ("release", GREEN, "^")):
        found = events["kind"] == kind
        if found.any():
            x, t = metre * events["xyz"[axis]][found], second * events["time"][found]
            label = f"{kind} ({found.sum()})"
            right.plot(x, t, marker, color=color, ms=6, mec="white", mew=0.6, label=label, zorder=5)
    if right.get_legend_handles_labels()[1]:
        right.legend(loc="best")
