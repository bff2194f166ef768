"""Triangles and tetrahedra by Mmg (Dapogny, Dobrzynski and Frey, J. Comput. Phys. 262, 358 (2014)), within a boundary
that stays; the only place that imports ``mmgpy``.
"""

from types import ModuleType

import numpy as np
from scipy.spatial import cKDTree

from softway.adaptivity.new_cells.filling import Filled
from softway.adaptivity.new_cells.sizes import SizeField
from softway.adaptivity.new_cells.triangulation import triangulated
from softway.arrays import Array, IntArray
from softway.errors import InputError

PASSES = 2
"""Number of times that Mmg is called, each with the lengths at the points of the time before."""
GROWTH = 1.3
"""Greatest ratio of the lengths of two edges that follow each other."""
SAME = 1e-9
"""Distance, relative to the body, within which a point is the one that it was."""


def mmg() -> ModuleType:
    """The library.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        import mmgpy
    except ImportError as error:
        remedy = "pip install 'softway[remesh]', or generator = 'own'"
        raise InputError("generator", "mmgpy, which calls Mmg, is not installed", remedy) from error
    return mmgpy  # type: ignore[no-any-return]


def mmg_triangles(corners: Array, sides: IntArray, field: SizeField) -> Filled | None:
    """Triangles inside closed polygons, as :func:`softway.adaptivity.new_cells.filling.filled`.

    Parameters
    ----------
    corners, sides
        (k, 2) corners [m], and the sides (s, 2) between them, with the body to the left.
    field
        Lengths of the edges inside.

    Raises
    ------
    InputError
        If Mmg is not installed.
    """
    library, triangles = mmg(), triangulated(corners, sides)
    if triangles is None:
        return None
    points = corners
    for _ in range(PASSES):
        made = library.MmgMesh2D(np.array(points), triangles.astype(np.int32))
        made.set_field("metric", field.at(points)[:, None])
        made.remesh(nosurf=1, hgrad=GROWTH, verbose=-1)
        points, triangles = _ordered(made.get_vertices(), made.get_triangles(), corners)
    return Filled(points=points, triangles=triangles)


def mmg_tetrahedra(points: Array, tetrahedra: IntArray, kept: IntArray, sizes: Array) -> tuple[Array, IntArray]:
    """Points (m, 3) and tetrahedra (t, 4) with the same boundary; the points kept are the first ones.

    Parameters
    ----------
    points, tetrahedra
        (n, 3) points [m] and tetrahedra (t, 4).
    kept
        (k,) numbers of the points on the boundary.
    sizes
        (n,) lengths of the edges asked for [m].

    Raises
    ------
    InputError
        If Mmg is not installed.
    """
    made = mmg().MmgMesh3D(np.array(points), tetrahedra.astype(np.int32))
    made.set_field("metric", np.array(sizes)[:, None])
    made.remesh(nosurf=1, hgrad=GROWTH, verbose=-1)
    return _ordered(made.get_vertices(), made.get_tetrahedra(), points[kept])


def _ordered(points: Array, cells: IntArray, first: Array) -> tuple[Array, IntArray]:
    """Points and cells numbered so that the points ``first`` (k, d), exactly as they are, come first."""
    away, number = cKDTree(points).query(first)
    assert away.max() <= SAME * float(np.ptp(first)), "Mmg has moved the boundary"
    rest = np.setdiff1d(np.arange(len(points)), number)
    place = np.empty(len(points), dtype=np.int64)
    place[np.concatenate([number, rest])] = np.arange(len(points))
    return np.concatenate([first, points[rest]]), place[np.asarray(cells, dtype=np.int64)]
