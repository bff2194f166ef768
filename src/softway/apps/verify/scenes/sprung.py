"""Stiff block on a rough floor, held by springs: masses on springs with friction (C02, C03, C08).

The spring is a thin column on top of the block, of the same material. Its upper end is held along the floor and free
across it. The stiffness is measured in a static computation with the same mesh, so the bending accuracy of the elements
does not matter. The mass is the modal mass of the motion with the static bending shape. The block is stiff: its own
vibrations are thousands of times faster.

Ten times the weight of the cases with a tenth of their friction prevents the block from tipping over its edges.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

import softway as sw
from softway.arrays import Array, IntArray
from softway.laws.friction_law import FrictionLaw
from softway.marching.results.step import Step
from softway.marching.start.initial_state import initial_state

SIDE, HEIGHT = 0.5, 0.1
COLUMN, THIN = 0.05, 5e-4
ENERGY = sw.contact.Energy(spread=2)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Swing:
    """March of n slabs: ``time`` (n,) at their ends, and mean ``place`` (n, d) of the lower side of the block."""

    time: Array
    place: Array
    steps: tuple[Step, ...]

    def at(self, time: float) -> Array:
        """Place (d,) at the slab end nearest to a time."""
        return np.asarray(self.place[int(np.argmin(np.abs(self.time - time)))])


@dataclass(frozen=True, slots=True, kw_only=True)
class Sprung:
    """Block and column in ``dim`` dimensions with given ``mass``, ``stiffness`` and ``weight`` [N].

    The block stands on its lower side, ``bottom``, or on its lower corners, ``feet``.
    """

    dim: int
    mass: float
    stiffness: float
    weight: float
    touching: str = "bottom"

    @property
    def mesh(self) -> sw.Mesh:
        """Mesh with the tags ``bottom``, ``feet`` and ``held``."""
        return _mesh(self.dim)

    @property
    def density(self) -> float:
        """Mass per volume."""
        return self.mass / _inertia(self.dim, self.touching)

    @property
    def gravity(self) -> sw.Gravity:
        """Gravity that gives the weight."""
        acceleration = self.weight / (self.density * _volume(self.dim))
        return sw.Gravity(acceleration=(*(0.0,) * (self.dim - 1), -acceleration))

    @property
    def youngs(self) -> float:
        """Young's modulus that gives the stiffness."""
        return self.stiffness / _unit(self.dim, self.touching)

    def solid(self, velocity: tuple[float, ...], at: tuple[float, ...]) -> sw.Solid:
        """Body at the place ``at`` along the floor, in static equilibrium except for its velocity."""
        pull = self.stiffness * np.array(at)
        bent: Any = _bent(self.dim, self.touching, self.youngs, self.density, tuple(pull), (self.gravity,))
        return sw.Solid(
            mesh=self.mesh,
            material=sw.LinearElastic(E=self.youngs),
            density=self.density,
            velocity=sw.bodies.Uniform(value=velocity),
            displacement=bent,
            supports=(sw.Fixed(on="held", components=_plane(self.dim)),),
        )

    def scene(
        self, velocity: tuple[float, ...], at: tuple[float, ...], friction: FrictionLaw, speed: float = 0.0
    ) -> sw.Scene:
        """Scene of the block ``b`` with the contact ``floor``; the floor moves at ``speed`` along the first axis."""
        up = tuple(np.eye(self.dim)[-1])
        belt = sw.bodies.Translation(velocity=(speed, *(0.0,) * (self.dim - 1))) if speed else sw.bodies.Still()
        floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0,) * self.dim, normal=up), motion=belt)
        return sw.Scene(
            bodies={"b": self.solid(velocity, at), "belt": floor},
            contacts=(
                sw.Contact(between=(f"b.{self.touching}", "belt"), name="floor", friction=friction, timing=ENERGY),
            ),
            loads=(self.gravity,),
        )

    def swing(self, scene: sw.Scene, until: float, step: float) -> Swing:
        """March a scene of this block."""
        steps = tuple(sw.march(scene, until=until, step=step))
        place = np.array([self.mean(s.after.displacement["b"]) for s in steps])
        return Swing(time=np.array([s.after.time for s in steps]), place=place, steps=steps)

    def mean(self, field: Array) -> Array:
        """Mean (d,) of a nodal field over the lower side of the block."""
        return np.asarray(field[self.mesh.nodes("bottom")].mean(axis=0))


def _plane(dim: int) -> str:
    """Components along the floor."""
    return "xy"[: dim - 1]


def _grid(axes: list[Array], kind: str) -> tuple[Array, IntArray]:
    """Points and second-order cells of a grid; the axes list the cell corners."""
    size: Any = tuple(float(a[-1] - a[0]) for a in axes)
    cells: Any = tuple(len(a) - 1 for a in axes)
    source = sw.meshes.Rectangle if len(axes) == 2 else sw.meshes.Box
    mesh = source(size=size, cells=cells, cell=kind).build()
    moved = []
    for j, corners in enumerate(axes):
        even = np.linspace(0.0, size[j], len(corners))
        moved.append(np.interp(mesh.points[:, j], even, corners))
    return np.stack(moved, axis=1), mesh.blocks[kind]


@cache
def _mesh(dim: int) -> sw.Mesh:
    kind = "quad9" if dim == 2 else "hex27"
    across = np.array([-0.5 * SIDE, -0.5 * THIN, 0.5 * THIN, 0.5 * SIDE])
    up = HEIGHT * np.linspace(0.0, 1.0, 5)
    block = _grid([across] * (dim - 1) + [up], kind)
    column = _grid([across[1:3]] * (dim - 1) + [HEIGHT + COLUMN * np.array([0.0, 0.25, 0.5, 0.75, 1.0, 1.05])], kind)
    points = np.concatenate([block[0], column[0]])
    _, first, number = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
    cells = number.ravel()[np.concatenate([block[1], column[1] + len(block[0])])]
    mesh = sw.Mesh(points=points[first], blocks={kind: cells})
    mesh = mesh.with_tag("bottom", lambda x: x[:, -1] == 0.0)
    mesh = mesh.with_tag("feet", lambda x: (x[:, -1] == 0.0) & (np.abs(x[:, :-1]) > 0.4999 * SIDE).all(axis=1))
    return mesh.with_tag("held", lambda x: x[:, -1] >= HEIGHT + COLUMN - 1e-9)


def _volume(dim: int) -> float:
    return SIDE ** (dim - 1) * HEIGHT + 1.05 * THIN ** (dim - 1) * COLUMN


@cache
def _inertia(dim: int, touching: str) -> float:
    """Modal mass of block and column for density 1, with the mass distribution of the contact rule."""
    u = _bent(dim, touching, 1.0, 1.0, (1e-9, *(0.0,) * (dim - 2)), ())[:, 0]
    solid = sw.Solid(mesh=_mesh(dim), material=sw.LinearElastic(E=1.0), density=1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0,) * dim, normal=tuple(np.eye(dim)[-1])))
    contact = sw.Contact(between=(f"b.{touching}", "floor"), timing=ENERGY)
    model = sw.build(sw.Scene(bodies={"b": solid, "floor": floor}, contacts=(contact,)))
    return float(u @ (model.mass @ u)) / float(u[_mesh(dim).nodes("bottom")].mean()) ** 2


@cache
def _unit(dim: int, touching: str) -> float:
    """Measured stiffness of the spring for E = 1."""
    u = _bent(dim, touching, 1.0, 1.0, (1e-9, *(0.0,) * (dim - 2)), ())
    return 1e-9 / float(u[_mesh(dim).nodes("bottom"), 0].mean())


def _bent(
    dim: int, touching: str, youngs: float, density: float, pull: tuple[float, ...], loads: tuple[sw.Gravity, ...]
) -> Array:
    """Equilibrium displacement (n, d) on rollers, under forces along the lower side and loads."""
    solid = sw.Solid(
        mesh=_mesh(dim),
        material=sw.LinearElastic(E=youngs),
        density=density,
        supports=(sw.Fixed(on="held", components=_plane(dim)), sw.Fixed(on=touching, components="xyz"[dim - 1])),
    )
    traction = sw.Traction(on="block.bottom", value=(*(float(p) / SIDE ** (dim - 1) for p in pull), 0.0))
    model = sw.build(sw.Scene(bodies={"block": solid}, loads=(traction, *loads), start=sw.model.StaticStart()))
    return initial_state(model).start.displacement.copy()
