"""One solid as arrays: its mesh in place, its internal force, its supports and initial fields."""

from dataclasses import dataclass

import numpy as np

from softway.bodies.fields import sample
from softway.bodies.force import SlabForce
from softway.bodies.internal import InternalForce, internal_force
from softway.bodies.section import default_section
from softway.bodies.solid import Fixed, Solid
from softway.errors import InputError, within
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Part:
    """One solid as arrays; ``rows`` are its nodes among those of the model, ``density`` is in kg/m^3."""

    name: str
    mesh: Mesh
    rows: slice
    internal: InternalForce
    density: float
    average: SlabForce


def part_of(name: str, solid: Solid, first: int) -> Part:
    """The arrays of one solid whose nodes are numbered from ``first``."""
    with within("mesh"):
        mesh = solid.mesh if isinstance(solid.mesh, Mesh) else solid.mesh.build()
    with within("place"):
        mesh = solid.place.applied(mesh)
    section = default_section(mesh) if solid.section is None else solid.section
    internal = internal_force(mesh, solid.material, section)
    rows = slice(first, first + mesh.n_nodes)
    return Part(name=name, mesh=mesh, rows=rows, internal=internal, density=solid.density, average=solid.force)


def initial(part: Part, solid: Solid) -> tuple[Array, Array, BoolArray]:
    """Initial displacement and velocity (n, d), and the components without support (n, d)."""
    with within(f"bodies.{part.name}.displacement"):
        displacement = sample(solid.displacement, part.mesh)
    with within(f"bodies.{part.name}.velocity"):
        velocity = sample(solid.velocity, part.mesh)
    with within(f"bodies.{part.name}"):
        return displacement, velocity, free_components(solid.supports, part.mesh)


def free_components(supports: tuple[Fixed, ...], mesh: Mesh) -> BoolArray:
    """Components (n, d) of the nodes of a mesh that no support holds.

    Raises
    ------
    InputError
        With the place from ``supports[k]`` on: letters that are no axes of the mesh, a tag that matches nothing.
    """
    free = np.ones((mesh.n_nodes, mesh.dim), bool)
    axes = "xyz"[: mesh.dim]
    for k, fixed in enumerate(supports):
        letters = axes if fixed.components == "all" else fixed.components
        if not letters or set(letters) - set(axes):
            where = f"supports[{k}].components"
            raise InputError(where, f"{fixed.components!r} in {mesh.dim}D", f"letters of {axes!r}, or 'all'")
        with within(f"supports[{k}].on"):
            nodes = mesh.nodes(fixed.on)
        for letter in letters:
            free[nodes, axes.index(letter)] = False
    return free
