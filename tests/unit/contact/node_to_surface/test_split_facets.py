"""Quadrilaterals as triangles around their centres, and rows on them."""

import numpy as np
import pytest

from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.kept_facets import keep_facets
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.node_to_surface.split_facets import OnSplitSurface, SplitSurface
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.facet_geometry import nearest
from softway.meshes.cells import CELLS

WARPED = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.4], [2.0, 2.0, 0.0], [0.0, 2.0, 0.4], [1.0, 0.5, 0.6]])
SPLIT = SplitSurface(given=ContactSurface(facets={"quad4": np.array([[0, 1, 2, 3]])}), count=5)


def method() -> OnSplitSurface:
    return OnSplitSurface(method=NodeToFacet(slaves=np.array([4]), side=SPLIT.side, slots=1, over=True), surface=SPLIT)


def test_a_row_on_a_triangle_acts_on_the_corners_and_has_the_exact_derivative() -> None:
    found = method().meet(WARPED, WARPED, 0.5)
    rows = found.at(WARPED)
    corners = np.array([WARPED[0], WARPED[1], WARPED[:4].mean(axis=0)])
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal /= np.linalg.norm(normal)
    assert rows.gap[0] == pytest.approx(normal @ (WARPED[4] - corners[0]), rel=1e-14)
    assert rows.weights.sum() == pytest.approx(0.0, abs=1e-15)
    gradient, e = rows.gradient().toarray()[0], 1e-6
    for k in range(WARPED.size):
        shift = np.zeros(WARPED.size)
        shift[k] = e
        high, low = (found.at(WARPED + s * shift.reshape(WARPED.shape)).gap[0] for s in (1, -1))
        assert gradient[k] == pytest.approx((high - low) / (2 * e), abs=1e-9)


def test_a_node_beyond_all_triangles_has_no_row_and_a_kept_one_keeps_its_triangle() -> None:
    beyond = WARPED.copy()
    beyond[4] = [1.0, -0.1, 0.6]
    assert method().meet(beyond, beyond, 0.5).at(beyond).gap[0] == np.inf
    found = method().meet(WARPED, WARPED, 0.5)
    kept = keep_facets(found, WARPED, None)
    assert kept.at(WARPED).gap == pytest.approx(found.at(WARPED).gap, rel=1e-14)
    assert kept.at(beyond).gap[0] < np.inf


def roof(x: float, z: float, turned: bool, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (6, 3) and facets of a roof whose ridge is along x, or along y."""
    nodes = np.array([[-1, 0, 0], [1, 0, 0], [1, 1, -0.1], [-1, 1, -0.1], [-1, -1, -0.1], [1, -1, -0.1]], float)
    if turned:
        nodes = nodes[:, [1, 0, 2]] * [-1.0, 1.0, 1.0]
    nodes[:, 2] *= sign
    quads = np.array([[0, 1, 2, 3], [4, 5, 1, 0]])
    return nodes + [x, 0.0, z], quads if sign > 0 else quads[:, ::-1]


def test_smooth_ridges_that_cross_have_one_row_with_their_distance() -> None:
    """The ridges bend by eleven degrees: they are not sharp.  A valley against a ridge has no row."""
    lower, one = roof(0.0, 0.0, turned=False, sign=1.0)
    upper, two = roof(0.3, 0.05, turned=True, sign=-1.0)
    x = np.concatenate([lower, upper])
    side = ContactSurface(facets={"quad4": np.concatenate([one, two + 6])})
    assert not len(side.sharp_edges(x).ends)
    edges = side.edges()
    rows = EdgeToEdge(first=edges.subset(np.arange(1)), second=edges.subset(np.arange(1, 2)), slots=4).meet(x, x, 0.5)
    assert rows.at(x).gap == pytest.approx([0.05, np.inf, np.inf, np.inf], abs=1e-15)
    valley = x.copy()
    valley[[2, 3, 4, 5], 2] = 0.1
    assert np.isinf(rows.at(valley).gap).all()


def bent(kind: str) -> tuple[np.ndarray, SplitSurface]:
    """A curved facet of a kind, two wide, and its triangles."""
    local = CELLS[kind].nodes
    x = np.column_stack(
        [2.0 * local, 0.3 * local[:, 0] ** 2 - 0.2 * local[:, 0] * local[:, 1] + 0.1 * local[:, 1] ** 2]
    )
    given = ContactSurface(facets={kind: np.arange(len(x))[None]})
    return x, SplitSurface(given=given, count=len(x))


@pytest.mark.parametrize(("kind", "pieces"), [("tri6", 4), ("quad4", 4), ("quad8", 8), ("quad9", 8)])
def test_the_corners_of_the_triangles_are_points_of_the_facet_and_they_cover_it(kind: str, pieces: int) -> None:
    x, split = bent(kind)
    every, triangles = split.positions(x), split.flat.facets["tri3"]
    assert len(triangles) == pieces
    assert every == pytest.approx(split.means @ x, abs=1e-15)
    feet = nearest(kind, every, np.broadcast_to(x, (len(every), *x.shape)), np.zeros(0))
    assert np.abs(feet.offset).max() < 1e-12
    one, two = (every[triangles[:, k], :2] - every[triangles[:, 0], :2] for k in (1, 2))
    areas = 0.5 * (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    assert areas.min() > 0.0
    assert areas.sum() == pytest.approx(2.0 if kind == "tri6" else 4.0, rel=1e-14)
    assert len(split.flat.edges().ends) == (3 if kind == "tri6" else pieces)


def test_mixed_kinds_keep_their_order_and_their_values() -> None:
    """Linear facets first, whatever the order they are given in; nodes are on curved facets as they are."""
    facets = {"quad8": np.arange(8)[None], "quad4": np.arange(8, 12)[None], "tri6": np.arange(12, 18)[None]}
    split = SplitSurface(given=ContactSurface(facets=facets), count=18)
    assert {kind: len(f) for kind, f in split.side.facets.items()} == {"tri3": 4, "tri6": 1, "quad8": 1}
    one_two_three = np.array([[1], [2], [3]])
    assert split.of_facets(one_two_three).ravel().tolist() == [2] * 4 + [3, 1]
    assert split.of_triangles(one_two_three).ravel().tolist() == [2] * 4 + [3] * 4 + [1] * 8
    assert [sorted(set(row)) for row in split.whole.tolist()][4:] == [list(range(12, 18)), [*range(8), 19]]
    assert split.means[[18, 19]].sum(axis=1) == pytest.approx([1.0, 1.0])


def test_an_edge_on_a_spoke_of_an_eight_node_facet_has_the_exact_derivative() -> None:
    """The spoke ends at the centre: the row acts on all eight nodes, and its weights balance."""
    x, _ = bent("quad8")
    x[:, 2] *= -1.0
    roof_, quads = roof(0.0, 0.0, turned=False, sign=-1.0)
    x = np.concatenate([x, roof_ @ np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]) + [0.62, 1.1, 0.1]])
    given = ContactSurface(facets={"quad8": np.arange(8)[None], "quad4": quads + 8})
    split = SplitSurface(given=given, count=len(x))
    every = split.flat.edges()
    ridge = every.subset((every.ends >= 8).all(axis=1) & (every.ends <= 9).all(axis=1))
    spokes = every.subset((every.ends == len(x) + 2).any(axis=1))
    assert (len(ridge.ends), len(spokes.ends)) == (1, 8)
    method = OnSplitSurface(method=EdgeToEdge(first=ridge, second=spokes, slots=4), surface=split)
    found = method.meet(x, x, 0.5)
    rows = found.at(x)
    row = int(np.argmin(rows.gap))
    assert 0.0 < rows.gap[row] < 0.2
    assert rows.weights[[row]].sum() == pytest.approx(0.0, abs=1e-15)
    assert set(range(8)) <= set(rows.weights[[row]].indices.tolist())
    gradient, e = rows.gradient().toarray()[row], 1e-6
    for k in range(x.size):
        shift = np.zeros(x.size)
        shift[k] = e
        high, low = (found.at(x + s * shift.reshape(x.shape)).gap[row] for s in (1, -1))
        assert gradient[k] == pytest.approx((high - low) / (2 * e), abs=1e-8)
