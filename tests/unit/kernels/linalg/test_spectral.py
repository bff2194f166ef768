"""Principal values and axes."""

import numpy as np
import pytest

from softway.kernels.linalg.spectral import moduli_in_axes, of_principal, principal
from softway.kernels.linalg.tensors import isotropic

TENSORS = np.array(
    [
        [[2.0, 0.3, -0.1], [0.3, 1.0, 0.4], [-0.1, 0.4, -0.5]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[1e-9, 2e-9, 0.0], [2e-9, 1e-9, 0.0], [0.0, 0.0, -3e-9]],
    ]
)


def test_values_and_axes_make_the_tensor_again():
    again = of_principal(*principal(TENSORS))
    assert np.all(np.abs(again - TENSORS) <= 4e-15 * np.abs(TENSORS).max(axis=(1, 2))[:, None, None])


def test_nan_stays_nan_and_changes_no_other_tensor():
    T = TENSORS.copy()
    T[1, 0, 0] = np.nan
    values, axes = principal(T)
    assert np.isnan(values[1]).all() and np.isfinite(axes).all()
    assert np.array_equal(values[0], principal(TENSORS[0])[0])


@pytest.mark.parametrize("turn", [0, 1, 2])
def test_isotropic_moduli_are_the_same_in_all_axes(turn):
    axes = principal(TENSORS)[1][turn]
    C = moduli_in_axes(3.0 + 4.0 * np.eye(3), np.full((3, 3), 4.0), axes)
    assert np.allclose(C, isotropic(3.0, 2.0), rtol=0.0, atol=2e-14)
