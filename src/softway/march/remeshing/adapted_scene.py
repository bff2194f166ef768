"""Scene with adapted meshes: its model, and its state on other meshes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.even_surface import even
from softway.adaptivity.projection import projection
from softway.adaptivity.transfer import Motion, Transferred, transfer
from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import any_path_dependent
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.loads import Traction
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Solid
from softway.errors import InputError, within
from softway.heat.coupled.build import build
from softway.march.remeshing.wanted_mesh import wanted_mesh
from softway.march.state.march_state import AdaptedMeshes, MarchState
from softway.march.state.model_state import join_states, split_states
from softway.meshes.adaptive.adapt import Adapt, adaption
from softway.meshes.adaptive.leaves import Leaves, require_cover, same
from softway.meshes.adaptive.refinement import BISECTED, AdaptedMesh, refined
from softway.meshes.mesh import Mesh
from softway.model.model import Model
from softway.model.scene import Scene
from softway.solve.operators.operator_memory import OperatorMemory
from softway.solve.static_equilibrium import StaticState, equilibrium

WHAT = (
    f"elastic solids of one type of cell, {', '.join(BISECTED)}, without friction, heat, ties, bulk viscosity or "
    "rigid bodies, with contacts whose nodes have no inertia"
)
"""What may adapt."""


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
        bodies = dict(self.scene.bodies)
        for name, mesh in changed.items():
            solid = bodies[name]
            assert isinstance(solid, Solid)
            bodies[name] = replace(solid, mesh=mesh.mesh)
        model = build(replace(self.scene, bodies=bodies))
        meshes = {**self.meshes, **changed}
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
        """The scene on the meshes for the coming slabs, in fine cells what closes or is pushed within ``ahead`` [s]."""
        touching = np.concatenate([_touching(self.model, now, ahead), _pushed(self.model, now.state.time, ahead)])
        meshes = dict(self.meshes)
        for name, how in adaptions(self.scene).items():
            solid = self.solid(name)
            nodes = solid.part.nodes
            motion = _motion(self.model, now, name)
            places = self.model.points[touching[(touching >= nodes.start) & (touching < nodes.stop)]]
            stretch = now.step_history.longest / now.step_history.span
            tags = [tag for body, tag in chain(*(c.surfaces for c in self.scene.contacts)) if body == name]
            meshes[name] = even(wanted_mesh(how, solid, motion, energy, places, stretch), tags)
        return self.on(meshes)


def adaptions(scene: Scene) -> dict[str, Adapt]:
    """Adaptions of the solids whose meshes adapt, by name."""
    solids = {name: body for name, body in scene.bodies.items() if isinstance(body, Solid)}
    return {name: how for name, solid in solids.items() if (how := adaption(solid.adapt)) is not None}


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
    for name in adaptions(model.scene):
        solid = bodies[name]
        assert isinstance(solid, Solid)
        with within(f"bodies.{name}.adapt"):
            if not _bisected(bases[name]) or solid.thermal is not None or solid.shock is not None:
                raise InputError("", "a solid whose mesh cannot adapt in a march", WHAT)
    known = {name: base for name, base in bases.items() if _bisected(base)}
    for name, base in known.items():
        solid = bodies[name]
        assert isinstance(solid, Solid)
        bodies[name] = replace(solid, mesh=base, place=Placement(), group=())
    plain = not model.companions and model.rigid is None and all(_own_dofs(model)) and model.friction.frictionless
    light = model.timing.massless or not model.scene.contacts
    if not (plain and light) or any_path_dependent(model.parts):
        where = f"bodies.{next(iter(adaptions(model.scene)))}.adapt"
        raise InputError(where, "in a scene in which no mesh can adapt", WHAT)
    meshes = {name: refined(base, np.zeros(base.n_cells, dtype=np.int64)) for name, base in known.items()}
    return AdaptedScene(replace(model, scene=replace(model.scene, bodies=bodies), adapted=meshes))


def _bisected(mesh: Mesh) -> bool:
    """True for meshes that bisection refines."""
    return len(mesh.blocks) == 1 and next(iter(mesh.blocks)) in BISECTED


def _own_dofs(model: Model) -> list[bool]:
    """True for each solid whose unknowns are its own: no solid is in the group of another one."""
    return [int((model.linked == group).sum()) == 1 for group in model.linked]


def _motion(model: Model, now: MarchState, name: str) -> Motion:
    """Motion of a solid."""
    start = now.state.start
    nodes = next(p.nodes for p in model.parts if p.name == name)
    return Motion(displacement=start.displacement[nodes], velocity=start.velocity[nodes])


def _touching(model: Model, now: MarchState, ahead: float) -> IntArray:
    """Nodes (k,) of contact rows that are closed, or would close within ``ahead`` [s] at the present velocities, with
    those of the facets in them.
    """
    start, state = now.state.start, now.state
    coming = start.displacement + ahead * start.velocity
    here, later = model.rows(start.displacement, state.time), model.rows(coming, state.time + ahead)
    closing = later.near & (later.gap(coming) <= 0.0)
    chosen = ((here, state.closed), (later, closing), (here, closing))
    nodes = [rows.gradient[which].indices // model.shape[1] for rows, which in chosen]
    return np.unique(np.concatenate(nodes))


def _pushed(model: Model, time: float, ahead: float) -> IntArray:
    """Nodes (k,) of tractions that change within ``ahead`` [s]; of all of them at the start, where they are sudden."""
    parts, found = {part.name: part for part in model.parts}, [np.zeros(0, dtype=np.int64)]
    for load in model.scene.loads:
        if isinstance(load, Traction) and (time <= 0.0 or _changes(load.ramp, time, time + ahead)):
            part = parts[load.body]
            found.append(part.nodes.start + part.mesh.nodes(load.tag))
    return np.concatenate(found)


def _changes(ramp: Ramp, start: float, end: float) -> bool:
    """True if a factor of a load changes between two times."""
    inner = (time for time in ramp.times if start < time < end)
    return len({ramp.at(time) for time in (start, *inner, end)}) > 1


def carried_over(old: AdaptedScene, new: AdaptedScene, now: MarchState) -> tuple[MarchState, Mapping[str, Transferred]]:
    """State of a march on the new meshes, and the transfers of the solids with meshes of their own.

    Displacements are projected, massless nodes of all solids find their equilibrium with the contacts, and then the
    balances are closed.  What the transfers, and this equilibrium in other solids, have taken of the energy is in its
    account.
    """
    state, names = split_states(old.model, now.state), list(new.meshes)
    pairs = {name: (old.solid(name), new.solid(name)) for name in names}
    casts = {name: projection(*pair) for name, pair in pairs.items()}
    places = {n: cast.displacement(state.displacement[n]) for n, cast in casts.items()}
    rest = _settled(new.model, new.model.join({**state.displacement, **places}), now.state.time)
    places = new.model.split(rest.displacement)
    found = {n: transfer(*pairs[n], _motion(old.model, now, n), casts[n], places[n]) for n in names}
    labels, rows = new.model.contacts.labels, new.model.contacts
    pressure = {label: rest.pressure[rows.rows_of(k)] for k, label in enumerate(labels)}
    state = replace(
        state,
        displacement=places,
        velocity={**state.velocity, **{n: one.motion.velocity for n, one in found.items()}},
        acceleration={**state.acceleration, **{n: casts[n].velocity(state.acceleration[n]) for n in names}},
        pressure=pressure,
        closed={label: value > 0.0 for label, value in pressure.items()},
    )
    joined = join_states(new.model, state, now.step_history.span)
    fixed = np.array([part.name not in new.meshes for part in new.model.parts])
    taken = sum(one.booked for one in found.values()) + float(
        (now.state.start.energy - joined.start.energy)[fixed].sum()
    )
    account = replace(now.account, remeshing=now.account.remeshing + taken)
    energy = 0.0 if now.adapted is None else now.adapted.energy
    adapted = AdaptedMeshes(leaves=new.leaves, energy=energy)
    return replace(
        now, state=joined, account=account, memory=OperatorMemory(room=now.memory.room), adapted=adapted
    ), found


def _settled(model: Model, u: Array, time: float) -> StaticState:
    """Massless nodes in equilibrium with the contacts, the others at the displacement u (n, d)."""
    return equilibrium(model, u, model.dofs.only(~model.massive), model.loads.at(time), time)
