"""Cells of bars in which there may be a front, and the contents of their phases."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.laws.heat.heat_content import ContentCurve
from softway.laws.heat.mixed_content import MixedContent


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Phases:
    """Nodes of a body, and the specific contents of its solid and its liquid at any temperature."""

    nodes: slice
    solid: ContentCurve
    liquid: ContentCurve

    def content(self, liquid: BoolArray) -> MixedContent:
        """Specific content of nodes (n,) in their phases."""
        here = liquid[self.nodes]
        return MixedContent(curves=(self.solid, self.liquid), shares=np.stack([~here, here]).astype(float))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FrontCells:
    """Cells of bars in which there may be a front.

    Parameters
    ----------
    nodes, numbers
        (c, 2) their nodes, and (c,) their numbers among all cells.
    latent
        (c,) latent heat of the liquid cell [J].
    solid, liquid
        (c,) conductances of the whole cell in each phase [W/K].
    melting, capacity
        (n,) temperatures of melting [K], not a number at other nodes, and capacities there [J/K].
    phases
        Specific contents of the phases by bodies.
    """

    nodes: IntArray
    numbers: IntArray
    latent: Array
    solid: Array
    liquid: Array
    melting: Array
    capacity: Array
    phases: tuple[Phases, ...]

    def around(self, node: int) -> IntArray:
        """Cells (k,) of a node."""
        return np.flatnonzero((self.nodes == node).any(axis=1))
