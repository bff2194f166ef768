"""Knots of laws over time: instants at which a prescribed rate bends or jumps."""

from collections.abc import Iterable

import numpy as np

from softway.arrays import Array
from softway.bodies.setup.motion_laws import SINE

BENT = 1e-9
"""Jump of a rate or of its slope, relative to the greatest magnitude in the law, that is not rounding."""


def knots_of_table(times: Iterable[float], values: Iterable[object]) -> tuple[float, ...]:
    """Instants [s] at which a table bends that is linear between its times, and constant before and after them.

    Parameters
    ----------
    times
        (k,) increasing times; may be empty.
    values
        (k,) or (k, c) values at these times.

    Examples
    --------
    >>> knots_of_table((0.0, 1.0, 2.0, 3.0), (0.0, 1.0, 2.0, 0.0))
    (0.0, 2.0, 3.0)
    """
    time = np.asarray(tuple(times), float)
    table = np.reshape(np.asarray(tuple(values), float), (-1, 1) if not time.size else (len(time), -1))
    if len(time) < 2:
        return ()
    slopes = np.diff(table, axis=0) / np.diff(time)[:, None]
    rest = np.zeros((1, slopes.shape[1]))
    jumps = np.abs(np.diff(slopes, axis=0, prepend=rest, append=rest)).max(axis=1)
    return tuple(time[jumps > BENT * np.abs(slopes).max()].tolist())


def knots_of_pieces(law: Array) -> tuple[float, ...]:
    """Instants [s] at which the rate of a law of motion bends or jumps.

    Parameters
    ----------
    law
        (q, 10) pieces, see :func:`~softway.bodies.setup.motion_laws.pieces`.

    Examples
    --------
    >>> from softway.bodies.setup.motion_laws import RatePolyline, Sine, SmoothSteps
    >>> knots_of_pieces(RatePolyline(times=(0.0, 0.5, 1.0), rates=(0.0, 1.0, 0.0)).pieces)
    (0.5, 1.0)
    >>> knots_of_pieces(Sine(amplitude=0.1, frequency=2.0).pieces)
    ()
    >>> knots_of_pieces(SmoothSteps(times=(0.0, 2.0), points=(0.0, 1.0)).pieces)
    ()
    """
    if len(law) < 2:
        return ()
    shares = np.array([0.0, 0.25, 0.5, 1.0])
    rates = np.array(
        [
            [_rates(piece, piece[0] + share * (end - piece[0])) for share in shares]
            for piece, end in zip(law, (*law[1:, 0], law[-1, 0]), strict=True)
        ]
    )
    before, after, scale = rates[:-1, -1], rates[1:, 0], np.abs(rates).max(axis=(0, 1))
    return tuple(law[1:, 0][(np.abs(after - before) > BENT * scale).any(axis=1)].tolist())


def _rates(piece: Array, time: float) -> tuple[float, float]:
    """Rate and slope of the rate of a piece (10,) at a time [s]."""
    since, powers = time - piece[0], np.arange(6.0)
    size, often, phase = piece[SINE]
    if not piece[2:7].any() and not size:
        return 0.0, 0.0
    terms = piece[1:7] * since ** np.maximum(powers - 1.0, 0.0)
    bends = piece[1:7] * powers * (powers - 1.0) * since ** np.maximum(powers - 2.0, 0.0)
    rate = float(terms @ powers) + size * often * np.cos(often * since + phase)
    return rate, float(bends.sum()) - size * often**2 * np.sin(often * since + phase)
