"""New mesh of the present shape of a solid: by rezoning, or with other cells."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from softway.adaptivity.new_cells.filling import filled
from softway.adaptivity.new_cells.mmg import mmg_tetrahedra, mmg_triangles
from softway.adaptivity.new_cells.plane_mesh import NewMesh, moved_mesh, plane_mesh
from softway.adaptivity.new_cells.space_mesh import improved_tetrahedra, space_mesh
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.rezone import rezoned
from softway.adaptivity.rezoning.volume import volume_of, with_volume
from softway.adaptivity.unrelated.fields import simplices
from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.solid import Solid
from softway.marching.remeshing.forming.fitting import fitted_places
from softway.marching.remeshing.forming.formable import makes_cells
from softway.marching.remeshing.forming.formed_scene import FormedScene, Replacement
from softway.marching.state.march_state import MarchState
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remesh import Quality, Remesh
from softway.meshes.walls.wall_edges import wall_edges
from softway.model.model import Model

DIVISIONS = 3
"""Greatest number of divisions of walls one cell thick."""


def replacement(on: FormedScene, how: Remesh, now: MarchState, name: str) -> Replacement | None:
    """New mesh of a solid; None if none that fits into its shape is better.

    With ``auto`` a rezoned mesh if it is within the limits, otherwise new cells, and without those the rezoned mesh.
    """
    makes = makes_cells(how, on.part(name).mesh, _solid(on, name))
    same = None if makes and how.by == "new cells" else _rezoned(on, how, now, name)
    if not makes or (same is not None and how.within(_quality(same.mesh))):
        return same
    return _with_new_cells(on, how, now, name) or same


def _quality(mesh: Mesh) -> Quality:
    """Quality of the worst cells of a mesh at rest."""
    return cell_quality(mesh.blocks, mesh.points).worst


def _walled(model: Model, name: str, mesh: Mesh) -> bool:
    """Whether a model would divide cells of a mesh, since edges cross a wall one cell thick: the mesh has the nodes and
    tags of that of the solid in ``model``.
    """
    nodes = next(p for p in model.parts if p.name == name).nodes
    touchable = model.touchable[(model.touchable >= nodes.start) & (model.touchable < nodes.stop)] - nodes.start
    return model.inert and model.timing.massless and len(wall_edges(mesh, touchable)) > 0


def _rezoned(on: FormedScene, how: Remesh, now: MarchState, name: str) -> Replacement | None:
    """The same cells with their nodes in other places; None if they are not better."""
    closed, kept = on.touching(now, name)
    part, mesh = on.part(name), on.meshes[name]
    tags = tuple(support.on for support in _solid(on, name).supports)

    def put(places: Array, touching: BoolArray) -> tuple[Array, BoolArray]:
        u, time = now.state.start.displacement, now.state.time
        return fitted_places(on.model, u, time, name, touching & ~kept, kept, places)

    found = rezoned(part, mesh.ideal, on.places(now, name), closed, kept, put, tags)
    moved = None if found is None else moved_mesh(part.mesh, found)
    if moved is None or _walled(on.model, name, moved) or not how.improves(_quality(moved), on.quality(now, name)):
        return None
    return Replacement(mesh=moved, sizes=mesh.sizes)


def _with_new_cells(on: FormedScene, how: Remesh, now: MarchState, name: str) -> Replacement | None:
    """Other cells, with the boundary on the tools, and the volume as it was.

    Walls one cell thick get a node inside; the boundary on the tools may have others.
    """
    closed, kept = on.touching(now, name)
    present = on.quality(now, name)
    new = _made(on, how, now, name, closed, kept)
    for _ in range(DIVISIONS):
        if new is None:
            return None
        trial = on.trial(name, Replacement(mesh=new.mesh, sizes=new.sizes))
        new = new.divided(next(p for p in trial.parts if p.name == name).mesh)
        mesh = _on_boundary(on, trial, now, name, new)
        if mesh is None or not how.improves(_quality(mesh), present):
            return None
        if not _walled(trial, name, mesh):
            return Replacement(mesh=mesh, sizes=new.sizes)
        new = replace(new, mesh=mesh)
    return None


def _on_boundary(on: FormedScene, trial: Model, now: MarchState, name: str, new: NewMesh) -> Mesh | None:
    """The mesh of a model with its boundary on the tools, and the volume that the solid has; None if a cell folds."""
    part, others = next(p for p in trial.parts if p.name == name), now.state.start.displacement
    u = trial.join({**on.model.split(others), name: np.zeros_like(new.mesh.points)})
    points, pushed = fitted_places(trial, u, now.state.time, name, new.touching, new.kept, new.mesh.points)
    surface = np.isin(np.arange(new.mesh.n_nodes), new.mesh.nodes("surface"))
    free = part.dofs.free & (surface & ~new.touching & ~new.kept & ~pushed)[:, None]
    section = part.internal.section
    wanted = volume_of(on.part(name).mesh.blocks, section, on.places(now, name))
    return new.with_boundary(with_volume(new.mesh.blocks, new.mesh.boundary(), section, points, wanted, free))


def space_of(blocks: Mapping[str, IntArray], places: Array) -> float:
    """Area [m^2] or volume [m^3] of cells with straight edges, without the factor of a section.

    Examples
    --------
    >>> space_of({"tri3": np.array([[0, 1, 2]])}, np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]))
    2.0
    """
    x = places[simplices(blocks)]
    return float(np.abs(np.linalg.det(x[:, 1:] - x[:, :1])).sum() / math.factorial(x.shape[2]))


def _made(
    on: FormedScene, how: Remesh, now: MarchState, name: str, closed: BoolArray, kept: BoolArray
) -> NewMesh | None:
    """Mesh of about as many new cells as before, before its boundary is put on tools."""
    mesh, places, stored = on.part(name).mesh, on.places(now, name), on.meshes[name]
    spread = space_of(mesh.blocks, places) / space_of(stored.ideal.blocks, stored.ideal.points)
    sizes = stored.sizes * spread ** (1.0 / mesh.dim)
    mmg = how.generator == "mmg"
    if mesh.dim == 2:
        return plane_mesh(mesh, places, sizes, closed, kept, mmg_triangles if mmg else filled)
    return space_mesh(mesh, places, sizes, closed, kept, mmg_tetrahedra if mmg else improved_tetrahedra)


def _solid(on: FormedScene, name: str) -> Solid:
    """A solid of the scene."""
    solid = on.scene.bodies[name]
    assert isinstance(solid, Solid)
    return solid
