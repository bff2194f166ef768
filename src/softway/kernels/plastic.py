"""Hypoelastic law and J2 plasticity at the points of the lanes; rows as in :mod:`softway.kernels.lanes`.

In the axes of the middle of the slab.  Numbers of the laws:

=====  ==================================================================================
0, 1   bulk modulus and shear modulus [Pa]
2, 3   yield stress, and modulus of kinematic hardening in tension [Pa]
4..6   those of the hardening: H; H, saturation [Pa], exponent
=====  ==================================================================================
"""

from functools import cache

from numba import carray

from softway.kernels.compiled import Stage, inlined, stage
from softway.kernels.functions import exp
from softway.kernels.lanes import (
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
from softway.kernels.vectors import any_above, load, pick, root, spread, store

NUMBERS = 8
"""Numbers that a law may have."""
_LIMIT, _TOLERANCE = 60, 1e-14  # as in softway.laws.return_mapping


@cache
def hypoelastic() -> Stage:
    """The law :class:`softway.laws.bulk.Hypoelastic`."""
    return stage(_hypoelastic)


@cache
def j2_linear() -> Stage:
    """The law :class:`softway.laws.bulk.J2`, independent of the rate, with linear hardening."""
    return stage(_j2_linear)


@cache
def j2_voce() -> Stage:
    """The law :class:`softway.laws.bulk.J2`, independent of the rate, with the hardening of Voce."""
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
    _put(s, BRIDGE, (none, none, none, none, none, none))
    store(s, SOFT, spread(twice))
    store(s, STIFF, none)
    store(s, BULK, spread(bulk))


def _j2_linear(state, numbers) -> None:
    s, law = carray(state, (PAST,)), carray(numbers, (NUMBERS,))
    slope, initial, modulus = 3.0 * law[1] + law[3], law[2], law[4]
    norm = _trial(s, 2.0 * law[1])
    gain, most = (norm - (initial + modulus * load(s, PLASTIC))) / (slope + modulus), norm / slope
    gain = pick(gain, spread(0.0), pick(gain, most, most, gain), spread(0.0))
    _return(s, law, norm, gain, spread(1.0 / (slope + modulus)))


def _j2_voce(state, numbers) -> None:
    s, law = carray(state, (PAST,)), carray(numbers, (NUMBERS,))
    norm = _trial(s, 2.0 * law[1])
    gain, rise = _gain_voce(norm, load(s, PLASTIC), 3.0 * law[1] + law[3], law[2], (law[4], law[5], law[6]))
    _return(s, law, norm, gain, rise)


@inlined
def _gain_voce(norm, p, slope, initial, hardening):
    """Gain x of ``norm - slope x = s(p + x)``, and its derivative to the norm, by Newton's method inside a bracket.

    All lanes together, as softway.laws.return_mapping.
    """
    none = spread(0.0)
    high = pick(norm, _voce(initial, hardening, p)[0], norm * (1.0 / slope), none)
    x, low, fall = none, none, none
    for _ in range(_LIMIT):
        still, up = _voce(initial, hardening, p + x)
        rest, fall = norm - slope * x - still, slope + up
        low, high = pick(rest, none, x, low), pick(rest, none, high, x)
        new, half = x + rest / fall, 0.5 * (low + high)
        new = pick(low, new, half, new)
        new = pick(new, high, half, new)
        change = new - x
        x = new
        if not any_above(pick(none, change, none - change, change), _TOLERANCE * high):
            break
    return x, 1.0 / fall


@inlined
def _voce(initial, hardening, p):
    """Yield stress and its slope."""
    modulus, most, exponent = hardening
    fade = (most - initial) * exp(-exponent * p)
    return most - fade + modulus * p, exponent * fade + modulus


@inlined
def _trial(s, twice):
    """Norm of the relative trial stress, which goes to BRIDGE."""
    e, old, back = _six(s, STRAIN), _six(s, STRESS), _six(s, BACK)
    trial = _sum(old, _sum(_times(e, twice), _times(back, -1.0)))  # a back stress has no trace
    trial = _sum(trial, _isotropic((trial[0] + trial[1] + trial[2]) * (-1.0 / 3.0)))
    _put(s, BRIDGE, trial)
    return root(1.5 * _dot(trial, trial))


@inlined
def _return(s, law, norm, gain, rise):
    """Stress, memory, energies and moduli by the gain of the plastic strain, which rises with the trial stress."""
    bulk, shear, kinematic = law[0], law[1], law[3]
    e, old, back, n = _six(s, STRAIN), _six(s, STRESS), _six(s, BACK), _six(s, BRIDGE)
    none = spread(0.0)
    shrink = 1.0 / pick(norm, none, norm, spread(1.0))
    ratio = gain * shrink
    plastic, kept = _times(n, 1.5 * ratio), 1.0 - 3.0 * shear * ratio
    pressure = (old[0] + old[1] + old[2]) * (1.0 / 3.0) + bulk * (e[0] + e[1] + e[2])
    new = _sum(_sum(_times(n, kept), back), _isotropic(pressure))
    held = kinematic / 3.0 * _dot(plastic, plastic) + _dot(back, plastic)
    store(s, STORED, 0.5 * _dot(_sum(old, new), _sum(e, _times(plastic, -1.0))) + held)
    store(s, LOST, _dot(new, plastic) - held)
    store(s, PLASTIC, load(s, PLASTIC) + gain)
    _put(s, STRESS, new)
    _put(s, BACK, _sum(back, _times(plastic, 2.0 / 3.0 * kinematic)))
    _put(s, BRIDGE, _times(n, shrink))
    store(s, SOFT, 2.0 * shear * kept)
    store(s, STIFF, pick(gain, none, 9.0 * shear * shear * (rise - ratio), none))
    store(s, BULK, spread(bulk))


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
