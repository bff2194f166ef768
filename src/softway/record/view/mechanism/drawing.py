"""Drawing of a mechanism at one instant: bodies, joints, stops and springs."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from softway.arrays import Array
from softway.mechanisms.members.joints import GROUND
from softway.mechanisms.members.stop_friction import tangents
from softway.record.view.mechanism.pose import CORNER, Poses, seen
from softway.record.view.style import BLACK, CYCLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COILS = 7
"""Windings of a drawn spring."""
SMALL = 0.012
"""Size of a drawn mark relative to the picture."""
SLENDER = 0.03
"""Area of a hull, relative to the square of its length, below which it is drawn as a line."""
HATCHES = 14
"""Strokes behind a drawn plane."""


def colours(poses: Poses) -> dict[str, str]:
    """Colour of each body."""
    return {name: _colour(k) for k, name in enumerate(poses.parts["bodies"])}


def _colour(k: int) -> str:
    """Colour of the body with a number; they become lighter where the cycle of colours begins again."""
    first = CYCLE[k % len(CYCLE)].lstrip("#")
    dark = 0.6 ** (k // len(CYCLE))
    return "#" + "".join(f"{round(255 - dark * (255 - int(first[i : i + 2], 16))):02x}" for i in (0, 2, 4))


def draw(axis: "Axes", poses: Poses, row: int, size: float, alpha: float = 1.0) -> None:
    """Draw the mechanism of a row of the table into a picture of a size [m]; paler with a smaller ``alpha``."""
    of = colours(poses)
    if alpha == 1.0:
        for stop in poses.parts["stops"]:
            if stop["kind"] == "PlaneStop":
                _plane(axis, poses, stop, row, size)
    for name, colour in of.items():
        _body(axis, poses, name, row, colour, size, alpha)
        for radius, start in radii(poses, name):
            _ball(axis, poses.point(name, start, row), radius, colour, alpha)
            _marks(axis, poses, name, start, row, radius, colour, alpha)
    for spring in poses.parts["springs"]:
        _spring(axis, poses, spring, row, size, alpha)
    for stop in poses.parts["stops"]:
        if stop.get("side") == "most":
            ends = [poses.point(body, at, row) for body, at in zip(stop["between"], stop["points"], strict=True)]
            axis.plot(*np.array(ends).T, color=BLACK, lw=0.9, ls=(0, (1, 2)), alpha=alpha, zorder=3)
    for joint in poses.parts["joints"]:
        _joint(axis, poses, joint, row, size, alpha)


def _body(axis: "Axes", poses: Poses, name: str, row: int, colour: str, size: float, alpha: float) -> None:
    """Hull of the points of a body, the line between two of them, or a block, and its centre."""
    points, centre = poses.points(name, row), poses.point(name, poses.parts["bodies"][name], row)
    axis.plot(*centre, "o", ms=4.0, color=colour, alpha=alpha, mec="white", mew=0.6, zorder=4)
    if len(points) == 1 and not radii(poses, name):
        corner = 2.0 * SMALL * size * poses.direction(name, [1.0, 0.7, 0.0][: poses.parts["dim"]], row)
        other = 2.0 * SMALL * size * poses.direction(name, [-1.0, 0.7, 0.0][: poses.parts["dim"]], row)
        points = points[0] + np.array([corner, other, -corner, -other])
    if len(points) > 2:
        hull = _hull(points)
        if hull is not None:
            axis.fill(*hull.T, facecolor=colour, edgecolor=colour, lw=2.0, alpha=0.35 * alpha, zorder=2)
            axis.plot(*np.vstack([hull, hull[:1]]).T, color=colour, lw=2.0, alpha=alpha, zorder=2)
            return
        along = points[-1] - points[0]
        points = points[np.argsort(points @ along)]
    axis.plot(*points.T, color=colour, lw=5.0, alpha=0.75 * alpha, solid_capstyle="round", zorder=2)


def _hull(points: Array) -> Array | None:
    """Corners (k, 2) of the convex hull of points, None if they lie nearly on a line."""
    try:
        found = ConvexHull(points)
    except QhullError:
        return None
    length = 0.5 * found.area  # of two dimensions: half of the circumference
    return np.asarray(points[found.vertices]) if found.volume > SLENDER * length**2 else None


def radii(poses: Poses, name: str) -> list[tuple[float, list[float]]]:
    """Radii [m] and places at the start of the balls that stops put around points of a body."""
    found: dict[tuple[float, ...], float] = {}
    for stop in poses.parts["stops"]:
        for body, point in zip(stop["between"], stop["points"], strict=True):
            if body != name:
                continue
            if stop["kind"] == "PlaneStop" and stop["radius"] and point is stop["points"][1]:
                found[tuple(point)] = stop["radius"]
            if stop["kind"] == "DistanceStop" and stop["side"] == "least" and GROUND not in stop["between"]:
                found[tuple(point)] = 0.5 * stop["distance"]
    return [(radius, list(point)) for point, radius in found.items()]


def _ball(axis: "Axes", centre: Array, radius: float, colour: str, alpha: float) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    circle = centre + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    axis.fill(*circle.T, facecolor=colour, edgecolor=colour, alpha=0.4 * alpha, lw=1.2, zorder=2)


def _marks(
    axis: "Axes", poses: Poses, name: str, start: list[float], row: int, radius: float, colour: str, alpha: float
) -> None:
    """Lines that turn with a ball: a radius in the plane; in space the visible halves of two great circles."""
    middle, turned = poses.point(name, start, row), poses.turned(name, row)
    if poses.parts["dim"] == 2:
        axis.plot(*np.array([middle, middle + radius * turned[:, 0]]).T, color=colour, lw=1.2, alpha=alpha, zorder=3)
        return
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    for one, other in ((0, 1), (0, 2)):
        circle = radius * (np.cos(angle)[:, None] * turned[:, one] + np.sin(angle)[:, None] * turned[:, other])
        drawn = middle + seen(circle.T).T
        drawn[circle @ np.cross(*CORNER) < 0.0] = np.nan  # behind the ball
        axis.plot(*drawn.T, color=colour, lw=1.2, alpha=alpha, zorder=3)


def _joint(axis: "Axes", poses: Poses, joint: Mapping[str, Any], row: int, size: float, alpha: float) -> None:
    """Pins as rings, rods as lines, guides as rails, supports as triangles on the ground."""
    places = [poses.point(body, at, row) for body, at in zip(joint["between"], joint["points"], strict=True)]
    if joint["kind"] == "Rod":
        axis.plot(*np.array(places).T, color=BLACK, lw=1.2, alpha=alpha, zorder=3)
    if "axis" in joint and alpha == 1.0:
        way = poses.direction(joint["between"][0], joint["axis"], row)
        length = float(np.linalg.norm(way))
        if length > 0.0:
            reach = max(float(np.linalg.norm(places[1] - places[0])), 6.0 * SMALL * size)
            middle = 0.5 * (places[0] + places[1])
            ends = middle + 1.3 * reach * np.array([[-1.0], [1.0]]) * way / length
            axis.plot(*ends.T, color=BLACK, lw=0.9, ls=(0, (6, 3)), alpha=0.7, zorder=1)
    shape = "s" if joint["kind"] in ("Slider", "PinSlot", "Cylindrical") else "o"
    for body, place in zip(joint["between"], places, strict=True):
        if body == GROUND:
            axis.plot(*place, "^", ms=9.0, color=BLACK, alpha=0.6 * alpha, zorder=1)
        else:
            axis.plot(*place, shape, ms=5.5, mfc="white", mec=BLACK, mew=1.2, alpha=alpha, zorder=5)


def _spring(axis: "Axes", poses: Poses, spring: Mapping[str, Any], row: int, size: float, alpha: float) -> None:
    one, other = (poses.point(body, at, row) for body, at in zip(spring["between"], spring["points"], strict=True))
    way = other - one
    length = float(np.linalg.norm(way)) or 1.0
    across = np.array([-way[1], way[0]]) / length * max(SMALL * size, 0.04 * length)
    along = np.concatenate([[0.0], np.linspace(0.15, 0.85, 2 * COILS + 1), [1.0]])
    side = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], COILS)[: 2 * COILS - 1], [0.0, 0.0]])
    axis.plot(*(one + along[:, None] * way + side[:, None] * across).T, color=BLACK, lw=1.0, alpha=alpha, zorder=3)


def _plane(axis: "Axes", poses: Poses, stop: Mapping[str, Any], row: int, size: float) -> None:
    """Line of a plane with strokes behind it; in space a part of the plane of the ground."""
    body, name = stop["between"][0], stop["name"]
    normal = poses.direction(body, stop["normal"], row)
    length = float(np.linalg.norm(normal))
    if poses.parts["dim"] == 3 and name in poses.floors:
        _patch(axis, poses.floors[name], stop["normal"], 0.1 * size)
        return
    if length == 0.0:
        return
    normal = normal / length
    along, half = np.array([-normal[1], normal[0]]), 0.12 * size
    places = poses.floors[name] if name in poses.floors else poses.point(body, stop["points"][0], row)[None]
    ways = (places - places[0]) @ along
    low, high = float(ways.min()) - half, float(ways.max()) + half
    start, apart = float(places[0] @ along), 2.0 * half / HATCHES  # stops on one plane have the same strokes
    axis.plot(*np.array([places[0] + low * along, places[0] + high * along]).T, color=BLACK, lw=1.8, zorder=1)
    for way in apart * np.arange(np.ceil((start + low) / apart), (start + high) / apart) - start:
        foot = places[0] + way * along
        axis.plot(*np.array([foot, foot - SMALL * size * (normal + along)]).T, color=BLACK, lw=0.7, alpha=0.7, zorder=1)


def _patch(axis: "Axes", corners: Array, normal: list[float], margin: float) -> None:
    """Part (4, 3) of a plane in space, with a margin around it."""
    across = np.array(tangents(np.asarray(normal, float) / float(np.linalg.norm(normal)), 3))
    middle = corners.mean(axis=0)
    reach = np.abs((corners - middle) @ across.T).max(axis=0) + margin
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    outline = middle + (signs * reach) @ across
    axis.fill(*seen(outline.T), facecolor=BLACK, edgecolor=BLACK, alpha=0.08, lw=1.0, zorder=0)
