"""conductors.json: names of the conductors and of their loads."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from softway.heat.heat_model import HeatModel

FILE = "conductors.json"
ENTRIES: Mapping[str, type] = MappingProxyType({"bodies": dict, "melting": list, "loads": list})
"""Entries of every file, and their types."""


def outline(model: HeatModel) -> dict[str, Any]:
    """Numbers of nodes of the conductors by name, those that melt, and their loads in the order of their columns.

    Examples
    --------
    >>> import softway as sw
    >>> law = sw.heat.Conduction(conductivity=1.0, capacity=1.0)
    >>> bar = sw.heat.Conductor(mesh=sw.meshes.Interval(length=1.0, cells=1), law=law, density=1.0, temperature=300.0)
    >>> outline(sw.heat.build_heat(sw.heat.HeatScene(bodies={"bar": bar})))
    {'bodies': {'bar': 2}, 'melting': [], 'loads': []}
    """
    return {
        "bodies": {part.name: part.mesh.n_nodes for part in model.parts},
        "melting": [part.name for part in model.parts if part.law.latent is not None],
        "loads": [f"{type(load).__name__} {load.on}" for load in model.loads],
    }
