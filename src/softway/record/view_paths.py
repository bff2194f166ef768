"""Bars in one picture: how their ends move, and the paths of all nodes in the x-t plane."""

from typing import TYPE_CHECKING, Any

import numpy as np

from softway.bodies.solid import Tool
from softway.record.run import Run
from softway.record.view_scene import plane
from softway.record.view_style import BLACK, CYCLE, GREEN, RED, canvas, scaled
from softway.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 60
"""Greatest number of paths drawn."""
TOOL: dict[str, Any] = {"color": BLACK, "lw": 2.0, "alpha": 0.5}
CUT: dict[str, Any] = {"levels": [0.0], "colors": BLACK, "linewidths": 2.0, "alpha": 0.5}


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
    moments = np.linspace(times[0], times[-1], 8 * len(times)) if len(times) > 1 else times
    for name, tool in cells.tools.items():
        level = metre * _level(tool, axis, moments)
        if np.isfinite(level).any():
            left.plot(second * moments, level, label=name, **TOOL)
            right.plot(level, second * moments, **TOOL)
        elif len(times) > 1:
            along, gaps = _gaps(tool, axis, times, cells.reference, track)
            if gaps.min() < 0.0 < gaps.max():
                left.contour(second * times, metre * along, gaps.T, **CUT)
                right.contour(metre * along, second * times, gaps, **CUT)
    left.legend(loc="best")
    return figure


def _level(tool: Tool, axis: int, times: Array) -> Array:
    """Where (t,) a flat obstacle across an axis stands at the times (t,) [m]; nan where there is none."""
    out = np.full(len(times), np.nan)
    for k, time in enumerate(times):
        flat = plane(tool.at(float(time)))
        if flat is not None and abs(flat[1][axis]) > 0.99:
            out[k] = flat[0][axis]
    return out


def _gaps(tool: Tool, axis: int, times: Array, reference: Array, track: Array) -> tuple[Array, Array]:
    """Places (s,) on the line of the bar, half as long again as its path, and the gap (t, s) of an obstacle there."""
    low, high = float(track.min()), float(track.max())
    along = np.linspace(1.25 * low - 0.25 * high, 1.25 * high - 0.25 * low, 300)
    line = np.repeat(reference.mean(axis=0)[None], len(along), axis=0)
    line[:, axis] = along
    return along, np.array([tool.at(float(time)).gap(line[:, : tool.shape.dim]) for time in times])


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
