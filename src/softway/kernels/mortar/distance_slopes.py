"""Slopes of the distance of two surfaces, measured along the normals of the slave.

The derivatives are explained in docs/theory/contact/mortar.md.
"""

from softway.kernels.jit.compilation import uncounted, uncounted_kernel
from softway.kernels.mortar.simplices import vector_area

STEEP = 0.2
"""Lower bound of the cosine between two surfaces when their distance is measured."""


@uncounted_kernel
def distance_slopes(slave, master, pairs, below, above, square, gradient, facing, leaning):
    """Slopes of the distances: ``facing`` (s, d) of the pairs, and ``leaning`` (p, k, k, d) of the slave simplices.

    The former are those of a shift of the slave.  The latter are integrals of coordinates on the slave times the change
    of the distance when its corners move: this also turns the direction in which it is measured.  Without the turn a
    row of two surfaces that are not parallel would have a moment.  ``square`` (1, d) and ``gradient`` (k, d) are room.
    """
    d, p, k = below.shape[1], slave.corner.shape[0], slave.corner.shape[1]
    for i in range(p):
        if pairs.first[i] < pairs.first[i + 1]:
            _gradients(below, slave.corner, i, square, gradient)
        for s in range(pairs.first[i], pairs.first[i + 1]):
            _face(above, master.corner, pairs.master[s], square, facing, s)
            for a in range(k):
                distance = 0.0
                for b in range(k):
                    own, cross = slave.corner[i, b], master.corner[pairs.master[s], b]
                    for c in range(d):
                        both = pairs.own[s, a, b] * below[own, c] - pairs.cross[s, a, b] * above[cross, c]
                        distance += facing[s, c] * both
                for b in range(k):
                    lean = 0.0
                    for c in range(d):
                        lean += gradient[b, c] * facing[s, c]
                    for c in range(d):
                        leaning[i, a, b, c] += pairs.own[s, a, b] * facing[s, c] - distance * lean * square[0, c]


@uncounted
def _gradients(vertices, corner, i, square, gradient):
    """Unit normal (1, d) of a simplex, and gradients (k, d), along it, of its barycentric coordinates."""
    size = vector_area(vertices, corner, i, square, 0)
    for c in range(square.shape[1]):
        square[0, c] /= size
    if len(gradient) == 2:
        for c in range(2):
            gradient[1, c] = (vertices[corner[i, 1], c] - vertices[corner[i, 0], c]) / (size * size)
            gradient[0, c] = -gradient[1, c]
        return
    for k in range(3):
        start, end = corner[i, (k + 1) % 3], corner[i, (k + 2) % 3]
        for c in range(3):
            y, z = (c + 1) % 3, (c + 2) % 3
            turned = square[0, y] * (vertices[end, z] - vertices[start, z])
            gradient[k, c] = (turned - square[0, z] * (vertices[end, y] - vertices[start, y])) / (2.0 * size)


@uncounted
def _face(vertices, corner, j, square, facing, s):
    """Slopes of the distance along a slave normal: the master normal divided by its cosine."""
    size, cosine = vector_area(vertices, corner, j, facing, s), 0.0
    for c in range(facing.shape[1]):
        facing[s, c] /= size if size > 0.0 else 1.0
        cosine -= square[0, c] * facing[s, c]
    for c in range(facing.shape[1]):
        facing[s, c] /= max(cosine, STEEP)
