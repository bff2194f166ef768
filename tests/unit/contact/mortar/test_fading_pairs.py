"""Pairs of facets whose normals are between 45 and 60 degrees from opposite."""

import numpy as np
import pytest

from softway.arrays import Array
from softway.contact.mortar.mortar import Mortar

FLAT = 0.1
"""Height of the flat master above the slave [m]."""


def leaning(degrees: float, dim: int) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """Positions of a facet of the slave below a much larger one of the master, which leans; facets of both."""
    a = np.deg2rad(degrees)
    if dim == 2:
        slave, wide = np.array([[0.0, 0.0], [1.0, 0.1]]), np.array([[-20.0, 0.0], [20.0, 0.0]])
        turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        kind, below, above = "bar2", [[1, 0]], [[2, 3]]
    else:
        slave = np.array([[0.0, 0.0, 0.0], [1.0, 0.1, 0.1], [0.2, 0.9, -0.1]])
        wide = np.array([[-20.0, -20.0, 0.0], [-20.0, 60.0, 0.0], [60.0, -20.0, 0.0]])
        turn = np.array([[np.cos(a), 0.0, -np.sin(a)], [0.0, 1.0, 0.0], [np.sin(a), 0.0, np.cos(a)]])
        kind, below, above = "tri3", [[0, 1, 2]], [[3, 4, 5]]
    up = np.eye(dim)[-1]
    x = np.concatenate([slave, wide @ turn.T + 1.3 * up])
    return x, {kind: np.array(below)}, {kind: np.array(above)}


@pytest.mark.parametrize("dim", [2, 3], ids=["plane", "space"])
@pytest.mark.parametrize("degrees", [42.0, 50.0, 56.0, 62.0])
def test_slopes_are_derivatives(dim: int, degrees: float) -> None:
    """Where the whole facet of the slave is common: what is left out, the motion of the edges of the common part, is
    nothing.  The weight reaches the gap by the mixture of dual and shape functions.
    """
    x, below, above = leaning(degrees, dim)
    met = Mortar(slave_facets=below, master_facets=above).meet(x, x, 5.0)
    found, step = met.at(x), 1e-6
    assert np.isfinite(found.gap).all()
    slopes, expected = found.slopes.toarray(), np.zeros((len(found.gap), x.size))
    for c in range(x.size):
        gaps = []
        for side in (-step, step):
            moved = x.ravel().copy()
            moved[c] += side
            gaps.append(met.at(moved.reshape(x.shape)).gap)
        expected[:, c] = (gaps[1] - gaps[0]) / (2.0 * step)
    np.testing.assert_allclose(slopes, expected, rtol=0, atol=1e-8 * np.abs(expected).max())
    np.testing.assert_allclose(slopes @ x.ravel(), found.gap, rtol=1e-12)


@pytest.mark.parametrize("dim", [2, 3], ids=["plane", "space"])
def test_rows_have_no_resultant_and_no_moment(dim: int) -> None:
    x, below, above = leaning(54.0, dim)
    slopes = Mortar(slave_facets=below, master_facets=above).meet(x, x, 5.0).at(x).slopes.toarray()
    for force in slopes.reshape(len(slopes), *x.shape):
        scale = np.abs(force).max() * np.abs(x).max()
        np.testing.assert_allclose(force.sum(axis=0), 0.0, atol=1e-14 * scale)
        for a in range(dim):
            for b in range(a):
                assert abs((x[:, a] * force[:, b] - x[:, b] * force[:, a]).sum()) < 1e-13 * scale


def test_a_gap_is_continuous_while_a_facet_turns_away() -> None:
    """A flat facet and one that turns cover the slave: from 64 degrees on the gap is that below the flat one.

    The greatest change between two angles falls with their difference, so there is no jump.
    """
    flat = np.array([[-3.0, FLAT], [3.0, FLAT]])

    def greatest_change(count: int) -> float:
        gaps = []
        for degrees in np.linspace(40.0, 64.0, count):
            x, below, above = leaning(degrees, 2)
            y = np.concatenate([x, flat])
            both = {"bar2": np.concatenate([above["bar2"], [[4, 5]]])}
            y[:2, 1] = 0.0
            gaps.append(Mortar(slave_facets=below, master_facets=both).meet(y, y, 5.0).at(y).gap)
        assert gaps[-1] == pytest.approx([FLAT, FLAT], rel=1e-12)
        assert np.abs(gaps[0] - FLAT).max() > 0.1
        return float(np.abs(np.diff(gaps, axis=0)).max())

    assert greatest_change(193) < 0.3 * greatest_change(49)
