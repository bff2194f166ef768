"""Operator of compiled slabs (time steps) in a band."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import reverse_cuthill_mckee

from softway.arrays import Array, IntArray
from softway.kernels.slab.band import spread_factor
from softway.kernels.slab.march import factor

LARGEST = 3e5
"""Greatest number of entries of the band of a factor: beyond it, sparse factors are faster."""


@dataclass(frozen=True, slots=True, eq=False)
class BandOrder:
    """Places (f,) of the unknowns in a band with ``width`` diagonals, after the ordering of Cuthill and McKee."""

    place: IntArray
    width: int


def band_order(matrix: sp.csr_array) -> BandOrder | None:
    """Order of a symmetric matrix (f, f) in a band; None if it is empty, or the band too large."""
    if not matrix.shape[0]:
        return None
    order = np.asarray(reverse_cuthill_mckee(matrix, symmetric_mode=True), np.int64)
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    i, j = sp.coo_array(matrix).coords
    width = int(np.abs(place[i] - place[j]).max(initial=0)) + 1
    return None if width * len(order) > LARGEST else BandOrder(place, width)


class SlabFactor(NamedTuple):
    """Factor of the operator of compiled slabs, see :func:`~softway.kernels.slab.solution.solve`: ``down`` and ``up``
    (f, w + 4) in a band, and ``pivot`` (f,); or ``single`` (2, f) and ``library`` (18,) for the factor of a library.
    """

    down: Array
    up: Array
    pivot: Array
    single: NDArray[np.float32] = np.zeros((2, 0), np.float32)
    library: IntArray = np.zeros(0, np.int64)


def banded_factor(matrix: sp.csr_array, order: BandOrder) -> SlabFactor | None:
    """Factor in a band; None if the matrix is not positive definite."""
    entries = sp.coo_array(matrix)
    i, j = (order.place[c] for c in entries.coords)
    below, shape = i >= j, (matrix.shape[0], order.width)
    band, lower, pivot = np.zeros(shape), np.zeros(shape), np.zeros(shape[0])
    band[i[below], (i - j)[below]] = entries.data[below]
    if not factor(band, lower, pivot):
        return None
    down, up = (np.zeros((shape[0], shape[1] + 3)) for _ in range(2))
    spread_factor(lower, down, up)
    return SlabFactor(down, up, pivot)
