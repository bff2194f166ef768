"""Tables of shape functions and quadrature; the only module that uses basix.

The shape functions are Lagrange polynomials on equispaced nodes in VTK order, see :mod:`softway.meshes.cells`. Those of
a serendipity cell are combinations of the functions of the cell with all nodes (docs/theory/bodies/mass.md). The
quadrature is the default of basix: Gauss-Jacobi on bars, squares and cubes, Xiao-Gimbutas on triangles and tetrahedra.
"""

from dataclasses import dataclass
from functools import cache

import basix
import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS, SERENDIPITY

__all__ = ["CELLS", "FACETS", "Element", "element", "exact_degree", "permutation", "stiffness_degree", "tabulate"]

_BASIX = {
    "bar": basix.CellType.interval,
    "tri": basix.CellType.triangle,
    "quad": basix.CellType.quadrilateral,
    "tet": basix.CellType.tetrahedron,
    "hex": basix.CellType.hexahedron,
}


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Element:
    """Shape functions at the quadrature points of a reference cell.

    Parameters
    ----------
    cell
        Name of the cell, such as ``"tri3"``.
    points
        (q, r) quadrature points.
    weights
        (q,) quadrature weights; their sum is the volume of the reference cell.
    N
        (q, a) shape functions.
    dN
        (q, a, r) their derivatives along the reference coordinates.
    """

    cell: str
    points: Array
    weights: Array
    N: Array
    dN: Array


def _family(cell: str) -> basix.CellType:
    name = cell.rstrip("0123456789")
    if cell not in FACETS:
        raise InputError("cell", f"unknown cell {cell!r}", f"one of: {', '.join(FACETS)}")
    return _BASIX[name]


def completion(cell: str) -> Array:
    """Shape functions (b, a) of a serendipity cell at the b nodes of the cell with all nodes.

    Examples
    --------
    >>> completion("quad8")[8].tolist()
    [-0.25, -0.25, -0.25, -0.25, 0.5, 0.5, 0.5, 0.5]
    """
    it, full = CELLS[cell], CELLS[SERENDIPITY[cell]]
    own, there = (np.prod(nodes[:, None] ** it.powers, axis=2) for nodes in (it.nodes, full.nodes))
    return np.rint(4.0 * there @ np.linalg.inv(own)) / 4.0  # multiples of a quarter


@cache
def _lagrange(cell: str) -> tuple[basix.finite_element.FiniteElement, tuple[int, ...]]:
    """Element of basix, and the number in basix of each node in VTK order."""
    kind, variant = basix.ElementFamily.P, basix.LagrangeVariant.equispaced
    made = basix.create_element(kind, _family(cell), CELLS[cell].order, variant)
    places = np.asarray(made.points, dtype=float)
    distance = np.abs(CELLS[cell].nodes[:, None, :] - places[None, :, :]).sum(axis=2)
    return made, tuple(int(k) for k in distance.argmin(axis=1))


def permutation(cell: str) -> IntArray:
    """Numbers (a,) in basix of the nodes of a cell in VTK order.

    Examples
    --------
    >>> permutation("quad4").tolist()
    [0, 1, 3, 2]
    """
    return np.array(_lagrange(cell)[1], dtype=np.int64)


def exact_degree(cell: str, *, curved: bool = False) -> int:
    """Degree of quadrature that integrates the mass matrix exactly.

    By default the degree is for the undistorted cell: N_a N_b has degree 2 p (in each direction on bars, squares and
    cubes). With ``curved`` it is for any positions of the nodes: the Jacobian determinant adds r (p - 1) on simplices
    and r p - 1 in each direction otherwise.

    Examples
    --------
    >>> exact_degree("tet10"), exact_degree("hex8", curved=True)
    (4, 4)
    """
    it = CELLS[cell]
    extra = it.dim * (it.order - 1) if it.simplex else it.dim * it.order - 1
    return 2 * it.order + (extra if curved else 0)


def stiffness_degree(cell: str) -> int:
    """Least degree of quadrature that integrates the stiffness of the undistorted cell exactly.

    The degree is 2 (p - 1) on simplices and bars, and 2 p on other cells.

    Examples
    --------
    >>> stiffness_degree("tet10"), stiffness_degree("hex8")
    (2, 2)
    """
    it = CELLS[cell]
    return 2 * (it.order - 1) if it.simplex or it.dim == 1 else 2 * it.order


def tabulate(cell: str, points: Array) -> tuple[Array, Array]:
    """Shape functions (q, a) and derivatives (q, a, r) at given reference points (q, r).

    Examples
    --------
    >>> N, dN = tabulate("bar2", np.array([[0.25]]))
    >>> N.round(12).tolist(), dN[..., 0].round(12).tolist()
    ([[0.75, 0.25]], [[-1.0, 1.0]])
    """
    made, order = _lagrange(SERENDIPITY.get(cell, cell))
    table = np.asarray(made.tabulate(1, np.ascontiguousarray(points, dtype=float)), dtype=float)[:, :, list(order), 0]
    if cell in SERENDIPITY:
        table = table @ completion(cell)
    table = np.where(np.abs(table) < 1e-14, 0.0, table)
    return np.ascontiguousarray(table[0]), np.ascontiguousarray(np.moveaxis(table[1:], 0, 2))


@cache
def _element(cell: str, degree: int) -> Element:
    points, weights = (np.array(table, dtype=float) for table in basix.make_quadrature(_family(cell), degree))
    N, dN = tabulate(cell, points)
    for table in (points, weights, N, dN):
        table.flags.writeable = False
    return Element(cell=cell, points=points, weights=weights, N=N, dN=dN)


def element(cell: str, degree: int | None = None) -> Element:
    """Shape functions and quadrature of a cell.

    Parameters
    ----------
    cell
        ``bar2 bar3 tri3 tri6 quad4 quad8 quad9 tet4 tet10 hex8 hex20 hex27``.
    degree
        Degree of quadrature; by default enough for exact mass and stiffness of the undistorted cell.

    Examples
    --------
    >>> element("tri3").N.shape, element("tri3").dN.shape, round(float(element("tri3").weights.sum()), 14)
    ((3, 3), (3, 3, 2), 0.5)
    """
    _family(cell)
    return _element(cell, exact_degree(cell) if degree is None else degree)
