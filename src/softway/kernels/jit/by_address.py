"""Tables of arrays that kernels receive by their address.

Numba passes a tuple of arrays by value, seven numbers for each array, so that functions that share tuples are best
inlined, and are compiled again in each of their callers.  A table by address is one pointer: a call takes a few
nanoseconds, and an access loads one array.

Optional parts of kernels are called by their address, too: a march that does not need a part does not compile it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.datamodel import models, register_default
from numba.core.typing.templates import AttributeTemplate
from numba.extending import infer_getattr, intrinsic, lower_getattr_generic

from softway.arrays import IntArray

WHOLE, WHOLES, FLAGS = types.int64, types.int64[::1], types.boolean[::1]
NUMBERS, ROWS, BLOCKS = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
"""Kinds of entries: a whole number, arrays of whole numbers and of truth values, and arrays of one to three indices."""


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


@intrinsic
def ask(typing, address, places, number):
    """Call the part at an address with an array of addresses and a number; its answer."""

    def generate(context, builder, signature, args):
        whole = ir.IntType(64)
        kind = ir.FunctionType(whole, [whole.as_pointer(), whole]).as_pointer()
        data = context.make_array(signature.args[1])(context, builder, args[1]).data
        return builder.call(builder.inttoptr(args[0], kind), [data, args[2]])

    return types.int64(types.int64, types.int64[::1], types.int64), generate


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
