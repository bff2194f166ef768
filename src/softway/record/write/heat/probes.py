"""Probes of conductors: the mean temperature of the nodes of a tag, or that of the node nearest to a point."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from softway.arrays import IntArray
from softway.errors import InputError
from softway.heat.march import HeatStep
from softway.meshes.mesh import Mesh
from softway.record.write.probes import Probe, probed_nodes, require_names


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatReading:
    """Probe resolved on a mesh: the mean temperature of nodes (k,) of a body."""

    name: str
    body: str
    nodes: IntArray
    unit: str = "K"

    def value(self, step: HeatStep) -> float:
        """Value after a step [K]."""
        return float(step.temperature[self.body][self.nodes].mean())


def heat_readings(probes: Sequence[Probe], meshes: Mapping[str, Mesh]) -> tuple[HeatReading, ...]:
    """Resolve the declared probes.

    Raises
    ------
    InputError
        For an unknown body, another quantity than the temperature, or a tag without nodes; with the path
        ``output.probes[k]``.
    """
    require_names(probes)
    found = []
    for k, probe in enumerate(probes):
        path = f"output.probes[{k}]"
        if probe.of not in meshes:
            raise InputError(f"{path}.of", f"no conductor '{probe.of}'", f"one of {list(meshes)}")
        if probe.quantity != "temperature":
            raise InputError(f"{path}.quantity", f"{probe.quantity!r} of a conductor", 'quantity = "temperature"')
        nodes = probed_nodes(path, probe, meshes[probe.of])
        found.append(HeatReading(name=probe.name, body=probe.of, nodes=nodes))
    return tuple(found)
