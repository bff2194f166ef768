"""Model: a scene turned into arrays, once, before the march."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.bodies.loads import Gravity, Load, Traction, traction_force
from softway.bodies.mass import following, nodal_mass, redistributed
from softway.bodies.part import Part, initial, part_of
from softway.bodies.section import wave_speed
from softway.bodies.solid import Solid, Tool
from softway.contact.candidates import Candidates
from softway.contact.pairs import Pairs, linear
from softway.contact.timing import Energy, Timing
from softway.errors import InputError, within
from softway.scene import Scene
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Model:
    """All that stays the same during a march; nodal fields are (n, d) over all solids in order.

    Parameters
    ----------
    parts
        The solids.
    mass
        (n, n) nodal mass matrix; candidate nodes of the Energy rule have empty rows.
    follow
        (n, n) velocities of all nodes from those with inertia: the others follow their neighbours.
    massive
        (n,) nodes with inertia.
    free
        (n, d) components without support.
    load
        (n, d) dead loads [N].
    displacement, velocity
        (n, d) initial fields as described.
    pairs
        Contact rows.
    floor
        (parts,) stored energy below which a body counts as undeformed: a strain of 1e-14 throughout [J].
    timing
        The contact rule of the scene.
    """

    scene: Scene
    parts: tuple[Part, ...]
    mass: sp.csr_array
    follow: sp.csr_array
    massive: BoolArray
    free: BoolArray
    load: Array
    displacement: Array
    velocity: Array
    pairs: Pairs
    floor: Array
    timing: Timing

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, d) of the nodal fields."""
        return self.free.shape[0], self.free.shape[1]

    @property
    def candidates(self) -> Candidates:
        """The contact rows in their linear form at the reference configuration."""
        return self.pairs.reference

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
    parts: list[Part] = []
    masses, follow, fields = [], [], []
    for name, solid in solids.items():
        with within(f"bodies.{name}"):
            part = part_of(name, solid, parts[-1].rows.stop if parts else 0)
        nodes = _candidate_nodes(scene, part) if isinstance(timing, Energy) else np.zeros(0, int)
        masses.append(_mass(part, solid, nodes))
        follow.append(following(part.mesh, nodes) if len(nodes) else sp.eye_array(part.mesh.n_nodes))
        parts.append(part)
        fields.append(initial(part, solid))
    if len({p.mesh.dim for p in parts}) > 1:
        raise InputError("bodies", "solids of different space dimension in one scene", "meshes of one dimension")
    pairs = _pairs(scene, parts)
    if not (pairs.flat or isinstance(timing, Energy)):
        raise InputError(
            "contacts[0].timing", f"{timing} with a curved obstacle", "Energy, or obstacles of kind HalfSpace"
        )
    mass = sp.csr_array(sp.block_diag(masses, format="csr"))
    free = np.concatenate([held for _, _, held in fields])
    return Model(
        scene=scene,
        parts=tuple(parts),
        mass=mass,
        follow=sp.csr_array(sp.block_diag(follow, format="csr")),
        massive=np.asarray(mass.diagonal()) > 0.0,
        free=free,
        load=_load(parts, mass, scene.loads, "loads"),
        displacement=np.concatenate([u for u, _, _ in fields]) * free,
        velocity=np.concatenate([v for _, v, _ in fields]) * free,
        pairs=pairs,
        floor=np.array([_floor(p) for p in parts]),
        timing=timing,
    )


def _timing(scene: Scene) -> Timing:
    rules = {c.timing for c in scene.contacts}
    if len(rules) > 1:
        raise InputError("contacts", f"{len(rules)} different timing rules in one scene", "the same timing for all")
    return rules.pop() if rules else Energy()


def _floor(part: Part) -> float:
    speed = wave_speed(part.internal.material, part.density, part.internal.section)
    return float(1e-28 * part.density * speed**2 * part.internal.volume.sum())


def _mass(part: Part, solid: Solid, candidates: IntArray) -> sp.csr_array:
    section = part.internal.section
    with within(f"bodies.{part.name}"):
        if len(candidates):
            return redistributed(part.mesh, solid.density, section, solid.mass, candidates)
        return nodal_mass(part.mesh, solid.density, section, solid.mass)


def _candidate_nodes(scene: Scene, part: Part) -> IntArray:
    found = [np.zeros(0, int)]
    for k, contact in enumerate(scene.contacts):
        if contact.body == part.name:
            with within(f"contacts[{k}].between"):
                found.append(part.mesh.nodes(contact.tag))
    return np.unique(np.concatenate(found))


def _load(parts: Sequence[Part], mass: sp.csr_array, loads: Sequence[Load], where: str) -> Array:
    """Dead nodal loads (n, d) [N]; gravity acts on the inertia, so that massless nodes have no weight."""
    dim = parts[0].mesh.dim
    out = np.zeros((mass.shape[0], dim))
    for k, item in enumerate(loads):
        with within(f"{where}[{k}]"):
            match item:
                case Gravity():
                    out += np.asarray(mass.sum(axis=1)).reshape(-1, 1) * item.vector(dim)
                case Traction():
                    part = _solid(parts, item.body, "on")
                    out[part.rows] += traction_force(part.mesh, part.internal.section, item.tag, item.value)
    return out


def _solid(parts: Sequence[Part], name: str, where: str) -> Part:
    for part in parts:
        if part.name == name:
            return part
    raise InputError(where, f"no solid '{name}'", f"one of {[p.name for p in parts]}")


def dead_load(model: Model, loads: Sequence[Load], where: str) -> Array:
    """Nodal forces (n, d) [N] of dead loads on a model; ``where`` is their place in the scene, for errors."""
    return _load(model.parts, model.mass, loads, where)


def _pairs(scene: Scene, parts: Sequence[Part]) -> Pairs:
    dim = parts[0].mesh.dim
    node, number, points, shapes = [np.zeros(0, int)], [np.zeros(0, int)], [np.zeros((0, dim))], []
    for k, contact in enumerate(scene.contacts):
        tool = scene.bodies.get(contact.between[1])
        with within(f"contacts[{k}]"):
            part = _solid(parts, contact.body, "between")
            if not isinstance(tool, Tool):
                tools = [n for n, b in scene.bodies.items() if isinstance(b, Tool)]
                raise InputError("between", f"'{contact.between[1]}' is not a tool", f"one of {tools}")
            with within("between"):
                nodes = part.mesh.nodes(contact.tag)
        with within(f"bodies.{contact.between[1]}.shape"):
            tool.shape.gap(part.mesh.points[nodes])
        node.append(nodes + part.rows.start)
        number.append(np.full(len(nodes), k))
        points.append(part.mesh.points[nodes])
        shapes.append(tool.shape)
    rows = np.concatenate(node), np.concatenate(number), np.concatenate(points)
    labels = tuple(c.label for c in scene.contacts)
    for k, label in enumerate(labels):
        if label in labels[:k]:
            raise InputError(f"contacts[{k}].name", f"'{label}' is the name of an earlier contact", "a name of its own")
    reference = linear(*rows, np.zeros_like(rows[2]), tuple(shapes), labels)
    return Pairs(node=rows[0], contact=rows[1], points=rows[2], shapes=tuple(shapes), reference=reference)
