"""Cells of bars that have fronts between their nodes, of conductors that ask for it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from softway.arrays import Array
from softway.bodies.conductor import Conductor, conduction_laws
from softway.bodies.elements.front_cells import FrontCells, Phases
from softway.errors import InputError, within
from softway.heat.heat_model import HeatModel, HeatPart
from softway.laws.heat.conduction import Conduction
from softway.laws.heat.heat_content import content_curve
from softway.laws.heat.temperature_table import TemperatureTable


def with_fronts(model: HeatModel, bodies: Mapping[str, Conductor]) -> HeatModel:
    """Model with the fronts of its bars.

    Raises
    ------
    InputError
        With the body: if a front is asked for that cells or laws do not allow.
    """
    found = []
    for part in model.parts:
        body = bodies[part.name]
        if body.latent == "front" and part.law.latent is not None:
            with within(f"bodies.{part.name}"):
                _require_bars(body, part)
            found.append(_front_cells(model, part, body))
    return replace(model, fronts=_joined(found))


def _require_bars(body: Conductor, part: HeatPart) -> None:
    """Refuse fronts where cells or laws do not allow them."""
    if set(part.mesh.blocks) != {"bar2"}:
        raise InputError("latent", f"'front' in {', '.join(part.mesh.blocks)}", "'cell'; or linear cells of bars")
    if len(conduction_laws(body.law)) > 1 or not isinstance(body.density, float | int):
        raise InputError("latent", "'front' in a body of several materials", "'cell'; or a conductor for each")
    assert part.law.latent is not None
    if part.law.latent.half_range:
        raise InputError("latent", "'front' in matter with a mushy range", "'node'; or half_range = 0")
    for name, law in (("law", part.law), ("law.latent.liquid", part.law.liquid)):
        if isinstance(law.conductivity, TemperatureTable):
            raise InputError(f"{name}.conductivity", "a table beside a front", "a number; or latent = 'cell'")


def _front_cells(model: HeatModel, part: HeatPart, body: Conductor) -> FrontCells:
    """Cells of a bar."""
    (cells,) = (block for block in model.cells if part.cells.start <= block.numbers[0] < part.cells.stop)
    melts = part.law.latent
    assert melts is not None and isinstance(body.density, float | int)
    unit = np.einsum("eq,eqar->e", cells.volume, cells.gradients[:, :, :1] ** 2)
    melting, capacity = np.full(model.n_nodes, np.nan), np.full(model.n_nodes, np.nan)
    melting[part.nodes] = melts.melting
    capacity[part.nodes] = model.mass[part.nodes] * part.curve.capacity(np.array(melts.melting))
    one = replace(melts, liquid=None)
    solid, liquid = (content_curve(replace(law, latent=one), latent=False) for law in (part.law, part.law.liquid))
    return FrontCells(
        nodes=cells.nodes, numbers=cells.numbers, latent=melts.heat * body.density * part.volume,
        solid=unit * _number(part.law), liquid=unit * _number(part.law.liquid), melting=melting, capacity=capacity,
        phases=(Phases(nodes=part.nodes, solid=solid, liquid=liquid),),
    )  # fmt: skip


def _number(law: Conduction) -> float:
    """Conductivity of a law along a bar [W/(m K)]."""
    k: Array = law.along_axes(np.ones(1), 1)[0]
    return float(k[0, 0])


def _joined(blocks: Sequence[FrontCells]) -> FrontCells | None:
    """Cells of several bodies; None without any."""
    if not blocks:
        return None

    melting, capacity = blocks[0].melting.copy(), blocks[0].capacity.copy()
    for block in blocks[1:]:
        own = ~np.isnan(block.melting)
        melting[own], capacity[own] = block.melting[own], block.capacity[own]
    return FrontCells(
        nodes=np.concatenate([block.nodes for block in blocks]),
        numbers=np.concatenate([block.numbers for block in blocks]),
        latent=np.concatenate([block.latent for block in blocks]),
        solid=np.concatenate([block.solid for block in blocks]),
        liquid=np.concatenate([block.liquid for block in blocks]),
        melting=melting, capacity=capacity, phases=tuple(phase for block in blocks for phase in block.phases),
    )  # fmt: skip
