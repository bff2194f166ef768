"""Compiled overlaps of pairs of simplices against arrays: leaning, crossing, touching, apart, turned away, narrow."""

import numpy as np
import pytest
import segment_arrays
import triangle_arrays

from softway.kernels.mortar.segments import segment_overlap
from softway.kernels.mortar.triangles import triangle_overlap, triangle_room

PAIRS = 400


def compiled(slave: np.ndarray, master: np.ndarray, normal: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Integrals (s, k, k) of the pairs of simplices (d, k, s), zero where they do not overlap."""
    d, k, s = slave.shape
    below, above = (np.ascontiguousarray(x.reshape(d, -1).T) for x in (slave, master))
    corner, each = np.arange(k * s).reshape(k, s).T.copy(), np.arange(s)
    pair, (own, cross) = np.empty(s, np.int64), np.empty((2, s, k, k))
    if normal is None:
        count = triangle_overlap(below, corner, above, corner, each, each, triangle_room(s, s), pair, own, cross)
    else:
        field = np.ascontiguousarray(normal.reshape(d, -1).T)
        count = segment_overlap(below, corner, field, above, corner, each, each, pair, own, cross)
    out = np.zeros((2, s, k, k))
    out[:, pair[:count]] = own[:count], cross[:count]
    return out[0], out[1]


def by_arrays(slave: np.ndarray, master: np.ndarray, normal: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The same integrals by arrays."""
    each = np.arange(slave.shape[2])
    if normal is None:
        found = triangle_arrays.overlap(slave, master, each, each)
    else:
        found = segment_arrays.overlap(slave, normal, master, each, each)
    out = np.zeros((2, len(each), *found.own.shape[:2]))
    out[:, found.pair] = found.own.transpose(2, 0, 1), found.cross.transpose(2, 0, 1)
    return out[0], out[1]


def triangles(kind: str, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of triangles (3, 3, s) about the plane z = 0 that face each other."""
    slave, master = rng.uniform(-1.0, 1.0, (2, 3, 3, PAIRS))
    for corners, side in ((slave, 1.0), (master, -1.0)):
        edge = corners[:2, 1:] - corners[:2, :1]
        turned = side * (edge[0, 0] * edge[1, 1] - edge[1, 0] * edge[0, 1]) < 0.0
        corners[:, 1:, turned] = corners[:, :0:-1, turned]
    slave[2] *= 0.1
    master[2] *= 0.1
    if kind == "parallel":
        slave[2], master[2] = 0.0, 0.3
    if kind == "crossing":
        slave[2] *= 5.0
        master[2] *= 5.0
    if kind == "apart":
        master[0] += 2.5
    if kind == "same":
        master = slave[:, ::-1].copy()
    if kind == "edge":
        master[:, 0], master[:, 1] = slave[:, 1], slave[:, 0]  # a common edge, from either side of it
    if kind == "corner":
        master[:2] += slave[:2, :1] - master[:2, :1]
    if kind == "behind":
        master = master[:, ::-1].copy()
        slave[2], master[2] = 0.0, 0.1
    if kind == "narrow":
        master[0] = slave[0, 0] + 1e-6 * master[0]
    return slave, master


KINDS = ["leaning", "parallel", "crossing", "apart", "same", "edge", "corner", "behind", "narrow"]


@pytest.mark.parametrize("kind", KINDS)
def test_triangles(kind: str) -> None:
    slave, master = triangles(kind, np.random.default_rng(KINDS.index(kind)))
    found, expected = compiled(slave, master), by_arrays(slave, master)
    size = np.sqrt(np.sum(np.cross(slave[:, 1] - slave[:, 0], slave[:, 2] - slave[:, 0], axis=0) ** 2, axis=0))
    lift = size * np.maximum(
        1.0, np.abs(expected[1]).max(axis=(1, 2)) / np.maximum(expected[0].max(axis=(1, 2)), 1e-300)
    )
    for one, other in zip(found, expected, strict=True):
        assert (np.abs(one - other).max(axis=(1, 2)) < 1e-13 * lift).all()
    covered = expected[0].sum(axis=(1, 2)) > 1e-12 * size
    assert covered.any() == (kind not in ("apart", "touching", "behind"))
    assert np.allclose(found[0].sum(axis=(1, 2)), found[1].sum(axis=(1, 2)), atol=1e-12)


@pytest.mark.parametrize("kind", ["leaning", "parallel", "crossing", "apart", "touching", "behind", "same"])
def test_segments(kind: str) -> None:
    rng = np.random.default_rng(20)
    slave, master = rng.uniform(-1.0, 1.0, (2, 2, 2, PAIRS))
    slave[0].sort(axis=0)
    master[0].sort(axis=0)
    slave, master = slave[:, ::-1] * np.array([1.0, 0.2])[:, None, None], master * np.array([1.0, 0.2])[:, None, None]
    normal = np.stack([rng.uniform(-0.3, 0.3, (2, PAIRS)), np.ones((2, PAIRS))])
    normal /= np.sqrt(np.sum(normal**2, axis=0))
    if kind == "parallel":
        slave[1], master[1], normal[0], normal[1] = 0.0, 0.1, 0.0, 1.0
    if kind == "crossing":
        master[1] *= 5.0
    if kind == "apart":
        master[0] += 3.0
    if kind == "touching":
        master[:, 0] = slave[:, 0]
    if kind == "behind":
        master = master[:, ::-1].copy()
    if kind == "same":
        master = slave[:, ::-1].copy()
    slave, master = np.ascontiguousarray(slave), np.ascontiguousarray(master)
    found, expected = compiled(slave, master, normal), by_arrays(slave, master, normal)
    length = np.sqrt(np.sum((slave[:, 1] - slave[:, 0]) ** 2, axis=0))
    for one, other in zip(found, expected, strict=True):
        assert (np.abs(one - other).max(axis=(1, 2)) < 1e-13 * length).all()
    assert (expected[0].sum(axis=(1, 2)) > 1e-12 * length).any() == (kind not in ("apart", "touching", "behind"))
