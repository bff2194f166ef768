"""Specific heat content over the temperature, exact for capacities that are piecewise linear, and its inverse."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.laws.heat.conduction import Conduction
from softway.laws.heat.temperature_table import value_at

ZERO = 273.15
"""Temperature [K] from which the content of matter that does not melt is counted; of matter that melts from melting."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ContentCurve:
    """Specific heat content in pieces along the temperature: quadratic in each, with a jump where matter melts.

    Parameters
    ----------
    knots
        (s - 1,) temperatures between the pieces [K].
    anchors
        (s,) temperature in each piece from which its content is counted [K].
    contents
        (s,) content at the anchor [J/kg].
    capacities, slopes
        (s,) capacity at the anchor [J/(kg K)], and its derivative [J/(kg K^2)].
    melting, heat, half_range
        Temperature of melting [K], heat [J/kg] and half of the mushy range [K]; nan, 0, 0 where nothing melts.

    Examples
    --------
    >>> from softway.laws.heat.conduction import Latent
    >>> ice = Conduction(conductivity=2.2, capacity=2000.0, latent=Latent(heat=3e5, melting=273.0))
    >>> curve = content_curve(ice, latent=True)
    >>> curve.content(np.array([272.0, 273.0, 274.0])).tolist()
    [-2000.0, 0.0, 302000.0]
    >>> curve.temperature(np.array([-2000.0, 1e5, 302000.0]))[0].tolist()
    [272.0, 273.0, 274.0]
    """

    knots: Array
    anchors: Array
    contents: Array
    capacities: Array
    slopes: Array
    melting: float
    heat: float
    half_range: float

    def content(self, temperature: Array) -> Array:
        """Content (...) [J/kg]; at the temperature of melting that of the solid."""
        piece = np.searchsorted(self.knots, temperature, side="left")
        over = temperature - self.anchors[piece]
        return np.asarray(self.contents[piece] + over * (self.capacities[piece] + 0.5 * self.slopes[piece] * over))

    def capacity(self, temperature: Array) -> Array:
        """Derivative of the content (...) [J/(kg K)]."""
        piece = np.searchsorted(self.knots, temperature, side="left")
        return np.asarray(self.capacities[piece] + self.slopes[piece] * (temperature - self.anchors[piece]))

    def entropy(self, temperature: Array) -> Array:
        """Integral (...) of the capacity over the temperature, from the lowest knot [J/(kg K)], without a jump.

        Examples
        --------
        >>> from softway.laws.heat.conduction import Conduction
        >>> curve = content_curve(Conduction(conductivity=1.0, capacity=4.0), latent=False)
        >>> (curve.entropy(np.array([300.0])) / np.log(300.0 / 273.15)).round(12).tolist()
        [4.0]
        """
        whole = self._entropy(np.arange(1, len(self.anchors) - 1), self.anchors[2:])
        begun = np.concatenate([[0.0, 0.0], np.cumsum(whole)])
        piece = np.searchsorted(self.knots, temperature, side="left")
        return np.asarray(begun[piece] + self._entropy(piece, temperature))

    def _entropy(self, piece: IntArray, temperature: Array) -> Array:
        """Integral (...) from the anchor of a piece to a temperature in it."""
        start, slope = self.anchors[piece], self.slopes[piece]
        steady = self.capacities[piece] - slope * start
        return np.asarray(steady * np.log1p((temperature - start) / start) + slope * (temperature - start))

    def temperature(self, content: Array) -> tuple[Array, Array]:
        """Temperature (...) [K] of a content (...) [J/kg], and its derivative [kg K/J], zero while matter melts."""
        upper = self._at_knots()
        piece = np.searchsorted(upper, content, side="left")
        rest, c = content - self.contents[piece], self.capacities[piece]
        root = np.sqrt(np.maximum(c * c + 2.0 * self.slopes[piece] * rest, np.finfo(float).tiny))
        found = self.anchors[piece] + 2.0 * rest / (c + root)
        low = np.concatenate([[-np.inf], self.knots])[piece]
        melts = found < low
        return np.where(melts, low, found), np.where(melts, 0.0, 1.0 / root)

    def liquid_share(self, content: Array, temperature: Array) -> tuple[Array, Array]:
        """Liquid share (...) of matter of a content [J/kg] and its temperature [K], and its derivative [kg/J]."""
        if not self.heat:
            return np.zeros_like(content), np.zeros_like(content)
        if self.half_range:
            share = (temperature - self.melting + self.half_range) / (2.0 * self.half_range)
            inside = (share > 0.0) & (share < 1.0)
            slope = 1.0 / (2.0 * self.half_range * self.capacity(temperature))
        else:
            share = content / self.heat
            inside = (share > 0.0) & (share < 1.0)
            slope = np.full_like(content, 1.0 / self.heat)
        return np.clip(share, 0.0, 1.0), np.where(inside, slope, 0.0)

    def _at_knots(self) -> Array:
        """Contents (s - 1,) at the knots, coming from below."""
        over = self.knots - self.anchors[:-1]
        return np.asarray(self.contents[:-1] + over * (self.capacities[:-1] + 0.5 * self.slopes[:-1] * over))


def content_curve(law: Conduction, *, latent: bool) -> ContentCurve:
    """Content of a law, counted from the solid at melting, or from 273.15 K where nothing melts.

    Parameters
    ----------
    law
        Law of conduction.
    latent
        True for the content with the latent heat, False for that of the capacities alone.

    Examples
    --------
    >>> curve = content_curve(Conduction(conductivity=1.0, capacity=4.0), latent=False)
    >>> curve.content(np.array([274.15])).round(9).tolist()
    [4.0]
    """
    melts = law.latent
    start, half = (ZERO, 0.0) if melts is None else (melts.melting, melts.half_range if latent else 0.0)
    heat = 0.0 if melts is None or not latent else melts.heat
    knots = np.unique([start, start - half, start + half, *_knots(law, start, below=True), *_knots(law.liquid, start)])
    ends = np.concatenate([[knots[0] - 1.0], knots, [knots[-1] + 1.0]])
    middle = 0.5 * (ends[1:] + ends[:-1])
    left, right = _ends(law, ends, middle < start)
    mushy = (np.abs(middle - start) < half) * (heat / (2.0 * half) if half else 0.0)
    capacities, slopes = left + mushy, (right - left) / np.diff(ends)
    slopes[[0, -1]] = 0.0
    anchors = ends[:-1].copy()
    anchors[0], capacities[0] = knots[0], right[0]
    rise = np.diff(ends) * (capacities + 0.5 * slopes * np.diff(ends))
    rise[0] = 0.0
    jump = heat if not half else 0.0
    contents = np.concatenate([[0.0], np.cumsum(rise[:-1])])
    at_start = contents[int(np.searchsorted(ends, start, side="left"))]
    contents = contents - at_start + jump * (middle > start)
    if half:
        contents = contents + 0.5 * heat
    return ContentCurve(
        knots=knots, anchors=anchors, contents=contents, capacities=capacities, slopes=slopes,
        melting=start if melts else np.nan, heat=heat, half_range=half,
    )  # fmt: skip


def _knots(law: Conduction, start: float, *, below: bool = False) -> list[float]:
    """Knots of the capacity of a phase on its side of the temperature ``start`` [K]."""
    table = getattr(law.capacity, "temperatures", ())
    return [t for t in table if (t < start if below else t > start)]


def _ends(law: Conduction, ends: Array, solid: Array) -> tuple[Array, Array]:
    """Capacity (s,) at the lower and at the upper end of each piece, of the solid or the liquid."""
    both = [np.where(solid, value_at(law.capacity, t), value_at(law.liquid.capacity, t)) for t in (ends[:-1], ends[1:])]
    return both[0], both[1]
