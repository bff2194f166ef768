"""Search of the places of fronts at the end of a part of a slab, and of the first event in it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.elements.front_cells import FrontCells
from softway.errors import NoConvergence
from softway.heat.fronts.held_fronts import Held, HeldFronts
from softway.heat.fronts.places import CROSSED, Fronts
from softway.heat.heat_balance import Stage, prescribed
from softway.heat.operators import heat_values

SWEEPS = 60
"""Greatest number of rounds in which each of several fronts is placed with the others held."""
PLACED = 1e-12
"""Error of the share of a cell that is searched for."""
ROUNDED = 1e-10
"""Change of the shares of cells in a round below which several fronts are placed."""
SEARCHED = 1e-13
"""Error of an instant that is searched for, relative to a slab."""
SAME = 1e-9
"""Latent heat, relative to a cell, by which nodes and events miss what they are taken to have reached."""


@dataclass(frozen=True, slots=True)
class FrontEvent:
    """What ends a part of a slab: the front of a ``cell`` or a prescribed temperature makes a ``node`` change phase
    (``pass``), its own temperature gets to melting (``reach``), or its pocket is ``empty`` or ``full``.
    """

    kind: str
    node: int
    cell: int = -1


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Piece:
    """Solution of a part of a slab: liquid ``shares`` at its end, and by how much heat each event is ``over`` [J];
    below zero it has not happened.
    """

    held: Held
    shares: Mapping[int, float]
    over: Mapping[FrontEvent, float]

    @property
    def happened(self) -> tuple[FrontEvent, ...]:
        """Events up to the end."""
        return tuple(event for event, over in self.over.items() if over > 0.0)


@dataclass(frozen=True, eq=False)
class Search:
    """Search in a part of a slab that begins with fronts between certain nodes."""

    held: HeldFronts

    def solved(self, stage: Stage, event: FrontEvent | None = None) -> Piece:
        """Solution of a stage, in which each front is placed with the others held, in rounds.

        With an ``event`` its front is at the node that it passes, whether or not it has got there by itself.

        Raises
        ------
        NoConvergence
            If the fronts cannot be placed.
        """
        fronts = self.held.fronts
        shares = {cell: float(fronts.share[cell]) for cell in fronts.cells.tolist()}
        stopped: dict[int, tuple[int, float]] = {}
        moving = [cell for cell in shares if cell not in self._standing]
        for _ in range(SWEEPS):
            change = 0.0
            for cell in moving:
                meant = event if event is not None and event.cell == cell else None
                share, stop = self._placed(stage, cell, shares, stopped, meant)
                change = max(change, abs(share - shares[cell]))
                shares[cell] = share
                stopped.pop(cell, None)
                if stop is not None:
                    stopped[cell] = stop
            if len(moving) < 2 or change <= ROUNDED:
                break
        else:
            raise NoConvergence(f"{len(moving)} fronts are not placed after {SWEEPS} rounds")
        held = self.held.solve(stage, shares, self._pins(stopped, shares))
        over = self._over(shares, stopped, (held.into, held.taken), held.result.after.temperature)
        return Piece(held=held, shares=shares, over=over)

    def first(self, left: Stage, whole: Piece) -> tuple[Piece | None, float]:
        """Solution up to the first event of a stage, from the solution of the ``whole`` of it, and the length of the
        part [s]; None at the very start.
        """
        happened = whole.happened
        if max(self.at_start[event] for event in happened) >= 0.0:
            return None, 0.0
        span, event = min(((self._instant(left, whole, event), event) for event in happened), key=lambda item: item[0])
        return self.solved(replace(left, span=span), event), span

    def _instant(self, left: Stage, whole: Piece, event: FrontEvent) -> float:
        """Time from the start to an event that happens in a stage [s]."""

        def over(span: float) -> float:
            if span in known:
                return known[span]
            return self.solved(replace(left, span=span), event).over[event]

        from scipy.optimize import brentq  # slow to load

        known = {0.0: self.at_start[event], left.span: whole.over[event]}
        accuracy = {"xtol": SEARCHED * left.span, "rtol": 8.0 * float(np.finfo(float).eps)}
        return float(brentq(over, 0.0, left.span, **accuracy))

    def begun(self, stage: Stage) -> tuple[int, ...]:
        """Nodes at melting at which fronts begin at the start of a stage: those that take heat as long as no node goes
        beyond melting.  Others keep their phase.

        Raises
        ------
        NoConvergence
            If the heats of the nodes cannot be balanced.
        """
        if not self._at_melting:
            return ()
        fronts, kept = self.held.fronts, self._bounded
        places = {cell: float(fronts.share[cell]) for cell in fronts.cells.tolist()}
        fixed, whole = self._pins({}, places) | self._crossing(stage.end), replace(stage, theta=1.0)
        while True:
            taken = self.held.solve(whole, places, fixed | kept).taken
            rest = {j for j in kept if (-taken[j] if fronts.liquid[j] else taken[j]) > 0.5 * self._slight[j]}
            if rest == kept or not rest & self._at_melting:
                return tuple(sorted(rest & self._at_melting))
            kept = frozenset(rest)

    @cached_property
    def at_start(self) -> Mapping[FrontEvent, float]:
        """By how much heat each event is over at the start [J]."""
        cells, fronts = self.held.cells, self.held.fronts
        places = {cell: float(fronts.share[cell]) for cell in fronts.cells.tolist()}
        none = np.zeros(len(cells.latent)), dict.fromkeys(fronts.waiting.tolist(), 0.0)
        return self._over(places, {}, none, self.held.before.temperature)

    @cached_property
    def _standing(self) -> frozenset[int]:
        """Cells whose fronts stand at a node that waits."""
        cells, fronts = self.held.cells, self.held.fronts
        return frozenset(c for j in fronts.waiting.tolist() for c in standing_at(cells, fronts, j))

    @cached_property
    def _slight(self) -> Array:
        """Heats (n,) by which nodes may miss the temperature of melting [J]."""
        return slight_heats(self.held.cells)

    @cached_property
    def _at_melting(self) -> frozenset[int]:
        """Nodes of these with a free temperature that are at melting, or beyond it."""
        cells, fronts, now = self.held.cells, self.held.fronts, self.held.before.temperature
        over = fronts.beyond(cells, now) * cells.capacity
        return frozenset(j for j in self._alone.tolist() if over[j] >= -self._slight[j]) - self.held.prescribed

    @cached_property
    def _bounded(self) -> frozenset[int]:
        """Nodes with a free temperature that may melt, and do not wait."""
        may = ~np.isnan(self.held.cells.melting) & np.isnan(self.held.fronts.pocket)
        return frozenset(np.flatnonzero(may).tolist()) - self.held.prescribed

    def _crossing(self, time: float) -> frozenset[int]:
        """Nodes whose prescribed temperature of a time [s] is beyond melting."""
        then = prescribed(self.held.model, self.held.before.unknowns, time)
        over = self.held.fronts.beyond(self.held.cells, heat_values(self.held.model, then, slopes=False).temperature)
        return frozenset(j for j in self.held.prescribed if over[j] > 0.0)

    @cached_property
    def _alone(self) -> IntArray:
        """Nodes (k,) that may melt, and have neither a front that moves beside them nor a pocket."""
        cells, fronts = self.held.cells, self.held.fronts
        alone = ~np.isnan(cells.melting) & np.isnan(fronts.pocket)
        alone[cells.nodes[[c for c in fronts.cells.tolist() if c not in self._standing]]] = False
        return np.flatnonzero(alone)

    def _pins(self, stopped: Mapping[int, tuple[int, float]], shares: Mapping[int, float]) -> frozenset[int]:
        """Nodes that are held at melting: those that wait, and those at which fronts are."""
        cells, fronts, nodes = self.held.cells, self.held.fronts, {node for node, _ in stopped.values()}
        nodes |= {fronts.liquid_node(cells, cell) for cell, share in shares.items() if share == 0.0}
        nodes |= {fronts.solid_node(cells, cell) for cell, share in shares.items() if share == 1.0}
        return frozenset((nodes - self.held.prescribed) | set(fronts.waiting.tolist()))

    def _placed(
        self,
        stage: Stage,
        cell: int,
        shares: Mapping[int, float],
        stopped: Mapping[int, tuple[int, float]],
        event: FrontEvent | None,
    ) -> tuple[float, tuple[int, float] | None]:
        """Share of a cell at the end, with the other fronts held; and the node at which its front stops, with the heat
        that it would go on with [J]; below zero it is the heat that it lacks to get there.
        """
        cells, fronts, start = self.held.cells, self.held.fronts, float(self.held.fronts.share[cell])
        others = {c: stop for c, stop in stopped.items() if c != cell}
        beside = {c: share for c, share in shares.items() if c != cell}
        pins, ends = self._pins(others, beside), (fronts.liquid_node(cells, cell), fronts.solid_node(cells, cell))

        def missing(share: float) -> float:
            """Latent heat of a share less the heat that comes to the front [J]."""
            node = ends[int(share)] if share in (0.0, 1.0) else -1
            own = {node} - self.held.prescribed if node >= 0 else set()
            held = self.held.solve(stage, {**beside, cell: share}, pins | own)
            sharing = 1 + sum(node == stop for stop, _ in others.values())
            from_node = held.taken[node] / sharing if own and node not in fronts.waiting else 0.0
            return float(cells.latent[cell] * (share - start) - held.into[cell] - from_node)

        if event is not None:
            end = float(ends.index(event.node))
            return end, (event.node, missing(end) * (1.0 - 2.0 * end))
        at_start = missing(start)
        end = 1.0 if at_start < 0.0 else 0.0
        node, known = ends[int(end)], {start: at_start}
        if at_start == 0.0 or start == end:
            return start, ((node, abs(at_start)) if at_start else None)
        from scipy.optimize import brentq  # slow to load

        known[end] = missing(end)
        if known[end] * at_start >= 0.0:
            return end, (node, abs(known[end]))
        share = float(brentq(lambda x: known[x] if x in known else missing(x), start, end, xtol=PLACED))
        return share, ((node, -abs(known[end])) if share == end else None)

    def _over(
        self,
        shares: Mapping[int, float],
        stopped: Mapping[int, tuple[int, float]],
        heats: tuple[Array, Mapping[int, float]],
        temperature: Array,
    ) -> dict[FrontEvent, float]:
        """By how much heat each event is over [J]."""
        cells, fronts, found = self.held.cells, self.held.fronts, {}
        for cell, share in shares.items():
            if cell in self._standing:
                continue
            node, beyond = stopped.get(cell, (-1, 0.0))
            for end, rest in ((fronts.liquid_node(cells, cell), share), (fronts.solid_node(cells, cell), 1.0 - share)):
                found[FrontEvent("pass", end, cell)] = beyond if end == node else -rest * float(cells.latent[cell])
        over = fronts.beyond(cells, temperature) * cells.capacity
        for node in (j for j in self._alone.tolist() if j not in self._at_melting):
            if node in self.held.prescribed:
                least = CROSSED * cells.melting[node] * cells.capacity[node]
                found[FrontEvent("pass", node)] = float(over[node] - least)
            else:
                found[FrontEvent("reach", node)] = float(over[node])
        for node in fronts.waiting.tolist():
            pocket = pocket_after(cells, fronts, *heats, node)
            found[FrontEvent("empty", node)] = float(fronts.least[node]) - pocket
            found[FrontEvent("full", node)] = pocket - float(fronts.limit[node])
        return found


def slight_heats(cells: FrontCells) -> Array:
    """Heats (n,) by which nodes that may melt may miss melting [J], not a number at others: a billionth of the latent
    heat of half their cells, and the rounding of the temperature.
    """
    half = np.zeros(len(cells.melting))
    np.add.at(half, cells.nodes, 0.5 * cells.latent[:, None])
    return SAME * half + CROSSED * cells.melting * cells.capacity


def pocket_after(cells: FrontCells, fronts: Fronts, into: Array, taken: Mapping[int, float], node: int) -> float:
    """Pocket of a node that waits after the heat ``taken`` from it, and ``into`` the fronts that stand there [J]."""
    heat = taken[node] + sum(into[c] for c in standing_at(cells, fronts, node))
    return float(fronts.pocket[node] + (-heat if fronts.liquid[node] else heat))


def standing_at(cells: FrontCells, fronts: Fronts, node: int) -> list[int]:
    """Cells whose fronts stand at a node that waits."""
    at = 0.0 if fronts.liquid[node] else 1.0
    return [c for c in cells.around(node).tolist() if fronts.share[c] == at]
