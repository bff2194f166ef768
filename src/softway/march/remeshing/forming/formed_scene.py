"""Scene whose solids get new meshes of their present shape."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from softway.adaptivity.new_cells.sizes import edge_lengths
from softway.adaptivity.rezoning.quality import CellQuality, cell_quality
from softway.adaptivity.unrelated.memory import require_recast
from softway.arrays import Array, BoolArray
from softway.bodies.discretised import DiscreteSolid, discretise
from softway.bodies.elements.section import Axisymmetric
from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.loads import Traction
from softway.bodies.setup.placement import Placement
from softway.bodies.setup.supports import Carried, Guided
from softway.bodies.solid import Solid
from softway.errors import InputError, within
from softway.heat.coupled.build import build
from softway.march.remeshing.forming.remesh import Remesh, require_cells
from softway.march.state.march_state import MarchState
from softway.meshes.mesh import Mesh
from softway.model.model import Model
from softway.model.scene import Scene

PASSES = 5
"""Greatest number of corrections of nodes on tools."""
ON_AXIS = 1e-12
"""Radius, relative to the size of the solid, within which a node is on the axis."""
ON_TOOL = 1e-14
"""Gap, relative to the size of the solid, at which a node is on its tool."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Replacement:
    """Mesh of the present shape of a solid.

    Parameters
    ----------
    mesh
        The mesh.
    base
        Mesh with the same cells when they were made.
    sizes
        (n,) lengths of the edges asked for at its nodes [m].
    """

    mesh: Mesh
    base: Mesh
    sizes: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FormedScene:
    """Scene with the present meshes of its solids.

    Parameters
    ----------
    scene, model
        The scene on these meshes, and its model.
    bases
        Mesh with the present cells when they were made, of each solid that gets new ones.
    sizes
        Lengths of the edges asked for at the nodes of each of them [m].
    new
        Quality of the cells of each of them when they were new.
    """

    scene: Scene
    model: Model
    bases: Mapping[str, Mesh]
    sizes: Mapping[str, Array]
    new: Mapping[str, CellQuality]

    def part(self, name: str) -> DiscreteSolid:
        """Tables of a solid."""
        return next(p for p in self.model.parts if p.name == name)

    def places(self, now: MarchState, name: str) -> Array:
        """Present places (n, d) of the nodes of a solid [m]."""
        part = self.part(name)
        found = np.asarray(part.mesh.points + now.state.start.displacement[part.nodes])
        if isinstance(part.internal.section, Axisymmetric):
            found[np.abs(found[:, 0]) < ON_AXIS * np.ptp(found), 0] = 0.0
        return found

    def asks(self, how: Remesh, now: MarchState, name: str) -> str:
        """The measure by which a solid asks for another mesh; empty if by none."""
        part = self.part(name)
        return how.asks(cell_quality(part.mesh.blocks, self.places(now, name)), self.new[name])

    def on(self, meshes: Mapping[str, Replacement]) -> "FormedScene":
        """The scene with other meshes of the present shapes; densities keep the masses."""
        bodies, new = dict(self.scene.bodies), dict(self.new)
        bases, sizes = dict(self.bases), dict(self.sizes)
        for name, other in meshes.items():
            solid, part, mesh = bodies[name], self.part(name), other.mesh
            bases[name], sizes[name] = other.base, other.sizes
            assert isinstance(solid, Solid)
            assert isinstance(solid.density, float | int)
            still = replace(solid, mesh=mesh, place=Placement(), group=(), displacement=Uniform(), velocity=Uniform())
            volumes = [float(p.internal.sampling.volume.sum()) for p in (part, discretise(name, still, 0))]
            bodies[name] = replace(still, density=solid.density * volumes[0] / volumes[1])
            new[name] = cell_quality(mesh.blocks, mesh.points)
        scene = replace(self.scene, bodies=bodies)
        model = build(scene)
        for part in model.parts:
            if part.name in meshes and part.mesh.n_nodes > bases[part.name].n_nodes:  # walls of one cell are divided
                near = cKDTree(meshes[part.name].mesh.points).query(part.mesh.points)[1]
                bases[part.name], sizes[part.name] = part.mesh, sizes[part.name][near]
        return FormedScene(scene=scene, model=model, bases=bases, sizes=sizes, new=new)

    def touching(self, now: MarchState, name: str) -> tuple[BoolArray, BoolArray]:
        """Nodes (n,) of a solid in closed contacts, and those of them in contact with other solids."""
        part, state = self.part(name), now.state
        rows = self.model.rows(state.start.displacement, state.time)
        closed = rows.gradient[state.closed]
        d, count = part.mesh.dim, np.diff(closed.indptr)
        nodes, own = closed.indices // d, np.repeat(np.arange(len(count)), count)
        several = np.array([len(np.unique(nodes[own == k])) > 1 for k in range(len(count))], dtype=bool)
        masks = []
        for chosen in (nodes, nodes[several[own]]):
            mask = np.zeros(len(self.model.points), dtype=bool)
            mask[chosen] = True
            masks.append(mask[part.nodes])
        return masks[0], masks[1]

    def on_tools(self, u: Array, time: float, name: str, closed: BoolArray, places: Array) -> Array:
        """Places (n, d) of the nodes of a solid, out of the tools, with those in contact on them; with displacements u
        of all solids.
        """
        part, u = self.part(name), np.array(u)
        mine, free = part.nodes, part.dofs.free
        for _ in range(PASSES):
            u[mine] = places - part.mesh.points
            rows = self.model.rows(u, time)
            gap = rows.gap(u)
            some = rows.near & (rows.node >= mine.start) & (rows.node < mine.stop)
            node = np.clip(rows.node - mine.start, 0, len(places) - 1)
            some &= closed[node] | (gap < 0.0)
            some &= np.abs(gap) > ON_TOOL * np.ptp(places)
            if not some.any():
                break
            places = np.array(places)
            places[node[some]] -= np.where(free[node[some]], gap[some, None] * rows.normal[some], 0.0)
        return places


def formed_scene(scene: Scene, remesh: Mapping[str, Remesh]) -> FormedScene:
    """Scene on its meshes at the start.

    Raises
    ------
    InputError
        For solids whose mesh cannot be replaced: elastic laws, several materials, plane stress, heat, tractions, and
        supports that measure from the undeformed shape.
    """
    bases, sizes, new = {}, {}, {}
    model = build(scene)
    for name in remesh:
        with within(f"remesh.{name}"):
            solid = scene.bodies.get(name)
            if not isinstance(solid, Solid):
                solids = ", ".join(n for n, b in scene.bodies.items() if isinstance(b, Solid))
                raise InputError("", "no solid of this name", f"one of: {solids}")
            part = next(p for p in model.parts if p.name == name)
            require_recast(part)
            _require_plain(scene, name, solid)
            require_cells(remesh[name], part.mesh, solid)
        bases[name], sizes[name] = part.mesh, edge_lengths(part.mesh)
        new[name] = cell_quality(part.mesh.blocks, part.mesh.points)
    return FormedScene(scene=scene, model=model, bases=bases, sizes=sizes, new=new)


def _require_plain(scene: Scene, name: str, solid: Solid) -> None:
    """Refuse what does not pass to a new mesh."""
    if solid.thermal is not None or solid.shock is not None:
        raise InputError("", "a solid with a temperature or bulk viscosity", "a solid without")
    if any(isinstance(s, Guided | Carried) for s in solid.supports):
        raise InputError("supports", "supports that measure from the shape at the start", "Fixed or Driven")
    if any(isinstance(load, Traction) and load.body == name for load in scene.loads):
        raise InputError("loads", f"a traction on {name!r}, per area of the shape at the start", "a tool that presses")
