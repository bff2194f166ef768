"""Mesh generators: intervals, rectangles, boxes, discs, cylinders, balls.

``cell`` selects the shape (simplex, or square and cube) and the order of the cells. Nodes of quadratic cells on a round
boundary lie exactly on it.
"""

from collections.abc import Sequence

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.generators.lattice import (
    SIMPLEX,
    kuhn_cells,
    merged,
    quadratic_simplices,
    require_few,
    tensor_cells,
)
from softway.meshes.generators.round import ball_lattice, extruded, rounded_simplices
from softway.meshes.mesh import Mesh

KINDS = {
    1: ("bar2", "bar3"),
    2: ("tri3", "tri6", "quad4", "quad8", "quad9"),
    3: ("tet4", "tet10", "hex8", "hex20", "hex27"),
}
"""Topological dimension -> available cells."""


def interval(
    length: float,
    cells: int,
    *,
    origin: Sequence[float] | float | None = None,
    cell: str = "bar2",
    direction: Sequence[float] | None = None,
    dim: int | None = None,
) -> Mesh:
    """Straight bar; tags ``left`` (its origin) and ``right``.

    Parameters
    ----------
    length
        Length [m].
    cells
        Number of cells.
    origin
        Left end [m]; zero by default.
    cell
        Type of cell: ``bar2`` or ``bar3``.
    direction
        Vector from left to right, of any length; the x axis by default.
    dim
        Dimension of space; by default the number of components of the direction or the origin, else 1.

    Examples
    --------
    >>> interval(1.0, cells=2).points[:, 0].tolist()
    [0.0, 0.5, 1.0]
    >>> interval(1.0, cells=1, direction=(0, 2)).points.tolist()
    [[0.0, 0.0], [0.0, 1.0]]
    """
    _check(cell, 1, (length,), (cells,))
    dim = dim or (np.size(direction) if direction is not None else np.size(origin) if origin is not None else 1)
    along = _vector("direction", direction if direction is not None else (1.0, 0.0, 0.0)[:dim], dim)
    norm = float(np.linalg.norm(along))
    if norm == 0.0:
        raise InputError("direction", "a direction of length zero", "another vector, such as (1, 0)")
    lattice, nodes = merged(tensor_cells((cells,), cell))
    steps = CELLS[cell].order * cells
    points = _vector("origin", origin, dim) + (length / norm) * (lattice / steps) * along
    return Mesh(points=points, blocks={cell: nodes}, tags={"left": np.array([0]), "right": np.array([steps])})


def rectangle(
    size: tuple[float, float], cells: tuple[int, int], *, origin: Sequence[float] | None = None, cell: str = "quad4"
) -> Mesh:
    """Rectangle along the axes; tags ``left``, ``right`` (x), ``bottom``, ``top`` (y).

    Parameters
    ----------
    size
        Lengths along x and y [m].
    cells
        Numbers of cells along x and y; each is split into two triangles for ``tri3`` and ``tri6``.
    origin
        Corner with the lowest coordinates [m]; zero by default.
    cell
        Type of cell: ``tri3 tri6 quad4 quad8 quad9``.

    Examples
    --------
    >>> mesh = rectangle((2.0, 1.0), (2, 1), cell="tri3")
    >>> mesh.n_nodes, mesh.n_cells, mesh.nodes("top").tolist()
    (6, 4, [3, 4, 5])
    """
    return _block(size, cells, origin, cell, (("left", "right"), ("bottom", "top")))


def box(
    size: tuple[float, float, float],
    cells: tuple[int, int, int],
    *,
    origin: Sequence[float] | None = None,
    cell: str = "hex8",
) -> Mesh:
    """Box along the axes; tags ``left``, ``right`` (x), ``front``, ``back`` (y), ``bottom``, ``top`` (z).

    Parameters
    ----------
    size
        Lengths along x, y and z [m].
    cells
        Numbers of cells along x, y and z; each is split into six tetrahedra for ``tet4`` and ``tet10``.
    origin
        Corner with the lowest coordinates [m]; zero by default.
    cell
        Type of cell: ``tet4 tet10 hex8 hex20 hex27``.

    Examples
    --------
    >>> mesh = box((1.0, 1.0, 2.0), (1, 1, 2))
    >>> mesh.n_nodes, mesh.nodes("bottom").tolist()
    (12, [0, 1, 2, 3])
    """
    return _block(size, cells, origin, cell, (("left", "right"), ("front", "back"), ("bottom", "top")))


def disc(radius: float, cells: int, *, centre: Sequence[float] | None = None, cell: str = "quad4") -> Mesh:
    """Disc; tags ``boundary`` and ``centre``.

    Parameters
    ----------
    radius
        Radius [m].
    cells
        Even number of cells across the diameter: at least 4 for squares, at least 2 for triangles.
    centre
        [m]; zero by default.
    cell
        Type of cell: ``tri3 tri6 quad4 quad8 quad9``.

    Examples
    --------
    >>> mesh = disc(1.0, 4, cell="tri3")
    >>> mesh.n_nodes, len(mesh.nodes("boundary")), mesh.points[mesh.nodes("centre")].tolist()
    (25, 16, [[0.0, 0.0]])
    """
    points, nodes = _ball(2, radius, cells, cell)
    tags = {"boundary": _far(points, radius), "centre": _middle(points, radius)}
    return Mesh(points=points + _vector("centre", centre, 2), blocks={cell: nodes}, tags=tags)


def ball(radius: float, cells: int, *, centre: Sequence[float] | None = None, cell: str = "hex8") -> Mesh:
    """Ball; tags ``surface`` and ``centre``.

    Parameters
    ----------
    radius
        Radius [m].
    cells
        Even number of cells across the diameter: at least 4 for cubes, at least 2 for tetrahedra.
    centre
        Centre of the ball [m]; zero by default.
    cell
        Type of cell: ``tet4 tet10 hex8 hex20 hex27``.

    Examples
    --------
    >>> mesh = ball(0.5, 4)
    >>> mesh.n_cells, len(mesh.nodes("surface"))
    (32, 26)
    """
    points, nodes = _ball(3, radius, cells, cell)
    tags = {"surface": _far(points, radius), "centre": _middle(points, radius)}
    return Mesh(points=points + _vector("centre", centre, 3), blocks={cell: nodes}, tags=tags)


def cylinder(
    radius: float, height: float, cells: tuple[int, int], *, origin: Sequence[float] | None = None, cell: str = "hex8"
) -> Mesh:
    """Cylinder with the axis z; tags ``side``, ``bottom`` and ``top``.

    Parameters
    ----------
    radius
        Radius [m].
    height
        Height [m].
    cells
        Numbers of cells across the diameter (as for :func:`~softway.meshes.generators.shapes.disc`) and along the axis.
    origin
        Centre of the bottom [m]; zero by default.
    cell
        Type of cell: ``tet4 tet10 hex8 hex20 hex27``.

    Examples
    --------
    >>> mesh = cylinder(1.0, 3.0, (4, 2))
    >>> mesh.n_cells, len(mesh.nodes("bottom")), len(mesh.nodes("side"))
    (24, 17, 24)
    """
    _check(cell, 3, (radius, height), cells, ("radius", "height"))
    flat = "tri3" if CELLS[cell].simplex else FACETS[cell][0][0]
    points, nodes = extruded(*_ball(2, radius, cells[0], flat), flat, height, cells[1])
    if cell == "tet10":
        points, nodes = rounded_simplices(points, nodes, _far(points[:, :2], radius), radius, axes=2)
    levels = points[:, 2] / height
    tags = {"side": _far(points[:, :2], radius), "bottom": _where(levels < 1e-9), "top": _where(levels > 1.0 - 1e-9)}
    return Mesh(points=points + _vector("origin", origin, 3), blocks={cell: nodes}, tags=tags)


def _block(
    size: Sequence[float],
    cells: Sequence[int],
    origin: Sequence[float] | None,
    cell: str,
    names: tuple[tuple[str, str], ...],
) -> Mesh:
    """Grid along the axes with one tag for each side."""
    dim = len(names)
    _check(cell, dim, size, cells)
    shape, order = tuple(cells), CELLS[cell].order
    if CELLS[cell].simplex:
        lattice, nodes = merged(kuhn_cells(shape, lambda low: low % 2))
        if order == 2:
            middles, nodes, _ = quadratic_simplices(2.0 * lattice.astype(float), nodes)
            lattice = np.rint(middles).astype(np.int64)
    else:
        lattice, nodes = merged(tensor_cells(shape, cell))
    steps = order * np.array(shape)
    points = _vector("origin", origin, dim) + np.array(size) * (lattice / steps)
    tags = {}
    for axis, (low, high) in enumerate(names):
        tags[low], tags[high] = _where(lattice[:, axis] == 0), _where(lattice[:, axis] == steps[axis])
    return Mesh(points=points, blocks={cell: nodes}, tags=tags)


def _ball(dim: int, radius: float, cells: int, cell: str) -> tuple[Array, IntArray]:
    """Points and cells of a disc or a ball about the origin."""
    _check(cell, dim, (radius,), (cells,), ("radius",))
    least = 2 if CELLS[cell].simplex else 4
    if cells % 2 or cells < least:
        raise InputError("cells", f"{cells} cells across the diameter", f"an even number, {least} or more")
    points, nodes = ball_lattice(dim, cells, cell if not CELLS[cell].simplex else SIMPLEX[dim][0])
    points = radius * points
    if cell == SIMPLEX[dim][1]:
        return rounded_simplices(points, nodes, _far(points, radius), radius, axes=dim)
    return points, nodes


def _check(cell: str, dim: int, size: Sequence[float], cells: Sequence[int], names: tuple[str, ...] = ()) -> None:
    """Check the type of cell, the sizes and the numbers of cells of a shape."""
    if cell not in KINDS[dim]:
        raise InputError(
            "cell", f"{cell!r} does not fit a body of {dim} dimensions", f"one of: {', '.join(KINDS[dim])}"
        )
    names = names or (("length",) if dim == 1 else ("size",) * dim)
    if len(size) != len(names):
        raise InputError(names[0], f"{len(size)} numbers", f"{len(names)} lengths")
    for name, value in zip(names, size, strict=True):
        if not 0.0 < value < np.inf:
            raise InputError(name, f"{value:g} m is not a length", "a positive number")
    wanted = {("radius",): 1, ("radius", "height"): 2}.get(names, dim)
    if len(cells) != wanted:
        raise InputError("cells", f"{len(cells)} numbers", f"{wanted} numbers of cells")
    for count in cells:
        if not isinstance(count, int | np.integer) or count < 1:
            raise InputError("cells", f"{count} is not a number of cells", "a whole number, 1 or more")
    require_few(*cells, *[cells[0]] * (dim - len(cells)))


def _vector(where: str, value: Sequence[float] | float | None, dim: int) -> Array:
    """Vector (d,); zero if ``value`` is None."""
    vector = np.zeros(dim) if value is None else np.atleast_1d(np.asarray(value, dtype=float))
    if vector.shape != (dim,):
        raise InputError(where, f"{vector.size} coordinates", f"{dim} coordinates")
    return vector


def _where(condition: BoolArray) -> IntArray:
    return np.flatnonzero(condition)


def _far(points: Array, radius: float) -> IntArray:
    """Nodes at the distance ``radius`` from the origin."""
    return _where(np.linalg.norm(points, axis=1) > radius * (1.0 - 1e-9))


def _middle(points: Array, radius: float) -> IntArray:
    return _where(np.linalg.norm(points, axis=1) < radius * 1e-9)
