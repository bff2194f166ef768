"""Examination of meshes: overlapping cells and hanging nodes are refused; loose parts, cracks and hinges are noted."""

import numpy as np
import pytest

from softway.errors import InputError
from softway.meshes.flaws.examination import examined
from softway.meshes.flaws.hinges import hinges
from softway.meshes.flaws.overlapping_cells import check_overlap
from softway.meshes.generators.graded import ring
from softway.meshes.generators.shapes import KINDS, ball, box, cylinder, disc, interval, rectangle
from softway.meshes.mesh import Mesh

FLAT, SOLID = KINDS[2], KINDS[3]


def joined(*meshes: Mesh) -> Mesh:
    """One mesh of the cells of several, which share no node."""
    first = np.cumsum([0, *(m.n_nodes for m in meshes)])
    names = dict.fromkeys(name for m in meshes for name in m.blocks)
    blocks = {
        name: np.concatenate([m.blocks[name] + n for m, n in zip(meshes, first, strict=False) if name in m.blocks])
        for name in names
    }
    return Mesh(points=np.concatenate([m.points for m in meshes]), blocks=blocks)


def merged(*meshes: Mesh) -> Mesh:
    """One mesh of the cells of several; nodes in the same place become one."""
    mesh, number = joined(*meshes), dict[tuple[float, ...], int]()
    same = np.array([number.setdefault(tuple(x), k) for k, x in enumerate(mesh.points.round(9).tolist())])
    ((cell, nodes),) = mesh.blocks.items()
    used, cells = np.unique(same[nodes], return_inverse=True)
    return Mesh(points=mesh.points[used], blocks={cell: cells.reshape(nodes.shape)})


def moved(mesh: Mesh, *shift: float) -> Mesh:
    """Mesh moved by a vector."""
    return Mesh(points=mesh.points + np.array(shift), blocks=mesh.blocks)


@pytest.mark.parametrize("cell", FLAT)
def test_generated_plane_meshes_have_no_notes(cell: str) -> None:
    for mesh in (rectangle((1.0, 2.0), (3, 4), cell=cell), disc(1.0, 4, cell=cell)):
        assert examined(mesh) == ()
    if cell[0] == "q":
        assert examined(ring(0.1, 1.0, cells=(3, 12), angle=1.5 * np.pi, cell=cell)) == ()


@pytest.mark.parametrize("cell", SOLID)
def test_generated_solid_meshes_have_no_notes(cell: str) -> None:
    meshes = box((1.0, 2.0, 1.0), (3, 2, 2), cell=cell), ball(1.0, 4, cell=cell), cylinder(1.0, 2.0, (4, 2), cell=cell)
    for mesh in meshes:
        assert examined(mesh) == ()


def test_generated_bars_have_no_notes() -> None:
    assert examined(interval(1.0, 4)) == ()
    assert examined(Mesh(points=np.eye(3), blocks={"bar2": np.array([[0, 1], [1, 2], [2, 0]])})) == ()


@pytest.mark.parametrize("cell", FLAT)
@pytest.mark.parametrize("cells", [(2, 2), (3, 5), (7, 4)])
def test_copy_of_a_body_with_other_cells_overlaps(cell: str, cells: tuple[int, int]) -> None:
    with pytest.raises(InputError, match="cells overlap others|cells lie in the place of another") as caught:
        examined(joined(rectangle((1.0, 1.0), (4, 4), cell=cell), rectangle((1.0, 1.0), cells, cell="tri3")))
    assert caught.value.where.startswith("blocks.")


@pytest.mark.parametrize("cell", SOLID)
@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.8, 0.7, 0.75), (-0.3, 0.2, 0.1)])
def test_overlap_of_two_boxes_is_found_at_any_shift(cell: str, shift: tuple[float, ...]) -> None:
    one, two = box((1.0, 1.0, 1.0), (3, 3, 3), cell=cell), box((1.0, 1.0, 1.0), (2, 4, 2))
    with pytest.raises(InputError, match=r"cell number \d+ overlaps cell number \d+"):
        check_overlap(joined(one, moved(two, *shift)))
    check_overlap(joined(one, moved(two, *(1.0 + abs(x) for x in shift))))


def test_small_part_inside_of_a_large_cell_overlaps() -> None:
    with pytest.raises(InputError, match="overlaps cell number"):
        examined(joined(rectangle((1.0, 1.0), (1, 1)), moved(rectangle((0.01, 0.01), (9, 9)), 0.4, 0.7)))


def test_surface_that_passes_through_itself_overlaps() -> None:
    """A strip of one part, rolled up by more than a turn."""
    strip = rectangle((2.0 * np.pi * 1.1, 0.1), (40, 1))
    angle, radius = strip.points[:, 0], 1.0 - strip.points[:, 1]
    mesh = Mesh(points=np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), blocks=strip.blocks)
    with pytest.raises(InputError, match="overlaps cell number"):
        examined(mesh)


@pytest.mark.parametrize("cell", FLAT)
def test_curved_parts_that_touch_do_not_overlap(cell: str) -> None:
    """The facets of two rings on one circle cut each other by their sagitta; the parts are accepted, and noted."""
    if cell[0] == "t":
        return
    inner = ring(0.5, 1.0, cells=(4, 12), angle=np.pi, cell=cell)
    outer = ring(1.0, 2.0, cells=(4, 17), angle=np.pi, cell=cell)
    (note,) = examined(joined(inner, outer))
    assert note.problem.startswith("2 parts that share no node") and "Contact" not in note.problem


def test_parts_that_share_no_node_are_noted_with_the_nodes_that_touch() -> None:
    one, two = rectangle((1.0, 1.0), (2, 2)), moved(rectangle((1.0, 1.0), (1, 3)), 1.0, 0.0)
    (note,) = examined(joined(one, two))
    assert note.where == "mesh"
    # two corners of each part coincide; beside them one node of the first and two of the second part touch
    assert note.problem == "2 parts that share no node; they touch at 7 nodes, where nothing holds them together"
    (note,) = examined(joined(one, moved(two, 0.5, 0.0), moved(two, 3.0, 0.0)))
    assert note.problem == "3 parts that share no node"
    assert examined(one) == () and examined(two) == ()  # the remedy: a body of its own for each part


def test_parts_that_are_glued_are_one() -> None:
    one, two = rectangle((1.0, 1.0), (2, 2)), moved(rectangle((1.0, 1.0), (1, 3)), 1.0, 0.0)
    mesh = joined(one, two, moved(two, 3.0, 0.0))
    body = np.repeat(np.arange(3), [one.n_nodes, two.n_nodes, two.n_nodes])
    for name, of in (("a", 0), ("b", 1)):
        mesh = mesh.with_tag(name, lambda x, of=of: (np.abs(x[:, 0] - 1.0) < 1e-9) & (body == of))
    (note,) = examined(mesh, [("a", "b")])
    assert note.problem == "2 parts that share no node"
    assert examined(mesh)[0].problem.startswith("3 parts that share no node; they touch at 7 nodes")


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad9", "tri6"])
def test_node_that_hangs_on_an_edge_is_refused(cell: str) -> None:
    """Two cells beside one: the node between them lies on the edge of the large cell."""
    large, small = rectangle((1.0, 1.0), (1, 1), cell=cell), moved(rectangle((0.5, 1.0), (1, 2), cell=cell), 1.0, 0.0)
    mesh = merged(large, small)
    with pytest.raises(InputError, match="lies on a facet, but is not a node of it") as caught:
        examined(mesh)
    assert "(1, " in caught.value.problem


def test_node_that_hangs_on_a_face_or_an_edge_of_a_hexahedron_is_refused() -> None:
    points = np.concatenate(
        [box((1.0, 1.0, 1.0), (1, 1, 1)).points, box((1.0, 1.0, 1.0), (1, 2, 2)).points + [1, 0, 0]]
    )
    number = {tuple(x): k for k, x in reversed(list(enumerate(points.tolist())))}
    same = np.array([number[tuple(x)] for x in points.tolist()])
    cells = [box((1.0, 1.0, 1.0), (1, 1, 1)).blocks["hex8"], box((1.0, 1.0, 1.0), (1, 2, 2)).blocks["hex8"] + 8]
    used, cell = np.unique(same[np.concatenate(cells)], return_inverse=True)
    with pytest.raises(InputError, match="5 such nodes"):
        examined(Mesh(points=points[used], blocks={"hex8": cell.reshape(-1, 8)}))


def test_crack_is_noted() -> None:
    """A square cut from one side to its middle, with two nodes in one place on the cut."""
    mesh = rectangle((1.0, 1.0), (4, 4))
    cells = mesh.blocks["quad4"].copy()
    cut = [10, 11]  # the nodes (0, 0.5) and (0.25, 0.5)
    above = mesh.points[cells].mean(axis=1)[:, 1] > 0.5
    for k, node in enumerate(cut):
        cells[above] = np.where(cells[above] == node, mesh.n_nodes + k, cells[above])
    slit = Mesh(points=np.concatenate([mesh.points, mesh.points[cut]]), blocks={"quad4": cells})
    (note,) = examined(slit)
    assert note.problem.startswith("4 nodes coincide with others of the same part, as at (0, 0.5) m")
    assert "unless a crack is meant" in note.remedy


def test_closed_ring_whose_ends_are_not_merged_is_noted() -> None:
    mesh = rectangle((2.0 * np.pi, 0.5), (24, 2))
    angle, radius = mesh.points[:, 0], 1.5 - mesh.points[:, 1]
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    (note,) = examined(Mesh(points=points, blocks=mesh.blocks))
    assert note.problem.startswith("6 nodes coincide")


def test_cells_that_meet_at_a_corner_or_an_edge_only_are_noted() -> None:
    grid, cubes = rectangle((2.0, 2.0), (2, 2)), box((2.0, 2.0, 2.0), (2, 2, 2))
    for mesh, kept, count in ((grid, [0, 3], 1), (cubes, [0, 3], 2), (cubes, [0, 7], 1)):
        (name,) = mesh.blocks
        used, cells = np.unique(mesh.blocks[name][kept], return_inverse=True)
        part = Mesh(points=mesh.points[used], blocks={name: cells.reshape(2, -1)})
        (note,) = examined(part)
        assert len(hinges(part)) == count and f"{count} of them" in note.problem and "hinges" in note.problem
    assert len(hinges(cubes)) == len(hinges(grid)) == 0
