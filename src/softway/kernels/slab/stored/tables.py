"""Arrays of solids with stored energies, and of the iterations of their slabs (time steps)."""

from typing import NamedTuple

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.by_address import BLOCKS, FLAGS, LANES, NUMBERS, ROWS, WHOLE, WHOLES, table


class Cells(NamedTuple):
    """Cells of one type with their law, as for :mod:`softway.kernels.fused.elastic`; ``energy`` (b, LANES) is work
    space.
    """

    measure: int
    law: int
    moduli: Array
    rows: IntArray
    table: Array
    geometry: Array
    starts: IntArray
    energy: Array


class Stored(NamedTuple):
    """A solid: the address of the function of its ``forces``, those of its tables ``cells`` (k,), the node of each of
    its ``extra`` rows (h,), and work space: ``u`` and ``out`` (n + h + 1, d) for displacements and forces, whose last
    row belongs to lanes without a cell, and ``energy`` (1,).
    """

    forces: int
    cells: IntArray
    extra: IntArray
    u: Array
    out: Array
    energy: Array


class Search(NamedTuple):
    """Iterations of a slab: ``solids`` (parts,) are the addresses of their tables.

    ``balance`` (groups, BALANCE) takes the terms of the energy balance.  The last differences are ``residuals``
    (depth, N) and ``values`` (depth, N + m), with their products ``gram`` (depth, depth); ``last`` (2 N + m,) are the
    residual and the value before, ``small`` (3, depth, depth) is work space, ``kept`` (2,) counts the differences and
    tells if there is a value before.  ``changes`` (most,) are the changes of the iterates [m/s], ``limits`` (LIMITS,)
    and ``taken`` (TAKEN,) are numbers of the march.
    """

    solids: IntArray
    balance: Array
    residuals: Array
    values: Array
    gram: Array
    last: Array
    small: Array
    kept: IntArray
    changes: Array
    limits: Array
    taken: IntArray


class Turning(NamedTuple):
    """Rotation of n nodes since the operator was made.

    Sparse rows ``start`` (n + 1,), ``node`` (z,) and ``slope`` (z, d) give the mean derivatives around a node;
    ``before`` (n, d, d) are the deformation gradients where the operator was made, ``inverse`` their inverses.  Nodes
    that are ``free`` (n,) of supports turn by ``rotation`` (n, d, d).  ``limit`` (1,) is the root mean square of
    ``R - I`` below which nothing turns, and ``state`` (2,) tells if closed rows are solved for in axes that turn, and
    if these have.  ``compliance`` (k, k) and ``size`` (k,) are work space.
    """

    start: IntArray
    node: IntArray
    slope: Array
    before: Array
    inverse: Array
    free: BoolArray
    rotation: Array
    limit: Array
    state: IntArray
    compliance: Array
    size: Array


cells_at = table(
    "Cells",
    measure=WHOLE,
    law=WHOLE,
    moduli=NUMBERS,
    rows=LANES,
    table=BLOCKS,
    geometry=BLOCKS,
    starts=WHOLES,
    energy=ROWS,
)
stored_at = table("Stored", forces=WHOLE, cells=WHOLES, extra=WHOLES, u=ROWS, out=ROWS, energy=NUMBERS)
search_at = table(
    "Search",
    solids=WHOLES,
    balance=ROWS,
    residuals=ROWS,
    values=ROWS,
    gram=ROWS,
    last=NUMBERS,
    small=BLOCKS,
    kept=WHOLES,
    changes=NUMBERS,
    limits=NUMBERS,
    taken=WHOLES,
)
turning_at = table(
    "Turning",
    start=WHOLES,
    node=WHOLES,
    slope=ROWS,
    before=BLOCKS,
    inverse=BLOCKS,
    free=FLAGS,
    rotation=BLOCKS,
    limit=NUMBERS,
    state=WHOLES,
    compliance=ROWS,
    size=NUMBERS,
)
"""The tables at addresses, for kernels."""

MISSING, CHANGE, ROUNDING, WORK, STRAINED, FLOOR, TOUCHED, SCALAR = range(8)
"""Columns of the balance of a group: missing work, its derivative by the scalar, its rounding, the work of the mean
force, stored energies, energy of an undeformed body, if a row touches, and the scalar."""
BALANCE = 8
TOLERANCE, PRICE, USUAL, WORN, ROUGH, SLIGHT = range(6)
"""Limits: tolerance of the iteration, cost of an operator in iterations, usual number of iterations, its multiple above
which an operator may be worn; scalar, and missing work relative to the work of the mean force, above which the next
slab may be shorter."""
LIMITS = 6
SLABS, TOTAL, LEAST, BEFORE, LATEST, DEAR = range(6)
"""Iterations since the operator was made: number of slabs, of their iterations, least of a slab, those of the last two
slabs, and 1 if the next slab needs a new operator."""
TAKEN = 6
MIXED, NOW = range(2)
STRAIGHT, TURNED, UNKNOWN = range(3)
"""Entries of ``Turning.state``, and what has happened to the axes: nothing, a rotation, or one near its limit."""
