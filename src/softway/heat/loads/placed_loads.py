"""Loads of heat on conductors: surfaces, sources, and nodes with prescribed temperatures."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.elements.following_heat import FollowingHeat
from softway.bodies.elements.section import Section
from softway.bodies.inertia.nodal_heat import heated_volumes
from softway.bodies.setup.heat_loads import HeatLoad, HeatSource, Temperature, place_of, surface_points
from softway.bodies.setup.held_temperatures import held_temperatures
from softway.errors import InputError, within
from softway.heat.heat_model import HeatPart, HeatSurface, Lump

Loads = tuple[tuple[HeatSurface, ...], tuple[tuple[HeatSource, Array], ...], tuple[tuple[Temperature, IntArray], ...]]


def placed_loads(
    loads: Mapping[int, HeatLoad],
    parts: Sequence[HeatPart],
    sections: Mapping[str, Section],
    lumps: tuple[Lump, ...],
    hanging: FollowingHeat | None,
) -> Loads:
    """Surfaces, sources, and nodes with prescribed temperatures, of which each belongs to one load.

    Nodes that hang follow those that do not, whatever is prescribed.

    Raises
    ------
    InputError
        With the load: on bodies or tags that are not there, on rigid bodies without the property that it needs.
    """
    known, n = {part.name: part for part in parts}, parts[-1].places.stop + len(lumps)
    rigid = {lump.name: (lump, n - len(lumps) + number) for number, lump in enumerate(lumps)}
    surfaces: list[HeatSurface] = []
    sources: list[tuple[HeatSource, Array]] = []
    held: dict[int, IntArray] = {}
    for k, load in loads.items():
        name, _ = place_of(load)
        with within(f"loads[{k}].{'of' if isinstance(load, HeatSource) else 'on'}"):
            if name not in known and name not in rigid:
                raise InputError("", f"there is no body {name!r}", ", ".join(repr(one) for one in known))
            on_rigid = name in rigid
            found = _on_rigid(load, *rigid[name], n) if on_rigid else _on_part(load, sections[name], known[name], n)
            match found:
                case HeatSurface():
                    surfaces.append(found)
                case tuple():
                    sources.append(found)
                case _:
                    held[k] = found
    if hanging is not None:
        surfaces = [replace(one, points=sp.csr_array(one.points @ hanging.follow)) for one in surfaces]
        sources = [(load, np.asarray(hanging.spread.T @ volume)) for load, volume in sources]
        held = {k: _unknowns(parts, len(lumps), nodes) for k, nodes in held.items()}
    return tuple(surfaces), tuple(sources), held_temperatures(loads, held)


def _unknowns(parts: Sequence[HeatPart], lumps: int, nodes: IntArray) -> IntArray:
    """Those of some ``nodes`` (k,), with hanging ones in their numbers, that do not hang, without."""
    own = [part.kept + part.places.start for part in parts]
    rigid = np.arange(parts[-1].places.stop, parts[-1].places.stop + lumps)
    return np.flatnonzero(np.isin(np.concatenate([*own, rigid]), nodes))


OnBody = HeatSurface | tuple[HeatSource, Array] | IntArray
"""Load on a body: its surface, its source with nodal volumes, or the nodes with its temperature."""


def _on_part(load: HeatLoad, section: Section, part: HeatPart, n: int) -> OnBody:
    """Load on a conductor."""
    tag = place_of(load)[1]
    match load:
        case Temperature():
            return part.places.start + part.mesh.nodes(tag)
        case HeatSource():
            return load, _source(part, section, tag, n)
        case _:
            table, areas = surface_points(part.mesh, section, tag)
            data = (table.data, table.indices + part.places.start, table.indptr)
            return HeatSurface(load=load, points=sp.csr_array(data, shape=(len(areas), n)), areas=areas)


def _on_rigid(load: HeatLoad, lump: Lump, node: int, n: int) -> OnBody:
    """Load on a rigid body, the node of this number."""
    if load.on != lump.name:
        raise InputError("", f"{load.on!r}: a rigid body has one temperature, and no tags", repr(lump.name))
    one = np.zeros(n)
    one[node] = 1.0
    match load:
        case Temperature():
            return np.array([node])
        case HeatSource():
            if lump.volume is None:
                problem = f"power per volume of {lump.name!r}, whose density is not given"
                raise InputError("", problem, f"bodies.{lump.name}.density, or a HeatFlux on its area")
            return load, lump.volume * one
        case _:
            if lump.area is None:
                problem = f"{type(load).__name__} on {lump.name!r}, whose surface has no area"
                raise InputError("", problem, f"bodies.{lump.name}.thermal.area, the surface that takes the heat")
            return HeatSurface(load=load, points=sp.csr_array(one[None]), areas=np.array([lump.area]))


def _source(part: HeatPart, section: Section, region: str, n: int) -> Array:
    """Volumes (n,) of the nodes in a region [m^3]."""
    inside, out = np.zeros(part.mesh.n_cells), np.zeros(n)
    inside[part.mesh.cells(region)] = 1.0
    out[part.places] = heated_volumes(part.mesh, section, inside)
    return out
