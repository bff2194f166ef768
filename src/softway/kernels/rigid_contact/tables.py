"""Table of the stops of a mechanism for the compiled slabs (time steps)."""

from typing import NamedTuple

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.jit.by_address import passed_by_address


@passed_by_address
class StopTable(NamedTuple):
    """Stops (s,) of a mechanism in its present state, as :class:`~softway.mechanisms.contacts.stop_rows.Stops`.

    ``rows`` (s, d) in the table of the joints; ``friction`` (s, q) in motion and ``static`` (s,) at rest; ``located``
    (s,) stops whose sliding has located instants; ``held`` (g,) groups that the ground holds by joints; ``closed``,
    ``sliding`` (s,) and ``turning`` (s, q - 1) at present; ``spent`` and ``shut`` (s,): energies that they dissipated
    in the slab [J], and times in which they were closed [s].
    """

    rows: IntArray
    friction: Array
    static: Array
    located: BoolArray
    held: IntArray
    closed: BoolArray
    sliding: BoolArray
    turning: BoolArray
    spent: Array
    shut: Array
