"""A row of lanes as one value inside kernels: ``LANES`` numbers that the machine handles together.

Loops over the lanes leave it to the compiler to see that arrays do not overlap, and sums in memory.  A vector is loaded
from an array, accumulated in a register, and stored.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core.datamodel import models, register_default
from numba.extending import intrinsic

from softway.kernels.lanes import LANES

_NUMBERS = ir.VectorType(ir.DoubleType(), LANES)


class Vector(types.Type):
    """Type of a row of lanes."""


VECTOR = Vector(name="softway.Vector")
register_default(Vector)(lambda manager, kind: models.PrimitiveModel(manager, kind, _NUMBERS))


@intrinsic
def load(typing, array, start):
    """The vector ``array[start : start + LANES]``."""

    def generate(context, builder, signature, args):
        return builder.load(_place(context, builder, signature, args), align=8)

    return VECTOR(array, types.intp), generate


@intrinsic
def store(typing, array, start, vector):
    """Put a vector to ``array[start : start + LANES]``."""

    def generate(context, builder, signature, args):
        builder.store(args[2], _place(context, builder, signature, args), align=8)
        return context.get_dummy_value()

    return types.none(array, types.intp, VECTOR), generate


@intrinsic
def spread(typing, number):
    """The vector that holds one number in every lane."""

    def generate(context, builder, signature, args):
        return _spread(builder, args[0])

    return VECTOR(types.float64), generate


@intrinsic
def fma(typing, left, right, summand):
    """``left right + summand``, rounded once where the machine can; ``left`` is a vector or a number."""

    def generate(context, builder, signature, args):
        first = args[0] if signature.args[0] == VECTOR else _spread(builder, args[0])
        product = builder.fmul(first, args[1], flags=("contract",))
        return builder.fadd(product, args[2], flags=("contract",))

    return VECTOR(VECTOR if left == VECTOR else types.float64, VECTOR, VECTOR), generate


@intrinsic
def mul(typing, left, right):
    """``left right`` of two vectors."""

    def generate(context, builder, signature, args):
        return builder.fmul(*args, flags=("contract",))

    return VECTOR(VECTOR, VECTOR), generate


@intrinsic
def call(typing, address, state, moduli):
    """Call the stage at an address with two arrays."""

    def generate(context, builder, signature, args):
        numbers = ir.DoubleType().as_pointer()
        stage = builder.inttoptr(args[0], ir.FunctionType(ir.VoidType(), [numbers, numbers]).as_pointer())
        arrays = (context.make_array(t)(context, builder, a) for t, a in zip(signature.args[1:], args[1:], strict=True))
        builder.call(stage, [array.data for array in arrays])
        return context.get_dummy_value()

    return types.none(types.intp, state, moduli), generate


def _spread(builder: Any, number: Any) -> Any:
    one = builder.insert_element(ir.Constant(_NUMBERS, ir.Undefined), number, ir.IntType(32)(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), LANES), None))


def _place(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Address of the vector in a one-dimensional array."""
    array = context.make_array(signature.args[0])(context, builder, args[0])
    return builder.bitcast(builder.gep(array.data, [args[1]]), _NUMBERS.as_pointer())
