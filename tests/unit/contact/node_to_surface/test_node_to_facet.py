"""Nodes against facets: gaps, their derivatives, and what is and is not touched."""

import numpy as np
import pytest

from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.stencils import Stencils
from softway.contact.surfaces.boundary import ContactSurface, outward
from softway.meshes.generators.shapes import ball, box, disc, interval, rectangle
from softway.meshes.mesh import Mesh

SOLIDS = {
    "bar2": ("quad4", 2),
    "bar3": ("quad9", 2),
    "tri3": ("tet4", 3),
    "tri6": ("tet10", 3),
    "quad4": ("hex8", 3),
    "quad8": ("hex20", 3),
    "quad9": ("hex27", 3),
}


def block(kind: str, size: float, cells: int) -> Mesh:
    """A block whose facets are of one kind."""
    cell, dim = SOLIDS[kind]
    return rectangle((size,) * 2, (cells,) * 2, cell=cell) if dim == 2 else box((size,) * 3, (cells,) * 3, cell=cell)


def contact(mesh: Mesh, slaves: np.ndarray, tag: str = "surface", slots: int = 0) -> tuple[np.ndarray, NodeToFacet]:
    """Positions of the nodes of a mesh followed by slaves, and the contact between them."""
    x = np.concatenate([mesh.points, slaves])
    number = np.arange(mesh.n_nodes, len(x))
    return x, NodeToFacet(slaves=number, side=ContactSurface(facets=mesh.facets_on(tag)), slots=slots)


def crossing(mesh: Mesh, start: np.ndarray, end: np.ndarray, tag: str = "surface", reach: float = 1e-3) -> Stencils:
    """Rows at the end of a slab in which slaves move from start to end."""
    x0, nodes = contact(mesh, start, tag)
    x1 = np.concatenate([mesh.points, end])
    return nodes.meet(x0, x1, reach).at(x1)


def rough(kind: str, seed: int) -> tuple[np.ndarray, np.ndarray, NodeToFacet]:
    """A distorted upper face of a block and 400 slaves that come down on it, some of them too deep or beside it."""
    mesh = block(kind, 3.0, 3)
    rng = np.random.default_rng(seed)
    dim = mesh.dim
    slaves = 3.2 * rng.random((400, dim)) - 0.1
    slaves[:, -1] = 3.2 + 0.3 * rng.random(400)
    x0, nodes = contact(mesh, slaves, "top")
    x0[: mesh.n_nodes] += (0.02 if kind in ("bar3", "tri6", "quad8", "quad9") else 0.04) * rng.normal(
        size=mesh.points.shape
    )
    x = x0 + 0.02 * rng.normal(size=x0.shape)
    x[mesh.n_nodes :, -1] -= 0.3
    return x0, x, nodes


@pytest.mark.parametrize("kept", [False, True])
@pytest.mark.parametrize("kind", SOLIDS)
def test_rows_are_the_derivatives_of_the_gaps(kind: str, kept: bool) -> None:
    x0, x, nodes = rough(kind, seed=1)
    pairing = nodes.meet(x0, x, 0.3)
    pairing = pairing.with_kept_facets(x) if kept else pairing
    rows = pairing.at(x)
    near = np.abs(rows.gap) < 0.3
    way = np.random.default_rng(2).normal(size=x.shape)
    exact = np.einsum("md,md->m", rows.normal, rows.weights @ way)
    quotients = []
    for h in (1e-5, 1e-6):
        ahead, behind = (pairing.at(x + s * way).gap[near] for s in (h, -h))
        quotients.append((ahead - behind) / (2.0 * h))
    error = np.abs(quotients - exact[near]).min(axis=0)
    assert near.sum() > 200
    # a few rows lie within a step of another facet, where the gap has a kink
    assert np.quantile(error, 0.99) < 1e-7
    assert np.count_nonzero(error > 1e-7) <= 3


@pytest.mark.parametrize("kept", [False, True])
@pytest.mark.parametrize("kind", SOLIDS)
def test_forces_along_the_rows_have_no_resultant_and_no_moment(kind: str, kept: bool) -> None:
    x0, x, nodes = rough(kind, seed=3)
    pairing = nodes.meet(x0, x, 0.3)
    rows = (pairing.with_kept_facets(x) if kept else pairing).at(x)
    near = np.abs(rows.gap) < 0.3
    assert np.abs(rows.weights.sum(axis=1)).max() < 1e-14
    lever = (rows.weights @ x)[near]
    assert lever == pytest.approx(rows.gap[near, None] * rows.normal[near], abs=1e-10)
    assert np.linalg.norm(rows.normal[near], axis=1) == pytest.approx(np.ones(near.sum()), abs=1e-14)


@pytest.mark.parametrize("kind", SOLIDS)
def test_gaps_are_invariant_under_rigid_motions(kind: str) -> None:
    x0, x, nodes = rough(kind, seed=4)
    dim = x.shape[1]
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(dim, dim)))[0]
    turn[:, 0] *= np.linalg.det(turn)
    shift = np.arange(1.0, dim + 1.0)
    before = nodes.meet(x0, x, 0.3).at(x)
    after = nodes.meet(x0 @ turn.T + shift, x @ turn.T + shift, 0.3).at(x @ turn.T + shift)
    seen = np.abs(before.gap) < 0.3
    assert after.gap[seen] == pytest.approx(before.gap[seen], abs=1e-12)
    assert after.normal[seen] == pytest.approx((before.normal @ turn.T)[seen], abs=1e-9)
    assert np.abs((after.weights - before.weights)[np.flatnonzero(seen)]).max() < 1e-9


@pytest.mark.parametrize(
    ("make", "cell", "order"),
    [
        (disc, "quad4", 2),
        (disc, "quad8", 4),
        (disc, "quad9", 4),
        (ball, "tet4", 2),
        (ball, "hex8", 2),
        (ball, "tet10", 3),
        (ball, "hex20", 3),
        (ball, "hex27", 3),
    ],
)
def test_distance_from_a_ball_converges(make, cell: str, order: int) -> None:
    rng = np.random.default_rng(6)
    errors = []
    for cells in (8, 16):
        mesh = make(1.0, cells, cell=cell)
        radial = rng.normal(size=(2000, mesh.dim))
        radius = 1.0 + 0.1 * rng.random(2000)
        slaves = radial * (radius / np.linalg.norm(radial, axis=1))[:, None]
        x, nodes = contact(mesh, slaves, slots=1)
        rows = nodes.meet(x, x, 0.2).at(x)
        errors.append(np.sqrt(np.mean((rows.gap - (radius - 1.0)) ** 2)))
    assert np.log2(errors[0] / errors[1]) > order - 0.2
    assert errors[1] < 10.0 * 16.0**-order


def test_ends_of_bars() -> None:
    """Two bars on a line; each end of the first sees the nearest end of the second that faces it."""
    one, two = interval(1.0, 2), interval(0.5, 1)
    x = np.concatenate([one.points, two.points + 1.25])
    points = two.boundary()["point1"]
    side = ContactSurface(facets={"point1": points + 3}, ends=outward(two.blocks["bar2"], points))
    nodes = NodeToFacet(slaves=np.array([2]), side=side)
    assert nodes.node.tolist() == [2]
    x1 = x.copy()
    x1[:3] += 2.0  # right through the second bar
    pairing = nodes.meet(x, x1, 1e-3)
    assert pairing.at(x).gap.tolist() == [0.25]
    rows = pairing.at(x1)
    assert rows.gap.tolist() == [-1.75]
    assert rows.normal.tolist() == [[-1.0]]
    assert rows.weights.toarray().tolist() == [[0.0, 0.0, 1.0, -1.0, 0.0]]


@pytest.mark.parametrize("kind", SOLIDS)
def test_a_thin_plate_cannot_be_crossed(kind: str) -> None:
    """The slaves cross a plate of a hundredth of a facet by fifty thicknesses; the farther face is not in their way."""
    cell, dim = SOLIDS[kind]
    mesh = rectangle((3.0, 0.01), (3, 1), cell=cell) if dim == 2 else box((3.0, 3.0, 0.01), (3, 3, 1), cell=cell)
    rng = np.random.default_rng(7)
    start = 3.0 * rng.random((200, dim))
    start[:, -1] = 0.01 + 0.2 * rng.random(200)
    end = start.copy()
    end[:, -1] = -0.5
    rows = crossing(mesh, start, end)
    first = rows.gap.reshape(200, dim)[:, 0]
    assert first == pytest.approx(np.full(200, -0.51), abs=1e-12)
    assert rows.normal[::dim, -1] == pytest.approx(np.ones(200), abs=1e-12)


def test_of_two_plates_the_one_that_is_met_first_comes_out_in_the_end() -> None:
    """A slave that has crossed two plates is led back over the first one, plate after plate."""
    plate = box((1.0, 1.0, 0.01), (2, 2, 1))
    under = plate.points - np.array([0.0, 0.0, 1.0])
    mesh = Mesh(
        points=np.concatenate([plate.points, under]),
        blocks={"hex8": np.concatenate([plate.blocks["hex8"], plate.blocks["hex8"] + plate.n_nodes])},
    )
    x0, nodes = contact(mesh, np.array([[0.3, 0.3, 0.2]]))
    x1 = x0.copy()
    x1[-1, 2] = -1.5
    pairing = nodes.meet(x0, x1, 1e-3)
    for _ in range(3):
        rows = pairing.at(x1)
        x1[-1] -= min(rows.gap[0], 0.0) * rows.normal[0]
    assert x1[-1].tolist() == pytest.approx([0.3, 0.3, 0.01], abs=1e-14)
    assert pairing.at(x1).gap[0] == pytest.approx(0.0, abs=1e-14)


def test_a_plate_cannot_be_crossed_near_its_rim() -> None:
    """Deeper than the distance to the rim: the face that was hit counts, not the nearer rim."""
    mesh = box((1.0, 1.0, 0.01), (4, 4, 1))
    rows = crossing(mesh, np.array([[0.995, 0.5, 0.011]]), np.array([[0.995, 0.5, -0.02]]))
    assert rows.gap[0] == pytest.approx(-0.03, abs=1e-14)
    assert rows.normal[0].tolist() == pytest.approx([0.0, 0.0, 1.0], abs=1e-14)


def test_slanted_paths_through_a_curved_wall_are_found() -> None:
    """The wall of a tube is crossed along chords over several facets."""
    flat = rectangle((2.0 * np.pi, 0.02), (48, 1), cell="quad9")
    radius, angle = 1.0 + flat.points[:, 1], -flat.points[:, 0]
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    _, first, same = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    mesh = Mesh(points=points[first], blocks={"quad9": same.ravel()[flat.blocks["quad9"]]})
    rng = np.random.default_rng(8)
    angle = 2.0 * np.pi * rng.random(300)
    turn = 0.4 * (2.0 * rng.random(300) - 1.0)
    ways = [(1.03, 0.85), (0.97, 1.2)]
    for before, after in ways:
        start = before * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        end = after * np.stack([np.cos(angle + turn), np.sin(angle + turn)], axis=1)
        assert crossing(mesh, start, end).gap.reshape(300, 2).min(axis=1).max() < -0.1


def test_a_slave_that_slides_over_an_edge_keeps_its_row_until_the_slab_ends() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4))
    over, beside = np.array([[1.002, 1.0 - 1e-4]]), np.array([[1.001, 0.9]])
    rows = crossing(mesh, np.array([[0.999, 1.0]]), over)
    assert rows.gap[0] == pytest.approx(-1e-4, abs=1e-15)
    assert rows.normal[0].tolist() == pytest.approx([0.0, 1.0], abs=1e-15)
    assert (rows.weights @ np.concatenate([mesh.points, over]))[0] == pytest.approx([0.0, -1e-4], abs=1e-15)
    later = crossing(mesh, over, beside, reach=0.1)
    assert later.gap[0] == pytest.approx(1e-3, abs=1e-15)
    assert later.normal[0].tolist() == pytest.approx([1.0, 0.0], abs=1e-15)


@pytest.mark.parametrize("tag", ["surface", "top"])
def test_beside_an_edge_the_gap_is_the_distance_to_it(tag: str) -> None:
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2))
    place = np.array([[1.3, 0.4, 1.4]])
    rows = crossing(mesh, place, place, tag, reach=1.0)
    assert rows.gap[0] == pytest.approx(0.5, abs=1e-15)
    assert rows.normal[0].tolist() == pytest.approx([0.6, 0.0, 0.8], abs=1e-14)
    below = np.array([[1.03, 0.4, 0.96]])
    x, nodes = contact(mesh, below, "top")
    pairing = nodes.meet(x, x, 0.1)
    rows = pairing.at(x)
    assert rows.gap[0] == pytest.approx(0.05, abs=1e-15)
    assert rows.normal[0].tolist() == pytest.approx([0.6, 0.0, -0.8], abs=1e-14)
    assert np.isinf(pairing.with_kept_facets(x).at(x).gap).all()


def corner(dim: int, angle: float = 0.5 * np.pi) -> Mesh:
    """Surfaces as meshes: two walls of a length of one that open upwards at an angle, the bottom of the groove at 0."""
    half = 0.5 * angle
    left, right = np.array([-np.sin(half), np.cos(half)]), np.array([np.sin(half), np.cos(half)])
    outer = np.array([0.0, -1.0])
    profile = np.array([left, 0.5 * left, [0.0, 0.0], 0.5 * right, right, right + outer, outer, left + outer])
    quads = np.array([[0, 7, 6, 1], [1, 6, 2, 2], [2, 6, 3, 3], [3, 6, 5, 4]])
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[[0, 3]][:, [0, 2, 3]]])
    plane = Mesh(points=profile, blocks={"tri3": triangles})
    if dim == 2:
        return plane
    count = len(profile)
    points = np.concatenate([np.insert(profile, 1, y, axis=1) for y in (0.0, 1.0)])
    lower = np.sort(triangles, axis=1)
    a, b, c = lower.T
    tets = np.concatenate(
        [
            np.stack(t, axis=1)
            for t in ((a, b, c, c + count), (a, b, b + count, c + count), (a, a + count, b + count, c + count))
        ]
    )
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    wrong = np.linalg.det(edges) < 0.0
    tets[wrong] = tets[wrong][:, [0, 1, 3, 2]]
    return Mesh(points=points, blocks={"tet4": tets})


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("depth", [0.1, 1e-6, 0.0, -1e-9, -1e-7, -1e-4, -1e-2])
def test_a_node_in_a_corner_has_rows_of_both_walls(dim: int, depth: float) -> None:
    """The walls rise at 45 degrees; behind both of them the slave comes out over one after the other."""
    mesh = corner(dim)
    x0, nodes = contact(mesh, np.full((1, dim), 0.5))
    x0[-1, 0], x0[-1, -1] = 0.0, np.sqrt(2.0) * depth
    pairing = nodes.meet(x0, x0, 0.5)
    rows = pairing.at(x0)
    assert rows.gap[0] == pytest.approx(depth, abs=1e-15)
    if depth >= 0.0:
        assert rows.gap.tolist()[1:] == pytest.approx([depth, np.inf][: dim - 1], abs=1e-15)
        assert np.abs(rows.normal[0] @ rows.normal[1]) < 1e-14
    x = x0.copy()
    for _ in range(2):
        rows = pairing.at(x)
        x[-1] -= min(rows.gap[0], 0.0) * rows.normal[0]
    assert x[-1, [0, -1]] == pytest.approx(np.array([0.0, max(np.sqrt(2.0) * depth, 0.0)]), abs=1e-15)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize(("along", "both"), [(0.02, True), (0.09, True), (0.24, False), (0.4, False)])
def test_both_walls_of_a_blunt_groove_count_near_its_bottom(dim: int, along: float, both: bool) -> None:
    """A slave 0.001 above one wall of a groove of 120 degrees, at a way ``along`` it from the bottom.

    Seen from the other wall it is beyond the bottom, by half of that way.  It may slide on within a slab, so that this
    wall counts as if it went on, within a tenth of the size of its facets; these are 0.5 by 1.
    """
    angle, height = 2.0 * np.pi / 3.0, 1e-3
    half = 0.5 * angle
    wall, normal = np.array([-np.sin(half), np.cos(half)]), np.array([np.cos(half), np.sin(half)])
    x, nodes = contact(corner(dim, angle), np.full((1, dim), 0.5))
    x[-1, [0, -1]] = along * wall + height * normal
    rows = nodes.meet(x, x, 0.3).at(x)
    assert rows.gap[0] == pytest.approx(height, abs=1e-15)
    assert rows.normal[0, [0, -1]] == pytest.approx(normal, abs=1e-15)
    assert rows.gap[1] == pytest.approx(along * np.sin(angle) + 0.5 * height if both else np.inf, abs=1e-15)
    if both:
        assert rows.normal[1, [0, -1]] == pytest.approx(normal * [-1.0, 1.0], abs=1e-15)


def test_three_walls_of_a_box_seen_from_inside() -> None:
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2))
    facets = {"quad4": mesh.boundary()["quad4"][:, ::-1]}  # turned inward: a cavity
    x = np.concatenate([mesh.points, [[0.1, 0.2, 0.3], [0.5, 0.5, 0.05]]])
    nodes = NodeToFacet(slaves=np.array([27, 28]), side=ContactSurface(facets=facets))
    rows = nodes.meet(x, x, 0.4).at(x)
    assert rows.gap[:3].tolist() == pytest.approx([0.1, 0.2, 0.3], abs=1e-15)
    assert rows.normal[:3] == pytest.approx(np.eye(3), abs=1e-15)
    assert rows.gap[3:].tolist() == pytest.approx([0.05, np.inf, np.inf], abs=1e-15)


@pytest.mark.parametrize("kind", SOLIDS)
def test_a_convex_edge_is_one_condition(kind: str) -> None:
    mesh = block(kind, 1.0, 2)
    dim = mesh.dim
    start, end = np.full((1, dim), 0.4), np.full((1, dim), 0.4)
    start[0, [0, -1]], end[0, [0, -1]] = (1.1, 1.2), (0.99, 0.98)
    rows = crossing(mesh, start, end)
    assert rows.gap[0] == pytest.approx(-0.01, abs=1e-14)
    assert np.isinf(rows.gap[1:]).all()


def test_kept_facets_continue_beyond_their_edge() -> None:
    mesh = rectangle((1.0, 1.0), (2, 2))
    x, nodes = contact(mesh, np.array([[0.9, 1.1]]))
    kept = nodes.meet(x, x, 0.5).with_kept_facets(x)
    x[-1] = (1.7, 0.8)
    rows = kept.at(x)
    assert rows.gap[0] == pytest.approx(-0.2, abs=1e-15)
    assert rows.normal[0].tolist() == pytest.approx([0.0, 1.0], abs=1e-15)
    assert (rows.weights @ x)[0] == pytest.approx([0.0, -0.2], abs=1e-14)


def test_beyond_a_convex_edge_the_facet_in_front_is_kept() -> None:
    mesh = rectangle((1.0, 1.0), (2, 2))
    x, nodes = contact(mesh, np.array([[1.3, 1.1]]))
    pairing = nodes.meet(x, x, 0.5)
    assert pairing.at(x).gap[0] == pytest.approx(np.sqrt(0.1), abs=1e-15)
    kept = pairing.with_kept_facets(x)
    assert kept.at(x).gap[0] == pytest.approx(0.3, abs=1e-15)
    assert kept.at(x).normal[0].tolist() == pytest.approx([1.0, 0.0], abs=1e-15)


def test_a_slave_is_no_candidate_of_its_own_facets() -> None:
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2))
    side = ContactSurface(facets=mesh.boundary())
    rows = NodeToFacet(slaves=side.nodes, side=side).meet(mesh.points, mesh.points, 0.6).at(mesh.points)
    assert rows.gap.min() >= 0.5 - 1e-14
    for row, node in enumerate(np.repeat(side.nodes, 3)):
        assert rows.weights[[row], [node]].tolist() == [1.0] if np.isfinite(rows.gap[row]) else True


def test_facets_of_different_kinds_on_one_side() -> None:
    x = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [0.5, 0.5, 0.1], [1.2, 0.3, 0.2]], dtype=float)
    side = ContactSurface(facets={"quad4": np.array([[0, 1, 2, 3]]), "tri3": np.array([[1, 4, 2]])})
    rows = NodeToFacet(slaves=np.array([5, 6]), side=side, slots=1).meet(x, x, 0.5).at(x)
    assert rows.gap.tolist() == pytest.approx([0.1, 0.2], abs=1e-15)
    assert rows.weights.toarray()[0] == pytest.approx([-0.25, -0.25, -0.25, -0.25, 0.0, 1.0, 0.0], abs=1e-14)
    assert rows.weights.toarray()[1] == pytest.approx([0.0, -0.5, -0.3, 0.0, -0.2, 0.0, 1.0], abs=1e-14)


def test_without_anything_near_all_rows_are_out_of_reach() -> None:
    mesh = rectangle((1.0, 1.0), (2, 2))
    far = np.array([[5.0, 5.0], [7.0, 0.0]])
    rows = crossing(mesh, far, far)
    assert np.isinf(rows.gap).all()
    assert rows.gap.shape == (4,)
    assert rows.weights.shape == (4, 11)
    assert rows.weights.nnz == 0


def test_a_slave_that_begins_slightly_inside_is_pushed_out_by_the_nearest_facet() -> None:
    mesh = box((1.0, 1.0, 1.0), (4, 4, 4))
    rng = np.random.default_rng(9)
    inside = rng.random((100, 3))
    inside[:, 2] = 1.0 - 1e-2 * rng.random(100)
    inside[:, :2] = 0.02 + 0.96 * inside[:, :2]
    rows = crossing(mesh, inside, inside, reach=0.05)
    assert rows.gap[::3] == pytest.approx(inside[:, 2] - 1.0, abs=1e-15)


def test_at_touch_gaps_and_normals_are_those_of_the_facet_everywhere() -> None:
    """On a flat face, over corners, edges and the inside of facets alike, at distances down to zero."""
    mesh = box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4")
    axis = np.array([0.25, 0.5, 0.6, 0.75])
    flat = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    for height in (0.0, 1e-17, -1e-17, 1e-13, -1e-13, 1e-7, -1e-7):
        place = np.column_stack([flat, np.full(len(flat), 1.0 + height)])
        rows = crossing(mesh, place, place)
        assert rows.gap[::3] == pytest.approx(place[:, 2] - 1.0, abs=1e-16)
        assert rows.normal[::3] == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(flat), 1)), abs=1e-15)


def cavity(mesh: Mesh) -> ContactSurface:
    """The surface of a body turned inward."""
    return ContactSurface(facets={kind: found[:, ::-1] for kind, found in mesh.boundary().items()})


def led_back(rows: Stencils, x: np.ndarray, target: np.ndarray) -> np.ndarray:
    """The points nearest to targets where the linear conditions of all rows hold, by Hildreth's method."""
    count, dim = target.shape
    gap, normal = rows.gap.reshape(count, -1), rows.normal.reshape(count, -1, dim)
    force, y = np.zeros_like(gap), target.copy()
    for _ in range(300):
        for k in range(gap.shape[1]):
            now = np.where(np.isfinite(gap[:, k]), gap[:, k], 1e9) + np.einsum("qd,qd->q", normal[:, k], y - x)
            change = np.maximum(-now, -force[:, k])
            force[:, k] += change
            y += change[:, None] * normal[:, k]
    return y


@pytest.mark.parametrize("kept", [False, True])
@pytest.mark.parametrize("body", ["block", "disc", "ball", "box seen from inside"])
def test_iterations_on_the_linear_conditions_do_not_chatter(body: str, kept: bool) -> None:
    """Slaves are drawn to targets inside the body, some over edges and into corners; three iterations settle them."""
    rng = np.random.default_rng(10)
    mesh = {"disc": disc(1.0, 16), "ball": ball(1.0, 8)}.get(body) or box((1.0, 1.0, 1.0), (3, 3, 3))
    start = rng.normal(size=(500, mesh.dim))
    start *= (1.0 + 0.02 * rng.random(500) / np.linalg.norm(start, axis=1))[:, None] / np.linalg.norm(start, axis=1)[
        :, None
    ]
    target = 0.9 * start + 0.1 * rng.normal(size=start.shape)
    if body in ("block", "box seen from inside"):
        start = 1.4 * rng.random((1000, 3)) - 0.2
        start = start[((start < 0.0) | (start > 1.0)).any(axis=1) == (body == "block")]
        target = 0.5 + (0.8 if body == "block" else 1.3) * (start - 0.5) + 0.1 * rng.normal(size=start.shape)
    side = cavity(mesh) if body == "box seen from inside" else ContactSurface(facets=mesh.boundary())
    number = np.arange(mesh.n_nodes, mesh.n_nodes + len(start))
    x0, x = np.concatenate([mesh.points, start]), np.concatenate([mesh.points, target])
    pairing = NodeToFacet(slaves=number, side=side).meet(x0, x, 0.5)
    now = pairing.with_kept_facets(x) if kept else pairing
    moves = []
    for _ in range(4):
        after = led_back(now.at(x), x[number], target)
        moves.append(np.abs(after - x[number]).max())
        x[number] = after
    assert moves[0] > 0.05
    assert max(moves[2:]) < 1e-12
    if not kept:
        assert pairing.at(x).gap.min() > -1e-12


def test_of_three_plates_the_one_that_is_hit_first_counts_for_a_slave_over_the_last() -> None:
    """Two plates are crossed in one slab, the third one not: the slave belongs over the first one."""
    plate = box((1.0, 1.0, 0.01), (2, 2, 1))
    count, tops = plate.n_nodes, (1.0, 0.0, -1.0)
    mesh = Mesh(
        points=np.concatenate([plate.points + [0.0, 0.0, top - 0.01] for top in tops]),
        blocks={"hex8": np.concatenate([plate.blocks["hex8"] + k * count for k in range(3)])},
    )
    rows = crossing(mesh, np.array([[0.3, 0.3, 1.2]]), np.array([[0.3, 0.3, -0.9]]), reach=0.2)
    assert rows.gap[0] == pytest.approx(-1.9, abs=1e-14)
    assert rows.normal[0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-14)
    opponents = mesh.points[np.flatnonzero(rows.weights[[0]].toarray()[0, :-1])]
    assert opponents[:, 2] == pytest.approx(np.full(len(opponents), 1.0), abs=1e-14)


@pytest.mark.parametrize("own", [False, True])
def test_the_lower_corner_of_a_block_on_another_one_does_not_touch_the_walls_of_that_one(own: bool) -> None:
    """Blocks of the same width but for a hair.  The corner sinks in by far more than this hair.

    Its facets face down and to the side: they face the top of the lower block.  The wall of that block is orthogonal
    to the bottom and has the normal of the side.  A slave without a surface may touch the wall, which is nearer.
    """
    below, above = rectangle((1.0, 1.0), (2, 2)), rectangle((0.9999, 1.0), (2, 2), origin=(0.0, 1.0))
    x0 = np.concatenate([below.points, above.points])
    corner_ = below.n_nodes + above.nearest((0.9999, 1.0))
    upper = {kind: found + below.n_nodes for kind, found in above.boundary().items()}
    nodes = NodeToFacet(
        slaves=np.array([corner_]),
        side=ContactSurface(facets=below.boundary()),
        own=ContactSurface(facets=upper) if own else None,
    )
    x1 = x0.copy()
    x1[below.n_nodes :, 1] -= 0.01
    rows = nodes.meet(x0, x1, 0.1).at(x1)
    assert rows.gap[0] == pytest.approx(-0.01 if own else -1e-4, abs=1e-13)
    assert rows.normal[0] == pytest.approx([0.0, 1.0] if own else [1.0, 0.0], abs=1e-13)
    assert np.isinf(rows.gap[1])
