"""Scene with adapted meshes: its model, and its state on other meshes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import chain
from math import ceil

import numpy as np

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.marking.even_surface import even
from softway.adaptivity.transfer import Motion
from softway.bodies.setup.placement import Placement, with_surface
from softway.bodies.solid import Solid
from softway.contact.assembly.tie import Tie
from softway.errors import InputError, within
from softway.heat.coupled.build import build
from softway.marching.remeshing.admitted import adaptions, can_be_cut, require_admitted
from softway.marching.remeshing.carried_bonds import tearing
from softway.marching.remeshing.touching import bulging, closing, least_gaps, pushed, touched
from softway.marching.remeshing.wanted_mesh import Seen, Wanted, affordable, shallower, unhurried, wanted_cells
from softway.marching.remeshing.warming import warmed, warmth
from softway.marching.state.march_state import MarchState
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.leaves import Leaves, require_cover, same
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.model.model import Model
from softway.model.scene import Scene


@dataclass(frozen=True, slots=True, eq=False)
class AdaptedScene:
    """Scene on adapted meshes: a model with the adapted mesh of each solid of cells that can be bisected."""

    model: Model

    @property
    def scene(self) -> Scene:
        """The scene, with the present meshes."""
        return self.model.scene

    @property
    def meshes(self) -> Mapping[str, AdaptedMesh]:
        """Mesh of each solid of cells that can be bisected."""
        return self.model.adapted

    @property
    def leaves(self) -> Mapping[str, Leaves]:
        """Leaves of these meshes."""
        return {name: mesh.leaves for name, mesh in self.meshes.items()}

    def solid(self, name: str) -> AdaptedSolid:
        """A solid with a mesh in ``meshes``, with its inertia in the model."""
        part = next(p for p in self.model.parts if p.name == name)
        solid = self.scene.bodies[name]
        assert isinstance(solid, Solid)
        mass, follow = (matrix[part.nodes][:, part.nodes] for matrix in (self.model.mass, self.model.follow))
        return AdaptedSolid(solid=solid, adapted=self.meshes[name], part=part, mass=mass, follow=follow)

    def on(self, meshes: Mapping[str, AdaptedMesh]) -> "AdaptedScene":
        """The scene on other meshes; itself if they are the same."""
        changed = {n: mesh for n, mesh in meshes.items() if not same(self.meshes[n].leaves, mesh.leaves)}
        if not changed:
            return self
        bodies, meshes = dict(self.scene.bodies), {**self.meshes, **changed}
        for name, mesh in meshes.items():
            solid = bodies[name]
            assert isinstance(solid, Solid)
            if solid.mesh is not mesh.mesh:  # other cells, or nodes that ties have moved
                bodies[name] = replace(solid, mesh=mesh.mesh)
        model = build(replace(self.scene, bodies=bodies), self.model)
        return AdaptedScene(replace(model, adapted=meshes, declared=self.model.declared))

    def at(self, leaves: Mapping[str, Leaves]) -> "AdaptedScene":
        """The scene on the meshes of these leaves."""
        if leaves.keys() != self.meshes.keys():
            problem = f"adapted meshes of {', '.join(leaves)}"
            raise InputError("state.adapted", problem, f"a state with those of {', '.join(self.meshes)}")
        for name, one in leaves.items():
            with within(f"state.adapted.{name}"):
                require_cover(one, self.meshes[name].base.n_cells)
        return self.on({name: refined(self.meshes[name].base, one.level, one) for name, one in leaves.items()})

    def wanted(self, now: MarchState, energy: float, ahead: float) -> "AdaptedScene":
        """The scene on the meshes for the coming slabs, in fine cells what closes or is pushed within ``ahead`` [s].

        Solids with ``auto`` halve edges less often where contacts close so fast that their cells would make slabs
        short, and while their meshes would have too many cells.
        """
        most = {name: how.most(self.meshes[name].base) for name, how in adaptions(self.scene).items()}
        hows = self._hows(now)
        stretch = now.step_history.longest / now.step_history.span
        while True:
            wanted = self._wanted(now, energy, ahead, hows)
            many = [name for name, one in wanted.items() if len(one.tree.leaves.level) > most[name]]
            if not many:
                meshes = self._buffered(wanted, stretch)
                many = [name for name, mesh in meshes.items() if mesh.mesh.n_cells > most[name]]
                if not many:
                    return self.on({**self.meshes, **meshes})
            hows |= {name: shallower(hows[name], self.meshes[name].base) for name in many}

    def halved(self) -> "AdaptedScene":
        """The scene with all edges halved in the solids that may have so fine and so many cells."""
        meshes = {}
        for name, how in adaptions(self.scene).items():
            mesh = self.meshes[name]
            base, leaves = mesh.base, mesh.leaves
            finer = leaves.level + base.cell_dim
            if finer.max() <= how.deepest(base.cell_dim) and len(finer) * 2**base.cell_dim <= how.most(base):
                meshes[name] = refined(base, finer, leaves)
        return self.on({**self.meshes, **meshes})

    def coarsest(self) -> "AdaptedScene":
        """The scene on the base meshes of the solids that adapt."""
        bases = {name: self.meshes[name].base for name in adaptions(self.scene)}
        coarse = {name: refined(base, np.zeros(base.n_cells, dtype=np.int64)) for name, base in bases.items()}
        return self.on({**self.meshes, **coarse})

    def _hows(self, now: MarchState) -> dict[str, Adapt]:
        """Adaptions of the solids, with which their coming meshes may have few enough and large enough cells."""
        hows, ways = {}, closing(self.model, now)
        for name, how in adaptions(self.scene).items():
            mesh = self.meshes[name]
            hows[name] = affordable(how, mesh)
            if how.levels == "auto":
                hows[name] = unhurried(hows[name], mesh, float(ways[self.solid(name).part.nodes].max(initial=0.0)))
        return hows

    def _wanted(self, now: MarchState, energy: float, ahead: float, hows: Mapping[str, Adapt]) -> dict[str, Wanted]:
        """Cells of each solid that adapts, for the coming slabs."""
        model, time = self.model, now.state.time
        chosen = touched(model, now, ahead), pushed(model, time, ahead), tearing(model, now.state.start)
        touching = np.concatenate([*chosen, warmed(model, now, ahead)])
        wanted: dict[str, Wanted] = {}
        for name, how in hows.items():
            solid = self.solid(name)
            nodes = solid.part.nodes
            own = touching[(touching >= nodes.start) & (touching < nodes.stop)] - nodes.start
            mesh = self.meshes[name]
            marks = [(how.deepest(mesh.mesh.cell_dim), mesh.flat[own])]
            if mesh.base.rounding is not None:
                marks += bulging(mesh, least_gaps(model, now, ahead)[nodes])
            group = int(model.linked[[part.name for part in model.parts].index(name)])
            seen = Seen(motion=motion_of(model, now, name), warmth=warmth(model, now, name, energy), moves=model.inert)
            wanted[name] = wanted_cells(how, solid, seen, energy, marks, group)
        return wanted

    def _buffered(self, wanted: Mapping[str, Wanted], stretch: float) -> dict[str, AdaptedMesh]:
        """Meshes with buffers, of one size on surfaces that may touch."""
        meshes: dict[str, AdaptedMesh] = {}
        for name, one in wanted.items():
            others = [other for other in wanted.values() if other is not one and other.group == one.group]
            meshes[name] = even(one.mesh(others, stretch), self._smooth(name))
        return meshes

    def _smooth(self, name: str) -> list[str]:
        """Tags of the surfaces of a solid that may touch or are glued."""
        scene = self.scene
        ties = ((body, tag) for tie in scene.ties for body, tag in zip(tie.bodies, tie.tags, strict=True))
        return [tag for body, tag in chain(*(c.surfaces for c in scene.contacts), ties) if body == name]


def adapted_scene(model: Model) -> AdaptedScene:
    """Scene of a model, on its adapted meshes, or else on the base meshes of its solids.

    Raises
    ------
    InputError
        For bodies whose meshes cannot adapt.
    """
    if model.adapted:
        return AdaptedScene(model)
    bodies = dict(model.scene.bodies)
    bases = model.meshes
    require_admitted(model)
    asked, meshes, curved = adaptions(model.scene), {}, False
    for name, base in ((name, base) for name, base in bases.items() if can_be_cut(base)):
        solid = bodies[name]
        assert isinstance(solid, Solid)
        base = with_surface(base, solid.mesh, solid.adapt, solid.section) if name in asked else base
        meshes[name] = refined(base, np.zeros(base.n_cells, dtype=np.int64))
        curved |= base.rounding is not None
        own = base if base.rounding is None else meshes[name].mesh
        bodies[name] = replace(solid, mesh=own, place=Placement(), group=())
    scene = replace(model.scene, bodies=bodies, ties=_ties(model.scene, meshes))
    found = build(scene, model) if curved else replace(model, scene=scene)
    return AdaptedScene(replace(found, adapted=meshes, declared=model.declared))


def _ties(scene: Scene, meshes: Mapping[str, AdaptedMesh]) -> tuple[Tie, ...]:
    """Ties whose surfaces may be as far apart in finer cells as they are in those of the base meshes."""
    halvings = dict.fromkeys(scene.bodies, 0)
    for name, how in adaptions(scene).items():
        dimension = meshes[name].base.cell_dim
        halvings[name] = ceil(how.deepest(dimension) / dimension)
    return tuple(
        replace(tie, tolerance=tie.tolerance * 2.0 ** max(halvings[name] for name in tie.bodies)) for tie in scene.ties
    )


def motion_of(model: Model, now: MarchState, name: str) -> Motion:
    """Motion of a solid, with its material state."""
    start = now.state.start
    k = [p.name for p in model.parts].index(name)
    nodes, state = model.parts[k].nodes, start.states[k] if start.states else None
    return Motion(displacement=start.displacement[nodes], velocity=start.velocity[nodes], state=state)
