"""Compliance of many contact directions at once, from the Schur complement of the unknowns that they touch.

One more factor, which ends at the contact, and a dense inverse cost less than a solution for each direction.
"""

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.kernels.linalg.dense import inverse_positive
from softway.solve.linear.interface import CondensingFactor, Factor

MANY = 256
"""Number of directions below which solutions for each are as fast."""


def condensed_compliance(factor: Factor, directions: sp.csc_array, missing: int) -> Array | None:
    """Compliance ``B^T A^-1 B`` (b, b) of all ``directions`` B (f, b) of a factored A, with ``missing`` columns as yet;
    None where their solutions are cheaper, or where A cannot be condensed.

    With c unknowns in the directions and a factor of e entries, the dense inverse takes 2 c^3 operations, and each
    solution 4 e, more slowly.
    """
    if missing < MANY or not isinstance(factor, CondensingFactor):
        return None
    own = np.unique(directions.indices)
    if float(len(own)) ** 3 > missing * factor.bytes / 2.0:
        return None
    complement = factor.schur_complement(own)
    inverse = None if complement is None else inverse_positive(complement)
    if inverse is None:
        return None
    part = sp.csr_array(sp.csr_array(directions)[own])
    if len(own) == part.shape[1] and part.nnz == len(own) and (part.data == 1.0).all():
        order = np.argsort(part.indices)
        return inverse if (order == part.indices).all() else inverse[np.ix_(order, order)]
    return np.asarray(part.T @ (part.T @ inverse).T)
