"""Offsets of a curved surface from the simplices that replace it.

Linear facets are chords of the body that was meshed: its surface bulges between the nodes as the nodes around tell
(:mod:`~softway.contact.mortar.bulges`), and follows their motion. Quadratic facets are curved themselves, and stand off
the simplices over their control points by heights of the reference (docs/theory/contact/mortar.md).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.mortar.bulges import bulges
from softway.contact.mortar.linear_surface import LINEAR, LinearSurface, control
from softway.contact.surfaces.facet_geometry import kind_of
from softway.kernels.mortar.simplices import vector_areas
from softway.meshes.cells import CELLS
from softway.meshes.element import completion

SLIGHT = 1e-4
"""Angle between the ends of a simplex, below which its offsets fade: flat surfaces stay flat when they bend."""
FLAT = 1e-9
"""Share of the heights of a simplex below which it is flat."""
_BETWEEN = {2: ((0, 1),), 3: ((0, 1), (0, 2), (1, 2))}
"""Pairs of corners of a simplex, by the number of its corners."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CurvedSurface:
    """Heights of a surface above p simplices.

    Parameters
    ----------
    offsets
        (p v, n) offsets at the corners of the simplices, and between pairs of corners, as sums of nodal positions that
        follow the motion: v = 3 of a segment, 6 of a triangle. The factors of a row add up to zero.
    fixed
        (p, k, k) heights of the reference that a simplex carries with it, as quadratic forms of coordinates [m].
    """

    offsets: sp.csr_array
    fixed: Array

    @property
    def flat(self) -> bool:
        """True if there are no heights."""
        return not self.offsets.nnz and not self.fixed.any()


def curved_surface(surface: LinearSurface, facets: Mapping[str, IntArray], points: Array) -> CurvedSurface:
    """Heights of the curved surface above its simplices.

    Parameters
    ----------
    surface
        The linear surface in place of the facets.
    facets
        Cell name -> (f, b) nodes, turned outward.
    points
        (n, d) reference positions of the model [m].

    Examples
    --------
    Facets of a circle of radius two: the middle of a chord is 2 (1 - cos(pi / 60)) = 0.00274 below it.

    >>> from softway.contact.mortar.linear_surface import linear_surface
    >>> turn = np.arange(60) * np.pi / 30
    >>> circle = 2.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    >>> facets = {"bar2": np.stack([np.arange(60), np.roll(np.arange(60), -1)], axis=1)}
    >>> made = curved_surface(linear_surface(facets), facets, circle)
    >>> float(np.linalg.norm((made.offsets @ circle)[2]).round(5))
    0.00274
    """
    facets = {cell: cells for cell, cells in facets.items() if len(cells)}
    edges = bulges({c: n for c, n in facets.items() if CELLS[c].order == 1}, points)
    offsets: dict[str, list[sp.csr_array]] = {}
    moving: dict[str, list[BoolArray]] = {}
    for cell, cells in facets.items():
        given = edges[cell] if cell in edges else _nodes(cells, len(points))
        matrix = offset_matrix(cell)
        wide = sp.kron(sp.eye_array(len(cells)), matrix.reshape(-1, matrix.shape[2]), format="csr")
        offsets.setdefault(LINEAR[cell][0], []).append(sp.csr_array(wide @ given))
        moving.setdefault(LINEAR[cell][0], []).append(np.full(len(cells) * len(matrix), cell in edges))
    made = sp.csr_array(sp.vstack([o for parts in offsets.values() for o in parts]))
    follows = np.concatenate([m for parts in moving.values() for m in parts])
    vertices = surface.spread @ (surface.control @ points[surface.node])
    form = forms(made @ points, vertices, surface.corner)
    share = _share(form, vertices[surface.corner])
    share[share <= FLAT] = 0.0
    made = sp.csr_array(sp.diags_array(np.repeat(share * follows, made.shape[0] // len(share))) @ made)
    made.eliminate_zeros()
    made.sort_indices()
    return CurvedSurface(offsets=made, fixed=np.where(follows, 0.0, share)[:, None, None] * form)


def _share(form: Array, corners: Array) -> Array:
    """Share (p,) of the offsets of simplices with the heights ``form`` (p, k, k) and corners (p, k, d) that counts."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    angle = 4.0 * np.abs(form).max(axis=(1, 2)) / longest
    return np.asarray(angle**2 / (angle**2 + SLIGHT**2))


def forms(offsets: Array, vertices: Array, corner: IntArray) -> Array:
    """Heights above simplices as quadratic forms of barycentric coordinates, ``height = l.T @ made[p] @ l`` [m].

    Parameters
    ----------
    offsets
        (p v, d) at the corners of the simplices, and between pairs of them [m]; none of flat surfaces.
    vertices, corner
        (w, d) and (p, k) of the simplices, turned outward [m].

    Returns
    -------
    (p, k, k) symmetric, positive where the surface lies outside; (0, k, k) of flat surfaces.

    Examples
    --------
    >>> x, bulge = np.array([[0.0, 0.0], [-1.0, 0.0]]), np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 0.1]])
    >>> middle = np.array([0.5, 0.5])
    >>> round(float(middle @ forms(bulge, x, np.array([[0, 1]]))[0] @ middle), 12)
    0.1
    """
    (k, d), pairs = (corner.shape[1], vertices.shape[1]), _BETWEEN[corner.shape[1]]
    offsets = offsets.reshape(-1, k + len(pairs), d)
    areas = vector_areas(vertices, corner[: len(offsets)])
    size = np.sqrt(np.sum(areas**2, axis=1))
    normal = areas / np.where(size > 0.0, size, 1.0)[:, None]
    height = np.einsum("pvd,pd->pv", offsets, normal)
    out = np.empty((len(height), k, k))
    for c in range(k):
        out[:, c, c] = height[:, c]
    for place, (a, b) in enumerate(pairs, start=k):
        out[:, a, b] = out[:, b, a] = 2.0 * height[:, place] - 0.5 * (height[:, a] + height[:, b])
    return out


def offset_matrix(cell: str) -> Array:
    """Offset of the surface from the simplices of a facet: at the corners of each, then between pairs of them.

    Returns
    -------
    (q, v, b) from the bulges of the edges of a linear facet, or from the nodes of a quadratic one.

    Examples
    --------
    A linear segment bulges in its middle. A quadratic one with the sagitta one stands at two thirds of the height of
    its control polygon, whose vertex is a third outside:

    >>> offset_matrix("bar2").tolist()
    [[[0.0], [0.0], [1.0]]]
    >>> (offset_matrix("bar3")[0] @ [0.0, 0.0, 1.0]).round(12).tolist()
    [0.0, -0.333333333333, 0.083333333333]
    """
    if CELLS[cell].order == 2:
        return _off_control_points(cell)
    if cell == "bar2":
        return np.array([[[0.0], [0.0], [1.0]]])
    if cell == "tri3":
        edge = np.eye(3)
        return np.stack([*np.zeros((3, 3)), edge[0], edge[2], edge[1]])[None]
    corners = np.array([[0.0] * 4, [0.0] * 4, [0.5] * 4])
    halfway = 0.1875 + 0.375 * np.array([[1.0, 0.0, 0.0, 1.0], [1.0, 1.0, 0.0, 0.0]])
    first = np.vstack([corners, [1.0, 0.0, 0.0, 0.0], halfway])
    return np.stack([np.roll(first, k, axis=1) for k in range(4)])


def _off_control_points(cell: str) -> Array:
    """Offsets (q, v, b) of a quadratic facet from the simplices over its control points."""
    table = np.array(LINEAR[cell][1])
    whole = "quad9" if cell == "quad8" else cell
    nodes, kind = CELLS[whole].nodes, kind_of(whole)
    full = completion(cell) if cell == "quad8" else np.eye(len(nodes))
    k = table.shape[1]
    weights = np.vstack([np.eye(k), *(0.5 * (np.eye(k)[a] + np.eye(k)[b]) for a, b in _BETWEEN[k])])
    local = np.einsum("vk,qkr->qvr", weights, nodes[table])
    shapes = np.stack([kind.shapes(part, (0,) * nodes.shape[1]) for part in local])
    flat = np.einsum("vk,qkb->qvb", weights, control(whole)[table])
    offsets = (shapes - flat) @ full
    return np.where(np.abs(offsets) < 1e-13, 0.0, offsets)


def _nodes(cells: IntArray, n: int) -> sp.csr_array:
    """Nodes of facets (f, b) among n, facet after facet (f b, n)."""
    return sp.csr_array((np.ones(cells.size), cells.ravel(), np.arange(cells.size + 1)), (cells.size, n))
