"""B08: an elastic disc meets a rigid wall in plane strain: invariants, symmetry, and convergence with the mesh."""

import numpy as np
import pytest

import results
from softway.apps.verify.cases.contact.b08_disc_on_wall import LAWS, Course, thrown


@pytest.fixture(scope="module", params=LAWS)
def course(request) -> Course:
    """The case with either law."""
    return thrown(request.param, 4, 0.004)


def test_case():
    assert results.missed("B08") == set()


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
    coarse, fine = (thrown("small strain", cells, step) for cells, step in ((4, 0.004), (8, 0.002)))
    assert coarse.duration == pytest.approx(fine.duration, rel=0.01)
    assert coarse.force.max() == pytest.approx(fine.force.max(), rel=0.01)
    assert coarse.momentum[-1, 1] == pytest.approx(fine.momentum[-1, 1], abs=0.003)
    assert fine.momentum[-1, 1] == pytest.approx(0.9812, abs=0.001)
