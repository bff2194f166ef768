"""One solid as arrays: its mesh in place, its internal force, its supports and initial fields."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.cells import Dilating
from softway.bodies.fields import sample
from softway.bodies.force import SlabForce
from softway.bodies.internal import InternalForce, internal_force
from softway.bodies.memory import Memory
from softway.bodies.rate_force import RateForce, rate_force
from softway.bodies.section import Section, default_section, wave_speed
from softway.bodies.shock import Shock, shock_of
from softway.bodies.solid import Driven, Solid, Support
from softway.errors import InputError, within
from softway.laws.law import Material, RateLaw
from softway.space.cells import CELLS
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray

UNSTRAINED = 1e-14
"""Strain below which a body counts as undeformed."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Part:
    """One solid as arrays; ``rows`` are its nodes among those of the model, ``density`` is in kg/m^3."""

    name: str
    mesh: Mesh
    rows: slice
    internal: InternalForce | RateForce
    density: float
    average: SlabForce
    dilatation: Dilating = "point"
    shock: Shock | None = None

    def shock_force(self, middle: Array, change: Array, span: float) -> Array:
        """Force (n, d) of its bulk viscosity [N], zero without."""
        return np.zeros_like(middle) if self.shock is None else self.shock.force(self.internal, middle, change, span)

    def stiffness(self, u: Array, secant: bool, again: float, chosen: BoolArray) -> Array:
        """Values of the tangent stiffness at its displacement u on its pattern, or of the secant one where its law has
        such [N/m]; between the ``chosen`` nodes (n,) what the mean rate of the slab makes counts ``again``.
        """
        if not isinstance(self.internal, RateForce):
            return np.asarray(self.internal.tangent(u).data)
        values = np.asarray((self.internal.secant(u) if secant else self.internal.tangent(u)).data)
        made = self.internal.viscous_tangent(u) if again > 0.0 else None
        if made is None:
            return values
        keep = np.repeat(chosen, self.mesh.dim)
        return np.asarray(values + again * made.data * keep[made.indices] * np.repeat(keep, np.diff(made.indptr)))

    def floor(self) -> float:
        """Stored energy below which it counts as undeformed [J]."""
        speed = wave_speed(self.internal.material, self.density, self.internal.section)
        return float(UNSTRAINED**2 * self.density * speed**2 * self.internal.sampling.volume.sum())

    def during(self, memory: Memory | None, span: float) -> "Part":
        """The solid in a slab of length ``span`` [s] that it meets with a memory."""
        if memory is None or not isinstance(self.internal, RateForce):
            return self
        return replace(self, internal=self.internal.during(memory, span))


def part_of(name: str, solid: Solid, first: int) -> Part:
    """The arrays of one solid whose nodes are numbered from ``first``."""
    with within("mesh"):
        mesh = solid.mesh if isinstance(solid.mesh, Mesh) else solid.mesh.build()
    with within("place"):
        mesh = solid.place.applied(mesh)
    section = default_section(mesh) if solid.section is None else solid.section
    if solid.dilatation == "mean" and any(CELLS[cell].order > 1 for cell in mesh.blocks):
        problem = "'mean' in quadratic cells: a single mean leaves some of their motions without stiffness"
        raise InputError("dilatation", problem, "'corner'")
    internal = force_of(mesh, solid.material, section, solid.dilatation)
    rows = slice(first, first + mesh.n_nodes)
    with within("shock"):
        shock = shock_of(solid.shock, mesh, solid.density, internal)
    return Part(
        name=name,
        mesh=mesh,
        rows=rows,
        internal=internal,
        density=solid.density,
        average=solid.force,
        dilatation=solid.dilatation,
        shock=shock,
    )


def force_of(mesh: Mesh, material: Material, section: Section, dilatation: Dilating) -> InternalForce | RateForce:
    """The internal force of a body, by what its law is."""
    if isinstance(material, RateLaw):
        return rate_force(mesh, material, section, dilatation)
    return internal_force(mesh, material, section, dilatation)


def initial(part: Part, solid: Solid) -> tuple[Array, Array, BoolArray]:
    """Initial displacement and velocity (n, d), and the components without support (n, d)."""
    with within(f"bodies.{part.name}.displacement"):
        displacement = sample(solid.displacement, part.mesh)
    with within(f"bodies.{part.name}.velocity"):
        velocity = sample(solid.velocity, part.mesh)
    with within(f"bodies.{part.name}"):
        return displacement, velocity, free_components(solid.supports, part.mesh)


def free_components(supports: tuple[Support, ...], mesh: Mesh) -> BoolArray:
    """Components (n, d) of the nodes of a mesh that no support holds or drives.

    Raises
    ------
    InputError
        With the place from ``supports[k]`` on: letters that are no axes of the mesh, a tag that matches nothing.
    """
    free = np.ones((mesh.n_nodes, mesh.dim), bool)
    for k, support in enumerate(supports):
        with within(f"supports[{k}]"):
            free &= ~held_components(support, mesh)
    return free


def held_components(support: Support, mesh: Mesh) -> BoolArray:
    """Components (n, d) of the nodes of a mesh that a support holds or drives.

    Raises
    ------
    InputError
        Letters that are no axes of the mesh, a tag that matches nothing.
    """
    held = np.zeros((mesh.n_nodes, mesh.dim), bool)
    axes = "xyz"[: mesh.dim]
    letters = axes if support.components == "all" else support.components
    if not letters or set(letters) - set(axes):
        problem = f"{support.components!r} in {mesh.dim}D"
        raise InputError("components", problem, f"letters of {axes!r}, or 'all'")
    with within("on"):
        nodes = mesh.nodes(support.on)
    for letter in letters:
        held[nodes, axes.index(letter)] = True
    return held


def driven_components(
    parts: Sequence[Part], solids: Mapping[str, Solid], shape: tuple[int, ...]
) -> tuple[tuple[Driven, BoolArray], ...]:
    """The driven supports with the components (n, d) that they move; a later support takes over from an earlier."""
    found = []
    for part in parts:
        for k, support in enumerate(solids[part.name].supports):
            if isinstance(support, Driven):
                with within(f"bodies.{part.name}.supports[{k}]"):
                    where = np.zeros(shape, bool)
                    where[part.rows] = held_components(support, part.mesh)
                found.append((support, where))
    return tuple(found)
