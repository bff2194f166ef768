"""Taylor bar of D09: scene, march, and final measurements."""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.bodies.elements.section import free_axes
from softway.bodies.internal_force.inelastic.material_points import RatePoints
from softway.marching.results.step import Step
from softway.model.model import Model

LENGTH, RADIUS, SPEED, END = 32.4e-3, 3.2e-3, 227.0, 80e-6
COPPER = sw.J2(E=117e9, nu=0.35, yield_stress=400e6, hardening=sw.laws.LinearHardening(modulus=100e6))
DENSITY = 8930.0
METHOD = sw.FixedPoint(tolerance=1e-8)
"""Tolerance above the default: 10 instead of 14 iterations per slab, energy to 1e-10 instead of 1e-12."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Crushed:
    """Final state of the bar.

    ``length`` and ``radius`` [mm], greatest mean plastic ``strain`` of a cell and greatest ``peak`` at a point,
    relative volume ``growth`` and ``least_ratio``, the smallest local volume ratio, ``mass`` [kg], ``dissipated``
    energy and greatest balance ``error`` [J], greatest ``depth`` in the wall [m], number of ``slabs`` and
    ``iterations``.
    """

    length: float
    radius: float
    strain: float
    peak: float
    growth: float
    least_ratio: float
    mass: float
    dissipated: float
    error: float
    depth: float
    slabs: int
    iterations: int


def scene(cells: tuple[int, int]) -> sw.Scene:
    """Scene of the bar on the wall; its lower side and its flank may touch."""
    bar = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(RADIUS, LENGTH), cells=cells),
        material=COPPER,
        density=DENSITY,
        section=sw.bodies.Axisymmetric(),
        velocity=sw.bodies.Uniform(value=(0.0, -SPEED)),
        supports=(sw.Fixed(on="left", components="x"),),
        dilatation="mean",
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contacts = (sw.Contact(between=("bar.bottom", "wall")), sw.Contact(between=("bar.right", "wall")))
    return sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=contacts)


def marched(cells: tuple[int, int], step: float) -> tuple[Model, list[Step]]:
    """Model of the bar, and its slabs up to 80 us."""
    model = sw.build(scene(cells))
    return model, list(sw.march(model, until=END, step=step, method=METHOD))


def measured(model: Model, steps: list[Step]) -> Crushed:
    """Measure the end of a march; a 3D bar stands on the plane z = 0 around the z axis."""
    internal, last = model.parts[0].internal, steps[-1].after
    points = RatePoints(law=COPPER, free=free_axes(internal.section), directions=internal.directions)
    memory, volume = last.memory["bar"], internal.sampling.volume
    x = model.points + last.displacement["bar"]
    plain = internal.sampling.plain_derivatives(last.displacement["bar"])
    ratio = np.linalg.det(points.gradient(plain, memory.lateral))
    seen = internal.sampling.derivatives(last.displacement["bar"])
    strain = memory.law["plastic_strain"].reshape(model.parts[0].mesh.n_cells, -1)
    return Crushed(
        length=1e3 * float(np.ptp(x[:, -1])),
        radius=1e3 * float(np.linalg.norm(x[:, :-1], axis=1).max()),
        strain=float(strain.mean(axis=1).max()),
        peak=float(strain.max()),
        growth=float(ratio @ volume / volume.sum() - 1.0),
        least_ratio=float(np.linalg.det(points.gradient(seen, memory.lateral)).min()),
        mass=DENSITY * float(volume.sum()),
        dissipated=steps[-1].ledger.dissipation,
        error=max(abs(s.ledger.energy_error) for s in steps),
        depth=max(-min(c.min_gap for c in s.ledger.contacts.values()) for s in steps),
        slabs=len(steps),
        iterations=sum(s.report.iterations for s in steps),
    )
