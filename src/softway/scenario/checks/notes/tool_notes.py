"""Notes on tools and bodies from files: flat facets of curved tools, and files read with another unit of length."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import RigidShape
from softway.bodies.solid import Solid, Tool
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.sagitta import NodalCurvature, nodal_curvature
from softway.errors import Note
from softway.meshes.generators.recipes import UNITS, Divided, MeshFile
from softway.meshes.mesh import Mesh
from softway.obstacles.primitives import Cavity
from softway.obstacles.triangulated import Facets, Surface

LONGER = 300.0
"""Extent of a file relative to the bodies, or the other way round, from which it may have been read in another unit."""
HUGE = 20.0
"""Extent of a body from a file in metres [m] from which the file may be in millimetres."""
SEGMENT = {2: "bar2", 3: "tri3"}
"""Facets of a tool by the dimension of space."""


def tool_curvature(tool: Tool | RigidShape) -> NodalCurvature | None:
    """Curvature of a tool of flat facets at its place at the start; None for another tool."""
    hollow = isinstance(tool.shape, Cavity)
    shape = tool.shape.of if isinstance(tool.shape, Cavity) else tool.shape
    facets = shape.facets if isinstance(shape, Surface) else shape
    if not isinstance(facets, Facets) or facets.smooth:
        return None
    cells = facets.cells[:, ::-1] if hollow else facets.cells
    side = ContactSurface(facets={SEGMENT[facets.dim]: cells})
    return nodal_curvature(side, tool.motion.at(0.0).place(facets.points))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Read:
    """File of a body or tool: its key in the scenario, the setting of millimetres, its extent and its unit [m]."""

    where: str
    key: str
    extent: float
    unit: float


def unit_notes(given: Mapping[str, Solid | Tool], solids: Mapping[str, Solid]) -> tuple[Note, ...]:
    """Notes on files whose extent is far from that of the solids; ``given`` are the bodies as in the scenario."""
    notes = []
    sizes = {name: _extent(s.mesh.points) for name, s in solids.items() if isinstance(s.mesh, Mesh)}
    for name, body in given.items():
        found = _read(body, sizes.get(name, 0.0))
        others = [size for other, size in sizes.items() if other != name]
        doubt = "" if found is None else _doubt(found, others)
        if found is None or not doubt:
            continue
        remedy = "the unit in which the file was written"
        if found.unit == 1.0 and found.extent > max(others, default=0.0):
            remedy = f"{found.key}, if the file is in millimetres"
        problem = f"its file extends over {found.extent:.4g} m, read in units of {found.unit:g} m, {doubt}"
        notes.append(Note(where=f"bodies.{name}.{found.where}", problem=problem, remedy=remedy))
    return tuple(notes)


def _doubt(found: _Read, others: Sequence[float]) -> str:
    """Reason to doubt the unit of a file; empty without one. ``others`` are the extents of the other solids [m]."""
    if others and (found.extent >= LONGER * max(others) or LONGER * found.extent <= min(others)):
        sizes = " to ".join(dict.fromkeys(f"{size:.3g}" for size in (min(others), max(others))))
        return f"but the {'other ' if found.where == 'mesh' else ''}solids over {sizes} m"
    if found.where == "mesh" and found.unit == 1.0 and found.extent >= HUGE:
        return "as a part does that is drawn in millimetres"
    return ""


def _read(body: Solid | Tool, extent: float) -> _Read | None:
    """File of a body of the given extent, or of a tool; None for what comes from no file."""
    if isinstance(body, Solid):
        where, mesh = ("mesh.mesh", body.mesh.mesh) if isinstance(body.mesh, Divided) else ("mesh", body.mesh)
        if not isinstance(mesh, MeshFile):
            return None
        return _Read(where=where, key='unit = "mm"', extent=extent, unit=UNITS[mesh.unit])
    shape = body.shape.of if isinstance(body.shape, Cavity) else body.shape
    if not isinstance(shape, Surface):
        return None
    return _Read(where="shape", key='scale = "1 mm"', extent=_extent(shape.facets.points), unit=shape.scale)


def _extent(points: Array) -> float:
    """Greatest extent of points (n, d) along an axis [m]."""
    return float(np.ptp(points, axis=0).max())
