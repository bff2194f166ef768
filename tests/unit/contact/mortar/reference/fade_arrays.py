"""NumPy reference: weights of pairs that hardly face each other, and the slopes of the gaps by their changes.

The derivative of the gaps with respect to a weight is that of a complex step.
"""

import numpy as np
import scipy.sparse as sp
from overlap_arrays import Overlap
from weight_arrays import gap_weights

from softway.arrays import Array, IntArray
from softway.contact.mortar.mortar import Mortar

FULL, NONE = np.cos(np.pi / 4.0), np.cos(np.pi / 3.0)
STEP = 1e-30


def pair_weights(square: Array, normal: Array) -> Array:
    """Weights (s,) of pairs with the unit normals ``square`` and ``normal`` (d, s) of slave and master."""
    way = np.clip((-np.sum(square * normal, axis=0) - NONE) / (FULL - NONE), 0.0, 1.0)
    return np.asarray(3.0 * way**2 - 2.0 * way**3)


def weight_changes(square: Array, normal: Array, gradients: tuple[Array, Array]) -> tuple[Array, Array]:
    """Changes (d, k, s) of the weights under a motion of the corners of slave and master; ``gradients`` (d, k, s) are
    those of the barycentric coordinates of both.
    """
    way = np.clip((-np.sum(square * normal, axis=0) - NONE) / (FULL - NONE), 0.0, 1.0)
    slope = 6.0 * way * (1.0 - way) / (FULL - NONE)
    mine = np.einsum("dks,ds->ks", gradients[0], normal) * slope
    others = np.einsum("dks,ds->ks", gradients[1], square) * slope
    return mine * square[:, None], others * normal[:, None]


def gap_change(
    mortar: Mortar, points: Array, size: Array, common: Overlap, pair: tuple[IntArray, IntArray], apart: Array, s: int
) -> Array:
    """Derivative (m,) of the gaps with respect to the weight of the pair s, relative to the weight.

    Arguments: control points and sizes of the slave, the overlaps with their weights, numbers of the simplices, and the
    integrals ``apart`` (k, s) of coordinates and distances.
    """
    factor = np.ones(len(pair[0]), complex)
    factor[s] += 1j * STEP
    mass = np.zeros((*common.own.shape[:2], len(size)), complex)
    np.add.at(mass, (slice(None), slice(None), pair[0]), common.own * factor)
    functions = gap_weights(mortar.slave, points, size, mass)
    total = functions.means(pair[0], common.cross * factor, np.ones((1, len(factor))))
    block = np.einsum("bks,ks->bs", np.take(functions.values, pair[0], axis=2), apart * factor)
    distance = np.zeros(len(points), complex)
    np.add.at(distance, np.take(functions.row, pair[0], axis=1), block)
    total, distance = (mortar.slave.nodal(sp.csr_array(v.reshape(-1, 1))).toarray().ravel() for v in (total, distance))
    met = np.real(total) > 0.0
    return np.asarray(np.where(met, np.imag(distance / np.where(met, total, 1.0)) / STEP, 0.0))
