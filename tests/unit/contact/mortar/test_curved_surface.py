"""Curved surfaces above their simplices: circles, spheres, kinks, flat and nearly flat facets, and their motion."""

import numpy as np
import pytest
from curved_shapes import Surface, arc, cap

from softway.contact.mortar.bulges import bulges
from softway.contact.mortar.curved_surface import curved_surface, forms
from softway.contact.mortar.linear_surface import LINEAR, linear_surface
from softway.kernels.mortar.simplices import vector_areas
from softway.meshes.generators.shapes import box

CURVED = sorted(set(LINEAR) - {"bar2", "bar3"})
POINTS = {
    2: [(1.0, 0.0), (0.5, 0.5), (0.25, 0.75)],
    3: [(1.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.2, 0.3, 0.5), (0.0, 0.0, 1.0)],
}


def off_unit(surface: Surface) -> np.ndarray:
    """Distances from the unit circle or sphere of points on the curved surface over each simplex (p, points)."""
    x, facets = surface
    made = linear_surface(facets)
    curved, vertices = curved_surface(made, facets, x), made.spread @ (made.control @ x[made.node])
    form = forms(curved.offsets @ x, vertices, made.corner) + curved.fixed
    areas = vector_areas(vertices, made.corner)
    normal = areas / np.linalg.norm(areas, axis=1, keepdims=True)
    found = []
    for at in map(np.array, POINTS[x.shape[1]]):
        height = np.einsum("a,pab,b->p", at, form, at)
        found.append(at @ vertices[made.corner] + height[:, None] * normal)
    found = np.stack(found, axis=1)
    return np.abs(np.linalg.norm(found, axis=2) - 1.0)


@pytest.mark.parametrize("kind", ["bar2", "bar3"])
def test_circle_is_met_to_fourth_order(kind: str) -> None:
    errors = [off_unit(arc(kind, n, 1.0, (0.2, 1.4), 1.0)).max() for n in (4, 8, 16)]
    assert np.log2(errors[0] / errors[2]) / 2.0 > 3.5
    assert errors[1] < 0.005 * (1.2 / 8) ** 2 / 8.0 * (5.0 if kind == "bar2" else 1.0)


@pytest.mark.parametrize("kind", CURVED)
def test_sphere_is_met_to_third_order_in_the_mean(kind: str) -> None:
    """At a rim that ends on the sphere fewer facets tell the curvature."""
    errors = [off_unit(cap(kind, n, 1.0, 0.35, 1.0)) for n in (3, 6, 12)]
    assert np.log2(errors[0].mean() / errors[2].mean()) / 2.0 > 2.5
    assert errors[2].max() < 0.5 * (0.7 / 12) ** 2 / 8.0


def test_uneven_facets_meet_the_circle() -> None:
    turn = np.cumsum([0.0, 0.1, 0.15, 0.1, 0.2, 0.12])
    x = np.column_stack([np.cos(turn), np.sin(turn)])
    found = bulges({"bar2": np.stack([np.arange(5), np.arange(1, 6)], axis=1)}, x)["bar2"] @ x
    exact = 1.0 - np.cos(0.5 * np.diff(turn))
    assert np.linalg.norm(found, axis=1) == pytest.approx(exact, rel=0.02)


def test_facets_beside_a_kink_are_flat() -> None:
    """Two straight sides that meet at 20 degrees, less than a sharp corner."""
    turn = np.deg2rad(20.0)
    side = np.arange(4.0)[:, None]
    x = np.concatenate([side[::-1] * [-1.0, 0.0], side[1:] * [np.cos(turn), np.sin(turn)]])
    found = bulges({"bar2": np.stack([np.arange(6), np.arange(1, 7)], axis=1)}, x)["bar2"] @ x
    assert np.abs(found).max() < 1e-15


@pytest.mark.parametrize("around", [1, 3])
def test_side_of_a_disc_is_curved_between_its_sharp_rims(around: int) -> None:
    """The side of a thick ring, one facet high or more, in one surface with its flat faces."""
    mesh = box((0.2, 0.5 * np.pi, 0.3), (2, 24, around))
    x, y, z = mesh.points.T
    points = np.column_stack([(0.8 + x) * np.cos(y), (0.8 + x) * np.sin(y), z])
    facets = {"quad4": mesh.facets_on("surface")["quad4"]}
    offset = (curved_surface(linear_surface(facets), facets, points).offsets @ points).reshape(
        len(facets["quad4"]), 4, 6, 3
    )
    outer = (np.hypot(*points[facets["quad4"], :2].transpose(2, 0, 1)) > 0.99).all(axis=1)
    level = np.ptp(points[facets["quad4"], 2], axis=1) < 1e-9
    sagitta = 1.0 - np.cos(np.pi / 96)
    assert np.linalg.norm(offset[outer][:, :, 2], axis=2) == pytest.approx(sagitta, rel=0.02)
    assert np.abs(offset[level][..., 2]).max() < 1e-15


@pytest.mark.parametrize("kind", sorted(LINEAR))
def test_flat_surfaces_have_no_offsets_and_nearly_flat_ones_hardly_any(kind: str) -> None:
    x, facets = arc(kind, 6, 1.0, (0.2, 1.4), 1.0) if kind in ("bar2", "bar3") else cap(kind, 4, 1.0, 0.35, 1.0)
    x = x.copy()
    x[:, -1] = 0.0 if kind in ("bar2", "bar3") else 1.0
    made = linear_surface(facets)
    assert curved_surface(made, facets, x).flat
    moved = x + 1e-8 * np.random.default_rng(1).standard_normal(x.shape)
    found = curved_surface(made, facets, moved)
    assert np.abs(found.offsets.toarray()).max() < 1e-4
    assert np.abs(found.fixed).max() < 1e-11


@pytest.mark.parametrize("kind", ["bar2", "tri3", "quad4"])
def test_offsets_turn_and_grow_with_the_body(kind: str) -> None:
    x, facets = arc(kind, 6, 1.0, (0.2, 1.4), 1.0) if kind == "bar2" else cap(kind, 4, 1.0, 0.35, 1.0)
    made = curved_surface(linear_surface(facets), facets, x).offsets
    turn, _ = np.linalg.qr(np.random.default_rng(2).standard_normal((x.shape[1], x.shape[1])))
    shift = np.arange(x.shape[1])
    assert made @ (1.3 * x @ turn + shift) == pytest.approx(1.3 * (made @ x) @ turn, abs=1e-14)


def test_round_facets_that_are_pressed_flat_have_no_offsets() -> None:
    x, facets = arc("bar2", 8, 1.0, (0.2, 1.4), 1.0)
    made = curved_surface(linear_surface(facets), facets, x).offsets
    length = np.linalg.norm(np.diff(x, axis=0), axis=1)
    flat = np.column_stack([np.cumsum(np.append(0.0, length)), np.zeros(len(x))])
    assert np.abs(made @ flat).max() < 1e-15 < np.abs(made @ x).max()
