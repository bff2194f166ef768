"""Figure of a mechanism: its position at an instant, earlier ones in pale, and the paths of its points."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.record.read.records import Records
from softway.record.view.mechanism.drawing import colours, draw
from softway.record.view.mechanism.pose import Poses, poses
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.style import BLACK, canvas, scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PALE = 6
"""Number of pale positions."""
DENSE = 10.0
"""Length of a path relative to the picture from which on it is drawn thin."""
MARGIN = 0.08
"""Margin around the mechanism, relative to its size."""


def positions(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of the position at the end, or of those at ``look.times`` side by side."""
    if look.field is not None:
        raise InputError("--field", f"'{look.field}': rigid bodies have no fields", "omit this option")
    shown = poses(run)
    rows = [_row(shown, time) for time in look.times] or [shown.motion.rows - 1]
    paths = _paths(shown)
    box = _box(shown, paths)
    width, height = _size(box, 2.0 if len(shown.parts["bodies"]) > 1 else 0.9)
    figure = canvas(*(look.inches or (width * len(rows), height)))
    axes = figure.subplots(1, len(rows), squeeze=False)[0]
    pale = [] if look.times else _spread(shown, rows[0])
    for axis, row in zip(axes, rows, strict=True):
        _scene(axis, shown, row, box, paths, pale)
        if axis is not axes[0]:
            axis.set_ylabel("")
        if axis is not axes[-1] and (names := axis.get_legend()) is not None:
            names.remove()
    title = run.provenance.get("title", "")
    figure.suptitle(title or "Mechanism", x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure


def _spread(shown: Poses, last: int) -> list[int]:
    """Rows up to ``last`` between which the bodies move by equal ways."""
    centres = np.array([shown.motion[c][: last + 1] for c in shown.motion if c.rpartition(".")[2] in ("x", "y", "z")])
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(centres, axis=1), axis=0))])
    return sorted({int(np.searchsorted(way, share * way[-1])) for share in np.linspace(0.0, 1.0, PALE + 1)[:-1]})


def film_of(run: Records, look: PictureOptions) -> "tuple[Figure, Callable[[int], None]]":
    """Figure of a film, and the function that draws a stored instant into it."""
    shown = poses(run)
    figure, paths = canvas(*(look.inches or (8.0, 4.5))), _paths(shown)
    box = _box(shown, paths)
    axis = figure.subplots()
    figure.suptitle(run.provenance.get("title", "") or "Mechanism", x=0.01, ha="left", fontsize=12, fontweight="bold")

    def drawn(number: int) -> None:
        axis.clear()
        _scene(axis, shown, number, box, paths)

    return figure, drawn


def _paths(shown: Poses) -> list[tuple[str, Array]]:
    """Paths (t, 2) of the points of the probes, or of all centres, with the names of their bodies."""
    probed = dict.fromkeys((probe["body"], tuple(probe["at"])) for probe in shown.parts["probes"])
    traced = list(probed) or [(name, tuple(centre)) for name, centre in shown.parts["bodies"].items()]
    return [(name, shown.path(name, start)) for name, start in traced]


def _scene(
    axis: "Axes", shown: Poses, row: int, box: Array, paths: list[tuple[str, Array]], pale: Sequence[int] = ()
) -> None:
    """Draw one position, some pale ones, and the paths until then."""
    size, of = float(np.linalg.norm(np.ptp(box, axis=0))), colours(shown)
    for name, path in paths:
        trail = path[: row + 1]
        dense = float(np.linalg.norm(np.diff(trail, axis=0), axis=1).sum()) > DENSE * size
        axis.plot(*trail.T, color=of[name], lw=0.5 if dense else 1.0, alpha=0.3 if dense else 0.6, zorder=0)
    for one in pale:
        draw(axis, shown, one, size, 0.18)
    draw(axis, shown, row, size)
    for name, colour in of.items():
        axis.plot([], [], "o", ms=5.0, color=colour, label=name)
    factor, unit = scaled(shown.times, "s")
    metre, length = scaled(box, "m")
    margin = MARGIN * size
    axis.set_xlim(box[0, 0] - margin, box[1, 0] + margin, auto=True)
    axis.set_ylim(box[0, 1] - margin, box[1, 1] + margin, auto=True)
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_title(f"t = {factor * shown.times[row]:.4g} {unit}")
    plane = shown.parts["dim"] == 2
    axis.xaxis.set_major_formatter(lambda value, _: f"{metre * value:.4g}")
    axis.yaxis.set_major_formatter(lambda value, _: f"{metre * value:.4g}")
    axis.set(xlabel=f"x [{length}]" if plane else f"seen from a corner [{length}]")
    axis.set(ylabel=f"y [{length}]" if plane else f"z upwards [{length}]")
    if len(of) > 1:
        axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), labelcolor=BLACK)


def _box(shown: Poses, paths: list[tuple[str, Array]]) -> Array:
    """Corners (2, 2) of a box around all positions and paths."""
    count = shown.motion.rows
    some = np.unique(np.linspace(0, count - 1, min(count, 60)).round().astype(int))
    points = [shown.points(name, int(row)) for name in shown.parts["bodies"] for row in some]
    ends = [
        shown.point(body, at, 0)[None]
        for part in (*shown.parts["joints"], *shown.parts["springs"])
        for body, at in zip(part["between"], part["points"], strict=True)
    ]
    every = np.vstack([*points, *ends, *(path for _, path in paths)])
    reach = max((radius_of(stop) for stop in shown.parts["stops"]), default=0.0)
    box = np.array([every.min(axis=0) - reach, every.max(axis=0) + reach])
    least = 0.25 * max(float(np.ptp(box, axis=0).max()), 1e-9)
    short = np.maximum(least - np.ptp(box, axis=0), 0.0)
    return np.asarray(box + 0.5 * np.array([-short, short]))


def radius_of(stop: Mapping[str, Any]) -> float:
    """Radius of the balls that a stop draws [m]."""
    return float(stop.get("radius") or (0.5 * stop["distance"] if stop.get("side") == "least" else 0.0))


def _size(box: Array, aside: float) -> tuple[float, float]:
    """Width and height of a panel with room ``aside`` for names [inches]."""
    wide, high = np.ptp(box, axis=0)
    height = float(np.clip(6.5 * high / wide + 1.2, 3.0, 7.0))
    return float(np.clip((height - 1.2) * wide / high + aside, 4.5, 9.0)), height


def _row(shown: Poses, time: float) -> int:
    """Row of the stored instant nearest to a time [s]."""
    last = float(shown.times[-1])
    if not 0.0 <= time <= last * (1.0 + 1e-9):
        raise InputError("--at, --times", f"{time:g} s is not in the run", f"from 0 to {last:g} s")
    return int(np.argmin(np.abs(shown.times - time)))
