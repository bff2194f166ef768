"""Optional parts of kernels, called by their address: a march that does not need a part does not compile it.

A part receives the address of a table of addresses and a number, and returns a number.  It is compiled at import of
its module, cached on disk, and may call the functions of :func:`~softway.kernels.jit.compilation.called`.
"""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def ask(typing, address, places, number):
    """Call the part at an address with an array of addresses and a number; its answer."""

    def generate(context, builder, signature, args):
        whole = ir.IntType(64)
        kind = ir.FunctionType(whole, [whole.as_pointer(), whole]).as_pointer()
        data = context.make_array(signature.args[1])(context, builder, args[1]).data
        return builder.call(builder.inttoptr(args[0], kind), [data, args[2]])

    return types.int64(types.int64, types.int64[::1], types.int64), generate
