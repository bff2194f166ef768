"""Figure of a pile: its balls at an instant, coloured by their speed or their group, and its walls."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import rotations
from softway.errors import InputError
from softway.record.pile.motion import BallMotion
from softway.record.read.records import Records
from softway.record.view.mechanism.pose import CORNER
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.pile.walls import shown_walls
from softway.record.view.style import CYCLE, canvas, library, scaled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FIELDS = ("speed", "body")
"""What colours the balls."""
SHADES = (
    *((1.0, 0.55, 0.0), (0.95, 0.8, 0.0), (0.84, 0.95, 0.03)),
    *((0.66, 1.0, 0.14), (0.45, 1.0, 0.28), (0.22, 1.0, 0.5)),
)
"""Discs that make a ball round: radius, brightness and share of white, each nearer to the light."""
LIGHT = (-0.14, 0.16)
"""Place of the light on a ball relative to its radius."""
MARGIN = 0.04
"""Margin relative to the size of the picture."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Stage:
    """What all instants share: motion, parts, colours, and the corners of a box (2, d) around all that is shown."""

    motion: BallMotion
    parts: Mapping[str, Any]
    field: str
    fastest: float
    box: Array

    @property
    def radii(self) -> Array:
        """Radii (n,) [m]."""
        return np.asarray(self.parts["radii"], float)

    def colours(self, row: int) -> Array:
        """Colours (n, 3) of the balls."""
        if self.field == "speed":
            share = self.motion.speeds[row] / (self.fastest or 1.0)
            return np.asarray(library().colormaps["viridis"](share)[:, :3])
        cycle = [library().colors.to_rgb(CYCLE[k % len(CYCLE)]) for k in range(len(self.parts["groups"]))]
        return np.repeat(np.array(cycle), list(self.parts["groups"].values()), axis=0)


def piles(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of the balls at the end, or of those at ``look.times`` side by side."""
    times = run.times
    rows = [_row(times, time) for time in look.times] or [len(times) - 1]
    stage = _stage(run, look, rows)
    wide, high = np.ptp(_seen(_corners(stage.box)), axis=0)
    height = float(np.clip(6.0 * high / wide + 1.2, 3.0, 7.0))
    width = float(np.clip((height - 1.2) * wide / high + 1.6, 4.5, 9.0))
    figure = canvas(*(look.inches or (width * len(rows), height)))
    axes = figure.subplots(1, len(rows), squeeze=False)[0]
    for axis, row in zip(axes, rows, strict=True):
        _scene(axis, stage, row)
    _legend(figure, list(axes), stage)
    figure.suptitle(run.provenance.get("title", "") or "Pile", x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure


def film_of_pile(run: Records, look: PictureOptions) -> "tuple[Figure, Callable[[int], None]]":
    """Figure of a film, and the function that draws a stored instant into it."""
    stage = _stage(run, look, list(range(len(run.times))))
    figure = canvas(*(look.inches or (8.0, 4.5)))
    axis = figure.subplots()
    _legend(figure, [axis], stage)
    figure.suptitle(run.provenance.get("title", "") or "Pile", x=0.01, ha="left", fontsize=12, fontweight="bold")

    def drawn(number: int) -> None:
        axis.clear()
        _scene(axis, stage, number)

    return figure, drawn


def _stage(run: Records, look: PictureOptions, rows: Sequence[int]) -> _Stage:
    """What the instants in some rows share."""
    parts, motion = run.pile, run.balls
    field = look.field or ("body" if len(parts["groups"]) > 1 else "speed")
    if field not in FIELDS:
        raise InputError("--field", f"'{field}' does not colour balls", " or ".join(FIELDS))
    some = np.unique(np.asarray(rows))
    radii = np.asarray(parts["radii"], float)[:, None]
    low = (motion.centres[some] - radii).min(axis=(0, 1))
    high = (motion.centres[some] + radii).max(axis=(0, 1))
    for wall in parts["walls"]:
        axis, at = int(np.argmax(np.abs(wall["normal"]))), np.asarray(wall["point"], float)
        if np.count_nonzero(wall["normal"]) == 1 and not high[axis] < at[axis] - np.ptp([low, high], axis=0).max():
            low[axis], high[axis] = min(low[axis], at[axis]), max(high[axis], at[axis])
    return _Stage(
        motion=motion,
        parts=parts,
        field=field,
        fastest=float(motion.speeds[some].max()),
        box=np.array([low, high]),
    )


def _corners(box: Array) -> Array:
    """Corners (2^d, d) of a box (2, d)."""
    picks = np.stack(np.meshgrid(*([[0, 1]] * box.shape[1]), indexing="ij"), axis=-1).reshape(-1, box.shape[1])
    return np.asarray(box[picks, np.arange(box.shape[1])])


def _seen(points: Array) -> Array:
    """Places (n, 2) in the picture of points in the plane, or in space from a corner."""
    return points if points.shape[1] == 2 else np.asarray(points @ np.array(CORNER).T)


def _scene(axis: "Axes", stage: _Stage, row: int) -> None:
    """Draw one instant."""
    corners = _seen(_corners(stage.box))
    margin = MARGIN * float(np.ptp(corners, axis=0).max())
    _walls(axis, stage)
    (_discs if stage.parts["dim"] == 2 else _spheres)(axis, stage, row)
    factor, unit = scaled(stage.motion.times, "s")
    metre, length = scaled(corners, "m")
    axis.set_xlim(corners[:, 0].min() - margin, corners[:, 0].max() + margin)
    axis.set_ylim(corners[:, 1].min() - margin, corners[:, 1].max() + margin)
    axis.set_aspect("equal", adjustable="box")
    axis.set_title(f"t = {factor * stage.motion.times[row]:.4g} {unit}")
    axis.grid(visible=False)
    axis.xaxis.set_major_formatter(lambda value, _: f"{metre * value:.4g}")
    axis.yaxis.set_major_formatter(lambda value, _: f"{metre * value:.4g}")
    plane = stage.parts["dim"] == 2
    axis.set(xlabel=f"x [{length}]" if plane else f"seen from a corner [{length}]")
    axis.set(ylabel=f"y [{length}]" if plane else f"z upwards [{length}]")


def _walls(axis: "Axes", stage: _Stage) -> None:
    """Draw the walls: lines in the plane; in space sheets behind the balls, and the edges of the others."""
    view = np.cross(*np.array(CORNER))
    reach = float(stage.radii.max()) if stage.parts["dim"] == 2 else 0.0  # lines meet below the lowest disc
    low, high = stage.box
    for corners, normal in shown_walls(stage.parts["walls"], low - reach, high + reach):
        line = _seen(np.vstack([corners, corners[:1]]))
        if len(normal) == 2:
            axis.plot(*line.T, color="#555555", lw=2.0, zorder=1)
        elif normal @ view > 0.0:
            axis.fill(*line.T, facecolor="#e4e4e4", edgecolor="#999999", lw=0.8, zorder=0)
        else:
            axis.plot(*line.T, color="#999999", lw=0.8, zorder=3)


def _discs(axis: "Axes", stage: _Stage, row: int) -> None:
    """Draw discs, each with a radius that turns with it."""
    centres, radii = stage.motion.centres[row], stage.radii
    _circles(axis, centres, radii, stage.colours(row), edge=0.4)
    arm = radii[:, None] * rotations(stage.motion.turns[row])[:, :2, 0]
    ends = np.stack([centres, centres + 0.9 * arm], axis=1)
    axis.add_collection(library().collections.LineCollection(ends, colors="white", linewidths=0.8, zorder=2.5))


def _spheres(axis: "Axes", stage: _Stage, row: int) -> None:
    """Draw balls as discs with a light, the far ones first."""
    centres = stage.motion.centres[row]
    order = np.argsort(centres @ np.cross(*np.array(CORNER)), kind="stable")
    places, radii, colours = _seen(centres)[order], stage.radii[order], stage.colours(row)[order]
    share = np.array([size for size, _, _ in SHADES])
    shift = radii[:, None, None] * ((1.0 - share)[:, None] * 1.5 * np.array(LIGHT))
    tones = np.stack([(1.0 - white) * bright * colours + white for _, bright, white in SHADES], axis=1)
    _circles(
        axis,
        (places[:, None] + shift).reshape(-1, 2),
        (radii[:, None] * share).ravel(),
        np.clip(tones, 0.0, 1.0).reshape(-1, 3),
        edge=0.0,
    )


def _circles(axis: "Axes", places: Array, radii: Array, colours: Array, edge: float) -> None:
    """Draw filled circles in their order."""
    made = library().collections.EllipseCollection(
        *(2.0 * radii, 2.0 * radii, np.zeros(len(radii))),
        units="xy",
        offsets=places,
        offset_transform=axis.transData,
        facecolors=colours,
        edgecolors="#333333" if edge else "none",
        linewidths=edge,
        zorder=2,
    )
    axis.add_collection(made)


def _legend(figure: "Figure", axes: "list[Axes]", stage: _Stage) -> None:
    """Colour bar of the speed, or names of the groups."""
    if stage.field == "speed":
        factor, unit = scaled(stage.fastest, "m/s")
        norm = library().colors.Normalize(0.0, factor * stage.fastest or 1.0)
        mapped = library().cm.ScalarMappable(norm, "viridis")
        figure.colorbar(mapped, ax=axes, shrink=0.8, pad=0.02, aspect=28, label=f"speed [{unit}]")
        return
    marks = [
        library().lines.Line2D([], [], ls="", marker="o", color=CYCLE[k % len(CYCLE)], label=name)
        for k, name in enumerate(stage.parts["groups"])
    ]
    figure.legend(handles=marks, loc="outside right upper")


def _row(times: Array, time: float) -> int:
    """Row of the stored instant nearest to a time [s]."""
    last = float(times[-1])
    if not 0.0 <= time <= last * (1.0 + 1e-9):
        raise InputError("--at, --times", f"{time:g} s is not in the run", f"from 0 to {last:g} s")
    return int(np.argmin(np.abs(times - time)))
