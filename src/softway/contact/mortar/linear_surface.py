"""Linear surfaces of segments and triangles in place of facets of every kind, with the same nodal loads.

A uniform pressure on a flat facet has the same nodal forces on the facet and on its linear replacement: a quadratic
facet becomes linear ones over control points ``c = C x``, a four-node facet becomes four triangles about the mean of
its corners. An eight-node facet is a nine-node one whose ninth node follows the others; the ninth test function is
divided among the mid-nodes (docs/theory/contact/mortar.md).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.element import completion

Rows = TypeVar("Rows", sp.csr_array, Array)

_SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))
_EDGES = {"bar3": ((0, 1),), "tri6": ((0, 1), (1, 2), (2, 0)), "quad8": _SIDES, "quad9": _SIDES}
_BARS = ((0, 2), (2, 1))
_TRIANGLES = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))
_ABOUT_CENTRE = ((8, 0, 4), (8, 4, 1), (8, 1, 5), (8, 5, 2), (8, 2, 6), (8, 6, 3), (8, 3, 7), (8, 7, 0))
LINEAR = {
    "bar2": ("bar2", ((0, 1),)),
    "bar3": ("bar2", _BARS),
    "tri3": ("tri3", ((0, 1, 2),)),
    "tri6": ("tri3", _TRIANGLES),
    "quad4": ("quad4", ((0, 1, 2, 3),)),
    "quad8": ("tri3", _ABOUT_CENTRE),
    "quad9": ("tri3", _ABOUT_CENTRE),
}
"""Kind of facet -> kind of the linear facets over its control points, and their local numbers; 8 is the centre."""


def control(cell: str) -> Array:
    """Matrix C (b, b) of the control points of a facet: corners stay, mid-nodes bulge by a third more.

    Examples
    --------
    >>> (6 * control("bar3")).round(12).tolist()
    [[6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [-1.0, -1.0, 8.0]]
    """
    b = int(cell[-1])
    edges = _EDGES.get(cell, ())
    matrix = np.eye(b)
    for middle, ends in enumerate(edges, start=len(edges) if len(edges) > 1 else 2):
        matrix[middle, middle], matrix[middle, list(ends)] = 4.0 / 3.0, -1.0 / 6.0
    if cell == "quad9":
        matrix[8, 8], matrix[8, :4] = 4.0 / 3.0, -1.0 / 12.0
    return matrix


def pieces(linear: str) -> Array:
    """Shape functions (q, k, b) of a linear facet at the corners of the q simplices that it consists of.

    Examples
    --------
    >>> pieces("quad4")[0].tolist()
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.25, 0.25, 0.25, 0.25]]
    """
    if linear != "quad4":
        return np.eye(int(linear[-1]))[None]
    unit = np.eye(4)
    return np.stack([np.stack([unit[i], unit[(i + 1) % 4], np.full(4, 0.25)]) for i in range(4)])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinearSurface:
    """A surface of straight segments (d = 2) or triangles (d = 3).

    Parameters
    ----------
    node
        (m,) model nodes, ascending; each has a control point.
    control
        (c, m) control points from the nodes: those of the nodes, then the centres of eight-node facets.
    sharing
        (m, c) shares of the nodes in the test functions of the control points; None if c = m: the identity.
    facets
        Kind -> (f, b) control points of the linear facets, ``bar2``, ``tri3`` or ``quad4``.
    spread
        (v, c) vertices from the control points: the control points, then the centres of four-node facets.
    corner
        (p, k) vertices of the simplices, facet after facet in the order of ``facets``.
    """

    node: IntArray
    control: sp.csr_array
    sharing: sp.csr_array | None
    facets: Mapping[str, IntArray]
    spread: sp.csr_array
    corner: IntArray

    def onto(self, nodes: int) -> sp.csr_array:
        """Control points (c, n) from all n nodes of a model."""
        pick = sp.csr_array(
            (np.ones(len(self.node)), self.node, np.arange(len(self.node) + 1)), (len(self.node), nodes)
        )
        return sp.csr_array(self.control @ pick)

    def nodal(self, rows: Rows) -> Rows:
        """Rows (m, k) of the nodes from the rows (c, k) of the control points."""
        return rows if self.sharing is None else self.sharing @ rows

    def thickness(self, nodal: Array | None) -> Array:
        """Thickness (p,) behind the simplices, from that of all n nodes of a model; infinite if it is not given."""
        if nodal is None:
            return np.full(len(self.corner), np.inf)
        at_vertices = np.full(self.spread.shape[0], np.inf)
        at_vertices[: len(self.node)] = nodal[self.node]
        return np.asarray(at_vertices[self.corner].min(axis=1))


def linear_surface(facets: Mapping[str, IntArray]) -> LinearSurface:
    """Linear surface in place of facets: cell name -> (f, b) node numbers.

    Examples
    --------
    >>> made = linear_surface({"bar3": np.array([[4, 6, 5]])})
    >>> made.node.tolist(), made.corner.tolist()
    ([4, 5, 6], [[0, 1], [1, 2]])
    """
    facets = {cell: cells for cell, cells in facets.items() if len(cells)}
    if not facets:
        raise InputError("contact", "no facets", "tags that contain whole facets of the boundary")
    for cell in facets:
        if cell not in LINEAR:
            raise InputError(
                "contact", f"facets {cell!r} have no mortar contact", f"facets of the kinds {', '.join(LINEAR)}"
            )
    node = np.unique(np.concatenate([cells.ravel() for cells in facets.values()]))
    local = {cell: np.searchsorted(node, cells) for cell, cells in facets.items()}
    controls, sharing = _controls(local, len(node)), None
    if "quad8" in local:
        local["quad8"], middles, sharing = _with_centres(local["quad8"], len(node))
        controls = sp.csr_array(sp.vstack([controls, middles]))
    linear: dict[str, list[IntArray]] = {}
    for cell, cells in local.items():
        kind, parts = LINEAR[cell]
        linear.setdefault(kind, []).append(cells[:, np.array(parts)].reshape(-1, len(parts[0])))
    joined = {kind: np.concatenate(parts) for kind, parts in linear.items()}
    spread, corner = _simplices(joined, controls.shape[0])
    return LinearSurface(node=node, control=controls, sharing=sharing, facets=joined, spread=spread, corner=corner)


def _with_centres(cells: IntArray, m: int) -> tuple[IntArray, sp.csr_array, sp.csr_array]:
    """Eight-node facets (f, 8) among m nodes with centres: nodes (f, 9), control points (f, m), sharing (m, m + f)."""
    f = len(cells)
    weights = np.tile(control("quad9")[8] @ completion("quad8"), f)
    middles = sp.csr_array((weights, cells.ravel(), 8 * np.arange(f + 1)), (f, m))
    quarters = (np.full(4 * f, 0.25), (cells[:, 4:].ravel(), np.repeat(np.arange(f), 4)))
    sharing = sp.csr_array(sp.hstack([sp.eye_array(m), sp.csr_array(quarters, (m, f))]))
    return np.column_stack([cells, m + np.arange(f)]), middles, sharing


def _controls(local: Mapping[str, IntArray], m: int) -> sp.csr_array:
    """Matrix (m, m) of control points from the nodes; a node of several facets has one control point for all."""
    row, column, value = [], [], []
    open_: BoolArray = np.ones(m, dtype=bool)
    for cell, cells in local.items():
        own, first = np.unique(cells, return_index=True)
        own, first = own[open_[own]], first[open_[own]]
        open_[own] = False
        facet, place = np.divmod(first, cells.shape[1])
        row.append(np.repeat(own, cells.shape[1]))
        column.append(cells[facet].ravel())
        value.append(control(cell)[place].ravel())
    parts = (np.concatenate(value), (np.concatenate(row), np.concatenate(column)))
    made = sp.csr_array(parts, shape=(m, m))
    made.eliminate_zeros()
    return made


def _simplices(facets: Mapping[str, IntArray], m: int) -> tuple[sp.csr_array, IntArray]:
    """Matrix (v, m) of vertices from control points, and the vertices (p, k) of the simplices."""
    spread, corner = [sp.eye_array(m, format="csr")], []
    for kind, cells in facets.items():
        if kind == "quad4":
            f = len(cells)
            centre = m + np.arange(f)
            spread.append(sp.csr_array((np.full(4 * f, 0.25), cells.ravel(), 4 * np.arange(f + 1)), (f, m)))
            sides = [np.stack([cells[:, i], cells[:, (i + 1) % 4], centre], axis=1) for i in range(4)]
            corner.append(np.stack(sides, axis=1).reshape(-1, 3))
        else:
            corner.append(cells)
    return sp.vstack(spread, format="csr"), np.concatenate(corner)
