"""Solution with the factor of compiled slabs (time steps): one in a band, or one of a library in single precision."""

import math

import numpy as np

from softway.kernels.jit.by_address import ARGUMENTS, call_library
from softway.kernels.jit.compilation import called
from softway.kernels.slab.band import solve_spread
from softway.tolerances import EXPONENT

MOST = 1000
"""Greatest exponent: ``2^MOST`` is a number."""


@called
def solve(down, up, pivot, single, library, x):
    """Solve in place, x (f,), with a factor in a band or, where there is one, by the ``library``.

    ``library`` (ARGUMENTS + 2,) are the addresses of its arguments and of its function, and the exponent e of the
    factored matrix ``2^e A``; ``single`` (2, f) takes right-hand side and solution.
    """
    if len(library) == 0:
        solve_spread(down, up, pivot, x)
        return
    most = 0.0
    for i in range(len(x)):
        most = max(most, abs(x[i]))
    if not (most > 0.0 and most < np.inf):
        return
    power = min(EXPONENT - math.frexp(most)[1], MOST)
    there, back = math.ldexp(1.0, power), math.ldexp(1.0, library[ARGUMENTS + 1] - power)
    for i in range(len(x)):
        single[0, i] = x[i] * there
    call_library(library[ARGUMENTS], library)
    for i in range(len(x)):
        x[i] = single[1, i] * back


@called
def solve_with(operator, x):
    """Solve in place with the factor of an operator, x (f,)."""
    solve(operator.down, operator.up, operator.pivot, operator.single, operator.library, x)
