"""Specific heat content of nodes that several laws share."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.laws.heat.heat_content import ContentCurve


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MixedContent:
    """Content of n nodes, each with shares of the mass of several laws, all at the temperature of the node.

    Parameters
    ----------
    curves
        (k,) contents of the laws, without latent heat.
    shares
        (k, n) parts of the mass of the nodes; their sums are one.

    Examples
    --------
    >>> from softway.laws.heat.conduction import Conduction
    >>> from softway.laws.heat.heat_content import content_curve
    >>> curves = [content_curve(Conduction(conductivity=1.0, capacity=c), latent=False) for c in (4.0, 2.0)]
    >>> mixed = MixedContent(curves=tuple(curves), shares=np.array([[1.0, 0.5], [0.0, 0.5]]))
    >>> mixed.content(np.array([274.15, 275.15])).round(9).tolist()
    [4.0, 6.0]
    """

    curves: tuple[ContentCurve, ...]
    shares: Array

    def content(self, temperature: Array) -> Array:
        """Content (n,) [J/kg] at temperatures (n,) [K]."""
        return self._mixed(lambda curve: curve.content(temperature))

    def capacity(self, temperature: Array) -> Array:
        """Derivative (n,) of the content [J/(kg K)]."""
        return self._mixed(lambda curve: curve.capacity(temperature))

    def entropy(self, temperature: Array) -> Array:
        """Integral (n,) of the capacity over the temperature [J/(kg K)]."""
        return self._mixed(lambda curve: curve.entropy(temperature))

    def _mixed(self, of: Callable[[ContentCurve], Array]) -> Array:
        """Values (n,) of the curves by shares."""
        return np.sum([share * of(curve) for curve, share in zip(self.curves, self.shares, strict=True)], axis=0)
