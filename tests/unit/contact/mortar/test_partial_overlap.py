"""Surfaces that end above facets of the other, facets that face away, and bodies out of reach or deep in each other."""

import numpy as np
import pytest

from softway.contact.mortar.facet_pairs import facet_pairs
from softway.contact.mortar.mortar import Mortar, MortarContact
from softway.contact.stencils import Stencils
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh


def table_and_plate(edge: float, slope: float = 0.0, kind: str = "bar2") -> tuple[np.ndarray, Mortar]:
    """A plate of two facets from -1 to 1, bent by ``slope`` at 0, on a table from -1.5 to ``edge``."""
    corners = np.array([[-1.0, 0.0], [0.0, 0.0], [1.0, -slope]])
    facets = np.array([[0, 1], [1, 2]])
    if kind == "bar3":
        corners = np.concatenate([corners, [[-0.5, 0.0], [0.5, -0.5 * slope]]])
        facets = np.array([[0, 1, 3], [1, 2, 4]])
    n = len(corners)
    x = np.concatenate([corners, [[edge, 0.0], [-0.4, 0.0], [-1.5, 0.0]]])
    return x, Mortar(slave_facets={kind: facets}, master_facets={"bar2": np.array([[n, n + 1], [n + 1, n + 2]])})


def at(x: np.ndarray, mortar: Mortar) -> Stencils:
    return mortar.meet(x, x, 0.5).at(x)


@pytest.mark.parametrize("kind", ["bar2", "bar3"])
@pytest.mark.parametrize("edge", [0.9995, 1.0])
def test_the_rows_of_a_hardly_uncovered_facet_stay_those_of_nodes(edge: float, kind: str) -> None:
    """The basis is dual on the covered part: diagonal on the slave, and linear fields are met there, too."""
    x, mortar = table_and_plate(edge, kind=kind)
    rows = at(x, mortar)
    found = np.isfinite(rows.gap)
    alone = at(*table_and_plate(2.0, kind=kind))
    m = len(mortar.node)
    assert found.sum() == m - (kind == "bar3" and edge < 0.5)
    assert np.allclose(rows.weights.toarray()[found, :m], alone.weights.toarray()[found, :m], atol=1e-13)
    assert np.abs(rows.weights @ x).max() < 1e-13
    assert np.abs(rows.weights.sum(axis=1)).max() < 1e-14


@pytest.mark.parametrize("edge", [0.0, 0.02, 0.15, 0.5, 1.0])
def test_uniform_pressure_on_the_covered_part(edge: float) -> None:
    """Two-node facets: the multipliers D_jj p make up the resultant and the moment of the pressure, on both sides."""
    x, mortar = table_and_plate(edge)
    weights = at(x, mortar).weights.toarray()
    part = np.array([0.5, 0.5 + edge - 0.5 * edge**2, 0.5 * edge**2])  # integrals of the shape functions up to the edge
    forces = weights.T @ part
    assert (part >= 0.0).all()
    assert np.allclose(forces[:3].sum(), 1.0 + edge, atol=1e-14)
    assert np.allclose(forces[3:].sum(), -1.0 - edge, atol=1e-14)
    assert np.allclose(forces[:3] @ x[:3, 0], 0.5 * (edge**2 - 1.0), atol=1e-13)
    assert np.allclose(forces @ x[:, 0], 0.0, atol=1e-13)


@pytest.mark.parametrize("kind", ["bar2", "bar3"])
def test_rows_fade_in_when_a_plate_slides_over_an_edge(kind: str) -> None:
    """Nothing jumps while the covered fraction grows from nothing, and no weight is large."""
    edges = np.concatenate([np.geomspace(1e-8, 1e-3, 20), np.linspace(1e-3, 1.1, 200)])
    found = [at(*table_and_plate(edge, 0.05, kind)) for edge in edges]
    gaps = np.array([rows.gap for rows in found])
    assert np.abs(np.array([rows.weights.toarray() for rows in found])).max() < 3.0
    assert (gaps[:, 0] == gaps[0, 0]).all()
    finite = np.isfinite(gaps)
    assert (np.diff(finite.astype(int), axis=0) >= 0).all()
    went_on = finite[1:] & finite[:-1]
    assert np.abs(gaps[1:][went_on] - gaps[:-1][went_on]).max() < 0.01


@pytest.mark.parametrize("width", [1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.3])
@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_slivers_in_the_middle_of_a_facet(width: float, turn: float) -> None:
    """A narrow stripe on a four-node facet: bounded weights that add up to zero, linear fields met.

    The corners of the stripe carry a rounding of eps, which is eps / width of the stripe; over random places and turns
    linear fields are met to 1.3 eps / width at worst, at every width.
    """
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [1.2, 1.0, 0.0], [0.1, 0.9, 0.0]])
    stripe = np.array([[-0.5, -1.0, 0.0], [-0.5, 1.0, 0.0], [0.5, 1.0, 0.0], [0.5, -1.0, 0.0]]) * np.array(
        [width, 1.0, 1.0]
    )
    c, s = np.cos(turn), np.sin(turn)
    stripe = stripe @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + np.array([0.6, 0.5, 0.0])
    x = np.concatenate([square, stripe])
    mortar = Mortar(slave_facets={"quad4": np.array([[0, 1, 2, 3]])}, master_facets={"quad4": np.array([[4, 5, 6, 7]])})
    rows = at(x, mortar)
    weights = rows.weights.toarray()
    assert np.isfinite(rows.gap).all()
    assert np.abs(weights).max() < 2.0 + 2.0 / max(width, 0.02)
    assert np.abs(weights.sum(axis=1)).max() < 1e-13
    assert np.abs(weights @ x).max() < 10.0 * np.finfo(float).eps / width


def stacked(sizes: tuple[float, float], thickness: float, dim: int) -> tuple[np.ndarray, Mortar, Mesh]:
    """Two plates, 0.01 apart, of one and two cells a side; all facets of their surfaces take part."""
    meshes = []
    for k, size in enumerate(sizes):
        low = k * (thickness + 0.01)
        if dim == 2:
            meshes.append(rectangle((size, thickness), (k + 1, 1), origin=(0.0, low)))
        else:
            meshes.append(box((size, size, thickness), (k + 1, k + 1, 1), origin=(0.0, 0.0, low)))
    below, above = meshes
    x = np.concatenate([below.points, above.points])
    slave = {kind: facets + below.n_nodes for kind, facets in above.boundary().items()}
    return x, Mortar(slave_facets=slave, master_facets=below.boundary()), below


@pytest.mark.parametrize("dim", [2, 3])
def test_only_facets_that_face_each_other_have_rows(dim: int) -> None:
    """Thin plates with their whole surfaces: far sides are not behind anything, edges have the normal of the face."""
    x, mortar, below = stacked((1.0, 1.0), 0.15, dim)
    for reach in (0.1, 0.5):  # the far sides, turned to each other at a depth of 0.31, are within the second
        rows = mortar.meet(x, x, reach).at(x)
        found = np.isfinite(rows.gap)
        assert np.array_equal(found, x[mortar.node, -1] < 0.17)
        assert np.allclose(rows.gap[found], 0.01, atol=1e-14)
        assert np.allclose(rows.normal[found], np.eye(dim)[-1], atol=1e-14)
        assert (np.diff(rows.weights.indptr)[~found] == 0).all()


@pytest.mark.parametrize(("depth", "seen"), [(0.1, True), (0.19, True), (0.21, False), (0.4, False)])
@pytest.mark.parametrize("dim", [2, 3])
def test_an_initial_overlap_has_rows_unless_it_is_as_deep_as_a_body(dim: int, depth: float, seen: bool) -> None:
    """Up to a fifth of the longest edge: beyond that the face of a plate would see the far face of one behind it."""
    x, mortar, below = stacked((1.0, 1.0), 0.8, dim)
    x[below.n_nodes :, -1] -= 0.01 + depth
    gap = mortar.meet(x, x, 0.5).at(x).gap
    bottom = x[mortar.node, -1] < 0.81
    assert np.array_equal(np.isfinite(gap), bottom & seen)
    assert np.allclose(gap[bottom & seen], -depth, atol=1e-13)


@pytest.mark.parametrize("dim", [2, 3])
def test_deep_overlaps_on_the_way_have_negative_gaps(dim: int) -> None:
    x, mortar, below = stacked((1.0, 1.0), 0.5, dim)
    down = np.zeros_like(x)
    down[below.n_nodes :, -1] = -1.0
    pairing = mortar.meet(x, x + 0.2 * down, 0.1)
    for depth in (0.1, 0.4, 1.5):
        gap = pairing.at(x + (0.01 + depth) * down).gap
        assert np.allclose(gap[np.isfinite(gap)], -depth, atol=1e-13)
        assert np.isfinite(gap).sum() == (3 if dim == 2 else 9)


@pytest.mark.parametrize("dim", [2, 3])
def test_what_is_out_of_reach_has_no_gap(dim: int) -> None:
    x, mortar, below = stacked((1.0, 1.0), 0.5, dim)
    apart, beside = np.zeros_like(x), np.zeros_like(x)
    apart[below.n_nodes :, -1], beside[below.n_nodes :, 0] = 0.3, 1.3
    pairing: MortarContact = mortar.meet(x + apart, x + apart, 0.2)
    assert np.isinf(pairing.at(x + apart).gap).all()
    assert pairing.at(x).weights.nnz == 0
    assert np.isinf(mortar.meet(x + beside, x + beside, 0.2).at(x + beside).gap).all()
    assert np.isfinite(mortar.meet(x + apart, x, 0.2).at(x).gap).any()


def test_a_smaller_block_on_a_larger_one_and_the_reverse() -> None:
    for sizes in ((1.0, 0.45), (0.45, 1.0)):
        x, mortar, _ = stacked(sizes, 0.5, 3)
        rows = mortar.meet(x, x, 0.1).at(x)
        found = np.isfinite(rows.gap)
        assert np.allclose(rows.gap[found], 0.01, atol=1e-13)
        assert found.sum() == (9 if sizes[0] > sizes[1] else 4)


@pytest.mark.parametrize("turn", [0.0, 0.7, -2.0])
@pytest.mark.parametrize("depth", [0.1, 0.19, 0.23, 0.6])
def test_a_leaning_facet_beside_another_stays_a_pair_however_far_behind_its_plane(depth: float, turn: float) -> None:
    """Facets of two coarse round bodies in contact: the bodies roll, and the line of the slave passes a corner."""
    turned = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    slave = turned @ np.array([[0.0, 1.0], [0.0, 0.0]])  # outward is down
    master = turned @ np.array([[2.05, 1.62], [depth + 0.61, depth]])
    for thickness, kept in ((np.inf, True), (0.3, depth <= 0.15)):
        pair = facet_pairs((slave[:, :, None],) * 2, (master[:, :, None],) * 2, 1.0, (thickness, thickness))
        assert len(pair.slave) == kept
