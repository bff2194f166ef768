"""Scene whose solids get new meshes of their present shape."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.adaptivity.new_cells.sizes import edge_lengths
from softway.adaptivity.rezoning.quality import cell_quality
from softway.adaptivity.rezoning.rim import crossing, rims
from softway.adaptivity.unrelated.fields import interpolation
from softway.arrays import Array, BoolArray
from softway.bodies.discretised import DiscreteSolid, discretise
from softway.bodies.elements.section import Axisymmetric
from softway.bodies.internal_force.regions import RegionForces
from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Solid
from softway.errors import InputError, within
from softway.heat.coupled.build import build
from softway.laws.heat.heat_content import ZERO
from softway.marching.remeshing.carried_heat import temperature_of
from softway.marching.remeshing.forming.formable import replacements
from softway.marching.state.march_state import MarchState
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remesh import Quality, worse
from softway.meshes.remeshed.remeshed_mesh import Densities, RemeshedMesh, remeshed_mesh
from softway.model.model import Model
from softway.model.scene import Scene

ON_AXIS = 1e-12
"""Radius, relative to the size of the solid, within which a node is on the axis."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Replacement:
    """Mesh of the present shape of a solid.

    Parameters
    ----------
    mesh
        The mesh.
    sizes
        (n,) lengths of the edges asked for at its nodes, when its cells were made [m].
    """

    mesh: Mesh
    sizes: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FormedScene:
    """Scene with the present meshes of its solids: a model with the mesh of each solid that gets new ones.

    Parameters
    ----------
    model
        Model on these meshes.
    new
        Quality of the cells of each of them when they were new.
    """

    model: Model
    new: Mapping[str, Quality]

    @property
    def scene(self) -> Scene:
        """The scene, with the present meshes."""
        return self.model.scene

    @property
    def meshes(self) -> Mapping[str, RemeshedMesh]:
        """Mesh of each solid that gets new ones."""
        return self.model.remeshed

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

    def quality(self, now: MarchState, name: str) -> Quality:
        """Present quality of the worst cells of a solid."""
        return cell_quality(self.part(name).mesh.blocks, self.places(now, name)).worst

    def crossing(self, now: MarchState, name: str) -> Array | None:
        """Place (2,) where the boundary of a solid in the plane crosses itself; None where it does not."""
        mesh, places = self.part(name).mesh, self.places(now, name)
        return crossing([places[rim] for rim in rims(mesh)]) if mesh.dim == 2 else None

    def asks(self, now: MarchState) -> dict[str, str]:
        """Solids that ask for another mesh, and the measure by which they do.

        Where none was found, a solid asks again when its cells are a fifth worse than they were then.
        """
        stored, history, found = now.remeshed, now.step_history, {}
        since = now.slabs - (0 if stored is None else stored.changed)
        for name, how in replacements(self.scene).items():
            quality = self.quality(now, name)
            crawls = history.rejected > 0 and now.state.span < how.shortened * history.span
            short = crawls and worse(quality, self.new[name])
            reason = how.asks(quality, self.new[name]) or (f"slab of {now.state.span:.3g} s" if short else "")
            failed = None if stored is None else stored.failed.get(name)
            if reason and since >= how.every and (failed is None or worse(quality, failed)):
                found[name] = reason
        return found

    def on(self, meshes: Mapping[str, Replacement], now: MarchState) -> "FormedScene":
        """The scene with other meshes of the present shapes; densities keep the masses."""
        found = {name: self._followed(name, mesh, self.places(now, name)) for name, mesh in meshes.items()}
        return self._with({**self.meshes, **found}, found)

    def trial(self, name: str, new: Replacement) -> Model:
        """Model with another mesh of a solid."""
        mesh = self.meshes[name].followed(new.mesh, new.sizes)
        return self._with({**self.meshes, name: mesh}, {name: mesh}).model

    def at(self, meshes: Mapping[str, RemeshedMesh]) -> "FormedScene":
        """The scene on the meshes of a state.

        Raises
        ------
        InputError
            For meshes of another march.
        """
        if meshes.keys() != self.meshes.keys():
            problem = f"meshes of {', '.join(meshes)}"
            raise InputError("state.remeshed", problem, f"a state with those of {', '.join(self.meshes)}")
        for name, mesh in meshes.items():
            with within(f"state.remeshed.{name}"):
                mesh.require_of(self.meshes[name].first)
        return self._with(meshes, meshes)

    def _with(self, meshes: Mapping[str, RemeshedMesh], changed: Mapping[str, RemeshedMesh]) -> "FormedScene":
        """The scene on meshes, of which some have changed."""
        solids = {n: self._still(n, mesh.mesh, mesh.density) for n, mesh in changed.items() if mesh.replaced}
        model = _uncleared(build(replace(self.scene, bodies={**self.scene.bodies, **solids}), self.model), meshes)
        new = {**self.new, **{name: _quality(mesh.mesh) for name, mesh in changed.items()}}
        return FormedScene(model=replace(model, remeshed=meshes, declared=self.model.declared), new=new)

    def _still(self, name: str, mesh: Mesh, density: Densities) -> Solid:
        """A solid on another mesh, where it is: its motion and its temperature are in the state.

        The stress of its law counts the free strain from one temperature: it takes what the mesh of the start has in
        the mean.
        """
        still = replace(_solid(self.scene, name), mesh=mesh, place=Placement(), group=(), density=density)
        if still.thermal is not None:
            found, reference = temperature_of(self.model), still.thermal.reference
            if found is not None and reference is None and still.thermal.expansion:
                heat = found[1].model
                reference = next(float(heat.initial[p.nodes].mean()) for p in heat.parts if p.name == name)
            still = replace(still, thermal=replace(still.thermal, temperature=ZERO, reference=reference))
        return replace(still, displacement=Uniform(), velocity=Uniform())

    def _followed(self, name: str, new: Replacement, places: Array) -> RemeshedMesh:
        """The mesh that replaces that of a solid with nodes at ``places`` (n, d)."""
        part, before, mesh = self.part(name), self.meshes[name], new.mesh
        still = discretise(name, self._still(name, mesh, before.density), 0)
        back = interpolation(part.mesh.blocks, places, mesh.points)
        matter = interpolation(mesh.blocks, mesh.points, before.matter @ places)
        found, density = before.followed(mesh, new.sizes), _kept_masses(before.density, part, still)
        return replace(found, density=density, origin=np.asarray(back @ before.origin), matter=matter)

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


def formed_scene(model: Model) -> FormedScene:
    """Scene of a model, on its present meshes, or else on those of the start."""
    if model.remeshed:
        meshes = model.remeshed
    else:
        meshes = {}
        for name in replacements(model.scene):
            first = model.meshes[name]
            meshes[name] = remeshed_mesh(first, _density(model.scene, name), edge_lengths(first))
        bodies = dict(model.scene.bodies)
        for name, mesh in meshes.items():
            bodies[name] = replace(_solid(model.scene, name), mesh=mesh.mesh, place=Placement(), group=())
        model = replace(model, scene=replace(model.scene, bodies=bodies), remeshed=meshes)
    return FormedScene(model=model, new={name: _quality(mesh.mesh) for name, mesh in meshes.items()})


def _uncleared(model: Model, meshes: Mapping[str, RemeshedMesh]) -> Model:
    """The model without offsets of gaps at solids whose meshes have been replaced: those are of the shape at the start.

    ``build`` finds them from the references of the solids, which no longer belong to the same time.
    """
    found = model.contacts.clearance
    if found is None:
        return model
    new = {name for name, one in meshes.items() if one.replaced}
    old = [not any(model.parts[k].name in new for k in solids) for solids in model.contact_solids]
    kept = np.where(np.array(old)[model.contacts.contact], found, 0.0)
    return replace(model, contacts=replace(model.contacts, clearance=kept if kept.any() else None))


def _quality(mesh: Mesh) -> Quality:
    """Quality of the worst cells of a mesh at rest."""
    return cell_quality(mesh.blocks, mesh.points).worst


def _solid(scene: Scene, name: str) -> Solid:
    """A solid of a scene."""
    solid = scene.bodies[name]
    assert isinstance(solid, Solid)
    return solid


def _density(scene: Scene, name: str) -> Densities:
    """Density of a solid, one for each region where it has several materials [kg/m^3]."""
    solid = _solid(scene, name)
    if isinstance(solid.material, Mapping) and not isinstance(solid.density, Mapping):
        return dict.fromkeys(solid.material, float(solid.density))
    return solid.density


def _kept_masses(density: Densities, before: DiscreteSolid, after: DiscreteSolid) -> Densities:
    """Densities with which each material of a solid has its mass on another mesh [kg/m^3]."""
    if not isinstance(density, Mapping):
        volumes = [float(p.internal.sampling.volume.sum()) for p in (before, after)]
        return density * volumes[0] / volumes[1]
    assert isinstance(before.internal, RegionForces) and isinstance(after.internal, RegionForces)
    old, new = before.internal.volumes, after.internal.volumes
    return {name: one * old[name] / new[name] if name in old else one for name, one in density.items()}
