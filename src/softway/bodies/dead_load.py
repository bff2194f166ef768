"""Dead loads as nodal forces of all solids."""

from collections.abc import Sequence

import numpy as np

from softway.bodies.loads import Gravity, Load, Traction, traction_force
from softway.bodies.part import Part
from softway.errors import InputError, within
from softway.typing import Array


def dead_load(parts: Sequence[Part], weight: Array, loads: Sequence[Load], where: str) -> Array:
    """Nodal forces (n, d) [N] of dead loads on solids whose nodes have the mass ``weight`` (n,) [kg].

    Gravity acts on the inertia, so that massless nodes have no weight; ``where`` is the place of the loads in the
    scene, for errors.
    """
    dim = parts[0].mesh.dim
    out = np.zeros((len(weight), dim))
    for k, item in enumerate(loads):
        with within(f"{where}[{k}]"):
            match item:
                case Gravity():
                    out += weight[:, None] * item.vector(dim)
                case Traction():
                    part = _solid(parts, item.body, "on")
                    out[part.rows] += traction_force(part.mesh, part.internal.section, item.tag, item.value)
    return out


def _solid(parts: Sequence[Part], name: str, where: str) -> Part:
    for part in parts:
        if part.name == name:
            return part
    raise InputError(where, f"no solid '{name}'", f"one of {[p.name for p in parts]}")
