"""The shortest of many edges."""

import numpy as np

from softway.kernels.compiled import kernel


@kernel
def shortest(points, moved, ends):
    """Least length [m] of the edges between the nodes ``ends`` (e, 2) at ``points + moved`` (n, d)."""
    least = np.inf
    for k in range(len(ends)):
        one, two = ends[k, 0], ends[k, 1]
        square = 0.0
        for i in range(points.shape[1]):
            apart = (points[one, i] + moved[one, i]) - (points[two, i] + moved[two, i])
            square += apart * apart
        least = min(least, square)
    return np.sqrt(least)
