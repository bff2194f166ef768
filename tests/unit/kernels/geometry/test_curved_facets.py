"""Points and feet of polynomial lines and sheets."""

import numpy as np
import pytest

from softway.kernels.geometry.curved_facets import feet, monomials

LINE = np.array([[0], [1], [2]])
SHEET = np.array([[0, 0], [0, 1], [1, 0], [1, 1], [0, 2], [2, 0]])


def places(local: np.ndarray, powers: np.ndarray, terms: np.ndarray, derivative: tuple[int, ...]) -> np.ndarray:
    """Points (d, p) of facets with the coefficients (b, d, p), or their derivatives."""
    values = [f * (1.0 if v is None else v) for f, v in monomials(local, powers, derivative)]
    return np.einsum("bp,bdp->dp", np.stack([np.broadcast_to(v, local.shape[1]) for v in values]), terms)


@pytest.mark.parametrize("powers", [LINE, SHEET])
def test_derivatives_of_places(powers: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    r = powers.shape[1]
    terms, local = rng.normal(size=(len(powers), 3, 7)), rng.random((r, 7))
    step, once = 1e-5, np.eye(r, dtype=int)
    for i in range(r):
        move = step * once[i][:, None]
        for before in [(0,) * r, *map(tuple, once)]:
            ahead, behind = (places(local + s * move, powers, terms, before) for s in (1, -1))
            exact = places(local, powers, terms, tuple(np.array(before) + once[i]))
            assert np.abs((ahead - behind) / (2.0 * step) - exact).max() < 1e-9


@pytest.mark.parametrize("powers", [LINE, SHEET])
def test_a_point_lifted_off_along_the_normal_has_its_foot_there(powers: np.ndarray) -> None:
    rng = np.random.default_rng(2)
    r, p = powers.shape[1], 300
    terms = 0.1 * rng.normal(size=(len(powers), r + 1, p))
    for j in range(r):
        terms[np.flatnonzero((powers == np.eye(r)[j]).all(axis=1))[0], j] += 1.0
    local = rng.random((r, p))
    tangents = [places(local, powers, terms, tuple(np.eye(r, dtype=int)[j])) for j in range(r)]
    normal = np.array([tangents[0][1], -tangents[0][0]]) if r == 1 else np.cross(*tangents, axis=0)
    x = places(local, powers, terms, (0,) * r) + 0.2 * rng.normal(size=p) * normal / np.linalg.norm(normal, axis=0)
    found = feet(x, powers, terms, local + 0.3 * rng.normal(size=(r, p)), -5.0, 5.0)
    assert np.abs(found - local).max() < 1e-12


def test_a_foot_stops_at_the_bounds() -> None:
    terms = np.zeros((3, 2, 1))
    terms[1, 0] = 1.0
    assert feet(np.array([[7.0], [1.0]]), LINE, terms, np.full((1, 1), 0.5), -1.0, 2.0).tolist() == [[2.0]]


def test_a_foot_does_not_depend_on_the_points_beside_it() -> None:
    rng = np.random.default_rng(3)
    terms, x = rng.normal(size=(len(SHEET), 3, 40)), rng.normal(size=(3, 40))
    start = np.full((2, 40), 0.5)
    alone = [feet(x[:, [p]], SHEET, terms[:, :, [p]], start[:, [p]], -1.0, 2.0) for p in range(40)]
    assert (feet(x, SHEET, terms, start, -1.0, 2.0) == np.concatenate(alone, axis=1)).all()
