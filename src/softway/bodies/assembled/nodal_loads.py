"""Dead loads as nodal forces of all solids."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.heat_loads import HeatLoad
from softway.bodies.setup.loads import Gravity, Load, Traction, traction_force
from softway.errors import InputError, within


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeadLoads:
    """Dead loads of a scene: pairs of a ramp and its nodal forces (n, d) [N] at the factor one."""

    fields: tuple[tuple[Ramp, Array], ...]
    shape: tuple[int, int]

    @property
    def steady(self) -> bool:
        """True if no load changes with time."""
        return all(ramp.steady for ramp, _ in self.fields)

    def at(self, time: float) -> Array:
        """Sum of the loads (n, d) at a time [N]."""
        return self._sum([ramp.at(time) for ramp, _ in self.fields])

    def mean(self, start: float, end: float) -> Array:
        """Mean of the sum of the loads (n, d) from ``start`` to ``end`` [N]."""
        return self._sum([ramp.mean(start, end) for ramp, _ in self.fields])

    def _sum(self, factors: list[float]) -> Array:
        out = np.zeros(self.shape)
        for factor, (_, field) in zip(factors, self.fields, strict=True):
            out += factor * field
        return out


def dead_load(parts: Sequence[DiscreteSolid], weight: Array, loads: Sequence[Load | HeatLoad], where: str) -> DeadLoads:
    """Build the dead loads on solids with the nodal masses ``weight`` (n,) [kg].

    Loads of heat are none of them.  Gravity acts on the mass matrix: nodes without mass have no weight.  ``where`` is
    the place of the loads in the scene, for error messages.
    """
    shape = (len(weight), parts[0].mesh.dim)
    fields = []
    for k, item in enumerate(loads):
        out = np.zeros(shape)
        with within(f"{where}[{k}]"):
            match item:
                case Gravity():
                    out += weight[:, None] * item.vector(shape[1])
                case Traction():
                    part = _solid(parts, item.body, "on")
                    out[part.nodes] += traction_force(part.mesh, part.internal.section, item.tag, item.value)
                case _:
                    continue
        fields.append((item.ramp, out))
    return DeadLoads(fields=tuple(fields), shape=shape)


def _solid(parts: Sequence[DiscreteSolid], name: str, where: str) -> DiscreteSolid:
    for part in parts:
        if part.name == name:
            return part
    raise InputError(where, f"no solid '{name}'", f"one of {[p.name for p in parts]}")
