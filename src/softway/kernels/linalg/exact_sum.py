"""Exact sums of doubles as integers: every double is a multiple of 2^-1074, split into digits of 32 bits.

The digits of all summands are added to 64-bit integers, without carries: 2^31 summands fit.  Sums of such integers do
not depend on their order, so that they are the same for every distribution of the summands.
"""

import numpy as np

from softway.arrays import Array, IntArray
from softway.kernels.jit.compilation import kernel

DIGITS = 66
"""Number of digits of 32 bits of the greatest double."""
NAN, PLUS, MINUS = DIGITS, DIGITS + 1, DIGITS + 2
"""Places of the numbers of summands that are nan, inf and -inf."""
PLACES = DIGITS + 3
"""Length of a sum."""


@kernel
def add(bits, out):
    """Add the doubles with these ``bits`` (n, k), as 64-bit integers, to the sums ``out`` (k, PLACES)."""
    for i in range(bits.shape[0]):
        for k in range(bits.shape[1]):
            b = bits[i, k]
            power = (b >> 52) & 2047
            part = b & 4503599627370495
            if power == 2047:
                if part != 0:
                    out[k, 66] += 1
                elif b > 0:
                    out[k, 67] += 1
                else:
                    out[k, 68] += 1
                continue
            if power > 0:
                part += 4503599627370496
                power -= 1
            if part == 0:
                continue
            place, shift = power >> 5, power & 31
            low = (part & 4294967295) << shift
            high = ((part >> 32) << shift) + (low >> 32)
            if b < 0:
                out[k, place] -= low & 4294967295
                out[k, place + 1] -= high & 4294967295
                out[k, place + 2] -= high >> 32
            else:
                out[k, place] += low & 4294967295
                out[k, place + 1] += high & 4294967295
                out[k, place + 2] += high >> 32


def digits(values: Array) -> IntArray:
    """Exact sums (k, PLACES) over the first axis of values (n, k), to be added to those of others."""
    out = np.zeros((values.shape[1], PLACES), np.int64)
    add(np.ascontiguousarray(values, float).view(np.int64), out)
    return out


def rounded_sum(places: IntArray) -> float:
    """Nearest double of an exact sum (PLACES,).

    Examples
    --------
    >>> rounded_sum(digits(np.array([[1e300], [1.0], [-1e300], [1e-300]]))[0])
    1.0
    """
    if places[DIGITS:].any():
        endless = np.inf * float(places[PLUS] > 0) if places[PLUS] else 0.0
        both = bool(places[NAN]) or (places[PLUS] > 0 and places[MINUS] > 0)
        return float("nan") if both else float(endless or -np.inf)
    total = 0
    for place in np.flatnonzero(places[:DIGITS]).tolist():
        total += int(places[place]) << (32 * place)
    try:
        return total / 2**1074
    except OverflowError:
        return float("inf") if total > 0 else float("-inf")
