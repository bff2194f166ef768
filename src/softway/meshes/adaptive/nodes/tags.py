"""Tags of an adapted mesh from those of its base mesh."""

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh


def refined_tags(base: Mesh, carriers: IntArray) -> Mapping[str, IntArray]:
    """Tags of a refined mesh: a new node is in those of the part of the base mesh in which it lies.

    A new node lies inside an edge, a facet or a cell of the base mesh, its carrier.  It is in a tag if its carrier

    - belongs to a boundary facet, or to a cell, all of whose nodes are in the tag,
    - or has all its nodes in the tag, none of which belongs to such a facet or cell: tags of lines of nodes.

    Tags of boundary nodes alone are sides: only carriers on the boundary are looked at, and cells do not count.

    Parameters
    ----------
    base
        Base mesh.
    carriers
        (k, c) corners of the carrier of each new node, in falling order and filled with -1.
    """
    kinds, number = np.unique(carriers, axis=0, return_inverse=True)
    number = number.ravel()
    boundary = base.boundary()
    name, cells = next(iter(base.blocks.items()))
    surface = np.zeros(base.n_nodes, dtype=bool)
    for facets in boundary.values():
        surface[facets] = True
    on_surface = _within(kinds, _corners(boundary))
    between = _edge_middles(base, kinds)
    out = {}
    for tag, nodes in base.tags.items():
        inside = np.zeros(base.n_nodes, dtype=bool)
        inside[nodes] = True
        whole = {f: rows[inside[rows].all(axis=1)] for f, rows in boundary.items()}
        side = bool(surface[nodes].all())
        if not side:
            whole[name] = cells[inside[cells].all(axis=1)]
        filled = np.zeros(base.n_nodes + 1, dtype=bool)
        for rows in whole.values():
            filled[rows.ravel()] = True
        loose = (np.append(inside, True)[kinds] & ~filled[kinds]).all(axis=1) & np.append(inside, True)[between]
        if side:
            loose &= on_surface
        new = (_within(kinds, _corners(whole)) | loose)[number]
        out[tag] = np.concatenate([nodes, base.n_nodes + np.flatnonzero(new)])
    return out


def _corners(rows: Mapping[str, IntArray]) -> list[IntArray]:
    """Corners (f, b) of facets and cells."""
    return [nodes[:, : CELLS[name].corners] for name, nodes in rows.items()]


def _within(kinds: IntArray, rows: list[IntArray]) -> BoolArray:
    """True (k,) for the carriers (k, c) whose corners all belong to one of the facets or cells ``rows`` (f, b)."""
    width = kinds.shape[1]
    parts = [np.zeros((0, width), dtype=np.int64)]
    for corners in rows:
        for size in range(2, corners.shape[1] + 1):
            for chosen in combinations(range(corners.shape[1]), size):
                part = np.full((len(corners), width), -1)
                part[:, :size] = np.sort(corners[:, chosen], axis=1)[:, ::-1]
                parts.append(part)
    table = np.unique(np.concatenate(parts), axis=0)
    number = np.unique(np.concatenate([table, kinds]), axis=0, return_inverse=True)[1].ravel()
    return np.isin(number[len(table) :], number[: len(table)])


def _edge_middles(base: Mesh, kinds: IntArray) -> IntArray:
    """Node (k,) of the base mesh in the middle of each carrier that is an edge of second order; -1 for others."""
    out = np.full(len(kinds), -1)
    name, cells = next(iter(base.blocks.items()))
    if CELLS[name].order == 1 or not len(kinds):
        return out
    edges, corners = np.array(CELLS[name].edges), CELLS[name].corners
    ends = np.sort(cells[:, edges].reshape(-1, 2), axis=1)[:, ::-1]
    pairs, first = np.unique(ends, axis=0, return_index=True)
    middle = cells[:, corners : corners + len(edges)].ravel()[first]
    edge = (kinds[:, 2:] < 0).all(axis=1) & (kinds[:, 1] >= 0)
    both = np.unique(np.concatenate([pairs, kinds[edge, :2]]), axis=0, return_inverse=True)[1].ravel()
    place = np.empty(both.max() + 1, dtype=np.int64)
    place[both[: len(pairs)]] = middle
    out[edge] = place[both[len(pairs) :]]
    return out
