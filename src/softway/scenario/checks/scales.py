"""Scales of a scenario before the computation: speeds, times, lengths, numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.section import Section, default_section
from softway.bodies.inertia.mass_matrix import Lumped
from softway.bodies.internal_force.materials import materials_of
from softway.bodies.solid import Solid
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.model.time_weight import Momentum, limit

_FREQUENCY = {("linear", False): 12.0, ("linear", True): 4.0, ("quadratic", False): 60.0, ("quadratic", True): 24.0}
ALIKE = 1.0 + 1e-9
"""Ratio of impedances up to which bodies are equally stiff."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyScales:
    """Scales of one body.

    Parameters
    ----------
    nodes, cells, dofs
        Numbers of nodes, cells and degrees of freedom; ``dofs`` does not include supported components.
    wave_speed
        Speed of the fastest wave [m/s].
    length
        Largest extent along an axis [m].
    transit
        Time in which a wave crosses the length [s].
    edge
        Length of the smallest edge [m].
    stable_step
        Estimate of the longest stable slab for the weight Momentum [s]; exact for equal two-node bars.
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
    """Scales of one contact.

    Parameters
    ----------
    nodes
        Number of nodes that may touch.
    gap
        Smallest gap at the start; for distant solids the distance of their nearest nodes [m].
    approach
        Closing speed of this gap at the start; the largest one if several places have the same gap [m/s].
    duration
        Expected time of contact ``2 L / c``, with the extent L along the normal, of the softer body [s].
    """

    nodes: int
    gap: float
    approach: float
    duration: float


def section_of(solid: Solid, mesh: Mesh) -> Section:
    """Section of a solid; the default section if none is given."""
    return default_section(mesh) if solid.section is None else solid.section


def body_scales(solid: Solid, mesh: Mesh, free: int, factor: float = 1.0) -> BodyScales:
    """Scales of a solid with its mesh, ``free`` components without support, and its masses times a ``factor``.

    The highest frequency of a cell with edge a in d dimensions is estimated by ``omega^2 = k d c^2 / a^2``.  The factor
    k is exact for one cell in one dimension: 12 and 4 (linear, consistent and lumped mass), 60 and 24 (quadratic).
    """
    speed = max(materials_of(mesh, solid.material, solid.density).speeds(section_of(solid, mesh), factor))
    length = float(np.ptp(mesh.points, axis=0).max())
    edge = mesh.edge()
    order = "quadratic" if any(CELLS[name].order == 2 for name in mesh.blocks) else "linear"
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


def soft_duration(durations: Sequence[float], impedances: Sequence[float]) -> float:
    """Expected time of contact of one or two bodies [s], from the times and impedances ``rho c`` [kg/m^2/s] of each.

    The wave that returns in a body unloads the contact only if the other body is not softer: the time is that of the
    body with the least impedance, the shorter one of equal impedances.

    Examples
    --------
    >>> soft_duration([1e-5, 2e-3], [4e7, 1e5])
    0.002
    """
    least = min(impedances)
    return min(t for t, z in zip(durations, impedances, strict=True) if z <= ALIKE * least)
