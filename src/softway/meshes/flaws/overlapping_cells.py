"""Cells of a mesh that overlap, found at points a quarter of a cell below the boundary.

Where cells overlap, points lie in two cells or more. The boundary of such a region consists of boundary facets of the
mesh: a point below one of them lies in the cell of the facet, and in another cell only where cells overlap. The cells
are taken as straight between their corners.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.meshes.cells import CELLS, FACETS, linear
from softway.meshes.mesh import Mesh
from softway.meshes.topology import described

SIMPLICES = {
    "bar2": ((0, 1),),
    "tri3": ((0, 1, 2),),
    "quad4": ((0, 1, 2), (0, 2, 3)),
    "tet4": ((0, 1, 2, 3),),
    "hex8": ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)),
}
"""Division of the linear cells into simplices."""


def check_overlap(mesh: Mesh) -> None:
    """Refuse cells that overlap by more than a quarter of a cell; ``mesh`` has cells of the dimension of space.

    Raises
    ------
    InputError
        With the numbers of two cells that overlap and their place.

    Examples
    --------
    >>> points = np.array([[0.0], [1.0], [0.5], [1.5]])
    >>> check_overlap(Mesh(points=points, blocks={"bar2": np.array([[0, 1], [2, 3]])}))
    Traceback (most recent call last):
    softway.errors.InputError: blocks.bar2[0]: cell number 0 overlaps cell number 1 at (0.75) m; 2 cells overlap others
      try: cells that do not overlap; parts that lie in each other are bodies of their own
    """
    below = _below_facets(mesh)
    where, cell = _containing(mesh, below.points)
    wrong = cell != below.cell[where]
    if not wrong.any():
        return
    names = [(name, k) for name, cells in mesh.blocks.items() for k in range(len(cells))]
    first = int(np.flatnonzero(wrong)[np.argmin(below.cell[where[wrong]])])
    own, other = int(below.cell[where[first]]), int(cell[first])
    (name, k), (of, j) = names[own], names[other]
    count = len(np.unique(np.concatenate([below.cell[where[wrong]], cell[wrong]])))
    raise InputError(
        f"blocks.{name}[{k}]",
        f"cell number {k} overlaps cell number {j}{'' if of == name else f' of {of}'} at "
        f"{described(below.points[where[first]])}; {count} cells overlap others",
        "cells that do not overlap; parts that lie in each other are bodies of their own",
    )


def near_pairs(points: Array, centres: Array, radii: Array) -> tuple[IntArray, IntArray]:
    """Numbers (p,) of points (n, d) and (p,) of the balls with ``centres`` (m, d) and ``radii`` (m,) that hold them.

    Examples
    --------
    >>> [k.tolist() for k in near_pairs(np.array([[0.0], [1.0]]), np.array([[0.9], [5.0]]), np.array([0.5, 1.0]))]
    [[1], [0]]
    """
    found = cKDTree(points).query_ball_point(centres, radii)
    count = np.array([len(near) for near in found], dtype=np.int64)
    return np.array([k for near in found for k in near], dtype=np.int64), np.repeat(np.arange(len(centres)), count)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Below:
    """Points (p, d) below boundary facets, and the number (p,) of the cell of each."""

    points: Array
    cell: IntArray


def _below_facets(mesh: Mesh) -> _Below:
    """Points halfway from the boundary facets, their centres and corners, to the centres of the cells."""
    points, owner, first = [], [], 0
    single = {name: {tuple(sorted(row)) for row in facets.tolist()} for name, facets in mesh.boundary().items()}
    for name, cells in mesh.blocks.items():
        centre = mesh.points[cells[:, : CELLS[name].corners]].mean(axis=1)
        for facet, local in FACETS[name]:
            rows = cells[:, local]
            known = single.get(facet, set())
            on = np.array([tuple(row) in known for row in np.sort(rows, axis=1).tolist()], dtype=bool)
            corners = mesh.points[rows[on][:, : CELLS[facet].corners]]
            middle = corners.mean(axis=1, keepdims=True)
            places = np.concatenate([middle, corners], axis=1)
            points.append(0.5 * (places + centre[on][:, None]).reshape(-1, mesh.dim))
            owner.append(np.repeat(first + np.flatnonzero(on), places.shape[1]))
        first += len(cells)
    return _Below(points=np.concatenate(points), cell=np.concatenate(owner))


def _containing(mesh: Mesh, points: Array) -> tuple[IntArray, IntArray]:
    """Numbers (p,) of points (n, d), and the number (p,) of a cell that contains each; several cells may."""
    where, cell, first = [], [], 0
    for name, cells in mesh.blocks.items():
        corners = mesh.points[cells[:, : CELLS[name].corners]]
        centre = corners.mean(axis=1)
        radii = np.linalg.norm(corners - centre[:, None], axis=-1).max(axis=1)
        point, of = near_pairs(points, centre, radii)
        low, high = corners.min(axis=1), corners.max(axis=1)
        boxed = ((points[point] >= low[of]) & (points[point] <= high[of])).all(axis=1)
        point, of = point[boxed], of[boxed]
        inside = np.zeros(len(point), dtype=bool)
        for simplex in SIMPLICES[linear(name)]:
            inside |= _in_simplices(corners[of][:, list(simplex)], points[point])
        where.append(point[inside])
        cell.append(first + of[inside])
        first += len(cells)
    return np.concatenate(where), np.concatenate(cell)


def _in_simplices(corners: Array, points: Array) -> BoolArray:
    """True (p,) for points (p, d) in the simplices with ``corners`` (p, d + 1, d)."""
    legs = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    flat = np.abs(np.linalg.det(legs)) <= 0.0
    legs[flat] = np.eye(points.shape[1])
    local = np.linalg.solve(legs, (points - corners[:, 0])[..., None])[..., 0]
    return np.asarray(~flat & (local.min(axis=1) >= 0.0) & (local.sum(axis=1) <= 1.0))
