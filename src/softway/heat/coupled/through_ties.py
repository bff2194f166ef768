"""Heat through permanent ties of solids that have a temperature."""

from collections.abc import Iterator, Mapping

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.conductor import Thermal, conduction_laws
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import CombinedDofs
from softway.bodies.setup.loads import facet_measures
from softway.contact.assembly.tie import Tie
from softway.heat.coupled.facing_areas import evened
from softway.heat.heat_contact import HeatExchange
from softway.model.model import Model

FREELY = 1e3
"""Conductance of a tie, relative to that of a cell."""


def through_ties(model: Model, thermals: Mapping[str, Thermal], nodes: IntArray) -> Iterator[HeatExchange]:
    """Exchange of heat through the permanent ties of solids with heat, among the ``nodes`` (k,) with a temperature.

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
                yield from _of_side(follow, parts[name], tag, parts[other], conductance, nodes)


def _of_side(
    follow: sp.csr_array, own: DiscreteSolid, tag: str, other: DiscreteSolid, conductance: float, nodes: IntArray
) -> Iterator[HeatExchange]:
    """Exchange of the nodes of a surface that follow another solid."""
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
        jump = sp.csr_array((mine - led)[here][:, nodes])
        yield HeatExchange(jump=jump, conductances=conductance * area[node[here]])


def _conductance(tie: Tie, parts: Mapping[str, DiscreteSolid], thermals: Mapping[str, Thermal]) -> float:
    """Conductance of a tie [W/(m^2 K)]."""
    if tie.conductance is not None:
        return tie.conductance
    laws = [law for name in tie.bodies for law in conduction_laws(thermals[name].law).values()]
    best = max(law.greatest_conductivity for law in laws)
    return FREELY * best / min(parts[name].mesh.edge() for name in tie.bodies)
