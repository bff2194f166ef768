"""Topology of a mesh: cells that occur twice or lie in the same place, and facets of more than two cells."""

from collections.abc import Mapping

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS

ONCE = "a mesh that lists every cell once"
SAME_PLACE = 1e-9
"""Distance of the centres of two cells, relative to the shortest edge, below which they are in the same place."""


def check_topology(points: Array, blocks: Mapping[str, IntArray], edge: float) -> None:
    """Refuse cells that occur twice, cells in the place of another, and facets of more than two cells.

    Their mass and stiffness would count twice, and facets that occur twice are no boundary: contact would not see them.

    Parameters
    ----------
    points
        (n, d) coordinates of the nodes [m].
    blocks
        Cell name -> (e, a) node numbers.
    edge
        Length of the shortest edge [m].

    Raises
    ------
    InputError
        With the number of the cell, its centre and the number of such cells.

    Examples
    --------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> check_topology(square, {"quad4": np.array([[0, 1, 2, 3]])}, 1.0)
    >>> check_topology(square, {"quad4": np.array([[0, 1, 2, 3], [1, 2, 3, 0]])}, 1.0)
    Traceback (most recent call last):
    softway.errors.InputError: blocks.quad4[1]: cell number 1 has the corners of cell number 0, with the centre \
(0.5, 0.5) m; 1 cell occurs twice
      try: a mesh that lists every cell once
    """
    for name, cells in blocks.items():
        _check_copies(points, name, cells)
    if CELLS[next(iter(blocks))].dim == points.shape[1]:
        _check_places(points, blocks, edge)
        _check_facets(points, blocks)


def repeated(keys: IntArray, least: int = 2) -> tuple[IntArray, ...]:
    """Numbers of equal rows of ``keys`` (n, k), one array for each row that occurs ``least`` times or more.

    Examples
    --------
    >>> [rows.tolist() for rows in repeated(np.array([[3, 1], [0, 2], [3, 1]]))]
    [[0, 2]]
    """
    order = np.lexsort(keys.T)
    ordered = keys[order]
    first = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)]).nonzero()[0]
    count = np.diff(np.append(first, len(keys)))
    many = count >= least
    return tuple(np.sort(order[a : a + n]) for a, n in zip(first[many], count[many], strict=True))


def described(point: Array) -> str:
    """Coordinates of a point (d,) in text, such as ``(0.5, 0.25) m``."""
    return f"({', '.join(f'{value:.6g}' for value in point)}) m"


def _check_copies(points: Array, name: str, cells: IntArray) -> None:
    """Refuse cells of a block that have the same corners."""
    corners = cells[:, : CELLS[name].corners]
    found = repeated(np.sort(corners, axis=1))
    if not found:
        return
    first, second = min(((int(rows[0]), int(rows[1])) for rows in found), key=lambda pair: pair[1])
    copies = sum(len(rows) - 1 for rows in found)
    centre = described(points[corners[second]].mean(axis=0))
    raise InputError(
        f"blocks.{name}[{second}]",
        f"cell number {second} has the corners of cell number {first}, with the centre {centre}; "
        f"{copies} {'cell occurs' if copies == 1 else 'cells occur'} twice",
        ONCE,
    )


def _check_places(points: Array, blocks: Mapping[str, IntArray], edge: float) -> None:
    """Refuse cells with other nodes that have the same centre."""
    centres = np.concatenate([points[cells[:, : CELLS[name].corners]].mean(axis=1) for name, cells in blocks.items()])
    pairs = cKDTree(centres).query_pairs(SAME_PLACE * edge, output_type="ndarray")
    if not len(pairs):
        return
    names = [(name, k) for name, cells in blocks.items() for k in range(len(cells))]
    first, second = (int(k) for k in min(pairs.tolist(), key=lambda pair: (pair[1], pair[0])))
    (name, k), (other, j) = names[second], names[first]
    copies = len(np.unique(pairs[:, 1]))
    raise InputError(
        f"blocks.{name}[{k}]",
        f"cell number {k} is in the place of cell number {j}{'' if name == other else f' of {other}'}, with the centre "
        f"{described(centres[second])}; {copies} {'cell lies' if copies == 1 else 'cells lie'} in the place of another",
        ONCE,
    )


def _check_facets(points: Array, blocks: Mapping[str, IntArray]) -> None:
    """Refuse facets that belong to more than two cells; facets that have collapsed to an edge or a point may."""
    rows: dict[int, list[IntArray]] = {}
    for name, cells in blocks.items():
        for facet, local in FACETS[name]:
            n = CELLS[facet].corners
            rows.setdefault(n, []).append(np.sort(cells[:, local[:n]], axis=1))
    for parts in rows.values():
        keys = np.concatenate(parts)
        distinct = 1 + (np.diff(keys, axis=1) > 0).sum(axis=1)
        found = repeated(keys[distinct >= points.shape[1]], least=3)
        if found:
            nodes = keys[distinct >= points.shape[1]][found[0][0]]
            raise InputError(
                "blocks",
                f"{len(found[0])} cells share the facet of the nodes {nodes.tolist()}, with the centre "
                f"{described(points[nodes].mean(axis=0))}; "
                f"{len(found)} {'facet has' if len(found) == 1 else 'facets have'} more than two cells",
                "cells that do not overlap, at most two at a facet",
            )
