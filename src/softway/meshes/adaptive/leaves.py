"""Keys of leaves: cells of an adapted mesh as intervals, so that those of any two meshes of one base compare.

Bisection cuts the interval of a cell into halves.  The interval of base cell r begins at ``r * 2^40``, and a leaf of
level l has the length ``2^(40 - l)``.
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.errors import InputError

DEPTH = 40
"""Greatest level of a leaf."""
MOST_CELLS = 2 ** (62 - DEPTH)
"""Greatest number of cells of a base mesh."""


@dataclass(frozen=True, slots=True, eq=False)
class Leaves:
    """Leaves that cover a base mesh, in rising order.

    Parameters
    ----------
    start
        (e,) start of the interval of each leaf.
    level
        (e,) number of bisections from the base cell to the leaf.

    Examples
    --------
    >>> whole = roots(2)
    >>> whole.root.tolist(), whole.level.tolist()
    ([0, 1], [0, 0])
    >>> finest(whole, whole, np.array([3, 1])).tolist()
    [3, 1]
    """

    start: IntArray
    level: IntArray

    def __post_init__(self) -> None:
        self.start.flags.writeable = self.level.flags.writeable = False

    @property
    def root(self) -> IntArray:
        """Base cell (e,) of each leaf."""
        return self.start >> DEPTH

    @property
    def length(self) -> IntArray:
        """Length (e,) of the interval of each leaf."""
        return np.left_shift(np.int64(1), DEPTH - self.level)

    def around(self, start: IntArray) -> IntArray:
        """Number (k,) of the leaf whose interval contains each ``start`` (k,)."""
        return np.asarray(np.searchsorted(self.start, start, side="right") - 1)


def require_cover(leaves: Leaves, count: int) -> None:
    """Refuse leaves, such as those of a damaged file, that do not cover a base mesh of ``count`` cells.

    Raises
    ------
    InputError
        If an interval is missing, or is none of a cell.

    Examples
    --------
    >>> require_cover(roots(2), 2)
    """
    start, level = leaves.start, leaves.level
    whole = start.dtype == level.dtype == np.int64 and start.shape == level.shape == (len(start),) and len(start) > 0
    if not (whole and ((level >= 0) & (level <= DEPTH)).all()):
        raise InputError("leaves", "no starts and levels of leaves", "the leaves of an adapted mesh")
    ends = start + leaves.length
    together = start[0] == 0 and ends[-1] == count << DEPTH and (start[1:] == ends[:-1]).all()
    if not (together and (start % leaves.length == 0).all()):
        raise InputError("leaves", f"{len(start)} leaves that do not cover {count} cells", "those of this mesh")


def roots(count: int) -> Leaves:
    """Leaves of a base mesh of ``count`` cells."""
    return Leaves(np.arange(count, dtype=np.int64) << DEPTH, np.zeros(count, dtype=np.int64))


def finest(cells: Leaves, given: Leaves, level: IntArray) -> IntArray:
    """Greatest ``level`` (e,) that is given on the leaves ``given`` (e,) in the interval of each of the ``cells``."""
    first = given.around(cells.start)
    last = np.searchsorted(given.start, cells.start + cells.length, side="left")
    ends = np.column_stack([first, last]).ravel()
    return np.asarray(np.maximum.reduceat(np.append(level, 0), ends)[::2])


def same(one: Leaves, other: Leaves) -> bool:
    """True if the leaves are the same.

    Examples
    --------
    >>> same(roots(2), roots(2)), same(roots(2), roots(3))
    (True, False)
    """
    return np.array_equal(one.start, other.start) and np.array_equal(one.level, other.level)


def nested(coarse: Leaves, fine: Leaves) -> BoolArray:
    """True (e,) for each leaf of ``fine`` that lies in a leaf of ``coarse``."""
    return np.asarray(fine.level >= coarse.level[coarse.around(fine.start)])
