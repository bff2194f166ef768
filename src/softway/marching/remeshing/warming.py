"""Where heat needs fine cells: fronts of melting, surfaces whose loads change, and temperatures that bend."""

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.setup.heat_loads import HeatSource, place_of
from softway.marching.remeshing.carried_heat import temperature_of
from softway.marching.remeshing.touching import changes
from softway.marching.state.march_state import MarchState
from softway.model.model import Model

EVEN = 1e-9
"""Range of the temperatures of a solid, relative to the greatest, that is rounding."""


def warmed(model: Model, now: MarchState, ahead: float) -> IntArray:
    """Nodes (k,) of cells in which matter melts, and of surfaces whose heat changes within ``ahead`` [s]; of all these
    surfaces at the start, where they are sudden.
    """
    found = temperature_of(model)
    if found is None:
        return np.zeros(0, dtype=np.int64)
    (k, temperature), time = found, now.state.time
    parts, nodes = {part.name: part for part in model.parts}, [np.zeros(0, dtype=np.int64)]
    values = temperature.values_of(now.state.start.fields[k])
    for load in temperature.model.loads:
        name, tag = place_of(load)
        sudden = time <= 0.0 or changes(load.ramp, time, time + ahead)
        if name in parts and sudden and not isinstance(load, HeatSource):
            nodes.append(parts[name].nodes.start + parts[name].mesh.nodes(tag))
    at = temperature.model.everywhere(values.temperature)
    for heat in (part for part in temperature.model.parts if part.law.latent is not None):
        melts, melted = heat.law.latent, values.melted[heat.cells]
        assert melts is not None
        ((_, cells),) = heat.mesh.blocks.items()
        over = at[heat.places][cells] - melts.melting
        crossed = (over.min(axis=1) < melts.half_range) & (over.max(axis=1) > -melts.half_range)
        here = crossed | ((melted > 0.0) & (melted < 1.0))
        nodes.append(parts[heat.name].nodes.start + np.unique(cells[here]))
    return np.concatenate(nodes)


def warmth(model: Model, now: MarchState, name: str, energy: float) -> Array | None:
    """Temperatures (n,) of a solid relative to their range, or to what the ``energy`` of the scene [J] would warm it by
    if that is more; None without heat, and where they are even.
    """
    found = temperature_of(model)
    heats = () if found is None else (part for part in found[1].model.parts if part.name == name)
    for heat in heats:
        assert found is not None
        k, temperature = found
        part = next(p for p in model.parts if p.name == name)
        values = now.state.start.fields[k].values[part.nodes, 0]
        own = temperature.values_of(now.state.start.fields[k]).temperature[heat.nodes]
        capacity = float(temperature.model.mass[heat.nodes] @ heat.curve.capacity(own))
        if temperature.model.capacity is not None:
            capacity = float(temperature.model.capacity[heat.nodes].sum())
        scale = max(float(np.ptp(values)), energy / capacity)
        if np.ptp(values) > EVEN * abs(values).max():
            return np.asarray((values - values.min()) / scale)
    return None
