"""Branch-free functions for loops over the lanes or for vectors, accurate to about one unit in the last place."""

from math import factorial

import numpy as np

from softway.kernels.jit.compilation import inlined
from softway.kernels.jit.simd import inverse_cube_guess, pick, power_of_two, spread

_SIGNIFICAND, _BIAS = 0x000FFFFFFFFFFFFF, 1023  # fields of a double-precision number
_HALF_ROOT, _ONE = 0x3FE6A09E00000000, 0x3FF0000000000000  # bits of sqrt(1/2), rounded, and of 1
_WHOLE = 6755399441055744.0  # 1.5 2^52: adding it rounds to the nearest integer
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_SERIES = tuple(1.0 / factorial(k) for k in range(14))
_LEAST, _MOST = -700.0, 700.0  # range of arguments of exp with normal results


@inlined
def log1p(j, shrink):
    """``ln(1 + j)`` without a branch; ``shrink`` is 1/(1 + j), j > -1.

    ``1 + j = 2^n (1 + f)`` with ``1 + f`` between sqrt(1/2) and sqrt(2), and ``ln(1 + f)`` by the polynomial in ``s =
    f/(2 + f)`` of FreeBSD's libm (e_log.c, 1993).  The rounding error of ``1 + j`` is corrected to first order.
    """
    bits = np.float64(1.0 + j).view(np.int64) + (_ONE - _HALF_ROOT)
    n = np.float64((bits >> 52) - _BIAS)
    f = np.int64((bits & _SIGNIFICAND) + _HALF_ROOT).view(np.float64) - 1.0
    lost = (j - ((1.0 + j) - 1.0)) * shrink
    s = f / (2.0 + f)
    tail = log_tail(s * s)
    half = 0.5 * f * f
    low = n * _LN2_LOW + lost
    return n * _LN2_HIGH - ((half - (s * (half + tail) + low)) - f)


@inlined
def log_tail(z):
    """``ln((1 + s)/(1 - s))/s - 2`` as a function of ``z = s^2`` up to (3 - 2 sqrt(2))^2, a number or a vector."""
    w = z * z
    even = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01))
    odd = 2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)
    return even + z * (6.666666666666735130e-01 + w * odd)


@inlined
def exp(x):
    """``e^x`` of a vector; x is limited to the range from -700 to 700.

    ``x = n ln 2 + r`` with r up to ln(2)/2; the series of ``e^r`` up to the 13th power has an error of 5e-17.
    """
    x = pick(spread(_LEAST), x, spread(_LEAST), x)
    x = pick(x, spread(_MOST), spread(_MOST), x)
    n = (1.44269504088896338700 * x + _WHOLE) - _WHOLE
    r = (x - _LN2_HIGH * n) - _LN2_LOW * n
    square = r * r
    even, odd = spread(_SERIES[12]), spread(_SERIES[13])
    for k in range(10, -1, -2):
        even, odd = even * square + _SERIES[k], odd * square + _SERIES[k + 1]
    return (even + r * odd) * power_of_two(n)


@inlined
def inverse_cube_root(x):
    """``x^(-1/3)`` of a vector, ``nan`` unless x > 0.

    A guess with an error of a few hundredths is improved by two steps of fourth order and one Newton step.
    """
    x = pick(x, spread(0.0), x, spread(np.nan))
    y = inverse_cube_guess(x)
    for _ in range(2):
        e = 1.0 - x * y * y * y
        y = y + y * e * (1.0 / 3.0 + e * (2.0 / 9.0 + e * (14.0 / 81.0)))
    e = 1.0 - x * y * y * y
    return y + y * e * (1.0 / 3.0)
