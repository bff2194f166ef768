"""Fronts between the nodes of bars: where they are, the latent heat of the liquid, and how they pass nodes.

A front is at the temperature of melting and has no capacity (docs/theory/heat/phase.md).  A cell has one front where
its nodes differ in phase, else none.  What is left of a phase when two fronts meet is the pocket of a node, which
waits at the temperature of melting until that has changed phase, too.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.front_cells import FrontCells
from softway.errors import NoConvergence
from softway.heat.heat_model import HeatModel
from softway.heat.operators import HeatValues

CROSSED = 1e-12
"""Difference from the temperature of melting, relative to it, up to which a temperature is this one."""
STANDING = 1e-6
"""Way of a front that stands at a node, relative to a cell, after which it moves again."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Fronts:
    """Places of the fronts at one instant.

    Parameters
    ----------
    share
        (c,) liquid share of the cells with a front; not a number in others.
    liquid
        (n,) phase of the nodes.
    pocket
        (n,) latent heat of what is left of the other phase around a node that waits [J]; not a number at others.  It is
        negative where a front that stands at the node has gone on by as much.
    least, limit
        (n,) pocket at which the node has changed phase, and at which it changes back [J].
    """

    share: Array
    liquid: BoolArray
    pocket: Array
    least: Array
    limit: Array

    @property
    def cells(self) -> IntArray:
        """Cells (f,) with a front."""
        return np.flatnonzero(~np.isnan(self.share))

    @property
    def waiting(self) -> IntArray:
        """Nodes (w,) with a pocket."""
        return np.flatnonzero(~np.isnan(self.pocket))

    def liquid_node(self, cells: FrontCells, cell: int) -> int:
        """Liquid node of a cell with a front."""
        one, other = cells.nodes[cell]
        return int(one if self.liquid[one] else other)

    def solid_node(self, cells: FrontCells, cell: int) -> int:
        """Solid node of a cell with a front."""
        one, other = cells.nodes[cell]
        return int(other if self.liquid[one] else one)

    def beyond(self, cells: FrontCells, temperature: Array) -> Array:
        """By how much temperatures (n,) are beyond melting for the phases of the nodes [K]."""
        over = temperature - cells.melting
        return np.where(self.liquid, -over, over)

    def shares(self, cells: FrontCells) -> Array:
        """Liquid share (c,) of the cells without pockets."""
        return np.where(np.isnan(self.share), self.liquid[cells.nodes[:, 0]], self.share)

    def latent_heat(self, cells: FrontCells) -> float:
        """Latent heat of all liquid [J]."""
        wait = self.waiting
        pockets = np.where(self.liquid[wait], -self.pocket[wait], self.pocket[wait])
        return float(cells.latent @ self.shares(cells) + pockets.sum())


def first_fronts(cells: FrontCells, temperature: Array) -> Fronts:
    """Fronts of initial temperatures (n,) [K]: where a linear temperature is that of melting; at it matter is solid,
    whatever the rounding of its temperature.

    Examples
    --------
    >>> two = FrontCells(nodes=np.array([[0, 1], [1, 2]]), numbers=np.arange(2), latent=np.ones(2), solid=np.ones(2),
    ...                  liquid=np.ones(2), melting=np.full(3, 273.0), capacity=np.ones(3), phases=())
    >>> first_fronts(two, np.array([271.0, 272.0, 275.0])).share.round(3).tolist()
    [nan, 0.667]
    """
    n = len(cells.melting)
    with np.errstate(invalid="ignore"):
        liquid = temperature > cells.melting * (1.0 + CROSSED)
    apart = liquid[cells.nodes[:, 0]] != liquid[cells.nodes[:, 1]]
    share = np.where(apart, _above(cells, temperature), np.nan)
    none = np.full(n, np.nan)
    return Fronts(share=share, liquid=liquid, pocket=none, least=none, limit=none)


def _above(cells: FrontCells, temperature: Array) -> Array:
    """Part (c,) of the difference of the temperatures (n,) of the nodes [K] of cells that is above melting."""
    one, other = (temperature[cells.nodes[:, k]] - cells.melting[cells.nodes[:, k]] for k in (0, 1))
    above, below = np.maximum(one, other), np.minimum(one, other)
    differ = above > below
    return np.asarray(np.clip(above / np.where(differ, above - below, 1.0), 0.0, 1.0))


def content_of_phases(model: HeatModel, cells: FrontCells, fronts: Fronts, bare: HeatValues) -> Array:
    """Contents (n,) of the nodes in their phases without latent heat [J]."""
    content = bare.content.copy()
    for phases in cells.phases:
        here = phases.nodes
        content[here] = model.mass[here] * phases.content(fronts.liquid).content(bare.temperature[here])
    return content


def with_latent(model: HeatModel, fronts: Fronts | None, bare: HeatValues) -> HeatValues:
    """Contents of the phases and liquid shares of a state with the latent heat of the liquid; ``bare`` are those
    without.

    A cell with a front conducts like the liquid by the part of its difference of temperatures that is above melting:
    its mean heat flux is that of both parts.
    """
    cells = model.fronts
    if cells is None or fronts is None:
        return bare
    content, share = content_of_phases(model, cells, fronts, bare), fronts.shares(cells)
    whole, melted, liquid = cells.latent, bare.melted.copy(), bare.liquid.copy()
    cut = ~np.isnan(fronts.share)
    far = np.where(cut, 0.5 * share**2, 0.5 * share)
    near = share - far
    first = fronts.liquid[cells.nodes[:, 0]]
    liquid[cells.numbers] = np.where(cut, _above(cells, bare.temperature), first)
    np.add.at(content, cells.nodes[:, 0], whole * np.where(first, near, far))
    np.add.at(content, cells.nodes[:, 1], whole * np.where(first, far, near))
    for node in fronts.waiting.tolist():
        pocket = -fronts.pocket[node] if fronts.liquid[node] else fronts.pocket[node]
        content[node] += pocket
        around = [c for c in cells.around(node).tolist() if not cut[c]] or cells.around(node).tolist()
        share[around] += pocket / whole[around].sum()
    melted[cells.numbers] = np.clip(share, 0.0, 1.0)
    return replace(bare, content=content, melted=melted, liquid=liquid)


def passed(cells: FrontCells, fronts: Fronts, nodes: Sequence[int]) -> Fronts:
    """Fronts after some ``nodes`` have changed phase at once.

    Cells around a node that had no front get one at the node; what is left of the old phase in those that had one
    becomes its pocket.  Nodes that change together share what is left between them.
    """
    share, liquid = fronts.share.copy(), fronts.liquid.copy()
    pocket, limit = fronts.pocket.copy(), fronts.limit.copy()
    for node in nodes:
        was, left = bool(liquid[node]), 0.0
        liquid[node], pocket[node] = not was, np.nan
        for cell in cells.around(node).tolist():
            if np.isnan(share[cell]):
                share[cell] = 1.0 if was else 0.0
                continue
            rest = share[cell] if was else 1.0 - share[cell]
            share[cell] = np.nan
            one, other = cells.nodes[cell].tolist()
            twin = other if one == node else one
            if rest == 1.0 and twin in nodes:
                _add(cells, (pocket, limit), share, twin, 0.5 * cells.latent[cell])
                rest = 0.5
            left += rest * cells.latent[cell]
        if left:
            _add(cells, (pocket, limit), share, node, left)
    return Fronts(share=share, liquid=liquid, pocket=pocket, least=_least(fronts, pocket), limit=limit)


def turned(
    model: HeatModel, cells: FrontCells, fronts: Fronts, temperature: Array, prescribed: Sequence[int]
) -> Fronts:
    """Fronts after nodes with ``prescribed`` temperatures (n,) [K] have been put to that of the other phase.

    Raises
    ------
    NoConvergence
        Of :func:`handed_on`.
    """
    with np.errstate(invalid="ignore"):
        beyond = fronts.beyond(cells, temperature) > CROSSED * cells.melting
    wrong = [j for j in prescribed if beyond[j]]
    return handed_on(model, cells, passed(cells, fronts, wrong), prescribed) if wrong else fronts


def handed_on(model: HeatModel, cells: FrontCells, fronts: Fronts, prescribed: Sequence[int]) -> Fronts:
    """Fronts with the pockets of nodes with a ``prescribed`` temperature at nodes of the same phase beside them.

    Raises
    ------
    NoConvergence
        If there is no such node: there would be two fronts in a cell.
    """
    pocket, limit = fronts.pocket.copy(), fronts.limit.copy()
    for node in set(fronts.waiting.tolist()) & set(prescribed):
        beside = [int(k) for k in np.unique(cells.nodes[cells.around(node)]) if k != node and k not in prescribed]
        beside = [k for k in beside if fronts.liquid[k] == fronts.liquid[node]]
        if not beside:
            part = next(p for p in model.parts if p.nodes.start <= node < p.nodes.stop)
            place = f"at node {node - part.nodes.start} of {part.name!r}"
            raise NoConvergence(f"two fronts in a cell between prescribed temperatures, {place}")
        left, pocket[node], limit[node] = float(pocket[node]), np.nan, np.nan
        _add(cells, (pocket, limit), fronts.share, beside[0], left)
    return replace(fronts, pocket=pocket, least=_least(fronts, pocket), limit=limit)


def standing(cells: FrontCells, fronts: Fronts, node: int) -> Fronts:
    """Fronts that stand at a ``node``, which waits until they have moved by a millionth of a cell to either side."""
    pocket, least, limit = fronts.pocket.copy(), fronts.least.copy(), fronts.limit.copy()
    slight = STANDING * float(cells.latent[cells.around(node)].min())
    pocket[node], least[node], limit[node] = 0.0, -slight, slight
    return replace(fronts, pocket=pocket, least=least, limit=limit)


def overflowed(cells: FrontCells, fronts: Fronts, nodes: Sequence[int]) -> Fronts:
    """Fronts after some ``nodes`` have changed back to the phase of their pockets: there are fronts around them again,
    but not between two of them.
    """
    share, liquid = fronts.share.copy(), fronts.liquid.copy()
    pocket, limit = fronts.pocket.copy(), fronts.limit.copy()
    liquid[list(nodes)] = ~liquid[list(nodes)]
    for node in nodes:
        whole, left = [c for c in cells.around(node).tolist() if np.isnan(fronts.share[c])], 0.0
        part = min(float(pocket[node] / cells.latent[whole].sum()), 1.0) if whole else 0.0
        pocket[node] = limit[node] = np.nan
        for cell in cells.around(node).tolist():
            if cell not in whole:
                left += (1.0 - share[cell] if liquid[node] else share[cell]) * cells.latent[cell]
                share[cell] = np.nan
            elif not set(cells.nodes[cell].tolist()) <= set(nodes):
                share[cell] = part if liquid[node] else 1.0 - part
        if left:
            _add(cells, (pocket, limit), share, node, left)
    return Fronts(share=share, liquid=liquid, pocket=pocket, least=_least(fronts, pocket), limit=limit)


def emptied(cells: FrontCells, fronts: Fronts, node: int) -> Fronts:
    """Fronts after the pocket of a ``node`` has changed phase; those that stand at it go on."""
    share, beyond = fronts.share.copy(), -float(fronts.pocket[node])
    pocket, least, limit = fronts.pocket.copy(), fronts.least.copy(), fronts.limit.copy()
    pocket[node] = least[node] = limit[node] = np.nan
    stand = [c for c in cells.around(node).tolist() if share[c] == (0.0 if fronts.liquid[node] else 1.0)]
    if stand and beyond > 0.0:
        moved = beyond / float(cells.latent[stand].sum())
        share[stand] = moved if fronts.liquid[node] else 1.0 - moved
    return replace(fronts, share=share, pocket=pocket, least=least, limit=limit)


def _least(fronts: Fronts, pocket: Array) -> Array:
    """Least pockets (n,): zero for new ones [J]."""
    return np.where(np.isnan(pocket), np.nan, np.where(np.isnan(fronts.least), 0.0, fronts.least))


def _add(cells: FrontCells, waiting: tuple[Array, Array], share: Array, node: int, left: float) -> None:
    """Add to the pocket of a node, and set the limit at which it changes back: half of its cells without a front in
    the shares (c,), or all of it.
    """
    pocket, limit = waiting
    around = cells.around(node)
    whole = [c for c in around.tolist() if np.isnan(share[c])] or around
    pocket[node] = left + (0.0 if np.isnan(pocket[node]) else pocket[node])
    limit[node] = max(0.5 * float(cells.latent[whole].sum()), float(pocket[node]))
