"""Arrays of a model for its compiled slabs; nodal fields are flat, component ``i d + a`` of node i."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.by_address import BLOCKS, FLAGS, NUMBERS, ROWS, SINGLES, WHOLE, WHOLES, Tuple, caller, table


class Bodies(NamedTuple):
    """Solids with linear laws: N components of n nodes in d dimensions, f unknowns.

    ``first`` (parts + 1,) are the first nodes of the solids, ``group`` (parts,) the groups of solids that share
    unknowns; ``heavy`` (N,) are components with inertia, ``place`` (N,) the places of the components in the band, -1
    for a supported one.  ``mass`` and ``stiff`` are sparse rows of nodes: ``mass_start`` (n + 1,), ``mass_node``
    (z,), ``mass`` (z,) and the row sums ``weight`` (n,); ``stiff_start`` (n + 1,), ``stiff_node`` (y,) and ``stiff``
    (y, d, d) without the diagonal, as translations cause no force.  ``points``, ``load`` and ``load_before``
    (N,), at both ends of a slab, and ``floor`` (parts,) as in the model.  Supports have the velocity ``given`` (N,) at
    the end of a slab, and move by ``bent`` (N,) beyond the way of linear velocities.
    """

    dimension: int
    first: IntArray
    group: IntArray
    heavy: BoolArray
    place: IntArray
    mass_start: IntArray
    mass_node: IntArray
    mass: Array
    weight: Array
    stiff_start: IntArray
    stiff_node: IntArray
    stiff: Array
    points: Array
    load: Array
    load_before: Array
    given: Array
    bent: Array
    floor: Array


class Rows(NamedTuple):
    """Contact rows (M,) whose directions never change, m ``normals`` and then with friction the tangential ones.

    Sparse rows ``start`` (M + 1,), ``component`` and ``value`` (z,); gaps at zero displacement at both ends of a slab,
    ``before`` and ``offset`` (M,), and the motion ``moved`` (M,) of the tools along the rows in between; of the normal
    rows ``contact`` (m,) and ``part`` (m,), if unknowns ``move`` them (m,), and the overlap ``allowed`` (m,) of the
    free motion [m].
    """

    normals: int
    start: IntArray
    component: IntArray
    value: Array
    before: Array
    offset: Array
    moved: Array
    contact: IntArray
    part: IntArray
    move: BoolArray
    allowed: Array


class Operator(NamedTuple):
    """Factor ``down``, ``up`` (f, w + 4) and ``pivot`` (f,) of the operator in a band, see
    :func:`~softway.kernels.slab.band.spread_factor`, or that of a ``library`` with its arrays in ``single`` precision,
    see :func:`~softway.kernels.slab.solution.solve`; and the ``active`` rows (k,): the answers
    ``answer`` (k, N) to a unit impulse on each, and the ``inverse`` (k, k) of their compliance.  Tangential rows
    ``slip`` (j,) have ``factor`` (j,) times the impulse of their normal row ``partner`` (j,), in its answer as well.
    """

    down: Array
    up: Array
    pivot: Array
    single: NDArray[np.float32]
    library: IntArray
    active: IntArray
    answer: Array
    inverse: Array
    slip: IntArray
    partner: IntArray
    factor: Array


class Course(NamedTuple):
    """States of successive slabs: ``time`` (s + 1,); ``u``, ``v``, ``slope`` and ``force`` (s + 1, N), ``pressure``
    (s + 1, M), ``energy`` (s + 1, parts); ``scalar`` (s, parts) of the energy balance; ``support`` (s, N), without a
    row where nothing is supported; ``sums`` (s, SUMS) and, of the contacts, ``met`` (s, contacts, MET).
    """

    time: Array
    u: Array
    v: Array
    slope: Array
    force: Array
    pressure: Array
    energy: Array
    scalar: Array
    support: Array
    sums: Array
    met: Array


class Work(NamedTuple):
    """Fields (N,) of a slab: velocity, its correction, momenta at both ends, contact forces; and sums (groups, 3) and
    works (parts, WORKS).
    """

    q: Array
    x: Array
    before: Array
    after: Array
    push: Array
    row: Array
    group: Array
    works: Array


class PartCall(NamedTuple):
    """What optional parts of a kernel receive: addresses ``places`` (8,) of its tables, and the number of a slab."""

    places: IntArray
    number: int


PART = Tuple.of(PartCall, WHOLES, WHOLE)
call_part = caller(PART)
"""Kind of the argument of a part, and the call of the part at an address."""

bodies_at = table(
    "Bodies",
    dimension=WHOLE,
    first=WHOLES,
    group=WHOLES,
    heavy=FLAGS,
    place=WHOLES,
    mass_start=WHOLES,
    mass_node=WHOLES,
    mass=NUMBERS,
    weight=NUMBERS,
    stiff_start=WHOLES,
    stiff_node=WHOLES,
    stiff=BLOCKS,
    points=NUMBERS,
    load=NUMBERS,
    load_before=NUMBERS,
    given=NUMBERS,
    bent=NUMBERS,
    floor=NUMBERS,
)
rows_at = table(
    "Rows",
    normals=WHOLE,
    start=WHOLES,
    component=WHOLES,
    value=NUMBERS,
    before=NUMBERS,
    offset=NUMBERS,
    moved=NUMBERS,
    contact=WHOLES,
    part=WHOLES,
    move=FLAGS,
    allowed=NUMBERS,
)
operator_at = table(
    "Operator",
    down=ROWS,
    up=ROWS,
    pivot=NUMBERS,
    single=SINGLES,
    library=WHOLES,
    active=WHOLES,
    answer=ROWS,
    inverse=ROWS,
    slip=WHOLES,
    partner=WHOLES,
    factor=NUMBERS,
)
course_at = table(
    "Course",
    time=NUMBERS,
    u=ROWS,
    v=ROWS,
    slope=ROWS,
    force=ROWS,
    pressure=ROWS,
    energy=ROWS,
    scalar=ROWS,
    support=ROWS,
    sums=ROWS,
    met=BLOCKS,
)
work_at = table(
    "Work", q=NUMBERS, x=NUMBERS, before=NUMBERS, after=NUMBERS, push=NUMBERS, row=NUMBERS, group=ROWS, works=ROWS
)
"""The tables at addresses, for kernels."""

KINETIC, STRAIN, WORK, ERROR, MOMENTUM, SPIN, UNCLOSED, COMPLEMENTARITY, POWER, ITERATIONS, FIRST, LAST, LOST = (
    0, 1, 2, 3, 4, 7, 10, 11, 12, 13, 14, 15, 16,
)  # fmt: skip
"""Columns of the sums of a slab: energies and works as in the ledger, momentum and spin (3 each), momentum error,
complementarity and power of the certificate, number of iterations, the first and the last change [m/s], and the
energy dissipated so far."""
SUMS = 17
FORCE, GAP, CLOSED_POWER, COUNT, FORCE_T = range(5)
"""Columns of a contact: force, least gap, power residual, number of closed rows, and tangential force."""
MET = 5
