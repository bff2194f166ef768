"""The scales of a scenario, before anything is computed: speeds, times, lengths, numbers."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from softway.bodies.mass import Lumped
from softway.bodies.section import Section, default_section, wave_speed
from softway.bodies.solid import Solid
from softway.space.mesh import Mesh
from softway.time.weight import Momentum, limit
from softway.typing import Array

_FREQUENCY = {("linear", False): 12.0, ("linear", True): 4.0, ("quadratic", False): 60.0, ("quadratic", True): 24.0}
_QUADRATIC = {"bar3", "tri6", "quad9", "tet10", "hex27"}


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyScales:
    """Numbers of one body.

    Parameters
    ----------
    nodes, cells, dofs
        Counts; ``dofs`` without the supported components.
    wave_speed
        Of the fastest wave [m/s].
    length
        Greatest extent [m].
    transit
        Time in which a wave crosses the length [s].
    edge
        Smallest edge [m].
    stable_step
        Estimate of the greatest stable slab for the weight Momentum [s]; exact for equal two-node bars.
    """

    nodes: int
    cells: int
    dofs: int
    wave_speed: float
    length: float
    transit: float
    edge: float
    stable_step: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactScales:
    """Numbers of one contact.

    Parameters
    ----------
    nodes
        How many may touch.
    gap
        Least gap at the start; of solids far from each other the distance of their nearest nodes [m].
    approach
        Speed with which this gap closes at the start; of places with the same gap the greatest [m/s].
    duration
        Expected time of contact ``2 L / c``, L along the normal [s].
    """

    nodes: int
    gap: float
    approach: float
    duration: float


def section_of(solid: Solid, mesh: Mesh) -> Section:
    """The section of a solid, the default one if none is given."""
    return default_section(mesh) if solid.section is None else solid.section


def body_scales(solid: Solid, mesh: Mesh, free: int) -> BodyScales:
    """Scales of a solid with its mesh; ``free`` counts the components without support.

    The highest frequency of a cell with edge a is estimated by ``omega^2 = k d c^2 / a^2`` with the k of one cell in
    one dimension: 12 and 4 (linear, consistent and lumped mass), 60 and 24 (quadratic).
    """
    speed = wave_speed(solid.material, solid.density, section_of(solid, mesh))
    length = float(np.ptp(mesh.points, axis=0).max())
    edge = mesh.edge()
    order = "quadratic" if _QUADRATIC & set(mesh.blocks) else "linear"
    highest = sqrt(_FREQUENCY[order, isinstance(solid.mass, Lumped)] * mesh.cell_dim) * speed / edge
    return BodyScales(
        nodes=mesh.n_nodes,
        cells=sum(len(b) for b in mesh.blocks.values()),
        dofs=free,
        wave_speed=speed,
        length=length,
        transit=length / speed,
        edge=edge,
        stable_step=limit(Momentum()) / highest,
    )


def contact_duration(points: Array, normal: Array, speed: float) -> float:
    """Expected time of contact ``2 L / c`` [s]; L is the extent of the points (n, d) along the normal (d,)."""
    return 2.0 * float(np.ptp(points @ normal)) / speed
