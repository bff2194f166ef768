"""New mesh of the present shape of a solid: by rezoning, or with other cells."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from softway.adaptivity.new_cells.filling import filled
from softway.adaptivity.new_cells.plane_mesh import NewMesh, plane_mesh
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.rezone import rezoned
from softway.adaptivity.rezoning.volume import volume_of, with_volume
from softway.arrays import Array, BoolArray
from softway.bodies.solid import Solid
from softway.march.remeshing.forming.formed_scene import FormedScene, Replacement
from softway.march.remeshing.forming.remesh import Remesh, makes_cells
from softway.march.state.march_state import MarchState


def replacement(on: FormedScene, how: Remesh, now: MarchState, name: str) -> Replacement | None:
    """New mesh of a solid; None if no cells fit into its shape.

    With ``auto`` a rezoned mesh if it is within the limits, otherwise new cells, and without those the rezoned mesh.
    """
    makes = makes_cells(how, on.part(name).mesh)
    same = None if makes and how.by == "new cells" else _rezoned(on, now, name)
    if same is not None and (not makes or how.within(cell_quality(same.mesh.blocks, same.mesh.points))):
        return same
    return (_with_new_cells(on, how, now, name) or same) if makes else None


def _rezoned(on: FormedScene, now: MarchState, name: str) -> Replacement | None:
    """The same cells with their nodes in other places."""
    closed, kept = on.touching(now, name)
    solid, mesh = on.scene.bodies[name], on.part(name).mesh
    assert isinstance(solid, Solid)
    tags = tuple(support.on for support in solid.supports)

    def on_tools(places: Array, touching: BoolArray) -> Array:
        return on.on_tools(now.state.start.displacement, now.state.time, name, touching & ~kept, places)

    found = rezoned(on.part(name), on.bases[name], on.places(now, name), closed, kept, on_tools, tags)
    if found is None:
        return None
    return Replacement(mesh=replace(mesh, points=found), base=on.bases[name], sizes=on.sizes[name])


def _with_new_cells(on: FormedScene, how: Remesh, now: MarchState, name: str) -> Replacement | None:
    """Other cells, with the boundary on the tools, and the volume as it was."""
    closed, kept = on.touching(now, name)
    old, places = on.part(name).mesh, on.places(now, name)
    new = _made(on, how, now, name, closed, kept)
    if new is None:
        return None
    trial = on.on({name: Replacement(mesh=new.mesh, base=new.mesh, sizes=new.sizes)})
    part, others = trial.part(name), on.model.split(now.state.start.displacement)
    new = new.divided(part.mesh)
    u = trial.model.join(_stays(others, name, np.zeros_like(new.mesh.points)))
    points = trial.on_tools(u, now.state.time, name, new.touching, new.mesh.points)
    surface = np.isin(np.arange(new.mesh.n_nodes), new.mesh.nodes("surface"))
    free = part.dofs.free & (surface & ~new.touching & ~new.kept)[:, None]
    section = part.internal.section
    wanted = volume_of(old.blocks, section, places)
    points = with_volume(new.mesh.blocks, new.mesh.boundary(), section, points, wanted, free)
    mesh = new.with_boundary(points)
    return None if mesh is None else Replacement(mesh=mesh, base=mesh, sizes=new.sizes)


def _stays(displacement: Mapping[str, Array], name: str, none: Array) -> dict[str, Array]:
    """Displacements with that of one solid replaced."""
    return {**displacement, name: none}


def _made(
    on: FormedScene, how: Remesh, now: MarchState, name: str, closed: BoolArray, kept: BoolArray
) -> NewMesh | None:
    """Mesh of new cells, before its boundary is put on tools."""
    return plane_mesh(on.part(name).mesh, on.places(now, name), on.sizes[name], closed, kept, filled)
