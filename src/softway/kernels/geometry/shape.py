"""Shapes of cells: the sign of their maps at points, and the scaled Jacobian."""

import numpy as np

from softway.kernels.jit.compilation import inlined, kernel


@kernel
def shapes(points, moved, cells, frames, folds, best, rounding):
    """Least scaled Jacobian (e,) of ``cells`` (e, a) with nodes at ``points + moved`` (n, d).

    ``frames`` (f, a, d) give the tangents of each cell at points and in directions.  At the first ``folds`` of them
    only the sign counts: a determinant below ``-rounding`` of the lengths of the tangents; at the others the
    determinant over these lengths and over ``best``.
    """
    count, nodes, d = len(cells), cells.shape[1], points.shape[1]
    out = np.empty(count)
    x = np.empty((nodes, d))
    for e in range(count):
        for a in range(nodes):
            for i in range(d):
                x[a, i] = points[cells[e, a], i] + moved[cells[e, a], i]
        fold, flat = 0.0, np.inf
        for f in range(len(frames)):
            volume, lengths = _in_plane(frames[f], x) if d == 2 else _in_space(frames[f], x)
            if f < folds:
                if volume < 0.0:
                    fold = min(fold, volume / (np.sqrt(lengths) * best))
            else:
                flat = min(flat, volume / (np.sqrt(lengths) * best) if lengths > 0.0 else 0.0)
        out[e] = min(fold, flat) if fold < -rounding else flat
    return out


@inlined
def _in_plane(frame, x):
    """Determinant of the two tangents of nodes x (a, 2), and the product of their squares."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    for n in range(len(x)):
        a += frame[n, 0] * x[n, 0]
        b += frame[n, 1] * x[n, 0]
        c += frame[n, 0] * x[n, 1]
        d += frame[n, 1] * x[n, 1]
    return a * d - b * c, (a * a + c * c) * (b * b + d * d)


@inlined
def _in_space(frame, x):
    """Determinant of the three tangents of nodes x (a, 3), and the product of their squares."""
    a0, a1, a2, b0, b1, b2, c0, c1, c2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(len(x)):
        p, q, r = frame[n, 0], frame[n, 1], frame[n, 2]
        u, v, w = x[n, 0], x[n, 1], x[n, 2]
        a0 += p * u
        a1 += q * u
        a2 += r * u
        b0 += p * v
        b1 += q * v
        b2 += r * v
        c0 += p * w
        c1 += q * w
        c2 += r * w
    volume = a0 * (b1 * c2 - b2 * c1) - a1 * (b0 * c2 - b2 * c0) + a2 * (b0 * c1 - b1 * c0)
    squares = (a0 * a0 + b0 * b0 + c0 * c0) * (a1 * a1 + b1 * b1 + c1 * c1) * (a2 * a2 + b2 * b2 + c2 * c2)
    return volume, squares
