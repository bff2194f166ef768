"""Heat conduction in a part of a slab at whose end the fronts are at given places.

Fronts exchange heat with the two nodes of their cells as bodies at the temperature of melting would, so that the rest
is a model of heat conduction.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.elements.front_cells import FrontCells
from softway.bodies.setup.heat_loads import Radiation, Temperature
from softway.heat.fronts.places import Fronts
from softway.heat.heat_balance import Stage
from softway.heat.heat_contact import HeatExchange
from softway.heat.heat_model import HeatCells, HeatModel
from softway.heat.heat_slab import StageResult, solve_stage
from softway.heat.operators import HeatValues, heat_values
from softway.kernels.assembly.assembler import assembler

NEAR = 1e-12
"""Distance of a front from a node whose temperature is prescribed, relative to the cell, below which it is this."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeldFronts:
    """Model of a part of a slab with m fronts between the same nodes throughout.

    Parameters
    ----------
    cells, fronts
        Cells that may have fronts, and the fronts at the start.
    model
        Conductors without the cells that have a front, each of the others in its phase.
    before
        State at the start, without latent heat.
    prescribed
        Nodes with a prescribed temperature.
    """

    cells: FrontCells
    fronts: Fronts
    model: HeatModel
    before: HeatValues
    prescribed: frozenset[int]

    def solve(self, stage: Stage, shares: Mapping[int, float], held: frozenset[int]) -> "Held":
        """Solve a stage at whose end the cells have liquid ``shares`` and some nodes are ``held`` at melting.

        Raises
        ------
        NoConvergence
            If the heats of the nodes cannot be balanced.
        """
        nodes, conductances, owners = self._links(stage, shares, held)
        points = sp.csr_array((np.ones(len(nodes)), (np.arange(len(nodes)), nodes)), (len(nodes), self.model.n_nodes))
        link = HeatExchange(jump=points, conductances=conductances, ambient=self.cells.melting[nodes])
        pins = [(Temperature(on="front", value=float(self.cells.melting[j])), np.array([j])) for j in sorted(held)]
        exchanges, count = (*self.model.exchanges, link), len(pins)
        found = solve_stage(
            replace(self.model, exchanges=exchanges, held=(*self.model.held, *pins)), self.before, stage
        )
        mean = (1.0 - stage.theta) * self.before.temperature + stage.theta * found.after.temperature
        given = stage.span * link.heat(mean)
        into = np.asarray(np.bincount(owners, given, len(self.cells.latent)), float)
        taken = {j: -float(heat) for j, heat in zip(sorted(held), found.heats[len(found.heats) - count :], strict=True)}
        result = replace(
            found, heats=found.heats[: len(found.heats) - count], passed=found.passed[:-1],
            entropy=found.entropy + sum(heat / float(mean[j]) for j, heat in taken.items()),
            reservoirs=found.reservoirs - float((given / link.ambient).sum()),
        )  # fmt: skip
        if len(nodes):  # what is left of the balance belongs to the link whose heat is least exact
            gained = float(found.after.content.sum() - self.before.content.sum())
            rest = float(result.heats.sum()) - gained - float(into.sum()) - sum(taken.values())
            into[owners[int(np.argmax(conductances))]] += rest
        return Held(result=result, into=into, taken=taken)

    def _links(self, stage: Stage, shares: Mapping[int, float], held: frozenset[int]) -> tuple[Array, Array, Array]:
        """Nodes (p,) that exchange heat with fronts, conductances (p,) [W/K], and cells (p,) of the fronts.

        A front that meets a node which is held at melting exchanges none with it.
        """
        nodes, conductances, owners = [], [], []
        for cell, end in shares.items():
            share = (1.0 - stage.theta) * self.fronts.share[cell] + stage.theta * end
            for node, way, whole in (
                (self.fronts.liquid_node(self.cells, cell), share, self.cells.liquid[cell]),
                (self.fronts.solid_node(self.cells, cell), 1.0 - share, self.cells.solid[cell]),
            ):
                if node not in held:
                    nodes.append(node)
                    conductances.append(whole / (max(way, NEAR) if node in self.prescribed else way))
                    owners.append(cell)
        return np.array(nodes, dtype=int), np.array(conductances), np.array(owners, dtype=int)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Held:
    """Result of a stage with fronts at given places: heats ``into`` the fronts of the cells (c,) [J], and those
    ``taken`` from the nodes that are held [J].  The heats and entropies of the result are those of the loads.
    """

    result: StageResult
    into: Array
    taken: Mapping[int, float]


def held_fronts(model: HeatModel, cells: FrontCells, fronts: Fronts, before: HeatValues) -> HeldFronts:
    """Model of a part of a slab that begins at the bare state ``before`` with some ``fronts``."""
    phase = np.zeros(model.n_cells, dtype=int)
    phase[cells.numbers] = np.where(np.isnan(fronts.share), 1 + fronts.liquid[cells.nodes[:, 0]], 3)
    blocks: list[HeatCells] = []
    for block in model.cells:
        own = phase[block.numbers]
        if not own.any():
            blocks.append(block)
            continue
        for k, law in ((1, replace(block.law, latent=None)), (2, block.law.liquid)):
            here = own == k
            if here.any():
                blocks.append(
                    HeatCells(
                        law=law,
                        nodes=block.nodes[here],
                        N=block.N,
                        gradients=block.gradients[here],
                        volume=block.volume[here],
                        numbers=block.numbers[here],
                    )  # fmt: skip
                )
    blocks = blocks or [_no_cells(model.cells[0])]
    pattern = assembler([block.nodes for block in blocks], model.n_nodes, 1)
    known = frozenset(int(j) for _, nodes in model.held for j in nodes)
    radiates = any(isinstance(surface.load, Radiation) for surface in model.surfaces)
    linear = all(block.law.constant for block in blocks) and not radiates
    curves = {phases.nodes.start: phases.content(fronts.liquid) for phases in cells.phases}
    parts = tuple(replace(part, curve=curves.get(part.nodes.start, part.curve)) for part in model.parts)
    rest = replace(model, parts=parts, cells=tuple(blocks), pattern=pattern, linear=linear)
    return HeldFronts(
        cells=cells, fronts=fronts, model=rest, before=heat_values(rest, before.unknowns), prescribed=known
    )  # fmt: skip


def _no_cells(block: HeatCells) -> HeatCells:
    """Block without a cell, of a model whose cells all have a front."""
    none = slice(0)
    return replace(
        block, nodes=block.nodes[none], gradients=block.gradients[none], volume=block.volume[none],
        numbers=block.numbers[none],
    )  # fmt: skip
