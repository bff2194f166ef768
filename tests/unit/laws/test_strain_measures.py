"""Strain measures."""

import numpy as np
import pytest

from softway.laws.strain_measures import Green, Small

H = np.array([[0.1, 0.2, -0.1], [0.0, -0.1, 0.3], [0.05, 0.1, 0.2]])  # rows are du/dX_J


def test_green_is_half_of_the_change_of_the_metric() -> None:
    F = (np.eye(3) + H).T
    assert np.allclose(Green().strain(H, np.eye(3)), 0.5 * (F.T @ F - np.eye(3)), atol=1e-16)


def test_small_is_the_symmetric_part() -> None:
    assert np.allclose(Small().strain(H, np.eye(3)), 0.5 * (H + H.T), atol=1e-17)


@pytest.mark.parametrize("measure", [Small(), Green()])
def test_ratio_is_the_determinant(measure: Small | Green) -> None:
    E = measure.strain(H, np.eye(3))
    assert measure.ratio(H, np.eye(3), E) == pytest.approx(np.linalg.det(np.eye(3) + H), rel=1e-15)


def test_ratio_of_a_bar_in_space_is_stretch_times_lateral_stretches() -> None:
    direction, derivative = np.array([[0.6, 0.8]]), np.array([[0.2, 0.1]])
    E = np.diag([float(Green().strain(derivative, direction)[0, 0]), -0.1, -0.1])
    expected = np.linalg.norm(direction + derivative) * (1.0 - 0.2)
    assert Green().ratio(derivative, direction, E) == pytest.approx(expected, rel=1e-15)


def test_inversion_is_inadmissible_for_green_and_admissible_for_small() -> None:
    inverted = np.diag([-1.5, 0.0])
    assert not Green().admissible(inverted, np.eye(2))
    assert Small().admissible(inverted, np.eye(2))


@pytest.mark.parametrize("measure", [Small(), Green()])
def test_lateral_strain_has_the_derivatives_it_claims(measure: Small | Green) -> None:
    y, step = np.array([-0.3, 0.0, 0.4]), 1e-5
    E, slope, curvature = measure.lateral(y)
    plus, minus = measure.lateral(y + step), measure.lateral(y - step)
    assert np.allclose(slope, (plus[0] - minus[0]) / (2 * step), atol=1e-9)
    assert np.allclose(curvature, (plus[1] - minus[1]) / (2 * step), atol=1e-9)
