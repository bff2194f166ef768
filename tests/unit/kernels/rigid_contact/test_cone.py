"""Impulses of contacts with friction: the laws hold for random bodies, also where their compliance is singular."""

from typing import NamedTuple

import numpy as np
import pytest

from softway.arrays import IntArray
from softway.kernels.jit.by_address import passed_by_address
from softway.kernels.jit.compilation import kernel
from softway.kernels.rigid_contact.cone import solve_cone
from softway.kernels.rigid_contact.cone_call import call_cone, cone
from softway.kernels.rigid_contact.dense import solve_dense

BLOCKS = {(1, 1): [], (2, 1): [(1, 2)], (3, 1): [(1, 3)], (3, 2): [(1, 2), (2, 3)], (6, 3): [(1, 3), (3, 5), (5, 6)]}
"""Rows from and to of each block of friction, for contacts of d rows and q coefficients."""


@pytest.mark.parametrize(("d", "q"), BLOCKS)
def test_the_laws_of_contact_hold(d: int, q: int) -> None:
    rng = np.random.default_rng(10 * q + d)
    for trial in range(300):
        count = int(rng.integers(1, 7))
        rank = max(1, d * count + int(rng.integers(-3, 4)))
        A = rng.normal(size=(d * count, rank))
        W, b = A @ A.T, A @ rng.normal(size=rank)
        friction, least, x = 0.6 * rng.random((count, q)), np.zeros((count, q)), np.zeros(d * count)
        friction[0, -1] = 0.0
        assert solve_cone(W, b, friction, least, np.zeros(count), np.zeros(d * count), 0.0, x), trial
        y = W @ x + b
        normal, gap = x[::d], y[::d]
        size, speed = np.abs(x).max() + 1e-30, np.abs(b).max()
        assert normal.min() >= 0.0 and gap.min() >= -1e-9 * speed
        assert np.abs(normal * gap).max() <= 1e-9 * size * speed
        for k, (first, last) in enumerate(BLOCKS[d, q]):
            limits, pushes, slips = (
                friction[:, k] * normal,
                x.reshape(-1, d)[:, first:last],
                y.reshape(-1, d)[:, first:last],
            )
            for push, slip, limit in zip(pushes, slips, limits, strict=True):
                assert np.linalg.norm(push) <= limit + 1e-9 * size
                along = np.linalg.norm(slip) * push + limit * slip
                assert np.abs(along).max(initial=0.0) <= 1e-8 * size * speed, "friction is opposite to the slip"


def test_friction_with_a_given_direction_acts_along_it_only() -> None:
    rng = np.random.default_rng(5)
    for _ in range(100):
        A = rng.normal(size=(3, 3))
        W, b, friction = A @ A.T, A @ rng.normal(size=3), 0.6 * rng.random((1, 1))
        axis = np.array([0.0, *np.array([np.cos(b[0]), np.sin(b[0])])])
        x, least = np.zeros(3), np.full((1, 1), 0.1)
        assert solve_cone(W, b, friction, least, np.zeros(1), axis, 0.0, x)
        y, limit, along = W @ x + b, max(friction[0, 0] * x[0], 0.1), axis @ x
        assert x[0] >= 0.0 and y[0] >= -1e-9 and abs(x[0] * y[0]) < 1e-9
        np.testing.assert_allclose(x[1:], axis[1:] * along, atol=1e-12)
        assert abs(along) <= limit + 1e-12 and abs(abs(axis @ y) * along + limit * (axis @ y)) < 1e-9


def test_a_rod_that_would_jam_gets_the_mode_that_fits() -> None:
    """Painleve: sliding to the right alone has no solution, since W_nn - mu W_nt < 0; the tip stops at once."""
    W, friction = np.array([[1.0, 0.9], [0.9, 2.0]]), np.array([[1.5]])
    for b in ([-0.1, 1.0], [0.1, 1.0], [-1.0, -0.2]):
        x = np.zeros(2)
        assert solve_cone(W, np.array(b), friction, np.zeros((1, 1)), np.zeros(1), np.zeros(2), 0.0, x)
        y = W @ x + b
        assert x[0] >= 0.0 and y[0] >= -1e-12 and abs(x[0] * y[0]) < 1e-12
        assert abs(x[1]) <= 1.5 * x[0] + 1e-12 and x[1] * y[1] <= 1e-12


def test_dependent_rows_of_a_consistent_system_take_no_part() -> None:
    A = np.array([[2.0, 1.0, 3.0], [4.0, 2.0, 6.0], [1.0, 0.0, 1.0]])
    b = A @ np.array([1.0, -2.0, 0.5])
    x = b.copy()
    solve_dense(A.copy(), x)
    np.testing.assert_allclose(A @ x, b, atol=1e-14)


@passed_by_address
class Room(NamedTuple):
    """Work space with the address of the solution."""

    cone: IntArray


@kernel
def _called(room, W, b, friction, least, lower, axis, rounding, x):
    return call_cone(room, W, b, friction, least, lower, axis, rounding, x)


def test_the_same_bits_by_the_address() -> None:
    rng, room = np.random.default_rng(3), Room(cone=np.array([cone().address]))
    for count in (0, 1, 3):
        A = rng.normal(size=(3 * count, 3 * count))
        W, b, friction = A @ A.T, rng.normal(size=3 * count), rng.uniform(0.0, 1.0, (count, 1))
        given = (W, b, friction, np.zeros((count, 1)), np.zeros(count), np.zeros(3 * count), 0.0)
        one, other = np.zeros(3 * count), np.zeros(3 * count)
        assert _called(room, *given, one) == solve_cone(*given, other) == 1
        assert one.tobytes() == other.tobytes()
