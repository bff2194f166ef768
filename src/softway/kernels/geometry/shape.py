"""Shapes of cells: the sign of their maps at points, and the scaled Jacobian."""

import numpy as np

from softway.kernels.jit.compilation import kernel


@kernel
def shapes(points, moved, cells, frames, folds, best, rounding):
    """Least scaled Jacobian (e,) of ``cells`` (e, a) with nodes at ``points + moved`` (n, d).

    ``frames`` (f, a, d) give the tangents of each cell at points and in directions.  At the first ``folds`` of them
    only the sign counts: a determinant below ``-rounding`` of the lengths of the tangents; at the others the
    determinant over these lengths and over ``best``.
    """
    count, nodes, d = len(cells), cells.shape[1], points.shape[1]
    out = np.empty(count)
    x, t = np.empty((nodes, d)), np.empty((d, d))
    for e in range(count):
        for a in range(nodes):
            for i in range(d):
                x[a, i] = points[cells[e, a], i] + moved[cells[e, a], i]
        fold, flat = 0.0, np.inf
        for f in range(len(frames)):
            lengths = 1.0
            for j in range(d):
                square = 0.0
                for i in range(d):
                    t[i, j] = 0.0
                    for a in range(nodes):
                        t[i, j] += frames[f, a, j] * x[a, i]
                    square += t[i, j] * t[i, j]
                lengths *= np.sqrt(square)
            if d == 2:
                volume = t[0, 0] * t[1, 1] - t[0, 1] * t[1, 0]
            else:
                volume = (
                    t[0, 0] * (t[1, 1] * t[2, 2] - t[1, 2] * t[2, 1])
                    - t[0, 1] * (t[1, 0] * t[2, 2] - t[1, 2] * t[2, 0])
                    + t[0, 2] * (t[1, 0] * t[2, 1] - t[1, 1] * t[2, 0])
                )
            scaled = volume / (lengths * best) if lengths > 0.0 else 0.0
            if f < folds:
                fold = min(fold, scaled)
            else:
                flat = min(flat, scaled)
        out[e] = min(fold, flat) if fold < -rounding else flat
    return out
