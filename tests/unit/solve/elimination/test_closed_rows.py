"""Closed rows: projections, multipliers, dependent rows, and the bound on the spectrum."""

from dataclasses import dataclass

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp

from softway.arrays import Array
from softway.solve.elimination.closed_rows import ClosedRows
from softway.solve.elimination.contact_sweeps import Projection
from softway.solve.operators.matrix_free import Blocks


@dataclass(frozen=True)
class Setting:
    """Matrix A (f, f), blocks D (f, f) of its diagonal, and rows G (c, f)."""

    A: Array
    D: Array
    G: Array

    @property
    def closed(self) -> ClosedRows:
        return ClosedRows.of(sp.csr_array(self.G), self.inverse)

    @property
    def inverse(self) -> Blocks:
        return Blocks(sp.csr_array(np.linalg.inv(self.D)))


@pytest.fixture
def setting() -> Setting:
    """Ten nodes in space; two rows with four nodes each, which share two, and one row of a node alone."""
    rng = np.random.default_rng(5)
    root = rng.normal(size=(30, 34))
    A, D = root @ root.T, np.zeros((30, 30))
    for node in range(10):
        own = slice(3 * node, 3 * node + 3)
        D[own, own] = A[own, own]
    G = np.zeros((3, 30))
    G[0, :12], G[1, 6:18], G[2, 24:27] = rng.normal(size=12), rng.normal(size=12), rng.normal(size=3)
    return Setting(A, D, G)


def test_the_motion_is_the_shortest_and_moves_the_rows(setting: Setting) -> None:
    closed, wanted = setting.closed, np.array([1.0, -2.0, 0.5])
    motion = closed.motion(wanted)
    np.testing.assert_allclose(setting.G @ motion, wanted, rtol=1e-12)
    root = la.sqrtm(setting.D).real
    shortest = np.linalg.solve(root, np.linalg.lstsq(setting.G @ np.linalg.inv(root), wanted)[0])
    np.testing.assert_allclose(motion, shortest, atol=1e-10)


def test_projections_leave_no_motion_of_the_rows(setting: Setting) -> None:
    closed, z = setting.closed, np.random.default_rng(1).normal(size=30)
    assert np.abs(setting.G @ closed.removed(z)).max() <= 1e-13 * np.abs(z).max()
    np.testing.assert_allclose(closed.removed(closed.removed(z)), closed.removed(z), atol=1e-13)
    assert np.abs(closed.multipliers(closed.balanced(z))).max() <= 1e-12 * np.abs(closed.multipliers(z)).max()


def test_dependent_rows_share_the_force(setting: Setting) -> None:
    twice = Setting(setting.A, setting.D, np.concatenate([setting.G, setting.G[2:]])).closed
    force = twice.multipliers(setting.G.T @ np.array([1.0, 2.0, 3.0]))
    np.testing.assert_allclose(force, [1.0, 2.0, 1.5, 1.5], rtol=1e-4)
    np.testing.assert_allclose(twice.matrix @ twice.motion(np.array([1.0, 2.0, 3.0, 3.0])), [1, 2, 3, 3], rtol=1e-12)


def test_closed_rows_do_not_widen_the_spectrum(setting: Setting) -> None:
    """Courant and Fischer: on the fields with G x = 0 the quotient x.Ax / x.Dx stays between its values on all."""
    kernel = la.null_space(setting.G)
    whole = la.eigh(setting.A, setting.D, eigvals_only=True)
    inside = la.eigh(kernel.T @ setting.A @ kernel, kernel.T @ setting.D @ kernel, eigvals_only=True)
    assert whole[0] <= inside[0] and inside[-1] <= whole[-1]
    moved = [setting.closed.removed(setting.inverse.solve(setting.A @ x)) for x in kernel.T]
    found = np.sort(np.linalg.eigvals(kernel.T @ np.stack(moved, axis=1)).real)
    np.testing.assert_allclose(found, inside, rtol=1e-9)


@pytest.mark.parametrize("count", [1, 3], ids=["a row of one node", "rows that share nodes"])
def test_one_projection_serves_the_inverse_of_the_rows(setting: Setting, count: int) -> None:
    """The field of a balanced residual does not move the rows: it is that of two projections."""
    some, inverse = Setting(setting.A, setting.D, setting.G[-count:]), setting.inverse
    r = some.closed.balanced(np.random.default_rng(3).normal(size=30))
    own, other = Projection.of(some.closed, inverse, inverse), Projection.of(some.closed, inverse, setting.inverse)
    z, expected = own(r)[1], other(r)[1]
    np.testing.assert_allclose(z, expected, atol=1e-13 * np.abs(expected).max())
    assert np.abs(some.G @ z).max() <= 1e-13 * np.abs(z).max()
    assert own(r)[0] @ z == pytest.approx(other(r)[0] @ expected, rel=1e-12)
