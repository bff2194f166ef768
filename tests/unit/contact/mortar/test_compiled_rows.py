"""Compiled rows of mortar contact against arrays: gaps, normals, weights and slopes of uneven surfaces."""

import numpy as np
import pytest
from facet_solids import PLANE, SOLIDS
from row_arrays import rows

from softway.contact.mortar.mortar import Mortar
from softway.contact.stencils import Stencils
from softway.kernels.mortar.rows import gap_rows
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh


def block(kind: str, cells: int, low: tuple[float, ...]) -> Mesh:
    """A layer of unit width with facets of one kind at its top and bottom."""
    if kind in PLANE:
        return rectangle((1.0, 0.5), (cells, 1), origin=low, cell=SOLIDS[kind])
    return box((1.0, 0.9, 0.5), (cells, cells, 1), origin=low, cell=SOLIDS[kind])


def scene(kinds: tuple[str, ...], seed: int) -> tuple[np.ndarray, Mortar]:
    """Positions of two uneven blocks that overlap in part, the upper one from blocks side by side, and the mortar."""
    plane, rng = kinds[0] in PLANE, np.random.default_rng(seed)
    lows = [(0.13 + 1.1 * k, 0.48) if plane else (0.13 + 1.1 * k, 0.07, 0.48) for k in range(len(kinds) - 1)]
    meshes = [
        block(kinds[0], 5, (0.0,) * len(lows[0])),
        *(block(k, 3, low) for k, low in zip(kinds[1:], lows, strict=True)),
    ]
    starts = np.cumsum([0, *(m.n_nodes for m in meshes)])
    x = np.concatenate([m.points for m in meshes])
    x[: starts[1]] *= np.array([2.3, *np.ones(x.shape[1] - 1)])
    x += 0.02 * np.sin(5.0 * x[:, ::-1]) + 0.004 * rng.standard_normal(x.shape)
    slave = {
        kind: f + start
        for m, start in zip(meshes[1:], starts[1:], strict=False)
        for kind, f in m.facets_on("bottom").items()
    }
    return x, Mortar(slave_facets=slave, master_facets=meshes[0].facets_on("top"))


def agree(found: Stencils, expected: Stencils, covered: np.ndarray) -> None:
    """Check that two rows agree to rounding, which a row divides by its covered area (m,)."""
    lift = np.maximum(1.0, np.median(covered) / np.where(covered > 0.0, covered, 1.0))
    assert np.array_equal(np.isfinite(found.gap), np.isfinite(expected.gap))
    some = np.isfinite(found.gap)
    assert some.any()
    assert (np.abs(found.gap[some] - expected.gap[some]) < 1e-13 * lift[some]).all()
    assert (np.abs(found.normal - expected.normal) < 1e-13 * lift[:, None]).all()
    pairs = (found.weights, expected.weights, 1e-13), (found.gradient(), expected.gradient(), 1e-12)
    for one, other, rounding in pairs:  # slopes by the weights of pairs have the inverse mass of a facet twice
        assert one.shape == other.shape
        assert one.has_canonical_format
        assert (np.abs((one - other).toarray()).max(axis=1) < rounding * lift).all()


KINDS = [
    *((k, k) for k in SOLIDS),
    ("bar2", "bar2", "bar3"),
    ("quad4", "tri3"),
    ("quad8", "quad4", "tri3"),
    ("tri6", "quad4", "quad8"),
]


SOON = ("bar2", "bar2"), ("tri3", "tri3")
"""Kinds whose reference takes less than a second."""


@pytest.mark.parametrize("kinds", [k if k in SOON else pytest.param(k, marks=pytest.mark.slow) for k in KINDS])
def test_rows_of_uneven_surfaces(kinds: tuple[str, ...]) -> None:
    for seed in range(3):
        x, mortar = scene(kinds, seed)
        met = mortar.meet(x, x, 0.1)
        away = x + 0.03 * np.random.default_rng(seed + 10).standard_normal(x.shape)
        for positions in (x, away):
            agree(met.at(positions), *rows(mortar, met, positions))


@pytest.mark.parametrize("kind", ["bar2", "quad4"])
def test_rows_are_the_same_bits_again(kind: str) -> None:
    x, mortar = scene((kind, kind), 4)
    met = mortar.meet(x, x, 0.1)
    first, again = met.at(x), met.at(x.copy())
    assert first.gap.tobytes() == again.gap.tobytes()
    assert first.normal.tobytes() == again.normal.tobytes()
    for one, other in ((first.weights, again.weights), (first.gradient(), again.gradient())):
        assert one.data.tobytes() == other.data.tobytes()
        assert one.indices.tobytes() == other.indices.tobytes()


def test_rows_that_need_more_place_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    x, mortar = scene(("quad4", "quad8"), 5)
    met = mortar.meet(x, x, 0.1)
    wide = met.at(x)
    monkeypatch.setattr(gap_rows, "NODES", 1)
    narrow = met.at(x)
    assert wide.gap.tobytes() == narrow.gap.tobytes()
    assert (wide.weights != narrow.weights).nnz == 0
    assert (wide.gradient() != narrow.gradient()).nnz == 0
