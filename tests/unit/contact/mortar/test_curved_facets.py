"""Concentric arcs and spherical caps of meshes that do not match: orders of the gap, the moment and the derivative."""

import numpy as np
import pytest
from curved_shapes import Surface, arc, cap

from softway.contact.mortar.mortar import Mortar
from softway.contact.stencils import Stencils


def pair(slave: Surface, master: Surface, curved: bool = False) -> tuple[np.ndarray, Mortar]:
    x = np.concatenate([slave[0], master[0]])
    shifted = {kind: facets + len(slave[0]) for kind, facets in master[1].items()}
    return x, Mortar(slave_facets=slave[1], master_facets=shifted, points=x if curved else None)


def moment(rows: Stencils, x: np.ndarray) -> float:
    """Greatest moment of the forces of a row of unit force [m]."""
    arm = rows.weights @ x
    along = np.einsum("mi,mi->m", arm, rows.normal)
    return float(np.linalg.norm(arm - along[:, None] * rows.normal, axis=1).max())


def mismatch(x: np.ndarray, mortar: Mortar, motion: np.ndarray) -> float:
    """Greatest difference of the change of a gap and what the weights say, for a nodal motion (n, d)."""
    pairing = mortar.meet(x, x, 0.1)
    rows, step = pairing.at(x), 1e-6
    change = (pairing.at(x + step * motion).gap - pairing.at(x - step * motion).gap) / (2.0 * step)
    return float(np.abs(change - np.einsum("mi,mi->m", rows.normal, rows.weights @ motion)).max())


def order(values: list[float]) -> float:
    """Mean order over meshes that are halved again and again."""
    return float(np.log2(values[0] / values[-1]) / (len(values) - 1))


@pytest.mark.parametrize("inner", [True, False])
@pytest.mark.parametrize("gap", [0.0, 0.05])
@pytest.mark.parametrize(("slave", "master"), [("bar2", "bar2"), ("bar3", "bar3"), ("bar2", "bar3")])
def test_concentric_arcs(slave: str, master: str, gap: float, inner: bool) -> None:
    """The gap is met to second order, the moment to third; the frozen weights err little in slip."""
    gaps, moments, slips = [], [], []
    for cells in (8, 16, 32, 64):
        radii, sign = ((1.0, 1.0 + gap), 1.0) if inner else ((1.0 + gap, 1.0), -1.0)
        own = arc(slave, cells, radii[0], (0.2, 1.4), sign)
        x, mortar = pair(own, arc(master, int(1.6 * cells) + 1, radii[1], (0.0, 1.6), -sign))
        rows = mortar.meet(x, x, 0.1).at(x)
        gaps.append(float(np.abs(rows.gap - gap).max()))
        moments.append(moment(rows, x))
        slip = np.zeros_like(x)
        slip[mortar.node] = x[mortar.node] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        slips.append(mismatch(x, mortar, slip))
    assert order(gaps) > 1.8
    if gap == 0.0:  # across an open gap there is no force
        assert order(moments) > 2.5
        assert order(slips) > 2.0
    assert all(s < 0.1 * 1.2 / n for s, n in zip(slips, (8, 16, 32, 64), strict=True))  # nodal normals: h / 2 R
    assert gaps[0] < (0.15**2 + (1.6 / 13) ** 2) / 8.0  # what the chords are off the circles


@pytest.mark.parametrize(
    ("slave", "master"),
    [("quad4", "quad4"), ("tri3", "quad9"), ("tri6", "tri3"), ("quad8", "quad4"), ("quad9", "quad8")],
)
def test_concentric_caps(slave: str, master: str) -> None:
    gaps, moments = [], []
    for cells in (4, 8, 16):
        x, mortar = pair(cap(slave, cells, 1.0, 0.35, 1.0), cap(master, int(1.4 * cells), 1.0, 0.5, -1.0))
        rows = mortar.meet(x, x, 0.1).at(x)
        gaps.append(float(np.abs(rows.gap).max()))
        moments.append(moment(rows, x))
    assert order(gaps) > 1.7
    assert order(moments) > 1.9
    assert gaps[0] < (0.175**2 + 0.2**2) / 4.0  # what flat squares are off the sphere


def test_linear_momentum_is_kept_on_curved_surfaces() -> None:
    x, mortar = pair(cap("quad4", 5, 1.0, 0.35, 1.0), cap("quad9", 3, 1.02, 0.5, -1.0))
    rows = mortar.meet(x, x, 0.1).at(x)
    assert np.isfinite(rows.gap).all()
    assert np.abs(rows.weights.sum(axis=1)).max() < 1e-14


@pytest.mark.parametrize("inner", [True, False])
@pytest.mark.parametrize(("slave", "master"), [("bar2", "bar2"), ("bar3", "bar3"), ("bar2", "bar3")])
def test_concentric_circles_touch_to_fourth_order(slave: str, master: str, inner: bool) -> None:
    gaps, moments, slips = [], [], []
    for cells in (8, 16, 32):
        sign = 1.0 if inner else -1.0
        own = arc(slave, cells, 1.0, (0.2, 1.4), sign)
        x, mortar = pair(own, arc(master, int(1.6 * cells) + 1, 1.0, (0.0, 1.6), -sign), curved=True)
        rows = mortar.meet(x, x, 0.1).at(x)
        gaps.append(float(np.abs(rows.gap).max()))
        moments.append(moment(rows, x))
        slip = np.zeros_like(x)
        slip[mortar.node] = x[mortar.node] @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        slips.append(np.abs(rows.gradient() @ slip.ravel()).max())
    assert order(gaps) > 3.5
    assert order(moments) > 2.5
    assert all(s < 0.15 * (1.2 / n) ** 3 for s, n in zip(slips, (8, 16, 32), strict=True))
    assert gaps[0] < 2e-5


@pytest.mark.parametrize(
    ("slave", "master"),
    [("quad4", "quad4"), ("tri3", "quad9"), ("tri6", "tri3"), ("quad8", "quad4"), ("quad9", "quad8")],
)
def test_concentric_spheres_touch(slave: str, master: str) -> None:
    gaps = []
    for cells in (4, 8, 16):
        x, mortar = pair(cap(slave, cells, 1.0, 0.35, 1.0), cap(master, int(1.4 * cells), 1.0, 0.5, -1.0), curved=True)
        gaps.append(float(np.abs(mortar.meet(x, x, 0.1).at(x).gap).mean()))
    assert order(gaps) > 2.2
    assert gaps[2] < 0.02 * (0.7 / 16) ** 2 / 8.0


@pytest.mark.parametrize("inner", [True, False])
def test_two_like_circles_touch_at_their_nodes(inner: bool) -> None:
    """Where curved surfaces part from each other, a row reads their distance at its node, not a mean around it."""
    turn = np.linspace(-0.6, 0.6, 13)
    upper = np.column_stack([np.sin(turn), 1.01 - np.cos(turn)])
    lower = np.column_stack([np.sin(turn), np.cos(turn) - 1.0]) * (1.0 if inner else 0.7)
    facets = np.stack([np.arange(12), np.arange(1, 13)], axis=1)
    x, mortar = pair((upper, {"bar2": facets}), (lower, {"bar2": facets[:, ::-1]}), curved=True)
    gap = mortar.meet(x, x, 0.1).at(x).gap
    middle = np.flatnonzero(mortar.node == 6)
    assert gap[middle] == pytest.approx(0.01, abs=2e-5 if inner else 3e-4)
    assert gap.argmin() == middle


@pytest.mark.parametrize("dim", [2, 3])
def test_rows_of_curved_surfaces_have_no_resultant_and_no_moment(dim: int) -> None:
    if dim == 2:
        x, mortar = pair(arc("bar2", 9, 1.0, (0.2, 1.4), 1.0), arc("bar3", 7, 1.02, (0.0, 1.6), -1.0), curved=True)
    else:
        x, mortar = pair(cap("quad4", 5, 1.0, 0.35, 1.0), cap("tri6", 4, 1.02, 0.5, -1.0), curved=True)
    rows = mortar.meet(x, x, 0.1).at(x)
    assert np.isfinite(rows.gap).all()
    force = rows.gradient().toarray().reshape(-1, len(x), dim)
    assert np.abs(force.sum(axis=1)).max() < 1e-14
    planes = [(a, b) for a in range(dim) for b in range(a)]
    moments = [np.einsum("mn,n->m", force[:, :, a], x[:, b]) - force[:, :, b] @ x[:, a] for a, b in planes]
    assert np.abs(moments).max() < 1e-14


def test_a_small_round_on_the_master_does_not_reach_across_a_large_facet() -> None:
    """A plate of one facet above a corner of a twentieth of its size: the gap stays that of the facets within four
    times what they stand off the round, the greatest bow that counts.
    """
    turn = np.linspace(0.0, 0.5 * np.pi, 9)[::-1]
    round_ = 0.05 * np.column_stack([np.cos(turn) - 1.0, np.sin(turn) - 1.0])
    lower = np.concatenate([[[-1.0, 0.0]], round_])
    facets = np.stack([np.arange(len(lower) - 1), np.arange(1, len(lower))], axis=1)
    upper = np.array([[-0.6, 0.0], [0.4, 0.0]])
    gaps = []
    for curved in (False, True):
        x, mortar = pair((upper, {"bar2": np.array([[0, 1]])}), (lower, {"bar2": facets[:, ::-1]}), curved)
        gaps.append(mortar.meet(x, x, 0.1).at(x).gap)
    assert gaps[1] == pytest.approx(gaps[0], abs=4.0 * 0.05 * (1.0 - np.cos(np.pi / 32)))
