"""B08: an elastic disc meets a rigid wall in plane strain: invariants, symmetry, and convergence with the mesh."""

from dataclasses import dataclass

import numpy as np
import pytest

import softway as sw
from softway.space.sources import GradedDisc
from softway.typing import Array

LAWS = {"small strain": sw.LinearElastic(E=1000.0, nu=0.3), "finite strain": sw.NeoHookean(E=1000.0, nu=0.3)}
WALL = sw.HalfSpace(point=(0.0, -1.05), normal=(0.0, 1.0))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """An impact of m slabs.

    Parameters
    ----------
    energy, momentum, angular, force, gap
        (m,) energy over that at the start, momentum (m, 2) over the mass, angular momentum about the point where the
        centre started, force of the wall, least gap.
    impulse
        Of the wall, over the mass.
    lopsided
        Greatest difference of a displacement from that of the mirrored node.
    duration
        From the first touch to the last release.
    """

    energy: Array
    momentum: Array
    angular: Array
    force: Array
    gap: Array
    impulse: float
    lopsided: float
    duration: float


def thrown(law: sw.LinearElastic | sw.NeoHookean, cells: int, step: float) -> Course:
    """A disc of radius and density 1 with velocity 1 and the gap 0.05; ``cells`` along an arc of 0.26."""
    mesh = GradedDisc(radius=1.0, focus=0.26, cells=cells).build()
    disc = sw.Solid(mesh=mesh, material=law, density=1.0, velocity=sw.Uniform(value=(0.0, -1.0)))
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
    """Angular momentum of nodal momenta (n, 2) at positions (n, 2) about zero."""
    return float(np.sum(x[:, 0] * p[:, 1] - x[:, 1] * p[:, 0]))


@pytest.fixture(scope="module", params=LAWS)
def course(request) -> Course:
    """The case with either law."""
    return thrown(LAWS[request.param], 4, 0.004)


def test_the_energy_is_kept(course):
    """The case allows 1 percent."""
    assert np.abs(course.energy - 1.0).max() <= 1e-11


def test_the_impulse_is_the_change_of_momentum(course):
    """The case allows 1e-8."""
    assert course.impulse == pytest.approx(course.momentum[-1, 1] + 1.0, rel=1e-11)
    assert np.abs(course.momentum[:, 0]).max() <= 1e-12


def test_nothing_turns(course):
    """The case allows 1e-10."""
    assert np.abs(course.angular).max() <= 1e-12


def test_the_motion_is_symmetric(course):
    assert course.lopsided <= 1e-13


def test_the_wall_pushes_and_holds(course):
    assert course.gap.min() >= -1e-12
    assert course.force.min() >= 0.0
    assert course.force[-1] == 0.0


def test_duration_and_rebound_converge():
    """A finer mesh and slab change the duration and the force by less than a percent, the rebound by 0.003."""
    coarse, fine = (thrown(LAWS["small strain"], cells, step) for cells, step in ((4, 0.004), (8, 0.002)))
    assert coarse.duration == pytest.approx(fine.duration, rel=0.01)
    assert coarse.force.max() == pytest.approx(fine.force.max(), rel=0.01)
    assert coarse.momentum[-1, 1] == pytest.approx(fine.momentum[-1, 1], abs=0.003)
    assert fine.momentum[-1, 1] == pytest.approx(0.9812, abs=0.001)
