"""The two sides of contact rows: the points of both surfaces between which heat passes."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.contact.contact_rows import ContactRows

LEAST = 0.5
"""Sum of the weights of a side, relative to one, below which there is none: an opponent without nodes is a tool."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContactSides:
    """Sides of r rows.

    Parameters
    ----------
    mine, theirs
        (r, n) weights of the nodes at the point of either side; their sum is one, or zero where there is none.
    opponent
        (r,) a node of the other side; -1 for tools.
    """

    mine: sp.csr_array
    theirs: sp.csr_array
    opponent: IntArray


def contact_sides(first: ContactRows, last: ContactRows, rows: IntArray, part_of: IntArray) -> ContactSides:
    """Sides of some ``rows`` (r,) in a slab: at its end, or at its start for rows that have no opponent at the end.

    Parameters
    ----------
    first, last
        Contact rows at both ends.
    rows
        Their numbers.
    part_of
        (n,) number of the solid of each node.
    """
    near = last.near[rows]
    found = _weights(last, rows)
    if not near.all() and first is not last:
        pick = [sp.diags_array(mask.astype(float)) for mask in (near, ~near)]
        found = sp.csr_array(pick[0] @ found + pick[1] @ _weights(first, rows))
    row = np.repeat(np.arange(len(rows)), np.diff(found.indptr))
    foreign = part_of[found.indices] != part_of[last.node[rows]][row]
    meets = np.bincount(row[foreign], minlength=len(rows)) > 0
    ours = np.where(meets[row], ~foreign, found.data > 0.0)
    mine, theirs = (_side(found, row, keep, sign) for keep, sign in ((ours, 1.0), (~ours, -1.0)))
    strongest = np.full(len(rows), -1)
    entries = np.flatnonzero(theirs.data > 0.0)
    strongest[row[entries]] = found.indices[entries]
    return ContactSides(mine=mine, theirs=theirs, opponent=strongest)


def _weights(rows: ContactRows, which: IntArray) -> sp.csr_array:
    """Weights (r, n) of the nodes in the gaps of some rows, along their normals."""
    d = rows.normal.shape[1]
    some = rows.gradient[which]
    row = np.repeat(np.arange(len(which)), np.diff(some.indptr))
    data = some.data * rows.normal[which][row, some.indices % d]
    n = rows.gradient.shape[1] // d
    return sp.csr_array((data, (row, some.indices // d)), shape=(len(which), n))


def _side(weights: sp.csr_array, row: IntArray, keep: BoolArray, sign: float) -> sp.csr_array:
    """One side of rows with such ``weights`` (r, n), with a sum of one."""
    data = np.where(keep, sign * weights.data, 0.0)
    total = np.bincount(row, weights=data, minlength=weights.shape[0])
    scale: Array = np.where(total > LEAST, 1.0 / np.where(total > LEAST, total, 1.0), 0.0)
    return sp.csr_array((data * scale[row], weights.indices, weights.indptr), shape=weights.shape)
