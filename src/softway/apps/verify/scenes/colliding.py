"""Collisions of two solids along x with non-matching meshes across it, and their marches as arrays.

In every scene the bodies are ``left`` and ``right`` and the contact is ``middle``.
"""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.arrays import Array
from softway.marching.results.step import Step

Method = sw.contact.DualMortar | sw.contact.NodeToSurface | None
SIDES = {1: (), 2: (("bottom", "y"), ("top", "y")), 3: (("front", "y"), ("back", "y"), ("bottom", "z"), ("top", "z"))}
"""Lateral sides of a mesh, with the normal component of each."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Bar:
    """Block along x with a square section, a slice of it in 2D, or a bar in 1D.

    ``along`` and ``across`` are numbers of cells; the density is 1.
    """

    length: float = 1.0
    youngs: float = 1.0
    poisson: float = 0.0
    speed: float = 0.0
    width: float = 0.1
    along: int = 50
    across: int = 1

    def mesh(self, dim: int) -> sw.meshes.Interval | sw.meshes.Rectangle | sw.meshes.Box:
        """Mesh for a dimension of space."""
        n, k, width = self.along, self.across, self.width
        match dim:
            case 1:
                return sw.meshes.Interval(length=self.length, cells=n)
            case 2:
                return sw.meshes.Rectangle(size=(self.length, width), cells=(n, k))
            case _:
                return sw.meshes.Box(size=(self.length, width, width), cells=(n, k, k))

    def solid(self, dim: int, start: float, section: sw.bodies.PlaneStress | None, rollers: bool) -> sw.Solid:
        """Body with its left end at ``start``."""
        rest = (0.0,) * (dim - 1)
        supports = tuple(sw.Fixed(on=tag, components=c) for tag, c in SIDES[dim]) if rollers else ()
        return sw.Solid(
            mesh=self.mesh(dim),
            material=sw.LinearElastic(E=self.youngs, nu=self.poisson),
            density=1.0,
            section=section,
            velocity=sw.bodies.Uniform(value=(self.speed, *rest)),
            place=sw.bodies.Placement(translation=(start, *rest)),
            supports=supports,
        )


def pair(
    left: Bar,
    right: Bar,
    dim: int,
    *,
    gap: float = 0.0,
    section: sw.bodies.PlaneStress | None = None,
    rollers: bool = False,
    method: Method = None,
) -> sw.Scene:
    """Scene of two bodies with a gap between them; ``rollers`` keep the lateral sides in their planes."""
    bodies = {
        "left": left.solid(dim, 0.0, section, rollers),
        "right": right.solid(dim, left.length + gap, section, rollers),
    }
    contact = sw.Contact(between=("left.right", "right.left"), name="middle", method=method)
    return sw.Scene(bodies=bodies, contacts=(contact,))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Collision:
    """Collision of m slabs; forces per section area, energies and momenta relative to the initial totals.

    Parameters
    ----------
    steps
        Results of the slabs.
    time, force
        (m,) midpoints of the slabs, and mean force between the bodies in each slab.
    touch, release
        Times of the first touch and the last release.
    velocity
        (2, d) velocities of the centres of mass at the end.
    energy, vibration
        Energy at the end, and its part (2,) in the vibration of each body about its centre of mass.
    error, momentum, gap
        Greatest errors of the energy balance and the momentum; smallest gap.
    """

    steps: tuple[Step, ...]
    time: Array
    force: Array
    touch: float
    release: float
    velocity: Array
    energy: float
    vibration: Array
    error: float
    momentum: float
    gap: float

    @property
    def duration(self) -> float:
        """Duration from the first touch to the last release."""
        return self.release - self.touch

    def mean_force(self, start: float, end: float) -> float:
        """Mean force over the slabs whose midpoints lie between two times."""
        inside = (self.time > start) & (self.time < end)
        spans = np.array([s.slab.span for s in self.steps])
        return float(np.average(self.force[inside], weights=spans[inside]))

    def falls(self, level: float) -> float:
        """Last time at which the force, linear between the midpoints of slabs, falls below a level."""
        k = int(np.flatnonzero(self.force > level)[-1])
        (t0, t1), (f0, f1) = self.time[k : k + 2], self.force[k : k + 2]
        return float(t0 + (t1 - t0) * (f0 - level) / (f0 - f1))


def collided(scene: sw.Scene, until: float, step: float | None = None) -> Collision:
    """March a scene of this module; ``step`` is ``auto`` by default."""
    model = sw.build(scene)
    steps = tuple(sw.march(model, until=until, step="auto" if step is None else step))
    u, v = (model.join(f) for f in (steps[-1].after.displacement, steps[-1].after.velocity))
    mass = np.asarray(model.mass.sum(axis=1))
    total = model.space.totals(mass)
    centres = np.array([mass[p.nodes] @ v[p.nodes] for p in model.parts]) / total[:, None]
    energies = model.kinetic(v) + model.energy_and_force(u)[0]
    start, first = model.kinetic(model.velocity).sum(), mass @ model.velocity
    momenta = np.array([s.ledger.momentum[: model.shape[1]] for s in steps])
    forces = np.array([s.ledger.contacts["middle"].force_n for s in steps])
    events = [e for s in steps for e in s.events]
    return Collision(
        steps=steps,
        time=np.array([0.5 * (s.slab.start + s.slab.end) for s in steps]),
        force=forces * sum(np.ptp(p.mesh.points[:, 0]) for p in model.parts) / total.sum(),
        touch=min(e.time for e in events if e.kind == "touch"),
        release=max(e.time for e in events if e.kind == "release"),
        velocity=centres,
        energy=float(energies.sum() / start),
        vibration=(energies - 0.5 * total * (centres**2).sum(axis=1)) / start,
        error=max(abs(s.ledger.energy_error) for s in steps) / start,
        momentum=float(np.abs(momenta - first).max() / np.abs(first).sum()),
        gap=min(s.certificate.min_gap for s in steps),
    )
