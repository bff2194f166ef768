"""Means over the cells of a new mesh from those over the cells of an old one, by their exact overlap."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from softway.adaptivity.unrelated.control_volumes import ControlVolumes
from softway.arrays import Array, IntArray
from softway.kernels.geometry.overlap import polygon_overlaps, tetrahedron_overlaps


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Overlap:
    """Overlap of a old and b new control volumes in d dimensions.

    Parameters
    ----------
    pairs
        (k, 2) new and old volumes that overlap.
    measure
        (k,) measure of the overlap.
    arm
        (k, d) first moment of the overlap about the centroid of the old volume.
    covered
        (b,) measure of the parts of the new volumes that old ones cover.
    nearest
        (b,) nearest old volume, for new volumes outside of all.
    slopes
        d matrices (a, a) of the components of the gradient.
    reach
        (a, r, d) corners of the old volumes from their centroid.
    around
        (a, a) old volumes with a common corner.
    """

    pairs: IntArray
    measure: Array
    arm: Array
    covered: Array
    nearest: IntArray
    slopes: tuple[sp.csr_array, ...]
    reach: Array
    around: sp.csr_array

    def means(self, values: Array, *, limited: bool = True) -> Array:
        """Means (b, m) over the new volumes of fields with the means (a, m) over the old ones.

        In the old volumes the fields are linear, with the gradient of least squares of the means around, made smaller
        until no corner has a value beyond them (Barth and Jespersen); or constant.
        """
        new, old = self.pairs.T
        moved = self.measure[:, None] * values[old]
        if limited:
            gradient = self.gradient(values)
            moved = moved + np.einsum("kd,kmd->km", self.arm, gradient[old])
        total = np.zeros((len(self.covered), values.shape[1]))
        np.add.at(total, new, moved)
        safe = np.where(self.covered > 0.0, self.covered, 1.0)
        return np.where(self.covered[:, None] > 0.0, total / safe[:, None], values[self.nearest])

    def gradient(self, values: Array) -> Array:
        """Limited gradients (a, m, d) of fields with the means (a, m)."""
        slope = np.stack([matrix @ values for matrix in self.slopes], axis=2)
        rows, columns = self.around.nonzero()
        highest, lowest = np.array(values), np.array(values)
        np.maximum.at(highest, rows, values[columns])
        np.minimum.at(lowest, rows, values[columns])
        change = np.einsum("ard,amd->arm", self.reach, slope)
        room = np.where(change > 0.0, (highest - values)[:, None], (lowest - values)[:, None])
        share = np.where(change != 0.0, room / np.where(change != 0.0, change, 1.0), 1.0)
        return np.asarray(np.minimum(share.min(axis=1), 1.0)[:, :, None] * slope)


def overlap(old: ControlVolumes, new: ControlVolumes, *, radial: bool = False) -> Overlap:
    """Overlap of two meshes of about the same body.

    Parameters
    ----------
    old, new
        Control volumes of both meshes; those of the new one convex.
    radial
        True for bodies of revolution about the y axis: the measure is x dx dy.

    Examples
    --------
    >>> box = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]])
    >>> whole = ControlVolumes(corners=box, point=np.array([0]))
    >>> left = whole.corners * [0.5, 1.0]
    >>> halves = ControlVolumes(corners=np.concatenate([left, left + [1.0, 0.0]]), point=np.array([0, 1]))
    >>> overlap(halves, whole).means(np.array([[1.0], [3.0]])).tolist()
    [[2.0]]
    """
    own = np.repeat(np.arange(len(old.corners))[:, None], 2, axis=1)
    itself = _moments(old.corners, old.corners, own, radial).reshape(len(old.whole), old.pieces, -1).sum(axis=1)
    centroid = itself[:, 1:] / itself[:, :1]
    pairs = _candidates(old, new)
    pairs, found = _joined(pairs, _moments(old.corners, new.corners, pairs, radial), old.pieces, new.pieces)
    around = old.neighbours()
    return Overlap(
        pairs=pairs[:, ::-1],
        measure=found[:, 0],
        arm=found[:, 1:] - found[:, :1] * centroid[pairs[:, 0]],
        covered=np.asarray(np.bincount(pairs[:, 1], found[:, 0], minlength=len(new.whole)), dtype=float),
        nearest=cKDTree(old.centre).query(new.centre)[1].astype(np.int64),
        slopes=_slopes(centroid, around),
        reach=old.whole - centroid[:, None],
        around=around,
    )


def _joined(pairs: IntArray, moments: Array, ours: int, theirs: int) -> tuple[IntArray, Array]:
    """Pairs of control volumes and their moments, from those of their pieces."""
    some = moments[:, 0] != 0.0
    pairs, moments = pairs[some], moments[some]
    if ours == 1 and theirs == 1:
        return pairs, moments
    both, number = np.unique(pairs // [ours, theirs], axis=0, return_inverse=True)
    out = np.zeros((len(both), moments.shape[1]))
    np.add.at(out, number.ravel(), moments)
    return np.asarray(both, dtype=np.int64), out


def _moments(one: Array, other: Array, pairs: IntArray, radial: bool) -> Array:
    """Measure and first moments (k, 1 + d) of the intersections of pairs (k, 2)."""
    ours, theirs, which = np.ascontiguousarray(one), np.ascontiguousarray(other), np.ascontiguousarray(pairs)
    if ours.shape[2] == 2:
        return np.asarray(polygon_overlaps(ours, theirs, which, radial))
    return np.asarray(tetrahedron_overlaps(ours, theirs, which))


def _candidates(old: ControlVolumes, new: ControlVolumes) -> IntArray:
    """Pairs (k, 2) of old and new volumes whose boxes overlap."""
    low, high = old.corners.min(axis=1), old.corners.max(axis=1)
    below, above = new.corners.min(axis=1), new.corners.max(axis=1)
    size = float(np.linalg.norm(high - low, axis=1).max()) if len(old.corners) else 0.0
    reach = 0.5 * (size + np.linalg.norm(above - below, axis=1))
    lists = cKDTree(0.5 * (low + high)).query_ball_point(0.5 * (below + above), reach * (1.0 + 1e-9))
    counts = np.array([len(one) for one in lists])
    pairs = np.stack([np.concatenate([np.asarray(one, dtype=np.int64) for one in lists]),
                      np.repeat(np.arange(len(counts)), counts)], axis=1)  # fmt: skip
    ours, theirs = pairs.T
    meet = ((low[ours] < above[theirs]) & (below[theirs] < high[ours])).all(axis=1)
    return np.asarray(pairs[meet])


def _slopes(centroid: Array, around: sp.csr_array) -> tuple[sp.csr_array, ...]:
    """Matrices (a, a) of the components of the gradient, by least squares of the means around each volume."""
    count, d = centroid.shape
    rows, columns = around.nonzero()
    way = centroid[columns] - centroid[rows]
    square = np.zeros((count, d, d))
    np.add.at(square, rows, way[:, :, None] * way[:, None, :])
    inverse = np.linalg.pinv(square, rcond=1e-10, hermitian=True)
    weights = np.einsum("kij,kj->ki", inverse[rows], way)
    total = np.zeros((count, d))
    np.add.at(total, rows, weights)
    diagonal = np.arange(count)
    places = np.concatenate([rows, diagonal]), np.concatenate([columns, diagonal])
    data = np.concatenate([weights, -total])
    return tuple(sp.csr_array((data[:, i], places), shape=(count, count)) for i in range(d))
