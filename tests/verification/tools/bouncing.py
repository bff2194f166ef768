"""Bodies that bounce between two rigid planes: the energy over many contacts, and how smooth the force is.

The body of size 1 is neo-Hookean with E = rho = 1, nu = 0.3, and flies along z between planes at equal distances.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np

import softway as sw
from softway.arrays import Array
from softway.bodies.inertia.mass_matrix import MassRule
from softway.contact.impact_rule import ImpactRule
from softway.marching.results.step import Step

RUBBER = sw.NeoHookean(E=1.0, nu=0.3)
SPEED = sqrt(0.7 / (1.3 * 0.4))
"""Speed of pressure waves."""
CLEARANCE = 0.05
LUMPED = sw.bodies.Lumped()


def cube(cells: int) -> sw.Mesh:
    """Unit cube about zero."""
    return sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells), origin=(-0.5, -0.5, -0.5)).build()


def ball(cells: int) -> sw.Mesh:
    """Ball of diameter 1 about zero, an even number of cells across; ``bottom`` and ``top`` are both the surface."""
    mesh = sw.meshes.Ball(radius=0.5, cells=cells).build()
    surface = mesh.nodes("surface")
    return sw.Mesh(points=mesh.points, blocks=mesh.blocks, tags={"bottom": surface, "top": surface})


def between_planes(
    mesh: sw.Mesh, speed: float, *, timing: ImpactRule = sw.contact.Energy(), mass: MassRule = LUMPED
) -> sw.Scene:
    """A body thrown at the floor, with a ceiling above."""
    body = sw.Solid(
        mesh=mesh, material=RUBBER, density=1.0, velocity=sw.bodies.Uniform(value=(0.0, 0.0, -speed)), mass=mass
    )
    height = 0.5 + CLEARANCE
    floor = sw.obstacles.HalfSpace(point=(0.0, 0.0, -height), normal=(0.0, 0.0, 1.0))
    ceiling = sw.obstacles.HalfSpace(point=(0.0, 0.0, height), normal=(0.0, 0.0, -1.0))
    contacts = (
        sw.Contact(between=("body.bottom", "floor"), name="floor", timing=timing),
        sw.Contact(between=("body.top", "ceiling"), name="ceiling", timing=timing),
    )
    return sw.Scene(
        bodies={"body": body, "floor": sw.Tool(shape=floor), "ceiling": sw.Tool(shape=ceiling)}, contacts=contacts
    )


def step_of(mesh: sw.Mesh, courant: float) -> float:
    """Slab in which a pressure wave crosses ``courant`` shortest edges."""
    return courant * mesh.edge() / SPEED


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Bounces:
    """A march of m slabs up to the last bounce asked for; energies are parts of the energy at the start.

    Parameters
    ----------
    time
        (m,) ends of the slabs.
    energy, error, dissipation
        (m,) total energy there, what the balance lacks, and what jumps have lost.
    force
        (m, 2) mean force of floor and ceiling over each slab.
    gap, momentum
        (m,) least gap and momentum along z at the ends of the slabs.
    scalar, iterations
        (m,) greatest scalar of the Energy rule, and iterations.
    rejections, factorisations
        Slabs dropped, and factors made.
    """

    time: Array
    energy: Array
    error: Array
    dissipation: Array
    force: Array
    gap: Array
    momentum: Array
    scalar: Array
    iterations: Array
    rejections: int
    factorisations: int

    @property
    def first(self) -> Array:
        """Force (k,) of the floor from the first touch up to the first slab without any."""
        push = self.force[:, 0]
        start = int(np.argmax(push > 0.0))
        length = int(np.argmax(push[start:] <= 0.0)) or len(push) - start
        return push[start : start + length]

    @property
    def variation(self) -> float:
        """Total variation of the force of the first bounce over twice its maximum: 1 for a single hump."""
        push = np.concatenate([[0.0], self.first, [0.0]])
        return float(np.abs(np.diff(push)).sum() / (2.0 * push.max()))


def bounced(scene: sw.Scene, step: float, bounces: int) -> Bounces:
    """March a scene of this module for a number of bounces, contacts with the one plane and the other in turn.

    It ends when the body has left the last plane or met the next.
    """
    rows: list[tuple[float, ...]] = []
    rejections, count, side, last = 0, 0, "", None
    for last in sw.march(scene, until=1e3 * bounces, step=step):
        rows.append(_row(last))
        rejections += len(last.report.rejections)
        push, harder = max((contact.force_n, name) for name, contact in last.ledger.contacts.items())
        if push > 0.0:
            count, side = count + (harder != side), harder
        if count > bounces or (count == bounces and push <= 0.0):
            break
    assert last is not None
    table = np.array(rows).T
    first = table[1] + table[3] - table[2]
    return Bounces(
        time=table[0],
        energy=table[1] / first[0],
        error=table[2] / first[0],
        dissipation=table[3] / first[0],
        gap=table[4],
        momentum=table[5],
        scalar=table[6],
        iterations=table[7],
        force=table[8:].T,
        rejections=rejections,
        factorisations=last.report.factorisations,
    )


def _row(step: Step) -> tuple[float, ...]:
    ledger = step.ledger
    contacts = ledger.contacts["floor"], ledger.contacts["ceiling"]
    return (
        step.after.time,
        ledger.energy_kinetic + ledger.energy_strain,
        ledger.energy_error,
        ledger.dissipation,
        min(c.min_gap for c in contacts),
        float(ledger.momentum[2]),
        max(map(abs, (step.report.scalars or {}).values()), default=0.0),
        step.report.iterations,
        *(c.force_n for c in contacts),
    )
