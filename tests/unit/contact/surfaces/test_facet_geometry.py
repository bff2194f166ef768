"""Every kind of facet: closest points, normals, and continuation beyond the edges."""

import numpy as np
import pytest

from softway.contact.surfaces.facet_geometry import continued, kind_of, nearest, normals, on_facets
from softway.meshes.cells import CELLS
from softway.meshes.element import tabulate

KINDS = ("bar2", "bar3", "tri3", "tri6", "quad4", "quad8", "quad9")
NONE = np.zeros(0)


def _facets(kind: str, count: int, seed: int, wild: float = 0.05) -> tuple[np.ndarray, np.ndarray]:
    """Points around distorted facets, and the nodes of these."""
    rng = np.random.default_rng(seed)
    reference = CELLS[kind].nodes
    r = reference.shape[1]
    flat = np.concatenate([reference, np.zeros((len(reference), 1))], axis=1)
    nodes = flat + wild * rng.normal(size=(count, *flat.shape))
    x = np.concatenate([1.6 * rng.random((count, r)) - 0.3, 0.2 * rng.normal(size=(count, 1))], axis=1)
    return x, nodes


def _lattice(kind: str, steps: int) -> np.ndarray:
    axis = np.linspace(0.0, 1.0, steps)
    points = np.stack(np.meshgrid(*[axis] * CELLS[kind].dim), axis=-1).reshape(-1, CELLS[kind].dim)
    return points[points.sum(axis=1) <= 1.0 + 1e-12] if CELLS[kind].simplex else points


@pytest.mark.parametrize("kind", KINDS)
def test_shape_functions_are_those_of_the_elements(kind: str) -> None:
    r = CELLS[kind].dim
    local = np.random.default_rng(1).random((20, r))
    N, dN = tabulate(kind, local)
    assert np.abs(kind_of(kind).shapes(local, (0,) * r) - N).max() < 1e-13
    for i in range(r):
        assert np.abs(kind_of(kind).shapes(local, tuple(np.eye(r, dtype=int)[i])) - dN[:, :, i]).max() < 1e-13


@pytest.mark.parametrize("kind", KINDS)
def test_no_point_of_the_facet_is_closer(kind: str) -> None:
    x, nodes = _facets(kind, 300, seed=3)
    feet = nearest(kind, x, nodes, NONE)
    found = np.linalg.norm(feet.offset, axis=1)
    there = np.einsum("gb,pbd->pgd", kind_of(kind).shapes(_lattice(kind, 81), (0,) * CELLS[kind].dim), nodes)
    assert (found - np.linalg.norm(there - x[:, None], axis=2).min(axis=1)).max() < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_closest_points_are_stationary_and_in_the_facet(kind: str) -> None:
    x, nodes = _facets(kind, 500, seed=4)
    local = on_facets(kind, x, nodes)
    far = local.sum(axis=1) if CELLS[kind].simplex else local.max(axis=1)
    assert local.min() >= 0.0
    assert far.max() <= 1.0 + 1e-15
    feet = nearest(kind, x, nodes, NONE)
    inside = (local.min(axis=1) > 1e-9) & (far < 1.0 - 1e-9)
    sideways = feet.offset - np.einsum("pd,pd->p", feet.offset, feet.normal)[:, None] * feet.normal
    assert inside.sum() > 80
    assert np.linalg.norm(sideways[inside], axis=1).max() < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_feet_on_continued_facets_are_stationary(kind: str) -> None:
    x, nodes = _facets(kind, 500, seed=5)
    feet = continued(kind, x, nodes, NONE)
    height = np.einsum("pd,pd->p", feet.offset, feet.normal)
    assert np.abs(feet.offset - height[:, None] * feet.normal).max() < 1e-12
    assert np.abs(feet.shapes.sum(axis=1) - 1.0).max() < 1e-12
    assert np.abs(x - np.einsum("pb,pbd->pd", feet.shapes, nodes) - feet.offset).max() < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_normals_point_out_of_the_anticlockwise_side(kind: str) -> None:
    r = CELLS[kind].dim
    flat = np.concatenate([CELLS[kind].nodes, np.zeros((len(CELLS[kind].nodes), 1))], axis=1)[None]
    found = normals(kind, flat, np.full((1, r), 0.3))[0]
    assert found == pytest.approx(np.array([0.0, -1.0] if r == 1 else [0.0, 0.0, 1.0]), abs=1e-15)


def test_a_point_facet_is_its_own_closest_point() -> None:
    feet = nearest("point1", np.array([[3.0]]), np.array([[[1.0]]]), np.array([-1.0]))
    assert (feet.shapes.tolist(), feet.offset.tolist(), feet.normal.tolist()) == ([[1.0]], [[2.0]], [[-1.0]])
