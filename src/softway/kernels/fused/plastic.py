"""Hypoelastic law and J2 plasticity at the points of the lanes; rows as in :mod:`softway.kernels.jit.lanes`.

Tensors are in the axes of the middle of the slab.  Constants of the laws:

=====  ==================================================================================
0, 1   bulk modulus and shear modulus [Pa]
2, 3   yield stress, and modulus of kinematic hardening in tension [Pa]
4..6   constants of the hardening: H [Pa], or H [Pa], saturation [Pa] and exponent
7      1 if moduli are wanted, else 0
=====  ==================================================================================
"""

from functools import cache

from numba import carray

from softway.kernels.jit.compilation import Stage, inlined, stage
from softway.kernels.jit.elementary import exp
from softway.kernels.jit.lanes import (
    BACK,
    BRIDGE,
    BULK,
    LANES,
    LOST,
    PAST,
    PLASTIC,
    SOFT,
    STIFF,
    STORED,
    STRAIN,
    STRESS,
)
from softway.kernels.jit.simd import any_above, load, pick, root, spread, store

NUMBERS, MODULI = 8, 7
"""Number of constants of a law, and the position of the flag for the moduli."""
_LIMIT, _TOLERANCE = 60, 1e-14  # as in softway.laws.plasticity.return_mapping


@cache
def hypoelastic() -> Stage:
    """Stage of :class:`softway.laws.bulk.Hypoelastic`."""
    return stage(_hypoelastic)


@cache
def j2_linear() -> Stage:
    """Stage of rate-independent :class:`softway.laws.bulk.J2` with linear hardening."""
    return stage(_j2_linear)


@cache
def j2_voce() -> Stage:
    """Stage of rate-independent :class:`softway.laws.bulk.J2` with Voce hardening."""
    return stage(_j2_voce)


def _hypoelastic(state, numbers) -> None:
    s, law = carray(state, (PAST,)), carray(numbers, (NUMBERS,))
    bulk, twice = law[0], 2.0 * law[1]
    e, old = _six(s, STRAIN), _six(s, STRESS)
    pressure = (bulk - twice / 3.0) * (e[0] + e[1] + e[2])
    new = _sum(old, _sum(_times(e, twice), _isotropic(pressure)))
    _put(s, STRESS, new)
    none = spread(0.0)
    store(s, STORED, 0.5 * _dot(_sum(old, new), e))
    store(s, LOST, none)
    if law[MODULI] > 0.0:
        _put(s, BRIDGE, (none, none, none, none, none, none))
        store(s, SOFT, spread(twice))
        store(s, STIFF, none)
        store(s, BULK, spread(bulk))


def _j2_linear(state, numbers) -> None:
    s, law = carray(state, (PAST,)), carray(numbers, (NUMBERS,))
    slope, initial, modulus = 3.0 * law[1] + law[3], law[2], law[4]
    n, norm = _trial(s, law)
    rise = 1.0 / (slope + modulus)
    gain, most = rise * (norm - (initial + modulus * load(s, PLASTIC))), (1.0 / slope) * norm
    gain = pick(gain, spread(0.0), pick(gain, most, most, gain), spread(0.0))
    _return(s, law, n, norm, gain, spread(rise))


def _j2_voce(state, numbers) -> None:
    s, law = carray(state, (PAST,)), carray(numbers, (NUMBERS,))
    n, norm = _trial(s, law)
    gain, rise = _gain_voce(norm, load(s, PLASTIC), 3.0 * law[1] + law[3], law[2], (law[4], law[5], law[6]))
    _return(s, law, n, norm, gain, rise)


@inlined
def _gain_voce(norm, p, slope, initial, hardening):
    """Gain x with ``norm - slope x = s(p + x)``, and its derivative by the norm, by Newton's method inside a bracket.

    All lanes are solved together, as in softway.laws.plasticity.return_mapping.  The iteration ends when the error of a
    step, which follows from its square and the curvature of s, is below the tolerance.
    """
    none = spread(0.0)
    still, up, bend = _voce(initial, hardening, p)
    rest, fall = norm - still, slope + up
    high = pick(rest, none, (1.0 / slope) * norm, none)
    x, low = none, none
    for _ in range(_LIMIT):
        if not any_above(high, low):
            break
        step, half = rest / fall, 0.5 * (low + high)
        new = x + step
        inside = pick(low, new, none, pick(new, high, none, spread(1.0)))
        error = pick(inside, none, 0.5 * bend * step * step, fall * high)
        x = pick(inside, none, new, half)
        still, up, bend = _voce(initial, hardening, p + x)
        rest, fall = norm - slope * x - still, slope + up
        if not any_above(error, _TOLERANCE * fall * high):
            break
        low, high = pick(rest, none, x, low), pick(rest, none, high, x)
    return x, 1.0 / fall


@inlined
def _voce(initial, hardening, p):
    """Yield stress, its slope, and the absolute value of its curvature."""
    modulus, most, exponent = hardening
    fade = (most - initial) * exp(-exponent * p)
    up = exponent * fade
    bend = exponent * up
    return most - fade + modulus * p, up + modulus, pick(bend, spread(0.0), bend, -1.0 * bend)


@inlined
def _trial(s, law):
    """Relative trial stress, and its norm."""
    trial = _sum(_six(s, STRESS), _times(_six(s, STRAIN), 2.0 * law[1]))
    if law[3] > 0.0:
        trial = _sum(trial, _times(_six(s, BACK), -1.0))
    trial = _sum(trial, _isotropic((-1.0 / 3.0) * (trial[0] + trial[1] + trial[2])))  # a back stress has no trace
    return trial, root(1.5 * _dot(trial, trial))


@inlined
def _return(s, law, n, norm, gain, rise):
    """Stress, history variables, energies and moduli from the gain of the plastic strain and its slope ``rise``."""
    bulk, shear, none = law[0], law[1], spread(0.0)
    e, old = _six(s, STRAIN), _six(s, STRESS)
    shrink = 1.0 / pick(norm, none, norm, spread(1.0))
    ratio = gain * shrink
    plastic, kept = _times(n, 1.5 * ratio), 1.0 - 3.0 * shear * ratio
    pressure = (1.0 / 3.0) * (old[0] + old[1] + old[2]) + bulk * (e[0] + e[1] + e[2])
    new = _sum(_times(n, kept), _isotropic(pressure))
    held = none
    if law[3] > 0.0:
        new, held = _sum(new, _six(s, BACK)), _kinematic(s, law[3], plastic)
    store(s, STORED, 0.5 * _dot(_sum(old, new), _sum(e, _times(plastic, -1.0))) + held)
    store(s, LOST, _dot(new, plastic) - held)
    store(s, PLASTIC, load(s, PLASTIC) + gain)
    _put(s, STRESS, new)
    if law[MODULI] > 0.0:
        _put(s, BRIDGE, _times(n, shrink))
        store(s, SOFT, 2.0 * shear * kept)
        store(s, STIFF, pick(gain, none, 9.0 * shear * shear * (rise - ratio), none))
        store(s, BULK, spread(bulk))


@inlined
def _kinematic(s, modulus, plastic):
    """Update the back stress and return the energy that it stores."""
    back = _six(s, BACK)
    _put(s, BACK, _sum(back, _times(plastic, 2.0 / 3.0 * modulus)))
    return modulus / 3.0 * _dot(plastic, plastic) + _dot(back, plastic)


@inlined
def _six(s, at):
    one = load(s, at), load(s, at + LANES), load(s, at + 2 * LANES)
    two = load(s, at + 3 * LANES), load(s, at + 4 * LANES), load(s, at + 5 * LANES)
    return (*one, *two)


@inlined
def _put(s, at, T):
    for row in range(3):
        store(s, at + row * LANES, T[row])
        store(s, at + (row + 3) * LANES, T[row + 3])


@inlined
def _isotropic(p):
    none = spread(0.0)
    return p, p, p, none, none, none


@inlined
def _sum(S, T):
    return S[0] + T[0], S[1] + T[1], S[2] + T[2], S[3] + T[3], S[4] + T[4], S[5] + T[5]


@inlined
def _times(T, factor):
    return factor * T[0], factor * T[1], factor * T[2], factor * T[3], factor * T[4], factor * T[5]


@inlined
def _dot(S, T):
    """``S:T`` of two symmetric tensors."""
    return S[0] * T[0] + S[1] * T[1] + S[2] * T[2] + 2.0 * (S[3] * T[3] + S[4] * T[4] + S[5] * T[5])
