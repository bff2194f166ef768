"""Topology of meshes: cells that occur twice or lie in the same place, and facets of more than two cells."""

import re

import numpy as np
import pytest

from softway.errors import InputError
from softway.meshes.cells import CELLS
from softway.meshes.generators.shapes import KINDS, box, interval, rectangle
from softway.meshes.mesh import Mesh

MADE = {**dict.fromkeys(KINDS[2], 2), **dict.fromkeys(KINDS[3], 3)}


def made(cell: str) -> Mesh:
    """Small body of the cells of a kind."""
    return rectangle((2.0, 1.0), (3, 2), cell=cell) if MADE[cell] == 2 else box((3.0, 1.0, 1.0), (3, 1, 1), cell=cell)


@pytest.mark.parametrize("cell", list(MADE))
def test_cell_that_is_listed_twice_is_named(cell: str) -> None:
    mesh = made(cell)
    cells = mesh.blocks[cell]
    with pytest.raises(InputError, match=rf"cell number {len(cells)} has the corners of cell number 1") as caught:
        Mesh(points=mesh.points, blocks={cell: np.concatenate([cells, cells[1:2]])})
    centre = mesh.points[cells[1][: CELLS[cell].corners]].mean(axis=0)
    assert f"({', '.join(f'{x:.6g}' for x in centre)}) m; 1 cell occurs twice" in caught.value.problem
    assert caught.value.where == f"blocks.{cell}[{len(cells)}]"
    assert Mesh(points=mesh.points, blocks={cell: cells}).n_cells == len(cells)  # the remedy: every cell once


def test_copy_that_begins_at_another_corner_is_the_same_cell() -> None:
    mesh = rectangle((2.0, 1.0), (2, 1))
    cells = mesh.blocks["quad4"]
    twice = np.concatenate([cells, np.roll(cells, 1, axis=1)])
    with pytest.raises(InputError, match="cell number 2 has the corners of cell number 0, .* 2 cells occur twice"):
        Mesh(points=mesh.points, blocks={"quad4": twice})


@pytest.mark.parametrize("cell", list(MADE))
def test_copy_with_nodes_of_its_own_is_named(cell: str) -> None:
    mesh = made(cell)
    cells, n = mesh.blocks[cell], mesh.n_nodes
    with pytest.raises(InputError, match=rf"cell number {len(cells)} is in the place of cell number 0, .*{len(cells)}"):
        Mesh(points=np.concatenate([mesh.points] * 2), blocks={cell: np.concatenate([cells, cells + n])})


def test_cells_of_two_kinds_in_the_same_place_are_named() -> None:
    one, two = rectangle((2.0, 1.0), (2, 1)), rectangle((2.0, 1.0), (2, 1), cell="quad9")
    points = np.concatenate([one.points, two.points])
    with pytest.raises(InputError, match="cell number 0 is in the place of cell number 0 of quad4") as caught:
        Mesh(points=points, blocks={"quad4": one.blocks["quad4"], "quad9": two.blocks["quad9"] + one.n_nodes})
    assert caught.value.where == "blocks.quad9[0]"


def test_three_cells_at_a_facet_are_refused() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.3, 2.0], [0.0, -1.0]])
    cells = np.array([[0, 1, 2], [0, 1, 3], [1, 0, 4]])
    told = "3 cells share the facet of the nodes [0, 1], with the centre (0.5, 0) m; 1 facet has more"
    with pytest.raises(InputError, match=re.escape(told)):
        Mesh(points=points, blocks={"tri3": cells})
    assert Mesh(points=points[[0, 1, 2, 4]], blocks={"tri3": np.array([[0, 1, 2], [1, 0, 3]])}).n_cells == 2


def test_facets_of_cells_of_two_kinds_are_counted_together() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.2, 1.4], [2.0, 0.5]])
    blocks = {"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 5, 2], [1, 4, 2]])}
    with pytest.raises(InputError, match="3 cells share the facet"):
        Mesh(points=points, blocks=blocks)


def test_bars_may_meet_in_any_number_in_the_plane_but_not_on_the_axis() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    star = np.array([[0, 1], [0, 2], [0, 3]])
    assert Mesh(points=points, blocks={"bar2": star}).n_cells == 3
    with pytest.raises(InputError, match="3 cells share the facet of the nodes"):
        Mesh(points=np.array([[0.0], [1.0], [2.0], [3.0]]), blocks={"bar2": star})
    with pytest.raises(InputError, match="cell number 2 has the corners of cell number 0"):
        Mesh(points=interval(2.0, 2).points, blocks={"bar2": np.array([[0, 1], [1, 2], [0, 1]])})


def test_collapsed_facets_of_wedges_around_an_axis_are_allowed() -> None:
    """Six hexahedra with two corners each on an axis: their collapsed facets have the same two nodes."""
    turn = np.arange(6) * np.pi / 3
    rim = np.column_stack([np.cos(turn), np.sin(turn)])
    points = np.array([[*p, z] for z in (0.0, 1.0) for p in [(0.0, 0.0), *rim]])
    wedge = [[0, 1 + k, 1 + (k + 1) % 6, 0] for k in range(6)]
    cells = np.array([[*w, *(n + 7 for n in w)] for w in wedge])
    assert Mesh(points=points, blocks={"hex8": cells}).n_cells == 6
