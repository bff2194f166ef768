"""Contact rows along the surfaces."""

import numpy as np
import pytest
import scipy.sparse as sp

from softway.contact.friction_rows import FrictionRows
from softway.contact.tangential_rows import TangentialRows, tangents
from softway.laws.friction import Coulomb, Tresca


@pytest.mark.parametrize("dim", [2, 3])
def test_tangents_are_orthonormal(dim):
    normal = np.random.default_rng(1).normal(size=(50, dim))
    normal = np.vstack([normal / np.linalg.norm(normal, axis=1)[:, None], np.eye(dim), -np.eye(dim)])
    frames = np.concatenate([normal[:, None], tangents(normal)], axis=1)
    assert np.abs(frames @ frames.swapaxes(1, 2) - np.eye(dim)).max() < 1e-14


def test_bars_have_no_tangents():
    assert tangents(np.ones((3, 1))).shape == (3, 0, 1)


@pytest.fixture
def shear():
    """Node 0 on the middle of the edge between nodes 1 and 2, which a tool besides moves along."""
    weights = sp.csr_array(np.array([[1.0, -0.5, -0.5], [1.0, 0.0, 0.0]]))
    normal = np.array([[0.0, 1.0], [0.6, 0.8]])
    return TangentialRows(weights=weights, tangents=tangents(normal), moved=np.array([[0.0, 0.0], [0.4, -0.3]]))


def test_slip_is_relative_and_tangential(shear):
    moved = np.array([[2.0, 5.0], [1.0, 1.0], [0.0, 3.0]])
    slip = shear.slip(moved)
    assert slip[0] == pytest.approx([1.5, 0.0])
    assert slip[1] @ [0.6, 0.8] == pytest.approx(0.0)
    assert slip[1] @ [0.8, -0.6] == pytest.approx((moved[0] - [0.4, -0.3]) @ [0.8, -0.6])


def test_gradient_and_forces_are_transposed(shear):
    field, forces = np.random.default_rng(2).normal(size=(2, 3, 2))
    forces = shear.vectors(shear.flat(forces[:2]))
    rows = np.asarray(shear.gradient() @ field.ravel()).reshape(2, 1)
    assert rows == pytest.approx(shear.flat(shear.tangential(field)))
    assert np.sum(shear.spread(forces) * field) == pytest.approx(np.sum(rows * shear.flat(forces)))


def test_a_rigid_motion_of_both_bodies_is_no_slip(shear):
    assert shear.tangential(np.full((3, 2), 0.7))[0] == pytest.approx([0.0, 0.0])


def test_tractions_become_forces():
    rows = FrictionRows(
        laws=(Coulomb(mu=0.3), Tresca(shear=5.0)), contact=np.array([0, 1, 1]), area=np.array([0.1, 0.2, 0.4])
    )
    assert rows.limit(np.array([10.0, 10.0, 0.0])) == pytest.approx([3.0, 1.0, 2.0])
    value, slope, pressure_slope = rows.subset(np.array([0, 2])).resistance(np.ones(2), np.array([10.0, 1.0]))
    assert value == pytest.approx([3.0, 2.0])
    assert slope == pytest.approx([0.0, 0.0])
    assert pressure_slope == pytest.approx([0.3, 0.0])
