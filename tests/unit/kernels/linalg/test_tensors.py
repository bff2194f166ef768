"""Tensor helpers against numpy."""

import numpy as np
import pytest

from softway.kernels.linalg import tensors


@pytest.fixture
def symmetric() -> np.ndarray:
    T = np.random.default_rng(1).standard_normal((4, 5, 3, 3))
    return tensors.symmetric(T) + 3.0 * np.eye(3)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_determinant(m: int) -> None:
    T = np.random.default_rng(m).standard_normal((7, m, m))
    assert np.allclose(tensors.determinant(T), np.linalg.det(T), rtol=1e-13)


def test_inverse_is_symmetric_to_the_last_digit(symmetric: np.ndarray) -> None:
    inverse = tensors.symmetric_inverse(symmetric)
    assert np.allclose(inverse, np.linalg.inv(symmetric), rtol=1e-12)
    assert np.array_equal(inverse, np.swapaxes(inverse, -1, -2))


def test_second_invariant(symmetric: np.ndarray) -> None:
    trace = tensors.trace(symmetric)
    expected = 0.5 * (trace**2 - tensors.double_dot(symmetric, symmetric))
    assert np.allclose(tensors.second_invariant(symmetric), expected, rtol=1e-13)


def test_square_symmetric_is_the_derivative_of_the_inverse(symmetric: np.ndarray) -> None:
    change = tensors.symmetric(np.random.default_rng(2).standard_normal((3, 3)))
    step = 1e-5
    slope = (np.linalg.inv(symmetric + step * change) - np.linalg.inv(symmetric - step * change)) / (2.0 * step)
    derivative = -np.einsum("...ijkl,kl->...ij", tensors.square_symmetric(tensors.symmetric_inverse(symmetric)), change)
    assert np.allclose(derivative, slope, rtol=0.0, atol=1e-8 * np.abs(slope).max())


def test_isotropic_moduli_give_the_stress_of_hooke() -> None:
    e = tensors.symmetric(np.random.default_rng(3).standard_normal((3, 3)))
    stress = np.einsum("ijkl,kl->ij", tensors.isotropic(2.0, 3.0), e)
    assert np.allclose(stress, 2.0 * np.trace(e) * np.eye(3) + 6.0 * e, rtol=1e-14)
