"""Concentric arcs and spherical caps of meshes that do not match: orders of the gap, the moment and the derivative."""

import numpy as np
import pytest

from softway.contact.mortar.mortar import Mortar
from softway.contact.stencils import Stencils
from softway.meshes.generators.shapes import box

Surface = tuple[np.ndarray, dict[str, np.ndarray]]
SOLIDS = {"tri3": "tet4", "tri6": "tet10", "quad4": "hex8", "quad8": "hex20", "quad9": "hex27"}


def arc(kind: str, cells: int, radius: float, ends: tuple[float, float], sign: float) -> Surface:
    """Facets on a circle, turned away from its centre (sign 1) or towards it (-1)."""
    angle = np.linspace(*ends, cells + 1)
    facets = np.stack([np.arange(cells), np.arange(1, cells + 1)], axis=1)
    if kind == "bar3":
        facets = np.concatenate([facets, cells + 1 + np.arange(cells)[:, None]], axis=1)
        angle = np.concatenate([angle, 0.5 * (angle[1:] + angle[:-1])])
    if sign < 0.0:
        facets[:, :2] = facets[:, 1::-1]
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1), {kind: facets}


def cap(kind: str, cells: int, radius: float, half: float, sign: float) -> Surface:
    """Facets on a sphere over the square of tangents up to ``half``."""
    mesh = box((1.0, 1.0, 1.0), (cells, cells, 1), cell=SOLIDS[kind])
    flat = half * (2.0 * mesh.points - 1.0)
    flat[:, 2] = 1.0
    x = radius * flat / np.linalg.norm(flat, axis=1)[:, None]
    return x, dict(mesh.facets_on("top" if sign > 0.0 else "bottom"))


def pair(slave: Surface, master: Surface) -> tuple[np.ndarray, Mortar]:
    x = np.concatenate([slave[0], master[0]])
    shifted = {kind: facets + len(slave[0]) for kind, facets in master[1].items()}
    return x, Mortar(slave_facets=slave[1], master_facets=shifted)


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
