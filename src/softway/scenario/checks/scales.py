"""Scales of a scenario before the computation: speeds, times, lengths, numbers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import sqrt

import numpy as np
from scipy.spatial import cKDTree

from softway.arrays import Array
from softway.bodies.elements.section import Section, default_section
from softway.bodies.inertia.mass_matrix import Lumped
from softway.bodies.internal_force.materials import materials_of
from softway.bodies.solid import Solid
from softway.contact.contact_rows import ContactRows
from softway.marching.start.initial_state import SOON
from softway.meshes.adaptive.adapt import adaption
from softway.meshes.cells import CELLS
from softway.meshes.mesh import Mesh
from softway.model.model import Model
from softway.model.time_weight import Momentum, limit

_FREQUENCY = {("linear", False): 12.0, ("linear", True): 4.0, ("quadratic", False): 60.0, ("quadratic", True): 24.0}
ALIKE = 1.0 + 1e-9
"""Ratio of impedances up to which bodies are equally stiff."""
SAME = 1e-9
"""Difference of gaps relative to the body length below which two places are regarded as equally near."""


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
    finest_edge
        Length of the smallest edge of the finest cells of a mesh that adapts [m]; None for one that stays.
    """

    nodes: int
    cells: int
    dofs: int
    wave_speed: float
    length: float
    transit: float
    edge: float
    stable_step: float
    finest_edge: float | None = None


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
    edge, adapt = mesh.edge(), adaption(solid.adapt)
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
        finest_edge=None if adapt is None else adapt.finest(mesh),
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


def contact_scales(model: Model, bodies: Mapping[str, BodyScales]) -> dict[str, ContactScales]:
    """Scales of all contacts by their labels."""
    u, contacts = model.displacement, model.scene.contacts
    if not contacts:
        return {}
    rows, driven = model.rows(u), model.contacts.meet(u, u, 0.0, SOON).at(u).tool_motion / SOON
    return {c.label: _contact(model, k, bodies, rows, driven) for k, c in enumerate(contacts)}


def _contact(
    model: Model, number: int, bodies: Mapping[str, BodyScales], rows: ContactRows, driven: Array
) -> ContactScales:
    """Scales of one contact, from all ``rows`` (m,) and the normal velocities ``driven`` (m,) of their tools."""
    u = model.displacement
    here = np.flatnonzero(rows.of_contact(number) & rows.near)
    if not len(here):
        direction, gap, speed, met = _nearest(model, number)
    else:
        gaps, speeds = rows.gap(u)[here], (driven - rows.normal_component(model.velocity))[here]
        same = SAME * max(bodies[model.parts[k].name].length for k in model.contact_solids[number])
        least = np.flatnonzero(gaps <= gaps.min() + same)
        first = least[np.argmax(speeds[least])]
        direction, gap, speed = rows.normal[here[first]], float(gaps.min()), float(speeds[first])
        met = np.unique(model.part_of[rows.gradient[[here[first]]].indices // model.shape[1]]).tolist()
    parts = [model.parts[k] for k in met]
    waves = [bodies[p.name].wave_speed for p in parts]
    durations = [contact_duration(p.mesh.points, direction, c) for p, c in zip(parts, waves, strict=True)]
    return ContactScales(
        nodes=len(np.unique(rows.node[rows.of_contact(number)])),
        gap=gap,
        approach=speed + 0.0,
        duration=soft_duration(durations, [p.materials.impedance(p.internal.section) for p in parts]),
    )


def _nearest(model: Model, number: int) -> tuple[Array, float, float, Sequence[int]]:
    """Direction (d,), distance and closing speed between the nearest nodes of distant solids, and the numbers of both.

    A body that is in contact with itself only has an infinite distance.
    """
    numbers = {p.name: k for k, p in enumerate(model.parts)}
    surfaces = [
        (numbers[name], model.parts[numbers[name]].mesh.nodes(tag) + model.parts[numbers[name]].nodes.start)
        for name, tag in model.scene.contacts[number].surfaces
    ]
    x, best = model.points + model.displacement, None
    for (k, one), (l, other) in combinations(surfaces, 2):
        distance, found = cKDTree(x[other]).query(x[one])
        least = int(np.argmin(distance))
        if k != l and (best is None or distance[least] < best[0]):
            middles = x[one].mean(axis=0) - x[other].mean(axis=0)
            best = float(distance[least]), one[least], other[found[least]], middles, (k, l)
    if best is None:
        return np.eye(model.shape[1])[0], float("inf"), 0.0, model.contact_solids[number]
    distance, a, b, middles, met = best
    away = x[a] - x[b] if distance > 0.0 else middles
    direction = away / max(float(np.linalg.norm(away)), 1e-300)
    return direction, distance, -float((model.velocity[a] - model.velocity[b]) @ direction), met
