"""Picture of bars: motion of their ends, and paths of the nodes in the x-t plane."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.arrays import Array
from softway.bodies.solid import Tool
from softway.record.read.records import Records
from softway.record.read.summary import contacts_of
from softway.record.read.world_lines import changes, ends, kinks, mesh_lines, world_lines
from softway.record.view.bodies.surroundings import plane
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.plots.history import forces
from softway.record.view.style import BLACK, CYCLE, GREEN, RED, canvas, library, scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 60
"""Maximum number of drawn paths, without those of nodes with contact events."""
THIN = 32.0
"""Width of a line times the mean number of lines over the width of a picture [points]."""
TOOL: dict[str, Any] = {"color": BLACK, "lw": 2.0, "alpha": 0.5}
CUT: dict[str, Any] = {"levels": [0.0], "colors": BLACK, "linewidths": 2.0, "alpha": 0.5}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Diagrams:
    """Figure with its panels over time at the ``left``, the x-t diagram at the ``right``, and the scale of time."""

    figure: "Figure"
    left: "tuple[Axes, ...]"
    right: "Axes"
    second: float


def paths(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of end positions, end velocities and contact forces over time, and the x-t diagram of the nodes.

    The paths in the x-t diagram have kinks at the contact events.  Bars in the plane or in space are shown by the
    coordinate along which they are longest.
    """
    return diagrams(run, look).figure


def diagrams(run: Records, look: PictureOptions = STANDARD) -> Diagrams:
    """Draw the figure of :func:`paths` and return it with its panels."""
    axis = int(np.argmax(np.ptp(run.fields.cells.reference, axis=0)))
    track, speed, reach = ends(run, axis)
    times = run.fields.times
    (second, unit), (metre, length) = scaled(times, "s"), scaled(reach, "m")
    contacts = contacts_of(run.history)
    figure = canvas(*(look.inches or (9.6, 6.4 if contacts else 5.0)))
    grid = figure.add_gridspec(3 if contacts else 2, 2, width_ratios=(1.0, 1.05))
    left = [figure.add_subplot(grid[row, 0]) for row in range(grid.nrows)]
    right = figure.add_subplot(grid[:, 1])
    title = run.provenance.get("title", "")
    figure.suptitle(title or "Paths", x=0.01, ha="left", fontsize=12, fontweight="bold")
    letter = "xyz"[axis]
    _ends(left[0], second * times, metre * track, letter)
    left[0].set(title="Ends", ylabel=f"{letter} [{length}]")
    quick, speed_unit = scaled(speed, "m/s")
    _ends(left[1], second * times, quick * speed, letter)
    left[1].set(title="Velocity of the ends", ylabel=f"velocity [{speed_unit}]")
    if contacts:
        forces(left[2], second * run.history["time"], run.history, contacts=contacts)
    for panel in left:
        panel.sharex(left[0])
        panel.tick_params(labelbottom=panel is left[-1])
    left[-1].set_xlabel(f"time [{unit}]")
    title = _fan(right, run, axis, second, metre)
    marks(right, run, axis, second, metre)
    right.set(title=title, xlabel=f"position {letter} [{length}]", ylabel=f"time [{unit}]")
    right.set_ylim(second * times[0], second * times[-1])
    obstacles(left[0], right, run, axis, (second, metre), reach)
    left[0].legend(loc="best")
    return Diagrams(figure=figure, left=tuple(left), right=right, second=second)


def obstacles(left: "Axes", right: "Axes", run: Records, axis: int, factors: tuple[float, float], reach: Array) -> None:
    """Draw the positions of the obstacles over time and in the x-t diagram."""
    (second, metre), times, cells = factors, run.fields.times, run.fields.cells
    moments = np.linspace(times[0], times[-1], 8 * len(times)) if len(times) > 1 else times
    for name, tool in cells.tools.items():
        level = metre * _level(tool, axis, moments)
        if np.isfinite(level).any():
            left.plot(second * moments, level, label=name, **TOOL)
            right.plot(level, second * moments, **TOOL)
        elif len(times) > 1:
            along, gaps = _gaps(tool, axis, times, cells.reference, reach)
            if gaps.min() < 0.0 < gaps.max():
                left.contour(second * times, metre * along, gaps.T, **CUT)
                right.contour(metre * along, second * times, gaps, **CUT)


def _fan(right: "Axes", run: Records, axis: int, second: float, metre: float) -> str:
    """Draw the paths of some nodes with their kinks, or the mesh in space and time where it changes; return a title."""
    if changes(run):
        return f"Paths of {space_time_mesh(right, run, axis, second, metre)} nodes, as long as the mesh has them"
    reference = run.fields.cells.reference[:, axis]
    order = np.argsort(reference)
    chosen = order[np.unique(np.linspace(0, len(order) - 1, min(MOST, len(order))).astype(int))]
    touched = np.array(sorted(kinks(run)), int)
    for path in world_lines(run, np.union1d(chosen, touched), axis):
        right.plot(metre * path[:, 1], second * path[:, 0], color="#7f9db9", lw=0.8)
    return f"Paths of {len(np.union1d(chosen, touched))} nodes"


def space_time_mesh(axes: "Axes", run: Records, axis: int, second: float, metre: float) -> int:
    """Draw the world lines of all nodes of a run whose meshes change; return their number."""
    lines = mesh_lines(run, axis)
    thin = float(np.clip(THIN * len(run.fields) / sum(len(line) for line in lines), 0.15, 0.8))
    pieces = [line[:, ::-1] * (metre, second) for line in lines]
    axes.add_collection(library().collections.LineCollection(pieces, colors="#5b7fa3", linewidths=thin))
    axes.autoscale_view()
    return len(lines)


def _level(tool: Tool, axis: int, times: Array) -> Array:
    """Position (t,) of a flat obstacle normal to an axis at the times (t,) [m]; nan for other obstacles."""
    out = np.full(len(times), np.nan)
    for k, time in enumerate(times):
        flat = plane(tool.at(float(time)))
        if flat is not None and abs(flat[1][axis]) > 0.99:
            out[k] = flat[0][axis]
    return out


def _gaps(tool: Tool, axis: int, times: Array, reference: Array, reach: Array) -> tuple[Array, Array]:
    """Positions (s,) on the line of the bar, over 1.5 times the range of its path, and gaps (t, s) of an obstacle."""
    low, high = reach
    along = np.linspace(1.25 * low - 0.25 * high, 1.25 * high - 0.25 * low, 300)
    line = np.repeat(reference.mean(axis=0)[None], len(along), axis=0)
    line[:, axis] = along
    return along, np.array([tool.at(float(time)).gap(line[:, : tool.shape.dim]) for time in times])


def _ends(left: "Axes", times: Array, track: Array, letter: str) -> None:
    for path, color, word in zip(track.T, CYCLE, ("lower", "upper"), strict=False):
        left.plot(times, path, color=color, label=f"end at {word} {letter}")


def marks(right: "Axes", run: Records, axis: int, second: float, metre: float) -> None:
    """Mark the places and times at which nodes touch and are released."""
    events = run.events
    for kind, color, marker in (("touch", RED, "v"), ("release", GREEN, "^")):
        found = events["kind"] == kind
        if found.any():
            x, t = metre * events["xyz"[axis]][found], second * events["time"][found]
            label = f"{kind} ({found.sum()})"
            right.plot(x, t, marker, color=color, ms=6, mec="white", mew=0.6, label=label, zorder=5)
    if right.get_legend_handles_labels()[1]:
        right.legend(loc="best")
