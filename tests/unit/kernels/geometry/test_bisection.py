"""Compiled bisection against passes over arrays."""

import numpy as np
import pytest

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.adaptive.leaves import DEPTH, finest
from softway.meshes.adaptive.nodes.middles import Middles, edge_codes
from softway.meshes.adaptive.tree import halved, tree_of
from softway.meshes.adaptive.tree_cells import TreeCells, base_cells
from softway.meshes.generators.shapes import ball, box, disc, interval, rectangle
from softway.meshes.mesh import Mesh

CHILDREN = {2: ((0, 2), (2, 1)), 3: ((2, 0, 3), (1, 2, 3))}


def child(cells: TreeCells, side: int) -> tuple[IntArray, IntArray, BoolArray]:
    """Order of the corners of the child with corner ``side``, c for the middle, its marks and flags."""
    count, c = cells.corners.shape
    if c < 4:
        return np.tile(CHILDREN[c][side], (count, 1)), np.zeros((count, 2), int), np.zeros(count, bool)
    kept = cells.apex[:, 1 - side]
    planar = (cells.apex[:, 0] == cells.apex[:, 1]) & (cells.apex[:, 0] > 1)
    order = np.column_stack([np.full(count, side), 5 - kept, np.full(count, 4), kept])
    order[kept == side] = (2, 3, 4, side)
    apex = np.full((count, 2), 2)
    apex[planar & cells.flag, 0] = 3
    return order, apex, planar & ~cells.flag


def joined(parts: list[TreeCells]) -> TreeCells:
    """Cells of all parts, in rising order of their keys."""
    every = TreeCells(**{n: np.concatenate([getattr(p, n) for p in parts]) for n in TreeCells.__slots__})
    return every.some(np.argsort(every.start))


def cut(cells: TreeCells, middle: IntArray) -> list[TreeCells]:
    """Both halves of each cell."""
    corners = np.concatenate([cells.corners, middle[:, None]], axis=1)
    place = np.concatenate([cells.place, (cells.place[:, :1] + cells.place[:, 1:2]) / 2.0], axis=1)
    out = []
    for side in (0, 1):
        order, apex, flag = child(cells, side)
        start = cells.start + side * np.left_shift(np.int64(1), DEPTH - cells.level - 1)
        out.append(
            TreeCells(
                corners=np.take_along_axis(corners, order, axis=1),
                place=np.take_along_axis(place, order[:, :, None], axis=1),
                apex=apex, flag=flag, start=start, level=cells.level + 1,
            )
        )  # fmt: skip
    return out


def hanging(cells: TreeCells, middles: Middles) -> BoolArray:
    """Cells that neighbours force to be cut."""
    if cells.corners.shape[1] == 2:
        greatest = np.zeros(cells.corners.max() + 1, dtype=np.int64)
        np.maximum.at(greatest, cells.corners, cells.level[:, None])
        return np.asarray(greatest[cells.corners].max(axis=1) > cells.level + 1)
    pairs = [(i, j) for i in range(cells.corners.shape[1]) for j in range(i)]
    return np.any([np.isin(edge_codes(cells.corners[:, pair]), middles.codes) for pair in pairs], axis=0)


def by_passes(mesh: Mesh, want: IntArray) -> TreeCells:
    """The coarsest conforming refinement."""
    cells, middles = base_cells(mesh), Middles.none(mesh.n_nodes)
    given = cells.leaves
    while (some := (finest(cells.leaves, given, want) > cells.level) | hanging(cells, middles)).any():
        middles, middle = middles.with_middles(cells.some(some).corners[:, :2])
        cells = joined([cells.some(~some), *cut(cells.some(some), middle)])
    return cells


def places(mesh: Mesh, cells: TreeCells) -> Array:
    """Places of the corners of the cells [m]."""
    return tree_of(mesh).corners(cells)


@pytest.mark.parametrize(
    "mesh",
    [
        interval(1.0, cells=7),
        rectangle((1.0, 1.0), (3, 4), cell="tri3"),
        disc(1.0, 4, cell="tri6"),
        box((1.0, 1.0, 1.0), (2, 2, 1), cell="tet4"),
        ball(1.0, 2, cell="tet4"),
    ],
    ids=["bar2", "tri3", "tri6", "tet4", "ball"],
)
def test_the_cells_are_those_of_passes_over_arrays(mesh: Mesh) -> None:
    rng = np.random.default_rng(1)
    for _ in range(3):
        want = np.where(rng.random(mesh.n_cells) < 0.3, rng.integers(0, 8, mesh.n_cells), 0)
        tree, other = tree_of(mesh).grown(tree_of(mesh).leaves, want), by_passes(mesh, want)
        for name in ("place", "apex", "flag", "start", "level"):
            assert np.array_equal(getattr(tree.cells, name), getattr(other, name))
        assert np.array_equal(places(mesh, tree.cells), places(mesh, other))
        again = tree.grown(tree.leaves, tree.leaves.level)
        assert np.array_equal(again.cells.corners, tree.cells.corners)
        for k in range(tree.middles.count - mesh.n_nodes):
            ends = divmod(int(tree.middles.codes[k]), 2**32)
            assert max(ends) < tree.middles.nodes[k] < tree.middles.count


def test_growing_in_two_steps_is_growing_at_once() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3")
    want = np.random.default_rng(2).integers(0, 6, mesh.n_cells)
    tree = tree_of(mesh)
    once = tree.grown(tree.leaves, want)
    half = tree.grown(tree.leaves, want // 2)
    twice = half.grown(tree.leaves, want)
    assert np.array_equal(once.cells.start, twice.cells.start)
    assert np.array_equal(once.cells.place, twice.cells.place)


def test_halves() -> None:
    cells = base_cells(box((1.0, 1.0, 1.0), (1, 1, 1), cell="tet4"))
    both = halved(cells)
    assert both.level.tolist() == [1] * 2 * len(cells.level)
    assert abs(np.linalg.det(both.place)) == pytest.approx(np.full(len(both.level), 0.5))
