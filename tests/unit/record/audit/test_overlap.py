"""Overlaps of bodies whose places are known exactly, found without any contact."""

import numpy as np
import pytest

from softway.arrays import Array
from softway.bodies.prescribed_motion import PlacedShape, Still
from softway.meshes.generators import recipes
from softway.meshes.mesh import Mesh
from softway.obstacles import HalfSpace, Sphere
from softway.record.audit.geometry.bad_cells import bad_cells
from softway.record.audit.geometry.overlap import overlaps
from softway.record.audit.geometry.solids import Solids, solids
from softway.record.audit.geometry.tools import behind, sunk

pytestmark = pytest.mark.slow

PLANE = ("tri3", "tri6", "quad4", "quad9")
SPACE = ("tet4", "tet10", "hex8", "hex27")


def together(*meshes: Mesh) -> Solids:
    """Bodies a, b, ... in one numbering."""
    starts = np.cumsum([0, *(m.n_nodes for m in meshes)])
    names = dict.fromkeys(name for m in meshes for name in m.blocks)
    pick = {name: [(k, m.blocks[name] + starts[k]) for k, m in enumerate(meshes) if name in m.blocks] for name in names}
    return solids(
        "abcdef"[: len(meshes)],
        np.concatenate([m.points for m in meshes]),
        {name: np.concatenate([nodes for _, nodes in found]) for name, found in pick.items()},
        {name: np.concatenate([np.full(len(nodes), k) for k, nodes in found]) for name, found in pick.items()},
    )


def moved(bodies: Solids, body: int, by: list[float]) -> Array:
    x = bodies.reference.copy()
    x[bodies.owner == body] += by
    return x


def deepest(bodies: Solids, x: Array) -> tuple[float, float]:
    """Deepest overlap at nodes and between them."""
    found = overlaps(bodies, x)
    node = found.ends[:, 0] == found.ends[:, 1]
    return found.depth[node].max(initial=0.0), found.depth[~node].max(initial=0.0)


def square(cells: int, cell: str) -> Mesh:
    return recipes.Rectangle(size=(1.0, 1.0), cells=(cells, cells), cell=cell).build()


def cube(cells: int, cell: str) -> Mesh:
    return recipes.Box(size=(1.0, 1.0, 1.0), cells=(cells,) * 3, cell=cell).build()


def turn(angle: float, axis: int) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    out = np.eye(3)
    a, b = [k for k in range(3) if k != axis]
    out[a, a] = out[b, b] = c
    out[a, b], out[b, a] = -s, s
    return out


@pytest.mark.parametrize("cell", PLANE)
def test_squares_pressed_into_each_other(cell: str) -> None:
    bodies = together(square(6, cell), square(4, cell))
    nodes, between = deepest(bodies, moved(bodies, 1, [0.99, 0.33]))
    assert nodes == pytest.approx(0.01, rel=1e-9) and between <= 0.01 * (1 + 1e-9)
    assert max(deepest(bodies, moved(bodies, 1, [1.0, 0.33]))) < 1e-13
    assert deepest(bodies, moved(bodies, 1, [1.01, 0.33])) == (0.0, 0.0)


@pytest.mark.parametrize("cell", SPACE)
def test_cubes_pressed_into_each_other(cell: str) -> None:
    bodies = together(cube(3, cell), cube(2, cell))
    nodes, between = deepest(bodies, moved(bodies, 1, [0.99, 0.33, 0.21]))
    assert nodes == pytest.approx(0.01, rel=1e-9) and between <= 0.01 * (1 + 1e-9)
    assert max(deepest(bodies, moved(bodies, 1, [1.0, 0.33, 0.21]))) < 1e-13
    assert deepest(bodies, moved(bodies, 1, [1.01, 0.33, 0.21])) == (0.0, 0.0)


def test_a_body_deep_inside_of_another_one() -> None:
    bodies = together(square(10, "quad4"), recipes.Rectangle(size=(0.1, 0.1), cells=(2, 2)).build())
    nodes, _ = deepest(bodies, moved(bodies, 1, [0.42, 0.43]))
    assert nodes == pytest.approx(0.48, abs=0.01)  # its upper left corner is .48 from the right side and .47 from above


def test_edges_that_cross_between_their_nodes() -> None:
    """Two cubes on their edges, crosswise: no node is inside the other, the edges overlap by .013."""
    bodies, deep = together(cube(4, "hex8"), cube(4, "hex8")), 0.013
    x = bodies.reference - 0.5
    first = bodies.owner == 0
    x[first] = x[first] @ turn(np.pi / 4, 0).T
    x[~first] = x[~first] @ turn(np.pi / 4, 1).T + [0.07, 0.03, np.sqrt(2.0) - deep]
    nodes, between = deepest(bodies, x)
    assert nodes == 0.0 and between == pytest.approx(deep / np.sqrt(2.0), rel=1e-6)
    x[~first] += [0.0, 0.0, 1.01 * deep]
    assert deepest(bodies, x) == (0.0, 0.0)


@pytest.mark.parametrize("cell", ["quad8", "quad9", "tri6", "hex20", "hex27", "tet10"])
def test_curved_facets_that_overlap_while_their_nodes_and_flat_pieces_do_not(cell: str) -> None:
    """Two parabolas, one turned down and one up, whose tops are .01 in each other between the nodes of both."""
    size = (1.0, 1.0) if cell in PLANE + ("quad8",) else (1.0, 1.0, 1.0)
    recipe = recipes.Rectangle if len(size) == 2 else recipes.Box
    below, above = (recipe(size=size, cells=(1,) * len(size), cell=cell).build() for _ in range(2))
    bodies, deep = together(below, above), 0.01
    for pressed in (deep, -deep):
        x = bodies.reference.copy()
        upper = bodies.owner == 1
        x[upper, 0] += 0.25
        x[upper, 1] += 1.0 - pressed
        x[:, 1] += 0.5 * np.where(upper, 1.0, -1.0) * (x[:, 0] - 0.63) ** 2
        nodes, between = deepest(bodies, x)
        assert nodes == 0.0
        assert between == (pytest.approx(deep, rel=0.02) if pressed > 0.0 else 0.0)


def arch(bodies: Solids, turned: float) -> Array:
    """Strip of unit length and height .1 bent into an arc that turns by an angle: its ends cross beyond 2 pi."""
    x, y, *z = bodies.reference.T
    radius, angle = 1.0 / turned, turned * (x - 0.5)
    return np.stack([(radius + 0.05 - y) * np.sin(angle), (radius + 0.05 - y) * np.cos(angle), *z], axis=1)


@pytest.mark.parametrize("cell", ["tri6", "quad8", "quad9"])
def test_bodies_that_bend_together_do_not_overlap(cell: str) -> None:
    """Six and four edges on one parabola are the same curve, although straight lines between their nodes cross."""
    bodies = together(square(6, cell), square(4, cell))
    bent = moved(bodies, 1, [0.0, 1.0])
    bent[:, 1] += 0.2 * bent[:, 0] ** 2
    assert max(deepest(bodies, bent)) < 1e-12
    bent[bodies.owner == 1, 1] -= 1e-3
    assert deepest(bodies, bent)[1] == pytest.approx(1e-3, rel=0.1)


@pytest.mark.few(5)
@pytest.mark.parametrize("cell", PLANE + SPACE)
def test_a_strip_bent_through_itself(cell: str) -> None:
    recipe = recipes.Rectangle if cell in PLANE else recipes.Box
    size, cells = ((1.0, 0.1), (40, 4)) if cell in PLANE else ((1.0, 0.1, 0.1), (40, 4, 2))
    strip = together(recipe(size=size, cells=cells, cell=cell).build())
    assert max(deepest(strip, arch(strip, 0.97 * 2.0 * np.pi))) < 1e-13
    nodes, _ = deepest(strip, arch(strip, 1.05 * 2.0 * np.pi))
    assert 0.01 < nodes < 0.05  # .05 of the length overlaps; the nearest side is at most half a height away


def test_a_thin_wall_is_no_overlap_with_its_own_back() -> None:
    wall = together(recipes.Rectangle(size=(1.0, 0.001), cells=(10, 1)).build())
    assert deepest(wall, arch(wall, 3.0)) == (0.0, 0.0)
    assert deepest(wall, wall.reference * [1.0, 0.01]) == (0.0, 0.0)


def test_a_box_on_a_sphere_overlaps_between_its_nodes() -> None:
    """The four corners of a facet lie on a sphere: its centre is as deep as the sphere rises above them."""
    box = together(recipes.Box(size=(2.0, 2.0, 1.0), cells=(1, 1, 1)).build())
    radius = 5.0
    height = np.sqrt(radius**2 - 2.0)
    shape = PlacedShape(shape=Sphere(centre=(1.0, 1.0, -height), radius=radius), pose=Still().at(0.0))
    found = list(sunk(box, box.reference, shape, behind(box, shape)))
    assert [f.at_node for f in found if f.depth > 1e-12] == [False]
    assert found[-1].depth == pytest.approx(radius - height, rel=1e-9)
    assert found[-1].place == pytest.approx([1.0, 1.0, 0.0])


def test_a_plane_is_checked_at_the_nodes_of_linear_cells_and_between_those_of_quadratic_ones() -> None:
    floor = PlacedShape(shape=HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)), pose=Still().at(0.0))
    body = together(recipes.Rectangle(size=(1.0, 1.0), cells=(1, 1), cell="quad9").build())
    x = body.reference.copy()
    x[:, 1] += 0.1 - 0.4 * x[:, 0] * (1.0 - x[:, 0])  # the lower edge is a parabola that touches
    assert not [f for f in sunk(body, x, floor, behind(body, floor)) if f.depth > 1e-12]
    x[:, 1] -= 0.02
    (node, *between) = sunk(body, x, floor, behind(body, floor))
    assert node.at_node and node.depth == pytest.approx(0.02)
    assert not between or max(f.depth for f in between) <= 0.02 * (1 + 1e-9)


@pytest.mark.parametrize("cell", PLANE + SPACE)
def test_folded_cells_are_found_with_their_shape(cell: str) -> None:
    body = together(square(2, cell) if cell in PLANE else cube(2, cell))
    assert not bad_cells(body, body.reference)
    corner = int(np.argmax(body.reference.sum(axis=1)))
    x = body.reference.copy()
    x[corner] = 0.1  # pushed beyond the centre of the body
    ((number, nodes, shape),) = bad_cells(body, x)
    assert number == 0 and corner in nodes and shape < 0.0


def test_a_flat_corner_of_a_cell_is_not_inverted() -> None:
    """As where a flank folds onto a plane tool: both sides of the corner lie on it, up to rounding."""
    body, x = together(square(1, "quad4")), square(1, "quad4").points.copy()
    corner = int(np.argmax(x.sum(axis=1)))
    others = np.flatnonzero((x.sum(axis=1) > 0.5) & (np.arange(4) != corner))
    for beyond in (-1e-15, 0.0, 1e-15):
        x[corner] = x[others].mean(axis=0) + beyond
        assert not bad_cells(body, x)
    x[corner] -= 1e-3
    assert len(bad_cells(body, x)) == 1
    assert len(bad_cells(body, 0.0 * x)) == 1
