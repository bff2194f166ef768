"""I04: a ball that falls slowly on a rigid floor, on a mesh that adapts, against the uniform one and Hertz's law."""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.refinement import refined
from softway.meshes.adaptive.surfaces.surface import rounded
from softway.meshes.generators.shapes import disc
from softway.meshes.mesh import Mesh
from softway.record.view.plots.curves import Curve, Panel

CELLS, LEVELS = 8, 10
SPEED, POISSON, GAP = 1.67e-3, 0.3, 1e-4
"""Speed, of which the wave speed is about 700 times as much; Poisson's ratio; gap at the start.  Radius 1, E = 1."""
END, STEP = 20.0, 0.2
MASS = 4.0 / 3.0 * np.pi
ENERGY = 0.5 * MASS * SPEED**2
MODULUS = 4.0 / (3.0 * (1.0 - POISSON**2))
PEAK = MODULUS**0.4 * (1.25 * MASS * SPEED**2) ** 0.6
"""Greatest force by Hertz's law."""
LOW = -0.85
"""Height below which the surface may touch."""


def meridian() -> Mesh:
    """Half of a disc, the section of the ball, with its axis and the part ``under`` that may touch."""
    whole = disc(1.0, CELLS, cell="tri3")
    cells = whole.blocks["tri3"]
    chosen = cells[whole.centres()[:, 0] > 0.0]
    nodes, rows = np.unique(chosen, return_inverse=True)
    points = np.array(whole.points[nodes])
    points[np.abs(points[:, 0]) < 1e-12, 0] = 0.0
    mesh = Mesh(points=points, blocks={"tri3": rows.reshape(chosen.shape)})
    return mesh.with_tag("axis", lambda x: x[:, 0] == 0.0).with_tag(
        "under", lambda x: (np.linalg.norm(x, axis=1) > 1.0 - 1e-9) & (x[:, 1] < LOW)
    )


def scene(mesh: Mesh, adapt: Adapt | None = None) -> sw.Scene:
    """The ball just above the floor."""
    ball = sw.Solid(
        mesh=mesh,
        material=sw.LinearElastic(E=1.0, nu=POISSON),
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        velocity=sw.bodies.Uniform(value=(0.0, -SPEED)),
        supports=(sw.bodies.Fixed(on="axis", components="x"),),
        adapt=adapt,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.0 - GAP), normal=(0.0, 1.0)))
    return sw.Scene(
        bodies={"ball": ball, "floor": floor}, contacts=(sw.Contact(between=("ball.under", "floor"), name="floor"),)
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class History:
    """Ends of the slabs, forces and stored energies in them, mean number of unknowns, and the last slab."""

    time: Array
    force: Array
    stored: Array
    unknowns: float
    last: sw.Step


def history(march: sw.Scene) -> History:
    """Contact and rebound of a ball."""
    rows, sizes = [], []
    for step in sw.march(march, until=END, step=STEP):
        ledger = step.ledger
        rows.append((step.slab.end, ledger.contacts["floor"].force_n, ledger.energy_strain))
        sizes.append(step.model.dofs.size)
    time, force, stored = np.array(rows).T
    return History(time=time, force=force, stored=stored, unknowns=float(np.mean(sizes)), last=step)


@cache
def uniform() -> History:
    """Equal cells, as small as the finest ones of the mesh that adapts."""
    base = rounded(meridian(), radial=True)
    return history(scene(refined(base, np.full(base.n_cells, LEVELS)).mesh))


@cache
def adapted() -> History:
    """Cells that adapt."""
    return history(scene(meridian(), Adapt(levels=LEVELS, tolerance=2.0, contact_cells=4, buffer=2)))


def compute() -> Outcome:
    """Compute the whole contact, with cells of 1/128 of the radius at the finest."""
    plain, fitted = uniform(), adapted()
    ledger = fitted.last.ledger
    values = {
        "degrees of freedom, relative to uniform": fitted.unknowns / plain.unknowns,
        "greatest force, relative to uniform": float(fitted.force.max() / plain.force.max()),
        "greatest stored energy, relative to uniform": float(fitted.stored.max() / plain.stored.max()),
        "error of the force, rms": float(np.linalg.norm(fitted.force - plain.force) / np.linalg.norm(plain.force)),
        "greatest force, relative to Hertz": float(fitted.force.max() / PEAK),
        "speed of the rebound": float(ledger.momentum[1]) / (MASS * SPEED),
        "error of the energy balance": ledger.energy_error / ENERGY,
        "energy that changes of the mesh took": ledger.remeshing / ENERGY,
    }
    curves = tuple(
        Curve(x=one.time, y=one.force / PEAK, label=name) for name, one in (("adapted", fitted), ("uniform", plain))
    )
    panel = Panel(title="Force of the floor", x="t", y="force, relative to Hertz's greatest", curves=curves)
    return Outcome(values=values, panels=(panel,))
