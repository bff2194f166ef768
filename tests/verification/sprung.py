"""A stiff block on a rough floor, held by springs: masses on springs with friction (C02, C03, C08).

The spring is a thin column on top of the block, of the same matter, whose upper end is held along the floor and free
across it.  Its stiffness is measured by a static march of the same mesh, so that nothing depends on how well the
elements bend; the density makes the mass.  The block is stiff: its own vibrations are thousands of times faster.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from exact_waves import Array
from softway.march.begin import begin

SIDE, HEIGHT = 1.0, 0.5
COLUMN, THIN = 0.1, 4e-4
WEIGHT = 9.81


@dataclass(frozen=True, slots=True, kw_only=True)
class Sprung:
    """Block and column in ``dim`` dimensions with the ``mass`` and the ``stiffness``."""

    dim: int
    mass: float
    stiffness: float

    @property
    def mesh(self) -> sw.Mesh:
        """The mesh, with the tags ``bottom`` and ``held``."""
        return _mesh(self.dim)

    @property
    def density(self) -> float:
        return self.mass / _volume(self.dim)

    @property
    def youngs(self) -> float:
        """Young's modulus that makes the stiffness."""
        return self.stiffness / _unit(self.dim)

    def solid(self, velocity: tuple[float, ...], at: tuple[float, ...], gravity: float = WEIGHT) -> sw.Solid:
        """At rest at the place ``at`` along the floor, compressed by its weight, but for its velocity."""
        pull = self.stiffness / self.mass * np.array(at)
        return sw.Solid(
            mesh=self.mesh,
            material=sw.LinearElastic(E=self.youngs),
            density=self.density,
            velocity=sw.Uniform(value=velocity),
            displacement=_bent(self.dim, self.youngs, self.density, (*pull, -gravity)),
            supports=(sw.Fixed(on="held", components=_plane(self.dim)),),
        )

    def mean(self, field: Array) -> Array:
        """Mean (d,) of a nodal field over the lower side of the block."""
        return np.asarray(field[self.mesh.nodes("bottom")].mean(axis=0))


def _plane(dim: int) -> str:
    """The components along the floor."""
    return "xy"[: dim - 1]


def _grid(axes: list[Array], kind: str) -> tuple[Array, Array]:
    """Points and cells of second order on a grid whose axes list corners."""
    size = tuple(float(a[-1] - a[0]) for a in axes)
    cells = tuple(len(a) - 1 for a in axes)
    source = sw.Rectangle if len(axes) == 2 else sw.Box
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
    return mesh.with_tag("held", lambda x: x[:, -1] >= HEIGHT + COLUMN - 1e-9)


def _volume(dim: int) -> float:
    return SIDE ** (dim - 1) * HEIGHT + THIN ** (dim - 1) * 1.05 * COLUMN


@cache
def _unit(dim: int) -> float:
    """Stiffness of the spring for E = 1, measured."""
    u = _bent(dim, 1.0, 1.0 / _volume(dim), (1e-9, *(0.0,) * (dim - 1)))
    return 1e-9 / float(u[_mesh(dim).nodes("bottom"), 0].mean())


def _bent(dim: int, youngs: float, density: float, pull: tuple[float, ...]) -> Array:
    """Displacement (n, d) in equilibrium under an acceleration, the lower side on rollers."""
    solid = sw.Solid(
        mesh=_mesh(dim),
        material=sw.LinearElastic(E=youngs),
        density=density,
        supports=(sw.Fixed(on="held", components=_plane(dim)), sw.Fixed(on="bottom", components="xyz"[dim - 1])),
    )
    loads = (sw.Gravity(acceleration=tuple(float(p) for p in pull)),)
    model = sw.build(sw.Scene(bodies={"block": solid}, loads=loads, start=sw.StaticStart()))
    return begin(model).start.displacement.copy()
