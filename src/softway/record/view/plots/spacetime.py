"""Space-time mesh of bodies on a line or in the plane: world lines of nodes, time steps (slabs), contact events."""

from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array, IntArray
from softway.record.read.records import Records
from softway.record.read.world_lines import changes, kinks, mesh_lines, world_lines
from softway.record.view.bodies.surroundings import plane
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.plots.paths import marks, space_time_mesh
from softway.record.view.style import BLACK, canvas, scaled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 60
"""Maximum number of world lines, without those of bar nodes with contact events."""
SLABS = 120
"""Approximate maximum number of slab ends that are drawn."""


def spacetime(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of world lines over the coordinate normal to the obstacle, with the ends of the slabs."""
    cells, axis = run.fields.cells, _axis(run)
    changing, times = changes(run), run.history["time"]
    lines = _lasting(run, axis) if changing else world_lines(run, _nodes(run), axis)
    (second, unit), (metre, length) = scaled(times, "s"), scaled(np.concatenate(lines)[:, 1], "m")
    figure = canvas(*(look.inches or (5.2, 5.6)))
    panel = figure.subplots()
    for time in times[:: -(-len(times) // SLABS)]:
        panel.axhline(second * time, color="#dddddd", lw=0.5, zorder=0)
    count = len(lines)
    if changing and cells.dimension == 1:
        lines, count = [], space_time_mesh(panel, run, axis, second, metre)
    for line in lines:
        panel.plot(metre * line[:, 1], second * line[:, 0], color="#5b7fa3", lw=0.8)
    for tool in cells.tools.values():
        flats = [plane(tool.at(float(time))) for time in times]
        if all(flat is not None and abs(flat[1][axis]) > 0.99 for flat in flats):
            levels = [flat[0][axis] for flat in flats if flat is not None]
            panel.plot(metre * np.array(levels), second * times, color=BLACK, lw=2.0, alpha=0.5)
    marks(panel, run, axis, second, metre)
    panel.grid(False)
    letter = "xyz"[axis]
    panel.set(title=f"World lines of {count} nodes", xlabel=f"{letter} [{length}]", ylabel=f"time [{unit}]")
    panel.set_ylim(second * times[0], second * times[-1])
    return figure


def _lasting(run: Records, axis: int) -> list[Array]:
    """World lines of some nodes that the meshes of a run have from its start to its end."""
    lines, times = mesh_lines(run, axis), run.fields.times
    whole = [line for line in lines if line[0, 0] <= times[0] and line[-1, 0] >= times[-1]]
    return [whole[k] for k in np.unique(np.linspace(0, len(whole) - 1, min(MOST, len(whole))).astype(int))]


def _axis(run: Records) -> int:
    """Axis normal to a flat obstacle; without one, the axis of the longest bar, or the last axis in the plane."""
    cells = run.fields.cells
    for tool in cells.tools.values():
        flat = plane(tool.at(0.0))
        if flat is not None and np.abs(flat[1]).max() > 0.99:
            return int(np.argmax(np.abs(flat[1])))
    return int(np.argmax(np.ptp(cells.reference, axis=0))) if cells.dimension == 1 else cells.dimension - 1


def _nodes(run: Records) -> IntArray:
    """Nodes whose world lines are drawn: nodes of bars; in the plane nodes with contact events, or any if none has."""
    cells, touched = run.fields.cells, np.array(sorted(kinks(run)), int)
    pool = np.arange(len(cells.reference)) if cells.dimension == 1 or not len(touched) else touched
    chosen = pool[np.unique(np.linspace(0, len(pool) - 1, min(MOST, len(pool))).astype(int))]
    return np.union1d(chosen, touched) if cells.dimension == 1 else chosen
