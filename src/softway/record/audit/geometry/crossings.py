"""Crossings of the lines of a boundary with the flat pieces of another: where bodies overlap between their nodes."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray

WITHIN = (0.25, 0.5, 0.75)
"""Places in an interval between two crossings of a line at which the overlap is looked at."""
PARALLEL = 1e-14
"""Determinant, relative to the lengths, below which a line is parallel to a piece: its ends show the overlap."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Samples:
    """Points on lines: their line (k,), and the fraction (k,) of its length from its first end."""

    line: IntArray
    fraction: Array


def crossings(ends: Array, pieces: Array) -> tuple[Array, Array]:
    """Fractions (k,) of lines at which they cross the planes of pieces, and (k,) whether they cross the pieces.

    Parameters
    ----------
    ends
        (k, 2, d) ends of the lines [m].
    pieces
        (k, d, d) corners of the pieces: segments in the plane, triangles in space [m].

    Examples
    --------
    >>> line = np.array([[[0.0, -1.0], [0.0, 3.0]]])
    >>> fraction, hit = crossings(line, np.array([[[-1.0, 0.0], [1.0, 0.0]]]))
    >>> fraction.tolist(), hit.tolist()
    ([0.25], [True])
    """
    along = ends[:, 1] - ends[:, 0]
    sides = pieces[:, 1:] - pieces[:, :1]
    matrix = np.concatenate([-along[:, :, None], sides.transpose(0, 2, 1)], axis=2)
    size = np.prod(np.linalg.norm(matrix, axis=1), axis=1)
    good = np.abs(np.linalg.det(matrix)) > PARALLEL * size
    out = np.full((len(ends), ends.shape[2]), -1.0)
    right = ends[:, 0] - pieces[:, 0]
    out[good] = np.linalg.solve(matrix[good], right[good][:, :, None])[:, :, 0]
    shares = out[:, 1:]
    hit = good & (out[:, 0] > 0.0) & (out[:, 0] < 1.0) & (shares >= 0.0).all(axis=1) & (shares.sum(axis=1) <= 1.0)
    return out[:, 0], hit


def between(line: IntArray, fraction: Array) -> Samples:
    """Points between the crossings (k,) of lines, and between the crossings and the ends.

    Examples
    --------
    >>> found = between(np.array([7]), np.array([0.4]))
    >>> found.line.tolist(), found.fraction.round(2).tolist()
    ([7, 7, 7, 7, 7, 7], [0.1, 0.55, 0.2, 0.7, 0.3, 0.85])
    """
    crossed = np.unique(line)
    line = np.concatenate([line, crossed, crossed])
    fraction = np.concatenate([fraction, np.zeros(len(crossed)), np.ones(len(crossed))])
    order = np.lexsort((fraction, line))
    line, fraction = line[order], fraction[order]
    same = line[1:] == line[:-1]
    start, stop = fraction[:-1][same], fraction[1:][same]
    points = [start + share * (stop - start) for share in WITHIN]
    return Samples(line=np.tile(line[:-1][same], len(WITHIN)), fraction=np.concatenate(points))
