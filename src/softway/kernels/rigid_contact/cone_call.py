"""The solution of contacts with friction by its address: compiled once, and not again in each kernel that calls it."""

from functools import cache
from typing import NamedTuple

from softway.arrays import Array
from softway.kernels.jit.by_address import NUMBER, NUMBERS, ROWS, Tuple, caller
from softway.kernels.jit.compilation import Stage, function_at, inlined
from softway.kernels.rigid_contact.cone import solve_cone


class Cones(NamedTuple):
    """Arguments of ``solve_cone``, all arrays contiguous."""

    W: Array
    b: Array
    friction: Array
    least: Array
    lower: Array
    axis: Array
    rounding: float
    x: Array


_KIND = Tuple.of(Cones, ROWS, NUMBERS, ROWS, ROWS, NUMBERS, NUMBERS, NUMBER, NUMBERS)
_call = caller(_KIND)


@cache
def cone() -> Stage:
    """Function with an address that kernels have in their work space."""
    return function_at(_KIND, _solved)


def _solved(given):
    return solve_cone(given.W, given.b, given.friction, given.least, given.lower, given.axis, given.rounding, given.x)


@inlined
def call_cone(space, W, b, friction, least, lower, axis, rounding, x):
    """Impulses x of contacts by the function at the address in the work space, as ``solve_cone``."""
    return _call(space.cone[0], Cones(W, b, friction, least, lower, axis, rounding, x))
