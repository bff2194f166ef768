"""B08: elastic disc hits a rigid wall in plane strain: invariants."""

from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.meshes.generators.recipes import GradedDisc
from softway.record.view.plots.curves import Curve, Panel

LAWS: dict[str, sw.LinearElastic | sw.NeoHookean] = {
    "small strain": sw.LinearElastic(E=1000.0, nu=0.3),
    "finite strain": sw.NeoHookean(E=1000.0, nu=0.3),
}
WALL = sw.obstacles.HalfSpace(point=(0.0, -1.05), normal=(0.0, 1.0))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """Course of an impact over m slabs.

    Parameters
    ----------
    energy, momentum, angular, force, gap
        (m,) energy / initial energy, momentum (m, 2) / mass, angular momentum about the initial centre, force of the
        wall, smallest gap.
    impulse
        Impulse of the wall / mass.
    lopsided
        Greatest difference between the displacements of mirrored nodes.
    duration
        Time from the first touch to the last release.
    """

    energy: Array
    momentum: Array
    angular: Array
    force: Array
    gap: Array
    impulse: float
    lopsided: float
    duration: float


@cache
def thrown(law: str, cells: int, step: float) -> Course:
    """March a disc of radius, density and velocity 1 with the gap 0.05; ``cells`` along an arc of 0.26."""
    mesh = GradedDisc(radius=1.0, focus=0.26, cells=cells).build()
    disc = sw.Solid(mesh=mesh, material=LAWS[law], density=1.0, velocity=sw.bodies.Uniform(value=(0.0, -1.0)))
    contacts = (sw.Contact(between=("disc.focus", "wall"), name="wall"),)
    model = sw.build(sw.Scene(bodies={"disc": disc, "wall": sw.Tool(shape=WALL)}, contacts=contacts))
    steps = list(sw.march(model, until=0.3, step=step))
    total, start = model.mass.sum(), model.kinetic(model.velocity).sum()
    fields = [(s.after.displacement["disc"], model.mass @ s.after.velocity["disc"]) for s in steps]
    order = np.lexsort(np.round(mesh.points, 12).T)
    mirror = np.empty_like(order)
    mirror[order] = np.lexsort(np.round(mesh.points * (-1.0, 1.0), 12).T)
    instants = [e.time for s in steps for e in s.events]
    return Course(
        energy=np.array([s.ledger.energy_kinetic + s.ledger.energy_strain for s in steps]) / start,
        momentum=np.array([s.ledger.momentum[:2] for s in steps]) / total,
        angular=np.array([_moment(mesh.points + u, p) for u, p in fields]),
        force=np.array([s.ledger.contacts["wall"].force_n for s in steps]),
        gap=np.array([s.ledger.contacts["wall"].min_gap for s in steps]),
        impulse=sum(s.ledger.contacts["wall"].force_n * s.slab.span for s in steps) / total,
        lopsided=max(float(np.abs(u[mirror] * (-1.0, 1.0) - u).max()) for u, _ in fields),
        duration=max(instants) - min(instants),
    )


def _moment(x: Array, p: Array) -> float:
    """Angular momentum about the origin of nodal momenta (n, 2) at positions (n, 2)."""
    return float(np.sum(x[:, 0] * p[:, 1] - x[:, 1] * p[:, 0]))


def compute() -> Outcome:
    """Compute small and finite strain; the impulse is relative to m v (1 + e), with the measured rebound speed e v."""
    found: dict[str, float] = {}
    for law, tail in (("small strain", ""), ("finite strain", ", finite strain")):
        course = thrown(law, 4, 0.004)
        found["total energy drift" + tail] = float(np.abs(course.energy - 1.0).max())
        found["angular momentum" + tail] = float(np.abs(course.angular).max())
        found["impulse = m(v+e v)" + tail] = course.impulse / float(course.momentum[-1, 1] + 1.0)
    ours = [Curve(x=_times(n), y=thrown(n, 4, 0.004).force, label=n) for n in LAWS]
    return Outcome(values=found, panels=(Panel(title="Force of the wall", x="t", y="force", curves=tuple(ours)),))


def _times(law: str) -> Array:
    return 0.3 * (np.arange(len(thrown(law, 4, 0.004).force)) + 0.5) / len(thrown(law, 4, 0.004).force)
