"""Heat of solids that melt in cut cells, on other meshes: contents of the nodes pass over with their latent heat, and
the temperatures are those that have these contents (docs/theory/bodies/adaptive.md#change-of-phase).
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.heat import Heated, HeldByNodes, bounds_at, carried_contents
from softway.arrays import Array
from softway.bodies.elements.cut_cells import melted_part
from softway.errors import NoConvergence, NumericsError
from softway.heat.heat_balance import Stage
from softway.heat.heat_model import HeatModel, HeatPart
from softway.heat.heat_slab import solve_stage
from softway.heat.operators import heat_values
from softway.laws.heat.heat_content import ContentCurve, content_curve

Placed = tuple[HeatModel, HeatPart]
"""Solid in the model of its mesh."""


def melting_contents(
    both: tuple[Placed, Placed], meshes: tuple[Heated, Heated], at_nodes: sp.csr_array, over: Array
) -> Array:
    """Contents (k,) of the nodes of a solid on its new mesh [J], from the temperatures ``over`` melting (n,) of all its
    old nodes [K].

    A place keeps its content.  Its new nodes have those of the temperatures that are interpolated there, with the
    latent heat of the new cells, shifted evenly, and limited as temperatures are.
    """
    part = both[1][1]
    law = part.law
    assert law.latent is not None
    curve, melts = content_curve(law, latent=True), law.latent
    held = meshes[0].held(), meshes[1].held()
    near, low, high = np.asarray(at_nodes @ over), *bounds_at(at_nodes, over)

    def entropy(content: Array) -> Array:
        temperature = curve.temperature(content)[0]
        share = curve.liquid_share(content, temperature)[0]
        return np.asarray(curve.entropy(temperature) + share * melts.heat / melts.melting)

    values = _specific(*both[0], over, held[0]), _specific(*both[1], near, held[1])
    width = max((block.width for block in both[1][0].simplices), default=0.0)
    bounds = curve.content(low - width + melts.melting), curve.content(high + melts.melting)
    found = carried_contents(meshes, held, values, bounds, entropy)[part.kept]
    return np.asarray(both[1][0].mass[part.nodes] * found)


def _specific(heat: HeatModel, part: HeatPart, over: Array, held: HeldByNodes) -> Array:
    """Specific contents (k,) of the nodes of cells [J/kg] at temperatures ``over`` melting (n,) of all nodes [K]."""
    count, size = held.count, part.mesh.n_nodes
    latent = sp.csr_array((count, size))
    owned = over if part.mesh.hanging is None else _owned(heat, part, over)
    for block in heat.simplices:
        mine = np.flatnonzero((block.numbers >= part.cells.start) & (block.numbers < part.cells.stop))
        nodes, cell = block.nodes[mine] - part.places.start, block.numbers[mine] - part.cells.start
        melted = melted_part(owned[nodes], block.width)[0] * (block.heat * block.mass[mine])[:, None]
        rows = np.repeat(cell, nodes.shape[1])
        latent = latent + sp.csr_array((melted.ravel(), (rows, nodes.ravel())), shape=(count, size))
    if heat.hanging is not None:
        latent = _in_mesh(sp.csr_array(latent @ _spread(heat, part)), part)
    found = np.asarray(latent[held.cell, held.node]).ravel()
    assert isinstance(part.curve, ContentCurve)
    return np.asarray(part.curve.content(over[held.node] + part.zero) + found / held.share)


def _spread(heat: HeatModel, part: HeatPart) -> sp.csr_array:
    """Shares (n, k) of the nodes of a solid that do not hang in the heat of all."""
    assert heat.hanging is not None
    return sp.csr_array(heat.hanging.spread[part.places][:, part.nodes])


def _owned(heat: HeatModel, part: HeatPart, over: Array) -> Array:
    """Values (n,) by which the heat of all nodes tells its melting."""
    return over if heat.hanging is None else np.asarray(_spread(heat, part) @ over[part.kept])


def _in_mesh(latent: sp.csr_array, part: HeatPart) -> sp.csr_array:
    """Latent heat (e, n) by the numbers of the mesh, from that (e, k) of nodes that do not hang."""
    found = sp.coo_array(latent)
    rows, columns = found.coords
    return sp.csr_array((found.data, (rows, part.kept[columns])), shape=(latent.shape[0], part.mesh.n_nodes))


def with_contents(heat: HeatModel, unknowns: Array, wanted: Mapping[str, Array]) -> Array:
    """Unknowns (k + r,) with which the nodes of some solids have the contents (k,) that are ``wanted`` [J].

    Raises
    ------
    NumericsError
        If they are not found.
    """
    if not wanted:
        return unknowns
    alone = replace(heat, surfaces=(), sources=(), held=(), exchanges=())
    now = heat_values(alone, unknowns)
    content = now.content.copy()
    for part in heat.parts:
        if part.name in wanted:
            content[part.nodes] = wanted[part.name]
    try:
        stage = Stage(start=0.0, span=0.0, theta=1.0)
        return solve_stage(alone, replace(now, content=content), stage, guess=unknowns).after.unknowns
    except NoConvergence as error:
        raise NumericsError(f"temperatures of the contents on other cells: {error}", 0.0, "meshes that stay") from None
