"""Vectors of ``LANES`` numbers as values inside kernels, for vector instructions of the processor.

In a loop over the lanes the compiler has to prove that arrays do not overlap, and sums stay in memory.  A vector is
loaded from an array, accumulated in a register, and stored.  The operators + - * / work on two vectors, and on a
vector and a number.
"""

from collections.abc import Callable
from operator import add, sub, truediv
from operator import mul as times
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models, register_default
from numba.extending import intrinsic, overload

from softway.kernels.jit.lanes import LANES

_NUMBERS = ir.VectorType(ir.DoubleType(), LANES)
_BIAS, _FRACTION = 1023, 52  # fields of a double-precision number
_CUBE = 4.0 / 3.0 * (_BIAS - 0.045) * 2.0**_FRACTION


class Vector(types.Type):
    """Numba type of a vector of ``LANES`` numbers."""


VECTOR = Vector(name="softway.Vector")
register_default(Vector)(lambda manager, kind: models.PrimitiveModel(manager, kind, _NUMBERS))


@intrinsic
def load(typing, array, start):
    """Load the vector ``array[start : start + LANES]``."""

    def generate(context, builder, signature, args):
        return builder.load(_place(context, builder, signature, args), align=8)

    return VECTOR(array, types.intp), generate


@intrinsic
def store(typing, array, start, vector):
    """Store a vector in ``array[start : start + LANES]``."""

    def generate(context, builder, signature, args):
        builder.store(args[2], _place(context, builder, signature, args), align=8)
        return context.get_dummy_value()

    return types.none(array, types.intp, VECTOR), generate


@intrinsic
def spread(typing, number):
    """Vector with one number in every lane."""

    def generate(context, builder, signature, args):
        return _spread(builder, args[0])

    return VECTOR(types.float64), generate


@intrinsic
def fma(typing, left, right, summand):
    """``left right + summand``, rounded once if the processor supports it; ``left`` is a vector or a number."""

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
def root(typing, vector):
    """Square root of a vector."""

    def generate(context, builder, signature, args):
        kind = ir.FunctionType(_NUMBERS, [_NUMBERS])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, f"llvm.sqrt.v{LANES}f64"), args)

    return VECTOR(VECTOR), generate


@intrinsic
def pick(typing, left, right, above, otherwise):
    """Select ``above`` in the lanes where left > right, else ``otherwise``."""

    def generate(context, builder, signature, args):
        return builder.select(builder.fcmp_ordered(">", args[0], args[1]), args[2], args[3])

    return VECTOR(VECTOR, VECTOR, VECTOR, VECTOR), generate


@intrinsic
def any_above(typing, left, right):
    """True if left > right in any lane."""

    def generate(context, builder, signature, args):
        found = builder.bitcast(builder.fcmp_ordered(">", args[0], args[1]), ir.IntType(LANES))
        return builder.icmp_unsigned("!=", found, ir.IntType(LANES)(0))

    return types.boolean(VECTOR, VECTOR), generate


@intrinsic
def power_of_two(typing, number):
    """``2^number`` for whole numbers between -1022 and 1023."""

    def generate(context, builder, signature, args):
        whole = ir.VectorType(ir.IntType(64), LANES)
        bits = builder.add(builder.fptosi(args[0], whole), ir.Constant(whole, [_BIAS] * LANES))
        return builder.bitcast(builder.shl(bits, ir.Constant(whole, [_FRACTION] * LANES)), _NUMBERS)

    return VECTOR(VECTOR), generate


@intrinsic
def inverse_cube_guess(typing, number):
    """Guess of ``number^(-1/3)`` of positive numbers to a few hundredths: exponent and fraction divided by -3."""

    def generate(context, builder, signature, args):
        whole = ir.VectorType(ir.IntType(64), LANES)
        bits = builder.sitofp(builder.bitcast(args[0], whole), _NUMBERS)
        third, start = (ir.Constant(_NUMBERS, [x] * LANES) for x in (-1.0 / 3.0, _CUBE))
        return builder.bitcast(builder.fptosi(builder.fadd(builder.fmul(bits, third), start), whole), _NUMBERS)

    return VECTOR(VECTOR), generate


@intrinsic
def fetch(typing, array, start):
    """Prefetch the cache line with the entry ``start`` of an array, without waiting for it."""

    def generate(context, builder, signature, args):
        words, line = ir.IntType(32), ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [line, words, words, words])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        place = builder.bitcast(builder.gep(data, [args[1]]), line)
        builder.call(function, [place, words(0), words(3), words(1)])
        return context.get_dummy_value()

    return types.none(array, types.intp), generate


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


def _operation(name: str) -> Any:
    """One of the four arithmetic operations on vectors and numbers."""

    @intrinsic
    def operation(typing, left, right):
        def generate(context, builder, signature, args):
            sides = (a if t == VECTOR else _spread(builder, a) for a, t in zip(args, signature.args, strict=True))
            return getattr(builder, name)(*sides, flags=("contract",))

        return VECTOR(*(t if t == VECTOR else types.float64 for t in (left, right))), generate

    return operation


def _overloaded(operator: Callable[..., Any], operation: Any) -> None:
    @overload(operator)
    def chosen(left, right):
        if VECTOR in (left, right):
            return lambda left, right: operation(left, right)
        return None


for _operator, _name in ((add, "fadd"), (sub, "fsub"), (times, "fmul"), (truediv, "fdiv")):
    _overloaded(_operator, _operation(_name))


def _spread(builder: Any, number: Any) -> Any:
    one = builder.insert_element(ir.Constant(_NUMBERS, ir.Undefined), number, ir.IntType(32)(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), LANES), None))


def _place(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Address of the vector in a one-dimensional array."""
    array = context.make_array(signature.args[0])(context, builder, args[0])
    return builder.bitcast(builder.gep(array.data, [args[1]]), _NUMBERS.as_pointer())
