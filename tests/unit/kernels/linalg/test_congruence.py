"""Congruence of a dense matrix by sparse rows: whole numbers exactly, others as by sparse products."""

import numpy as np
import pytest
import scipy.sparse as sp

from softway.kernels.linalg.congruence import WIDTH, congruence, congruence_of_columns

SIZES = [(0, 0), (1, 1), (3, 7), (WIDTH, WIDTH), (WIDTH + 1, 2 * WIDTH - 1), (150, 40)]


def case(k: int, b: int, whole: bool) -> tuple[sp.csr_array, np.ndarray]:
    """Rows (k, b) with a third of their entries, and a matrix (b, b) that is not symmetric."""
    rng = np.random.default_rng(k + b)
    entries, matrix = (
        rng.integers(-9, 10, shape) + (0.0 if whole else rng.random(shape)) for shape in ((k, b), (b, b))
    )
    return sp.csr_array(entries * (rng.random((k, b)) < 0.3)), np.asarray(matrix, float)


@pytest.mark.parametrize(("k", "b"), SIZES)
@pytest.mark.parametrize("order", ["C", "F"])
def test_whole_numbers_are_exact(k: int, b: int, order: str) -> None:
    rows, matrix = case(k, b, whole=True)
    dense = rows.toarray()
    assert np.array_equal(congruence(rows, np.asarray(matrix, order=order)), dense @ matrix @ dense.T)


@pytest.mark.parametrize(("k", "b"), SIZES)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_other_numbers_are_as_by_sparse_products(k: int, b: int, kind: type) -> None:
    rows, matrix = case(k, b, whole=False)
    matrix = matrix.astype(kind)
    expected = (rows @ matrix) @ rows.T
    np.testing.assert_allclose(congruence(rows, matrix), expected, rtol=0.0, atol=1e-9)


def test_rows_may_have_their_entries_in_any_order() -> None:
    rows = sp.csr_array((np.array([2.0, 1.0]), np.array([1, 0]), np.array([0, 2])), shape=(1, 2))
    assert congruence(rows, np.array([[1.0, 0.5], [0.5, 3.0]])).tolist() == [[15.0]]


def test_columns_of_two_bodies_in_any_order() -> None:
    """The compliance of two bodies: its columns are zero on the other body."""
    rng = np.random.default_rng(5)
    sizes = WIDTH + 6, 2 * WIDTH - 3
    matrix = np.zeros((sum(sizes),) * 2)
    for part in (slice(0, sizes[0]), slice(sizes[0], sum(sizes))):
        half = rng.integers(-3, 4, (part.stop - part.start,) * 2)
        matrix[part, part] = half + half.T
    dense = rng.integers(-2, 3, (7, sum(sizes))) * (rng.random((7, sum(sizes))) < 0.2)
    order = rng.permutation(len(matrix))
    place = np.argsort(order)
    extent = np.where(order[:, None] < sizes[0], [0, sizes[0]], [sizes[0], sum(sizes)])
    stored = matrix[order]
    rows = sp.csr_array(dense.astype(float))
    assert np.array_equal(congruence_of_columns(rows, stored, place, extent), dense @ matrix @ dense.T)
    assert np.array_equal(congruence_of_columns(rows, stored, place), dense @ matrix @ dense.T)
