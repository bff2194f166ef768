"""Bodies pressed between platens without inertia: forces and shapes over the stroke.

The model is the upper half of the body, on its plane of symmetry, under a descending platen. The force of a slab is its
mean and belongs to the midpoint of the slab.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import softway as sw
from softway.arrays import Array
from softway.laws.friction_law import FrictionLaw
from softway.laws.law import RateLaw


@dataclass(frozen=True, kw_only=True)
class Press:
    """Body of revolution or slice in plane strain, between x = ``inner`` and ``outer``, under a platen."""

    material: RateLaw
    outer: float
    height: float
    inner: float = 0.0
    friction: FrictionLaw = sw.laws.Frictionless()
    section: sw.bodies.Axisymmetric | sw.bodies.PlaneStrain = sw.bodies.Axisymmetric()
    cells: tuple[int, int] = (12, 10)
    cell: str = "quad4"
    speed: float = 1.0
    stroke: float = 0.3
    slabs: int = 15
    solver: sw.FixedPoint | sw.Newton = sw.FixedPoint()

    @cached_property
    def steps(self) -> tuple[sw.Step, ...]:
        """Slabs of the stroke; ``stroke`` is the relative reduction of the height."""
        supports = [sw.Fixed(on="bottom", components="y")]
        if self.inner == 0.0:
            supports.append(sw.Fixed(on="left", components="x"))
        body = sw.Solid(
            mesh=sw.meshes.Rectangle(size=(self.outer - self.inner, self.height), cells=self.cells, cell=self.cell),
            place=sw.bodies.Placement(translation=(self.inner, 0.0)),
            material=self.material,
            density=1.0,
            section=self.section,
            dilatation="mean" if self.cell == "quad4" else "corner",
            supports=tuple(supports),
        )
        platen = sw.Tool(
            shape=sw.obstacles.HalfSpace(point=(0.0, self.height), normal=(0.0, -1.0)),
            motion=sw.bodies.Translation(velocity=(0.0, -self.speed)),
        )
        contact = sw.Contact(between=("body.top", "platen"), name="platen", friction=self.friction)
        scene = sw.Scene(bodies={"body": body, "platen": platen}, contacts=(contact,), inertia=sw.bodies.Off())
        until = self.stroke * self.height / self.speed
        return tuple(sw.march(scene, until=until, step=until / self.slabs, method=self.solver))

    @property
    def reduction(self) -> Array:
        """Reduction of the height at the midpoint of each slab."""
        return np.array([0.5 * (s.before.time + s.after.time) for s in self.steps]) * self.speed / self.height

    @property
    def force(self) -> Array:
        """Mean force of the platen in each slab."""
        return np.array([s.ledger.contacts["platen"].force_n for s in self.steps])

    def force_at(self, reduction: float) -> float:
        """Force at a reduction, from a smooth fit through the means of all slabs except the first.

        The fit is log(force) over log(height), which is a straight line if the body stays a cylinder.
        """
        height, force = np.log(1.0 - self.reduction[1:]), np.log(self.force[1:])
        fit = np.polynomial.Polynomial.fit(height, force, 4)
        return float(np.exp(fit(np.log(1.0 - reduction))))

    def radius(self, side: str, height: str) -> float:
        """Final coordinate x of a corner: ``side`` inner or outer, ``height`` middle or platen."""
        place = np.array([self.outer if side == "outer" else self.inner, self.height * (height == "platen")])
        rest = self.points
        node = int(np.argmin(np.abs(rest - place).sum(axis=1)))
        return float(rest[node, 0] + self.steps[-1].after.displacement["body"][node, 0])

    @property
    def bore(self) -> tuple[Array, Array]:
        """Reduction, and inner radius in the plane of symmetry, after each slab."""
        node = int(np.argmin(np.abs(self.points - [self.inner, 0.0]).sum(axis=1)))
        reduction = np.array([s.after.time for s in self.steps]) * self.speed / self.height
        return reduction, self.inner + np.array([s.after.displacement["body"][node, 0] for s in self.steps])

    @cached_property
    def points(self) -> Array:
        """Positions of the nodes before the stroke."""
        mesh = sw.meshes.Rectangle(
            size=(self.outer - self.inner, self.height), cells=self.cells, cell=self.cell
        ).build()
        return np.asarray(mesh.points + [self.inner, 0.0])

    @property
    def ledger_error(self) -> float:
        """Greatest error of the energy balance over the stroke, relative to the work done."""
        return max(abs(s.ledger.energy_error) for s in self.steps) / self.steps[-1].ledger.work_external

    @property
    def most_iterations(self) -> int:
        """Greatest number of iterations of a slab."""
        return max(s.report.iterations for s in self.steps)
