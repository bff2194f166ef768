"""Heat through the ties of solids that have a temperature, permanent ones and those that break, and between rigid
bodies that have one, always or through stops that are closed.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.assembled.heated_nodes import HeatedNodes
from softway.bodies.conductor import Thermal, conduction_laws
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import CombinedDofs
from softway.bodies.setup.loads import facet_measures
from softway.contact.assembly.tie import Tie
from softway.errors import InputError
from softway.heat.coupled.facing_areas import evened
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import Lump
from softway.mechanisms.members.couplings import HeatLink
from softway.mechanisms.members.mechanism import Mechanism
from softway.model.cohesive_ties import CohesiveTie
from softway.model.field import StopsInSlab
from softway.model.model import Model

FREELY = 1e3
"""Conductance of a tie, relative to that of a cell."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GlueInSlab:
    """Tie that breaks in a slab: the exchange through what holds of it, and the heat (n,) of its dissipation [J]."""

    exchange: HeatExchange
    heat: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BreakingGlue:
    """Tie that breaks, with heat.

    Parameters
    ----------
    tie, number
        The tie, and its place among the components of the damage.
    points
        (n, d) reference positions of all nodes [m].
    jump
        (m, k + r) jumps of the temperature from those of the nodes with heat and of rigid bodies.
    conductance
        Conductance while it is intact [W/(m^2 K)].
    """

    tie: CohesiveTie
    number: int
    points: Array
    jump: sp.csr_array
    conductance: float

    def in_slab(self, damage: Array, u1: Array) -> GlueInSlab:
        """Glue in a slab with the ``damage`` (n, ties) at its start and the displacement ``u1`` (n, d) at its end [m].

        It conducts by the mean of what holds at both ends.  Either surface takes half of the dissipated energy.
        """
        node, area = self.tie.jump.node, self.tie.jump.area
        before = damage[node, self.number]
        after, spent = self.tie.grown(before, u1, self.points + u1)
        conductances = self.conductance * area * (1.0 - 0.5 * (before + after))
        here = np.flatnonzero(conductances > 0.0)
        exchange = HeatExchange(jump=sp.csr_array(self.jump[here]), conductances=conductances[here])
        heat: Array = np.zeros(len(u1))
        for sign in (1.0, -1.0):
            side = (sign * self.tie.jump.rows).maximum(0.0)
            heat += side.T @ (0.5 * area * spent / np.asarray(side.sum(axis=1)).ravel())
        return GlueInSlab(exchange=exchange, heat=heat)


def breaking_glue(model: Model, heated: HeatedNodes) -> Iterator[BreakingGlue]:
    """Ties that break and have a conductance, among the nodes with a temperature."""
    for bond in model.bonds:
        for number, tie in enumerate(bond.ties):
            if tie.tie.conductance is not None:
                jump = heated.rows(tie.jump.rows)
                yield BreakingGlue(
                    tie=tie, number=number, points=bond.points, jump=jump, conductance=tie.tie.conductance
                )


def require_heated(model: Model, heated: Collection[str]) -> None:
    """Refuse the conductance of ties that break of solids that are not among the ``heated``.

    Raises
    ------
    InputError
        With the place of the tie.
    """
    for tie in (tie for bond in model.bonds for tie in bond.ties):
        cold = [name for name in tie.tie.bodies if name not in heated]
        if tie.tie.conductance is not None and cold:
            problem = f"heat through a tie of {cold[0]!r}, which has no temperature"
            remedy = f"bodies.{cold[0]}.thermal, or no conductance"
            raise InputError(f"ties[{tie.number}].conductance", problem, remedy)


def through_ties(model: Model, thermals: Mapping[str, Thermal], heated: HeatedNodes) -> Iterator[HeatExchange]:
    """Exchange of heat through the permanent ties of solids with heat, among the nodes with a temperature.

    The temperature of a node that follows is compared with that of the nodes that it follows, with their weights: where
    meshes do not match, a uniform flux passes exactly.
    """
    if not isinstance(model.dofs, CombinedDofs) or model.dofs.follow is None:
        return
    d, parts = model.dofs.d, {part.name: part for part in model.parts}
    follow = sp.csr_array(model.dofs.follow[::d][:, ::d])
    for tie in model.scene.ties:
        if tie.breaks is None and tie.conductance != 0.0 and set(tie.bodies) <= set(thermals):
            conductance = _conductance(tie, parts, thermals)
            for name, tag in zip(tie.bodies, tie.tags, strict=True):
                other = next((n for n in tie.bodies if n != name), name)
                for jump, area in _of_side(follow, parts[name], tag, parts[other]):
                    yield HeatExchange(jump=heated.rows(jump), conductances=conductance * area)


def _of_side(
    follow: sp.csr_array, own: DiscreteSolid, tag: str, other: DiscreteSolid
) -> Iterator[tuple[sp.csr_array, Array]]:
    """Jumps (p, n) and areas (p,) [m^2] of the nodes of a surface that follow another solid."""
    area: Array = np.zeros(own.mesh.n_nodes)
    for kind, facets in own.mesh.facets_on(tag).items():
        measure = facet_measures(own.mesh.points[facets], own.internal.section, kind)
        np.add.at(area, facets, evened(measure) if kind == "quad8" else measure)
    node = np.flatnonzero(area > 0.0)
    mine = sp.csr_array(sp.eye_array(follow.shape[0], format="csr")[node + own.nodes.start])
    led = sp.csr_array(follow[node + own.nodes.start])
    inside = (led.indices >= other.nodes.start) & (led.indices < other.nodes.stop) & (led.data != 0.0)
    row = np.repeat(np.arange(len(node)), np.diff(led.indptr))
    follows = np.bincount(row[inside], minlength=len(node)) > 0
    if own is other:
        follows &= np.asarray((mine - led).power(2).sum(axis=1)).ravel() > 0.0
    here = np.flatnonzero(follows)
    if here.size:
        yield sp.csr_array((mine - led)[here]), area[node[here]]


def _conductance(tie: Tie, parts: Mapping[str, DiscreteSolid], thermals: Mapping[str, Thermal]) -> float:
    """Conductance of a tie [W/(m^2 K)]."""
    if tie.conductance is not None:
        return tie.conductance
    laws = [law for name in tie.bodies for law in conduction_laws(thermals[name].law).values()]
    best = max(law.greatest_conductivity for law in laws)
    return FREELY * best / min(parts[name].mesh.edge() for name in tie.bodies)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StopLink:
    """Heat through a stop.

    Parameters
    ----------
    stop
        Name of the stop.
    exchange
        Exchange of its bodies while it is closed; None if it conducts nothing.
    shares
        (k + r,) shares of its dissipated energy, of two rigid bodies among the nodes with heat and the rigid bodies.
    """

    stop: str
    exchange: HeatExchange | None
    shares: Array

    def closed(self, stops: StopsInSlab) -> HeatExchange | None:
        """Exchange in a slab, in the part of it in which the stop is closed; None if there is none."""
        part = stops.closed.get(self.stop, 0.0)
        if self.exchange is None or not part:
            return None
        return HeatExchange(jump=self.exchange.jump, conductances=part * self.exchange.conductances)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StopsWithHeat:
    """Stops that pass heat, in a slab: their ``exchanges``, and the heat (k + r,) of what they dissipate [J]."""

    exchanges: tuple[HeatExchange, ...]
    heat: Array


def exchanges_of(glue: tuple[GlueInSlab, ...], stops: StopsWithHeat | None) -> tuple[HeatExchange, ...]:
    """Exchanges through ties that break and through stops, in a slab."""
    found = (one.exchange for one in glue if len(one.exchange.conductances))
    return (*found, *(() if stops is None else stops.exchanges))


def in_stops(links: tuple[StopLink, ...], stops: StopsInSlab, size: int) -> StopsWithHeat:
    """Heat through stops in a slab, of ``size`` nodes and rigid bodies with a temperature."""
    heat = np.zeros(size)
    for link in links:
        heat += stops.spent.get(link.stop, 0.0) * link.shares
    found = (link.closed(stops) for link in links)
    return StopsWithHeat(exchanges=tuple(one for one in found if one is not None), heat=heat)


def through_links(
    mechanism: Mechanism | None, lumps: tuple[Lump, ...], nodes: int
) -> tuple[list[HeatExchange], list[StopLink]]:
    """Heat between the rigid bodies ``lumps``, which are behind a number of ``nodes``: always, and through stops.

    Raises
    ------
    InputError
        If nothing says how the bodies of a stop share what it dissipates.
    """
    always: list[HeatExchange] = []
    stops: list[StopLink] = []
    place = {lump.name: nodes + k for k, lump in enumerate(lumps)}
    for k, link in enumerate(() if mechanism is None else mechanism.heat_links):
        assert mechanism is not None
        one, other = mechanism.linked_by_heat(link)
        at, size = np.array([place[one], place[other]]), nodes + len(lumps)
        jump = sp.csr_array((np.array([1.0, -1.0]), (np.zeros(2, int), at)), shape=(1, size))
        exchange = HeatExchange(jump=jump, conductances=np.array([link.conductance]))
        if link.stop is None:
            always.append(exchange)
            continue
        share = _share(link, mechanism, {lump.name: lump for lump in lumps}, f"heat_links[{k}].share")
        shares = np.zeros(size)
        shares[at] = share, 1.0 - share
        stops.append(StopLink(stop=link.stop, exchange=exchange if link.conductance else None, shares=shares))
    return always, stops


def _share(link: HeatLink, mechanism: Mechanism, lumps: dict[str, Lump], where: str) -> float:
    """Share of what a stop dissipates that heats its first body."""
    if link.share is not None:
        return link.share
    one, other = (lumps[name].effusivity for name in mechanism.linked_by_heat(link))
    if one is None or other is None:
        assert link.stop is not None
        stop = mechanism.stops[link.stop]
        if stop.restitution == 1.0 and not (stop.law.at_rest or stop.law.turns):
            return 0.5  # of nothing
        problem = f"missing: nothing says how the bodies of {link.stop!r} share what it dissipates"
        raise InputError(where, problem, "a share from 0 to 1, or density and thermal.conductivity of both bodies")
    return one / (one + other)
