"""Length of the shortest edge of a mesh."""

import numpy as np

from softway.kernels.jit.compilation import kernel


@kernel
def shortest(points, moved, ends):
    """Shortest length [m] of the edges ``ends`` (e, 2) between nodes at the positions ``points + moved`` (n, d)."""
    least = np.inf
    for k in range(len(ends)):
        one, two = ends[k, 0], ends[k, 1]
        square = 0.0
        for i in range(points.shape[1]):
            apart = (points[one, i] + moved[one, i]) - (points[two, i] + moved[two, i])
            square += apart * apart
        least = min(least, square)
    return np.sqrt(least)
