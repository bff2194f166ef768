"""Structured meshes with graded cells: discs refined towards one point, rings, grids at given coordinates.

The graded disc is a polar mesh of a half-plane with rings in geometric progression, mapped to the disc by a conformal
map. The map preserves angles, and the size of a cell is proportional to its distance from the point.
"""

from collections.abc import Sequence
from math import ceil, log, pi, tan
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.meshes.generators.lattice import merged, require_few, tensor_cells
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

Complex = NDArray[np.complex128]

Part = Literal["whole", "lower", "right", "quarter"]
"""Meshed part of a disc: all of it, y <= 0, x >= 0, or both."""

# Relative bulge of the sides of the core blocks, and half the width of the coarse core relative to the radius.
_BULGE, _COARSE = 0.2, 0.6


def grid(*coordinates: Sequence[float], cell: str | None = None) -> Mesh:
    """Rectangle or box along the axes with cells between given coordinates; each side has a tag.

    Parameters
    ----------
    coordinates
        Increasing coordinates along x and y, or along x, y and z [m].
    cell
        Type of cell: ``tri3 tri6 quad4 quad8 quad9``, or ``tet4 tet10 hex8 hex20 hex27``; by default ``quad4`` or
        ``hex8``.

    Examples
    --------
    >>> mesh = grid((0.0, 0.1, 1.0), (0.0, 0.5))
    >>> mesh.points[mesh.nodes("top")].round(12).tolist()
    [[0.0, 0.5], [0.1, 0.5], [1.0, 0.5]]
    """
    dim = len(coordinates)
    if dim not in (2, 3):
        raise InputError("x", f"coordinates along {dim} axes", "coordinates along x and y, or x, y and z")
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
    """Coordinates from ``start`` to ``end`` [m] of cells that grow by a constant factor.

    The last cell is ``ratio`` times as long as the first.

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
    """Ring or sector of a ring; tags ``inner``, ``outer``, and the straight sides ``start`` and ``end`` of a sector.

    Parameters
    ----------
    inner
        Inner radius [m].
    outer
        Outer radius [m].
    cells
        Numbers of cells across the ring and around it.
    angle
        Angle of the sector [rad]; a full ring by default.
    start
        Angle at which the sector starts, anticlockwise from the x axis [rad].
    centre
        Centre of the ring [m].
    cell
        Type of cell: ``tri3 tri6 quad4 quad8 quad9``; nodes of quadratic cells lie on the circles.

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
        raise InputError("cells", f"{list(cells)} cells of a full ring", "three or more around it")
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
    """Disc or part of a disc, with small cells at its lowest point that grow with the distance from it.

    Tags: ``boundary`` (the arc), ``focus`` (its fine part), ``bottom`` (the lowest point), ``centre``; for parts of a
    disc also ``diameter`` (at the height of the centre) and ``axis`` (above the lowest point).

    Parameters
    ----------
    radius
        Radius [m].
    focus
        Length of the arc on each side of the lowest point with cells of equal size [m], at most the radius.
    cells
        Number of cells along this length, two or more.
    part
        ``whole``, ``lower`` (half), ``right`` (half, the section of a ball) or ``quarter``.
    centre
        Centre of the disc [m].
    cell
        Type of cell: ``quad4``, ``quad8`` or ``quad9``.

    Examples
    --------
    >>> mesh = graded_disc(1.0, 0.01, 4, part="quarter")
    >>> mesh.n_cells, round(mesh.edge(), 6), mesh.points[mesh.nodes("bottom")].tolist()
    (232, 0.002065, [[0.0, -1.0]])
    """
    if not 0.0 < radius < np.inf:
        raise InputError("radius", f"{radius:g} m is not a length", "a positive number")
    if part not in get_args(Part):
        raise InputError("part", f"{part!r} is not a part of a disc", f"one of: {', '.join(get_args(Part))}")
    if not 0.0 < focus <= radius:
        raise InputError("focus", f"{focus:g} m on a disc of radius {radius:g} m", "a positive length up to the radius")
    if not isinstance(cells, int | np.integer) or cells < 2:
        raise InputError("cells", f"{cells} is not a number of cells", "a whole number, 2 or more")
    if cell not in ("quad4", "quad8", "quad9"):
        raise InputError("cell", f"{cell!r} is not available here", "quad4, quad8 or quad9")
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
    """Lattice points (e, a, 3): position in the core or on its rim, and layer of the ring, counted from the bottom."""
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
    """Points (n,) of the right half of the unit disc; the upper half is a mirrored lower half with another core."""
    low = _carried(shape, np.minimum(layer / lower, 1.0), edge)
    if not upper:
        return low
    high = _carried(shape, np.minimum((lower + upper - layer) / upper, 1.0), _COARSE)
    return np.where(layer <= lower, low, high.conj())


def _carried(shape: tuple[Array, Array], share: Array, edge: float) -> Complex:
    """Points (n,) of the lower half of the unit disc: |w| = 1 is mapped to its diameter, w = 0 to its lowest point.

    The core is a square with bulged sides; log w is linear between its rim (``share`` 0) and the circle (``share`` 1).
    """
    x, y = shape
    core = edge / (1.0 + _BULGE) * (x * (1.0 + _BULGE * (1.0 - y**2)) + 1j * y * (1.0 + _BULGE * (1.0 - x**2)))
    w = core ** (1.0 - share) * np.exp(0.25j * pi * (1.0 + y - x) * share)
    z = -1j * (1.0 + 1j * w) / (1.0 - 1j * w)
    return np.where(y == 0.0, z / np.abs(z), z)


def _tags(i: IntArray, j: IntArray, layer: IntArray, middle: int, part: Part) -> dict[str, IntArray]:
    """Tags of the nodes on lines of the lattice; ``middle`` is the layer of the diameter."""
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
    """Point (2,) of the plane."""
    found = np.asarray(point, dtype=float)
    if found.shape != (2,) or not np.isfinite(found).all():
        raise InputError(where, f"{found.tolist()}", "two finite coordinates")
    return found
