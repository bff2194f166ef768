"""Steps of conjugate gradients: product with a stored matrix, and the updates of all vectors in one pass.

Rows and entries are computed independently, so results do not depend on the number of threads, bit by bit.
"""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.jit.compilation import unfused_kernel
from softway.kernels.jit.threads import share

_ROWS, _ENTRIES = 4096, 32768  # rows of a product, and entries of vectors, that a thread takes at a time


@unfused_kernel
def product(indptr, indices, data, x, out, first, last):
    """Write rows ``first`` to ``last`` of the product of a matrix in compressed rows with x (f,) to ``out`` (f,)."""
    for row in range(first, last):
        total = 0.0
        for k in range(np.uint64(indptr[row]), np.uint64(indptr[row + 1])):  # unsigned: no wrap-around
            total += data[k] * x[np.uint64(indices[k])]
        out[row] = total


@unfused_kernel
def step(alpha, beta, z, w, p, Ap, x, Ax, r, first, last):
    """``p = z + beta p``, ``Ap = w + beta Ap``, ``x += alpha p``, ``Ax += alpha Ap``, ``r -= alpha Ap`` of (f,)."""
    for k in range(first, last):
        p[k] = z[k] + beta * p[k]
        Ap[k] = w[k] + beta * Ap[k]
        change = alpha * Ap[k]
        x[k] += alpha * p[k]
        Ax[k] += change
        r[k] -= change


def shared_step(alpha: float, beta: float, *vectors: Array) -> None:
    """:func:`step` of all entries, in several threads."""
    size = len(vectors[0])

    def task(first: int, last: int) -> None:
        step(alpha, beta, *vectors, first * _ENTRIES, min(last * _ENTRIES, size))

    share(task, -(-size // _ENTRIES))


def shared_product(indptr: IntArray, indices: IntArray, data: Array, x: Array) -> Array:
    """Product (f,) of a matrix (f, f) in compressed rows with x (f,), in several threads.

    Examples
    --------
    >>> shared_product(np.array([0, 1, 3]), np.array([0, 0, 1]), np.array([2.0, 1.0, 3.0]), np.array([1.0, 2.0]))
    array([2., 7.])
    """
    out = np.empty(len(x))

    def task(first: int, last: int) -> None:
        product(indptr, indices, data, x, out, first * _ROWS, min(last * _ROWS, len(out)))

    share(task, -(-len(out) // _ROWS))
    return out
