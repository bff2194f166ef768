"""Model: a scene turned into arrays, once, before the march."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import scipy.sparse as sp

from softway.bodies.fields import sample
from softway.bodies.force import SlabForce
from softway.bodies.internal import InternalForce, internal_force
from softway.bodies.loads import Gravity, Traction, traction_force
from softway.bodies.mass import nodal_mass, redistributed
from softway.bodies.section import default_section
from softway.bodies.solid import Fixed, Solid, Tool
from softway.contact.candidates import Candidates
from softway.contact.timing import Energy, Timing
from softway.errors import InputError
from softway.scene import Scene
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray, IntArray

T = TypeVar("T")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Part:
    """One solid as arrays; ``rows`` are its nodes among those of the model."""

    name: str
    mesh: Mesh
    rows: slice
    internal: InternalForce
    average: SlabForce


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Model:
    """All that stays the same during a march; nodal fields are (n, d) over all solids in order.

    Parameters
    ----------
    parts
        The solids.
    mass
        (n, n) nodal mass matrix; candidate nodes of the Energy rule have empty rows.
    massive
        (n,) nodes with inertia.
    free
        (n, d) components without support.
    load
        (n, d) dead loads [N].
    displacement, velocity
        (n, d) initial fields as described.
    candidates
        Contact rows.
    timing
        The contact rule of the scene.
    """

    scene: Scene
    parts: tuple[Part, ...]
    mass: sp.csr_array
    massive: BoolArray
    free: BoolArray
    load: Array
    displacement: Array
    velocity: Array
    candidates: Candidates
    timing: Timing

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, d) of the nodal fields."""
        return self.free.shape[0], self.free.shape[1]

    @property
    def meshes(self) -> Mapping[str, Mesh]:
        """Mesh of each solid."""
        return {p.name: p.mesh for p in self.parts}

    @property
    def linear(self) -> bool:
        """Whether every solid's force is linear in the displacement."""
        return all(p.internal.linear for p in self.parts)

    def stress(self, name: str, u: Array) -> Array:
        """Mean Cauchy stress (cells, 3, 3) of the solid ``name`` at its displacement ``u`` [Pa]."""
        return next(p for p in self.parts if p.name == name).internal.stress(u)

    def split(self, field: Array) -> dict[str, Array]:
        """The field of each solid by name."""
        return {p.name: field[p.rows] for p in self.parts}

    def join(self, fields: Mapping[str, Array]) -> Array:
        """The field over all nodes from those of the solids."""
        return np.concatenate([fields[p.name] for p in self.parts])

    def totals(self, density: Array) -> Array:
        """Sum (parts,) of a nodal quantity (n, ...) over each solid."""
        return np.array([density[p.rows].sum() for p in self.parts])

    def energy_and_force(self, u: Array) -> tuple[Array, Array]:
        """Stored energy of each solid (parts,) [J] and internal force (n, d) [N]."""
        pairs = [p.internal.energy_and_force(u[p.rows]) for p in self.parts]
        return np.array([e for e, _ in pairs]), np.concatenate([f for _, f in pairs])

    def force(self, u: Array) -> Array:
        """Internal force (n, d) [N]."""
        return np.concatenate([p.internal.force(u[p.rows]) for p in self.parts])

    def tangent(self, u: Array) -> sp.csc_array:
        """Tangent stiffness (n d, n d) [N/m]."""
        blocks = [p.internal.tangent(u[p.rows]) for p in self.parts]
        return sp.csc_array(sp.block_diag(blocks, format="csc"))

    def kinetic(self, v: Array) -> Array:
        """Kinetic energy of each solid (parts,) [J]."""
        return 0.5 * self.totals(v * (self.mass @ v))


def build(scene: Scene) -> Model:
    """Meshes, tables, mass and contact rows of a scene.

    Raises
    ------
    InputError
        Naming the place in the scene: a tag that matches nothing, a body that does not exist, mixed dimensions.
    """
    solids = {n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}
    if not solids:
        raise InputError("bodies", "no Solid among them", "at least one body of kind Solid")
    timing = _timing(scene)
    parts, masses, fields, starts = [], [], [], {}
    first = 0
    for name, solid in solids.items():
        mesh = _at(f"bodies.{name}.mesh", lambda s=solid: s.place.applied(s.mesh if isinstance(s.mesh, Mesh) else s.mesh.build()))
        section = solid.section if solid.section is not None else default_section(mesh)
        if solid.density <= 0.0 or not np.isfinite(solid.density):
            raise InputError(f"bodies.{name}.density", f"{solid.density:g} kg/m^3 is not positive", "a positive density")
        internal = _at(f"bodies.{name}", lambda s=solid, m=mesh, c=section: internal_force(m, s.material, c))
        rows = slice(first, first + mesh.n_nodes)
        starts[name], first = first, rows.stop
        parts.append(Part(name=name, mesh=mesh, rows=rows, internal=internal, average=solid.force))
        nodes = _candidate_nodes(scene, name, mesh) if isinstance(timing, Energy) else np.zeros(0, int)
        masses.append(
            redistributed(mesh, solid.density, section, solid.mass, nodes)
            if len(nodes)
            else nodal_mass(mesh, solid.density, section, solid.mass)
        )
        fields.append((
            _at(f"bodies.{name}.displacement", lambda s=solid, m=mesh: sample(s.displacement, m)),
            _at(f"bodies.{name}.velocity", lambda s=solid, m=mesh: sample(s.velocity, m)),
            _support(name, solid.supports, mesh),
        ))
    if len({p.mesh.dim for p in parts}) > 1:
        raise InputError("bodies", "solids of different space dimension in one scene", "meshes of one dimension")
    mass = sp.csr_array(sp.block_diag(masses, format="csr"))
    candidates = _candidates(scene, parts, starts)
    massive = np.asarray(mass.diagonal()) > 0.0
    free = np.concatenate([f[2] for f in fields])
    load = _load(scene, parts, mass, free.shape[1])
    return Model(
        scene=scene, parts=tuple(parts), mass=mass, massive=massive, free=free, load=load,
        displacement=np.concatenate([f[0] for f in fields]) * free,
        velocity=np.concatenate([f[1] for f in fields]) * free,
        candidates=candidates, timing=timing,
    )  # fmt: skip


def _at(path: str, make: Callable[[], T]) -> T:
    """Run ``make``, putting ``path`` before the place of an InputError."""
    try:
        return make()
    except InputError as error:
        raise error.within(path) from None


def _timing(scene: Scene) -> Timing:
    rules = {c.timing for c in scene.contacts}
    if len(rules) > 1:
        raise InputError("contacts", f"{len(rules)} different timing rules in one scene", "the same timing for all")
    return rules.pop() if rules else Energy()


def _candidate_nodes(scene: Scene, name: str, mesh: Mesh) -> IntArray:
    found = [
        _at(f"contacts[{k}].between", lambda c=c: mesh.nodes(c.tag))
        for k, c in enumerate(scene.contacts)
        if c.body == name
    ]
    return np.unique(np.concatenate(found)) if found else np.zeros(0, int)


def _support(name: str, supports: tuple[Fixed, ...], mesh: Mesh) -> BoolArray:
    free = np.ones((mesh.n_nodes, mesh.dim), bool)
    axes = "xyz"[: mesh.dim]
    for k, fixed in enumerate(supports):
        path = f"bodies.{name}.supports[{k}]"
        letters = axes if fixed.components == "all" else fixed.components
        if not letters or set(letters) - set(axes):
            raise InputError(f"{path}.components", f"'{fixed.components}' in {mesh.dim}D", f"letters of '{axes}' or 'all'")
        nodes = _at(f"{path}.on", lambda f=fixed: mesh.nodes(f.on))
        for letter in letters:
            free[nodes, axes.index(letter)] = False
    return free


def _load(scene: Scene, parts: list[Part], mass: sp.csr_array, dim: int) -> Array:
    load = np.zeros((mass.shape[0], dim))
    for k, item in enumerate(scene.loads):
        path = f"loads[{k}]"
        match item:
            case Gravity():
                g = np.atleast_1d(np.asarray(item.acceleration, float))
                if g.shape != (dim,):
                    raise InputError(f"{path}.acceleration", f"{g.size} components in {dim}D", f"{dim} components")
                load += np.asarray(mass.sum(axis=1)).reshape(-1, 1) * g
            case Traction():
                body, _, tag = item.on.partition(".")
                part = next((p for p in parts if p.name == body), None)
                if part is None:
                    raise InputError(f"{path}.on", f"no solid '{body}'", f"one of {[p.name for p in parts]}")
                load[part.rows] += _at(path, lambda p=part, t=tag, i=item: traction_force(p.mesh, p.internal.section, t, i.value))
    return load


def _candidates(scene: Scene, parts: list[Part], starts: Mapping[str, int]) -> Candidates:
    dim = parts[0].mesh.dim
    node, number, normal, offset = [np.zeros(0, int)], [np.zeros(0, int)], [np.zeros((0, dim))], [np.zeros(0)]
    for k, contact in enumerate(scene.contacts):
        path = f"contacts[{k}].between"
        part = next((p for p in parts if p.name == contact.body), None)
        tool = scene.bodies.get(contact.between[1])
        if part is None:
            raise InputError(path, f"no solid '{contact.body}'", f"one of {[p.name for p in parts]}")
        if not isinstance(tool, Tool):
            tools = [n for n, b in scene.bodies.items() if isinstance(b, Tool)]
            raise InputError(path, f"'{contact.between[1]}' is not a tool", f"one of {tools}")
        nodes = _at(path, lambda p=part, c=contact: p.mesh.nodes(c.tag))
        points = part.mesh.points[nodes]
        node.append(nodes + starts[part.name])
        number.append(np.full(len(nodes), k))
        offset.append(_at(f"bodies.{contact.between[1]}.shape", lambda t=tool, x=points: t.shape.gap(x)))
        normal.append(tool.shape.normal_at(points))
    return Candidates(
        node=np.concatenate(node), contact=np.concatenate(number), normal=np.concatenate(normal),
        offset=np.concatenate(offset), labels=tuple(c.label for c in scene.contacts),
    )  # fmt: skip
