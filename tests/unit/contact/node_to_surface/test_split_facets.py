"""Quadrilaterals as triangles around their centres, and rows on them."""

import numpy as np
import pytest

from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.kept_facets import keep_facets
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.node_to_surface.split_facets import OnSplitSurface, SplitSurface
from softway.contact.surfaces.boundary import ContactSurface

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
