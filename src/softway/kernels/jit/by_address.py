"""Tables of arrays that kernels receive by their address.

Numba passes a tuple of arrays by value, seven numbers for each array, so that functions that share tuples are best
inlined, and are compiled again in each of their callers.  A table by address is one pointer: a call takes a few
nanoseconds, and an access loads one array.  Its address is a number (``table``), or taken of a named tuple at the
entry of a kernel (``passed_by_address``).

Large functions and optional parts of kernels are called by their address, too (``caller``): each is compiled once, and
a march that does not need a part does not compile it.
"""

from collections.abc import Callable
from hashlib import sha256
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models, register_default
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    NativeValue,
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    typeof_impl,
    unbox,
)

from softway.arrays import IntArray

WHOLE, WHOLES, FLAGS = types.int64, types.int64[::1], types.boolean[::1]
NUMBER, NUMBERS, ROWS, BLOCKS = types.float64, types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
SINGLES, LANES = types.float32[:, ::1], types.uint32[:, :, ::1]
"""Kinds of entries: a whole number, arrays of whole numbers and of truth values, a number, arrays of one to three
indices, numbers in single precision, and whole numbers of the cells in lanes.
"""
ARGUMENTS = 16
"""Number of arguments of a solution by PARDISO."""


class Table(types.Type):
    """Numba type of the address of a table with entries of these kinds."""

    def __init__(self, name: str, entries: dict[str, Any]) -> None:
        super().__init__(name=f"softway.{name}")
        self.entries = entries


register_default(Table)(lambda manager, kind: models.PrimitiveModel(manager, kind, ir.IntType(8).as_pointer()))


@infer_getattr
class _Entries(AttributeTemplate):
    """Types of the entries of a table by name."""

    key = Table

    def generic_resolve(self, kind: Any, name: str) -> Any:
        """Type of an entry; None for another name."""
        return kind.entries.get(name)


@lower_getattr_generic(Table)
def _entry(context, builder, kind, value, name):
    """Load an entry; tables do not change while a kernel runs, so that loops need not load it again."""
    layout = ir.LiteralStructType([context.get_value_type(t) for t in kind.entries.values()])
    place = builder.gep(
        builder.bitcast(value, layout.as_pointer()),
        [ir.Constant(ir.IntType(32), k) for k in (0, list(kind.entries).index(name))],
    )
    return _loaded(builder, place, layout.elements[list(kind.entries).index(name)])


def _loaded(builder: Any, place: Any, kind: Any) -> Any:
    """Value of a kind in a place, number by number."""
    if not isinstance(kind, ir.LiteralStructType | ir.ArrayType):
        found = builder.load(place)
        found.set_metadata("invariant.load", builder.module.add_metadata([]))
        return found
    parts = kind.elements if isinstance(kind, ir.LiteralStructType) else [kind.element] * kind.count
    whole = ir.Constant(kind, ir.Undefined)
    for k, part in enumerate(parts):
        inner = builder.gep(place, [ir.Constant(ir.IntType(32), i) for i in (0, k)])
        whole = builder.insert_value(whole, _loaded(builder, inner, part), k)
    return whole


def table(name: str, **entries: Any) -> Callable[[int], Any]:
    """Function for kernels that makes a table of an address, with entries of these kinds in order."""
    kind = Table(name, entries)

    @intrinsic
    def at(typing, address):
        def generate(context, builder, signature, args):
            return builder.inttoptr(args[0], ir.IntType(8).as_pointer())

        return kind(types.int64), generate

    return at  # type: ignore[no-any-return]


class Tuple(types.Type):
    """Numba type of the address of a named tuple; a tuple in it has its address, too."""

    def __init__(self, whole: Any) -> None:
        kind = f"{whole.instance_class.__name__}.{sha256(str(whole).encode()).hexdigest()[:12]}"
        super().__init__(name=f"softway.{kind}")
        self.whole = whole

    @classmethod
    def of(cls, kind: type, *entries: Any) -> "Tuple":
        """Type of the address of a class of named tuples with entries of these kinds."""
        return cls(types.BaseTuple.from_types(entries, kind))

    def entry(self, name: str) -> Any:
        """Type of an entry; None for another name."""
        if name not in self.whole.fields:
            return None
        kind = self.whole.types[self.whole.fields.index(name)]
        return Tuple(kind) if isinstance(kind, types.NamedTuple | types.NamedUniTuple) else kind


register_default(Tuple)(lambda manager, kind: models.PrimitiveModel(manager, kind, ir.IntType(8).as_pointer()))


@infer_getattr
class _Parts(AttributeTemplate):
    """Types of the entries of a named tuple by name."""

    key = Tuple

    def generic_resolve(self, kind: Any, name: str) -> Any:
        """Type of an entry; None for another name."""
        return kind.entry(name)


@lower_getattr_generic(Tuple)
def _part(context, builder, kind, value, name):
    """Load an entry of a named tuple; it does not change while a kernel runs."""
    layout, entry = context.get_value_type(kind.whole), kind.entry(name)
    at = [ir.Constant(ir.IntType(32), k) for k in (0, kind.whole.fields.index(name))]
    place = builder.gep(builder.bitcast(value, layout.as_pointer()), at)
    if isinstance(entry, Tuple):
        return builder.bitcast(place, ir.IntType(8).as_pointer())
    return impl_ret_borrowed(context, builder, entry, _loaded(builder, place, context.get_value_type(entry)))


@unbox(Tuple)
def _address_of(kind, given, c):
    """Address of a named tuple whose entries are on the stack while the kernel runs."""
    whole = c.unbox(kind.whole, given)
    place = cgutils.alloca_once_value(c.builder, whole.value)
    at = c.builder.bitcast(place, ir.IntType(8).as_pointer())

    def release() -> None:
        """Give back the references to arrays; Numba sees none behind an address."""
        if whole.cleanup is not None:
            whole.cleanup()
        if c.context.enable_nrt:
            c.context.nrt.decref(c.builder, kind.whole, whole.value)

    return NativeValue(at, is_error=whole.is_error, cleanup=release)


def passed_by_address(kind: type) -> type:
    """Let kernels receive a class of named tuples by its address."""

    @typeof_impl.register(kind)
    def _(value, context):
        return Tuple(_whole(value, context))

    return kind


def caller(kind: Any) -> Callable[[int, Any], Any]:
    """Function for kernels that calls a :func:`~softway.kernels.jit.compilation.function_at` an address, and returns
    its number.

    Its argument is a whole number, as the address of a table is, or a named tuple, whose address is passed on.  The
    function is compiled once; kernels contain none of its code.
    """
    passed = kind.whole if isinstance(kind, Tuple) else kind

    @intrinsic
    def call(typing, address, given):
        def generate(context, builder, signature, args):
            value = args[1]
            if isinstance(kind, Tuple):
                value = builder.bitcast(cgutils.alloca_once_value(builder, value), ir.IntType(8).as_pointer())
            function = ir.FunctionType(ir.IntType(64), [value.type]).as_pointer()
            return builder.call(builder.inttoptr(args[0], function), [value])

        return (types.int64(types.int64, given), generate) if given == passed else None

    return call  # type: ignore[no-any-return]


def _whole(value: Any, context: Any) -> Any:
    """Numba type of a named tuple by value, with the tuples in it by value."""
    parts = [_whole(v, context) if hasattr(v, "_fields") else typeof_impl(v, context) for v in value]
    return types.BaseTuple.from_types(tuple(parts), type(value))


@intrinsic
def call_library(typing, function, arguments):
    """Call a function of a library at an address with the addresses of its sixteen arguments."""

    def generate(context, builder, signature, args):
        place = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [place] * ARGUMENTS).as_pointer()
        data = context.make_array(signature.args[1])(context, builder, args[1]).data
        given = [builder.load(builder.gep(data, [ir.Constant(ir.IntType(64), k)])) for k in range(ARGUMENTS)]
        builder.call(builder.inttoptr(args[0], kind), [builder.inttoptr(each, place) for each in given])
        return context.get_dummy_value()

    return types.none(types.int64, types.int64[::1]), generate


def packed(arrays: NamedTuple) -> IntArray:
    """Numbers of a table as Numba lays it out; the arrays and this one have to be kept while its address is used."""
    found: list[int] = []
    for value in arrays:
        if isinstance(value, np.ndarray):
            if not value.flags.c_contiguous:
                raise ValueError("an array of a table is not contiguous")
            found += [0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
        else:
            found.append(int(value))
    return np.array(found, np.int64)
