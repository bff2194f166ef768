"""Sharp edges against sharp edges."""

import numpy as np
import pytest

from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.surfaces.boundary import ContactSurface
from softway.meshes.generators.shapes import box
from softway.meshes.mesh import Mesh


def turned(mesh: Mesh, turn: np.ndarray, shift: tuple[float, float, float]) -> np.ndarray:
    """Points of a mesh about its centre, turned and shifted."""
    return (mesh.points - mesh.points.mean(axis=0)) @ turn.T + np.array(shift)


def rotation(axis: int, angle: float) -> np.ndarray:
    """A turn about one of the axes."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(3)
    out[[i, i, j, j], [i, j, i, j]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    return out


ROOF = rotation(0, 0.25 * np.pi)
"""A long block along x that stands on one of its long edges."""


def crossed(
    height: float, cell: str = "hex8", twist: float = 0.3
) -> tuple[np.ndarray, EdgeToEdge, tuple[ContactSurface, ContactSurface]]:
    """Two long blocks on edge, one over the other, their nearest edges ``height`` apart."""
    mesh = box((4.0, 1.0, 1.0), (3, 1, 1), cell=cell)
    lower = turned(mesh, ROOF, (0.0, 0.0, -np.sqrt(0.5)))
    upper = turned(mesh, rotation(2, 0.5 * np.pi + twist) @ ROOF, (0.1, 0.2, np.sqrt(0.5) + height))
    x = np.concatenate([lower, upper])
    low, high = (
        ContactSurface(facets={kind: found + first for kind, found in mesh.boundary().items()})
        for first in (0, mesh.n_nodes)
    )
    return x, EdgeToEdge(first=high.sharp_edges(x), second=low.sharp_edges(x)), (high, low)


@pytest.mark.parametrize("cell", ["hex8", "tet4", "hex20", "hex27", "tet10"])
@pytest.mark.parametrize("height", [0.1, 1e-9, 0.0, -1e-9, -0.05])
def test_the_crossing_edges_of_two_blocks_are_found(cell: str, height: float) -> None:
    x0, edges, _ = crossed(0.2, cell)
    x1 = crossed(height, cell)[0]
    pairing = edges.meet(x0, x1, 0.11)
    rows = pairing.at(x1)
    found = np.flatnonzero(np.isfinite(rows.gap))
    assert len(found) == 1
    assert rows.gap[found[0]] == pytest.approx(height, abs=1e-14)
    assert rows.normal[found[0]] == pytest.approx(np.array([0.0, 0.0, 1.0]), abs=1e-14)
    assert rows.weights.sum() == pytest.approx(0.0, abs=1e-15)
    assert (rows.weights @ x1)[found[0]] == pytest.approx(np.array([0.0, 0.0, height]), abs=1e-14)
    assert rows.weights[found][:, [edges.node[found[0]]]].toarray() > 0.0


def test_rows_of_nodes_miss_the_touch_of_two_edges() -> None:
    x0, _, (high, low) = crossed(0.2)
    x1 = crossed(-0.05)[0]
    for slaves, side in ((high, low), (low, high)):
        rows = NodeToFacet(slaves=slaves.nodes, side=side).meet(x0, x1, 1e-3).at(x1)
        assert rows.gap.min() > 0.5


@pytest.mark.parametrize("flat", [False, True])
def test_flat_blocks_laid_crosswise_touch_at_four_crossings(flat: bool) -> None:
    """One cell each, no node of one over the other: the four crossings carry the upper block."""
    mesh = box((4.0, 1.0, 1.0), (1, 1, 1))
    tilt = np.eye(3) if flat else rotation(1, 1e-4)
    x = np.concatenate(
        [turned(mesh, np.eye(3), (0.0, 0.0, -0.5)), turned(mesh, tilt @ rotation(2, 0.5 * np.pi), (0.0, 0.0, 0.51))]
    )
    low, high = (ContactSurface(facets={"quad4": mesh.boundary()["quad4"] + first}) for first in (0, 8))
    edges = EdgeToEdge(first=high.sharp_edges(x), second=low.sharp_edges(x))
    for slaves, side in ((high, low), (low, high)):
        assert NodeToFacet(slaves=slaves.nodes, side=side).meet(x, x, 0.1).at(x).gap.min() > 0.1
    rows = edges.meet(x, x, 0.1).at(x)
    gap = np.sort(rows.gap[np.isfinite(rows.gap)])
    assert len(gap) == 2  # two lower edges of the upper block, each with the nearest of two edges
    assert gap == pytest.approx([0.01, 0.01], abs=1e-15) if flat else (np.abs(gap - 0.01) < 1e-4).all()
    swapped = EdgeToEdge(first=edges.second, second=edges.first).meet(x, x, 0.1).at(x)
    assert np.isfinite(swapped.gap).sum() == 2


def test_rows_are_the_derivatives_of_the_gaps() -> None:
    rng = np.random.default_rng(1)
    x0, edges, _ = crossed(0.2)
    x = crossed(0.02)[0] + 0.05 * rng.normal(size=x0.shape)
    pairing = edges.meet(x0, x, 0.1)
    way, h = rng.normal(size=x.shape), 1e-6
    rows = pairing.at(x)
    found = np.isfinite(rows.gap)
    quotient = (pairing.at(x + h * way).gap[found] - pairing.at(x - h * way).gap[found]) / (2.0 * h)
    assert found.sum() == 1
    assert np.einsum("md,md->m", rows.normal, rows.weights @ way)[found] == pytest.approx(quotient, abs=1e-8)


def test_gaps_are_invariant_under_rigid_motions() -> None:
    x0, edges, _ = crossed(0.2)
    x1 = crossed(-0.03)[0]
    turn = rotation(0, 0.7) @ rotation(1, -1.1) @ rotation(2, 2.3)
    before, after = (edges.meet(x0 @ q.T, x1 @ q.T, 0.05).at(x1 @ q.T) for q in (np.eye(3), turn))
    found = np.isfinite(before.gap)
    assert np.array_equal(found, np.isfinite(after.gap))
    assert after.gap[found] == pytest.approx(before.gap[found], abs=1e-14)
    assert after.normal[found] == pytest.approx((before.normal @ turn.T)[found], abs=1e-14)


def test_a_deep_crossing_in_one_slab_is_seen_and_bodies_apart_are_not() -> None:
    x0, edges, _ = crossed(0.2)
    rows = edges.meet(x0, crossed(-0.6)[0], 1e-3).at(crossed(-0.6)[0])
    assert rows.gap.min() == pytest.approx(-0.6, abs=1e-14)
    x = crossed(-4.0)[0]  # the other block has been below all the time
    assert not (edges.meet(x, x, 5.0).at(x).gap < 0.0).any()


def test_parallel_edges_and_ends_are_left_to_the_nodes() -> None:
    x0, edges, _ = crossed(0.01, twist=0.5 * np.pi)
    assert edges.meet(x0, x0, 0.1).at(x0).gap.min() > 0.1
    x0, edges, _ = crossed(0.01)
    x0[len(x0) // 2 :] += np.array([3.0, 0.0, 0.0])
    assert np.isinf(edges.meet(x0, x0, 0.1).at(x0).gap).all()


@pytest.mark.parametrize(("sine", "touch"), [(-0.5, True), (0.0, True), (0.05, True), (0.2, False), (0.9, False)])
def test_an_edge_that_leans_over_a_face_touches_it_with_its_end_and_not_the_rim(sine: float, touch: bool) -> None:
    """The edges of a beam along y cross the rim y = 0 of a plate, 0.5 above it, and lean by an angle a over its face.

    The common normal is (0, sin a, cos a); the normals around the rim reach from -y to z, so that its share along -y is
    -sin a.  A tenth is let pass, for flat blocks that rock; beyond it the edges run into the face, behind the rim.
    """
    plate, beam = box((4.0, 4.0, 1.0), (1, 1, 1)), box((1.0, 4.0, 1.0), (1, 1, 1))
    about = np.array([0.0, 0.0, 0.5])  # of the beam: a point midway between its two lower edges
    leaning = (beam.points - beam.points.mean(axis=0) + about) @ rotation(0, -np.arcsin(sine)).T + about
    x = np.concatenate([turned(plate, np.eye(3), (0.0, 2.0, -0.5)), leaning])
    low, high = (
        ContactSurface(facets={"quad4": mesh.boundary()["quad4"] + first}) for mesh, first in ((plate, 0), (beam, 8))
    )
    for one, two, sign in ((high, low, 1.0), (low, high, -1.0)):
        rows = EdgeToEdge(first=one.sharp_edges(x), second=two.sharp_edges(x)).meet(x, x, 1.0).at(x)
        rim = np.isfinite(rows.gap) & (sign * rows.normal[:, 2] > 0.1)
        assert rim.any() == touch
        assert rows.gap[rim] == pytest.approx(np.full(rim.sum(), 0.5 * np.sqrt(1.0 - sine**2)), abs=1e-14)
        assert sign * rows.normal[rim] == pytest.approx(
            np.tile([0.0, sine, np.sqrt(1.0 - sine**2)], (rim.sum(), 1)), abs=1e-14
        )


@pytest.mark.parametrize("twist", [0.02, -0.02])
def test_edges_that_begin_parallel_cross_in_front_and_never_through_a_body(twist: float) -> None:
    """The upper and the lower edge of a block are apart by its height, but not in front of each other."""
    mesh, side = box((4.0, 1.0, 1.0), (3, 1, 1)), ContactSurface(facets=box((4.0, 1.0, 1.0), (3, 1, 1)).boundary())
    low = turned(mesh, ROOF, (0.0, 0.0, -np.sqrt(0.5)))
    high, later = (turned(mesh, rotation(2, t) @ ROOF, (0.1, 0.0, np.sqrt(0.5) + 0.1)) for t in (0.0, twist))
    x0, x1 = np.concatenate([low, high]), np.concatenate([low, later])
    above = ContactSurface(facets={kind: found + len(low) for kind, found in side.facets.items()})
    ahead = EdgeToEdge(first=above.sharp_edges(x0), second=side.sharp_edges(x0)).meet(x0, x1, 0.2).at(x1)
    assert ahead.gap.min() == pytest.approx(0.1, abs=1e-12)
    bent = low.copy()
    bent[:, 1] += twist * low[:, 0] * low[:, 2]
    own = side.sharp_edges(low)
    assert not np.isfinite(EdgeToEdge(first=own, second=own).meet(low, bent, 2.0).at(bent).gap).any()
