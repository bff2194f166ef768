"""Structured meshes whose cells differ in size: discs fine towards one point, rings, grids at given coordinates.

The fine disc is a polar mesh of a half-plane, its rings in geometric progression about zero, carried onto the disc by a
conformal map: angles stay right, and the size of a cell is in proportion to its distance from the point.
"""

from collections.abc import Sequence
from math import ceil, log, pi, tan
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from softway.errors import InputError
from softway.space.cells import CELLS
from softway.space.lattice import merged, require_few, tensor_cells
from softway.space.mesh import Mesh
from softway.space.shapes import box, rectangle
from softway.typing import Array, IntArray

Complex = NDArray[np.complex128]

Part = Literal["whole", "lower", "right", "quarter"]
"""Which part of a disc is meshed: all of it, y <= 0, x >= 0, or both."""

# How far the sides of the core blocks bulge, and half the width of the coarse core over the radius.
_BULGE, _COARSE = 0.2, 0.6


def grid(*coordinates: Sequence[float], cell: str | None = None) -> Mesh:
    """A rectangle or a box along the axes with cells between given coordinates; tags of its sides.

    Parameters
    ----------
    coordinates
        Increasing, along x and y, or x, y and z [m].
    cell
        ``tri3 tri6 quad4 quad9``, or ``tet4 tet10 hex8 hex27``; ``quad4`` or ``hex8`` by default.

    Examples
    --------
    >>> mesh = grid((0.0, 0.1, 1.0), (0.0, 0.5))
    >>> mesh.points[mesh.nodes("top")].round(12).tolist()
    [[0.0, 0.5], [0.1, 0.5], [1.0, 0.5]]
    """
    dim = len(coordinates)
    if dim not in (2, 3):
        raise InputError("x", f"coordinates along {dim} axes", "along x and y, or x, y and z")
    lines = [np.asarray(c, dtype=float) for c in coordinates]
    for axis, line in zip("xyz", lines, strict=False):
        if line.ndim != 1 or len(line) < 2 or not np.isfinite(line).all() or (np.diff(line) <= 0.0).any():
            raise InputError(axis, f"{line.tolist()}", "two or more increasing coordinates")
    steps = tuple(len(line) - 1 for line in lines)
    if dim == 2:
        even = rectangle((float(steps[0]), float(steps[1])), (steps[0], steps[1]), cell=cell or "quad4")
    else:
        size = (float(steps[0]), float(steps[1]), float(steps[2]))
        even = box(size, (steps[0], steps[1], steps[2]), cell=cell or "hex8")
    points = [np.interp(even.points[:, k], np.arange(len(line)), line) for k, line in enumerate(lines)]
    return Mesh(points=np.column_stack(points), blocks=even.blocks, tags=even.tags)


def geometric(start: float, end: float, cells: int, ratio: float) -> tuple[float, ...]:
    """Coordinates from ``start`` to ``end`` [m] whose cells grow by a constant factor, the last ``ratio`` times the
    first.

    Examples
    --------
    >>> geometric(0.0, 7.0, 3, 4.0)
    (0.0, 1.0, 3.0, 7.0)
    """
    if cells < 1 or not ratio > 0.0:
        raise InputError("cells", f"{cells} cells with the ratio {ratio:g}", "one cell or more, a positive ratio")
    sizes = ratio ** (np.arange(cells) / max(cells - 1, 1))
    places = start + (end - start) * np.concatenate([[0.0], np.cumsum(sizes) / sizes.sum()])
    return (*(float(x) for x in places[:-1]), float(end))


def ring(
    inner: float,
    outer: float,
    cells: tuple[int, int],
    *,
    angle: float = 2.0 * pi,
    start: float = 0.0,
    centre: Sequence[float] = (0.0, 0.0),
    cell: str = "quad4",
) -> Mesh:
    """A ring, or a sector of one; tags ``inner``, ``outer``, and of a sector ``start`` and ``end``, its straight sides.

    Parameters
    ----------
    inner, outer
        Radii [m].
    cells
        Numbers of cells across the ring and around it.
    angle, start
        Of the sector, and where it starts, from the x axis anticlockwise [rad].
    centre
        [m].
    cell
        ``tri3 tri6 quad4 quad9``; nodes of quadratic cells lie on the circles.

    Examples
    --------
    >>> quarter = ring(1.0, 2.0, (1, 2), angle=pi / 2)
    >>> quarter.points[quarter.nodes("inner")].round(6).tolist()
    [[1.0, 0.0], [0.707107, 0.707107], [0.0, 1.0]]
    """
    if not 0.0 < inner < outer < np.inf:
        raise InputError("inner", f"radii {inner:g} m and {outer:g} m", "0 < inner < outer")
    whole = abs(angle - 2.0 * pi) < 1e-9
    if not (0.0 < angle < 2.0 * pi or whole):
        raise InputError("angle", f"{angle:g} rad", "an angle above zero, up to a full turn")
    if whole and (len(cells) != 2 or cells[1] < 3):
        raise InputError("cells", f"{list(cells)} cells of a full turn", "three or more around it")
    flat = rectangle((1.0, 1.0), cells, cell=cell)
    across, around = flat.points.T
    radius, turn = inner + (outer - inner) * across, start + angle * around
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)]) + _plane("centre", centre)
    sides = {"inner": flat.nodes("left"), "outer": flat.nodes("right")}
    if not whole:
        sides = {**sides, "start": flat.nodes("bottom"), "end": flat.nodes("top")}
        return Mesh(points=points, blocks=flat.blocks, tags=sides)
    number = np.arange(len(points))
    seam, first = (flat.nodes(side)[np.argsort(across[flat.nodes(side)])] for side in ("top", "bottom"))
    number[seam] = first
    kept, closed = np.unique(number, return_inverse=True)
    blocks = {name: closed[nodes] for name, nodes in flat.blocks.items()}
    return Mesh(points=points[kept], blocks=blocks, tags={n: closed[nodes] for n, nodes in sides.items()})


def graded_disc(
    radius: float,
    focus: float,
    cells: int,
    *,
    part: Part = "whole",
    centre: Sequence[float] = (0.0, 0.0),
    cell: str = "quad4",
) -> Mesh:
    """A disc, or a part of one, with small cells at its lowest point that grow with the distance from it.

    Tags: ``boundary``, the arc; ``focus``, its fine part; ``bottom``, the lowest point; ``centre``; of
    parts also ``diameter`` (at the height of the centre) and ``axis`` (above the lowest point).

    Parameters
    ----------
    radius
        [m].
    focus
        Length of the arc, to either side of the lowest point, with cells of equal size [m], up to the radius.
    cells
        Number of cells along this length, two or more.
    part
        ``whole``, ``lower`` (half), ``right`` (half: the section of a ball), ``quarter``.
    centre
        Of the disc [m].
    cell
        ``quad4`` or ``quad9``.

    Examples
    --------
    >>> mesh = graded_disc(1.0, 0.01, 4, part="quarter")
    >>> mesh.n_cells, round(mesh.edge(), 6), mesh.points[mesh.nodes("bottom")].tolist()
    (232, 0.002065, [[0.0, -1.0]])
    """
    if not 0.0 < radius < np.inf:
        raise InputError("radius", f"{radius:g} m is not a length", "a positive number")
    if part not in get_args(Part):
        raise InputError("part", f"{part!r} is no part of a disc", f"one of: {', '.join(get_args(Part))}")
    if not 0.0 < focus <= radius:
        raise InputError("focus", f"{focus:g} m on a disc of radius {radius:g} m", "a positive length up to the radius")
    if not isinstance(cells, int | np.integer) or cells < 2:
        raise InputError("cells", f"{cells} is not a number of cells", "a whole number from 2 on")
    if cell not in ("quad4", "quad9"):
        raise InputError("cell", f"{cell!r} does not fit", "quad4 or quad9")
    require_few(cells, cells)
    edge = tan(0.5 * focus / radius)
    order = CELLS[cell].order
    lower = _rings(edge, cells)
    upper = _rings(_COARSE, cells) if part in ("whole", "right") else 0
    lattice, nodes = merged(_blocks(cells, lower + upper, part, cell))
    i, j, layer = lattice.T
    shape = np.abs(i) / (order * cells), j / (order * cells)
    z = _placed(shape, layer / order, lower, upper, edge)
    x = np.where(i == 0, 0.0, np.sign(i) * z.real)
    y = np.where(layer == order * lower, 0.0, z.imag)
    points = radius * np.column_stack([x, y]) + _plane("centre", centre)
    return Mesh(points=points, blocks={cell: nodes}, tags=_tags(i, j, layer, order * lower, part))


def _rings(edge: float, cells: int) -> int:
    """Number of rings with square cells from a core of half width ``edge`` to the circle |w| = 1."""
    return max(1, ceil(-log(edge * (1.0 + 0.5 * _BULGE)) * 4.0 * cells / pi))


def _blocks(cells: int, rings: int, part: Part, cell: str) -> IntArray:
    """Lattice points (e, a, 3): place in the core or on its rim, and the layer of the ring, counted from the bottom."""
    order = CELLS[cell].order
    side = order * cells
    left = -side if part in ("whole", "lower") else 0
    halves = 2 if left else 1
    core = tensor_cells((halves * cells, cells), cell)
    core[..., 0] += left
    parts = [np.concatenate([core, np.zeros_like(core[..., :1])], axis=-1)]
    layer, around = np.moveaxis(tensor_cells((rings, 2 * halves * cells), cell), -1, 0)
    rim = np.clip(2 * side - around, -side, side), np.minimum(np.minimum(around, side), 4 * side - around)
    parts.append(np.stack([*rim, layer], axis=-1))
    if part in ("whole", "right"):
        parts.append(
            np.stack([side + left - core[..., 0], core[..., 1], np.full(core.shape[:-1], order * rings)], axis=-1)
        )
    return np.concatenate(parts)


def _placed(shape: tuple[Array, Array], layer: Array, lower: int, upper: int, edge: float) -> Complex:
    """Points (n,) of the right half of the unit disc; the upper half is the lower one of another core, mirrored."""
    low = _carried(shape, np.minimum(layer / lower, 1.0), edge)
    if not upper:
        return low
    high = _carried(shape, np.minimum((lower + upper - layer) / upper, 1.0), _COARSE)
    return np.where(layer <= lower, low, high.conj())


def _carried(shape: tuple[Array, Array], share: Array, edge: float) -> Complex:
    """Points (n,) of the lower half of the unit disc: |w| = 1 is its diameter, w = 0 its lowest point.

    The core is a square with bulged sides; between its rim (``share`` 0) and the circle (1) log w is linear.
    """
    x, y = shape
    core = edge / (1.0 + _BULGE) * (x * (1.0 + _BULGE * (1.0 - y**2)) + 1j * y * (1.0 + _BULGE * (1.0 - x**2)))
    w = core ** (1.0 - share) * np.exp(0.25j * pi * (1.0 + y - x) * share)
    z = -1j * (1.0 + 1j * w) / (1.0 - 1j * w)
    return np.where(y == 0.0, z / np.abs(z), z)


def _tags(i: IntArray, j: IntArray, layer: IntArray, middle: int, part: Part) -> dict[str, IntArray]:
    """Nodes on the lines of the lattice; ``middle`` is the layer of the diameter."""
    found = {
        "boundary": j == 0,
        "focus": (j == 0) & (layer == 0),
        "bottom": (i == 0) & (j == 0) & (layer == 0),
        "centre": (i == 0) & (layer == middle),
    }
    if part in ("lower", "quarter"):
        found["diameter"] = layer == middle
    if part in ("right", "quarter"):
        found["axis"] = i == 0
    return {name: np.flatnonzero(where) for name, where in found.items()}


def _plane(where: str, point: Sequence[float]) -> Array:
    """A point of the plane (2,)."""
    found = np.asarray(point, dtype=float)
    if found.shape != (2,) or not np.isfinite(found).all():
        raise InputError(where, f"{found.tolist()}", "two finite coordinates")
    return found
