"""The tube of ``crash_tube``: force, energy and self-contact of its folds, and closed forms of the mean force.

Alexander (1960), Q. J. Mech. Appl. Math. 13, 10-15: rigid-plastic plates of the length l between circular hinges fold
outwards and flat, with the work 4 pi M0 (pi R + l) in the hinges and 2 pi Y t l^2 in the hoop for the way 2 l.  The
mean force is least for l^2 = pi R t / sqrt(3).  Abramowicz and Jones (1984), Int. J. Impact Eng. 2, 263-281: plates are
round, fold to both sides and do not become flat.
"""

from math import pi, sqrt

import numpy as np
import pytest

import softway as sw
from variants import whole

pytestmark = pytest.mark.minutes

RADIUS, WALL, LENGTH, TRAVEL = 20e-3, 1.5e-3, 40e-3, 30e-3
"""Middle radius, thickness and length of the tube, and the way of its end [m]."""


def alexander(stress: float) -> float:
    """Mean force [N] of folds of a rigid-plastic tube with a flow stress [Pa]."""
    moment = stress * WALL**2 / (2.0 * sqrt(3.0))
    plate = sqrt(pi * RADIUS * WALL / sqrt(3.0))
    return (4.0 * pi * moment * (pi * RADIUS + plate) + 2.0 * pi * stress * WALL * plate**2) / (2.0 * plate)


def abramowicz_jones(stress: float) -> float:
    """Mean force [N], with the way at which round folds are closed."""
    moment = stress * WALL**2 / (2.0 * sqrt(3.0))
    return moment * (25.23 * sqrt(2.0 * RADIUS / WALL) + 15.09)


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> sw.Run:
    return sw.run(whole("crash_tube"), tmp_path_factory.mktemp("tube") / "run")


def test_alexanders_force_has_its_rounded_coefficients() -> None:
    moment = WALL**2 / (2.0 * sqrt(3.0))
    assert alexander(1.0) == pytest.approx(moment * (20.73 * sqrt(2.0 * RADIUS / WALL) + 2.0 * pi), rel=1e-3)


def test_folds_go_outwards_twice_and_lie_on_each_other(run: sw.Run) -> None:
    """The middle of the wall is farthest out, farthest in and farthest out; forces are carried at three heights."""
    rest, frame = run.fields.cells.reference, run.fields[-1]
    faces = [np.flatnonzero(np.isclose(rest[:, 0], RADIUS + side * WALL / 2.0)) for side in (-1.0, 1.0)]
    inner, outer = (frame["points"][face[np.argsort(rest[face, 1])]] for face in faces)
    outwards = np.sign(np.diff((inner + outer)[:, 0] / 2.0))
    assert outwards[np.flatnonzero(np.diff(outwards, prepend=0.0))].tolist() == [1.0, -1.0, 1.0, -1.0]
    pressed = np.sort(frame["points"][frame["contact_force"] > 0.0, 1])
    assert np.count_nonzero(np.diff(pressed) > WALL) == 2


def test_energy_is_kept_to_rounding(run: sw.Run) -> None:
    """Relative to the dissipation; slabs are rarely tried again."""
    history = run.history
    assert abs(history["energy_error"]).max() < 1e-10 * history["dissipation"][-1]
    assert run.summary["slabs"] < 1.1 * 550


def test_the_mean_force_is_that_of_closed_forms(run: sw.Run) -> None:
    """With the flow stress of the run, its dissipation by its plastic strain.

    The closed forms are static, and leave out hardening and the stored energy, a tenth of the work.
    """
    history, frame = run.history, run.fields[-1]
    volume = 2.0 * pi * RADIUS * WALL * LENGTH
    stress = history["dissipation"][-1] / (frame["plastic_strain"].mean() * volume)
    assert 800e6 < stress < 1200e6
    force = history["work_external"][-1] / TRAVEL
    assert force == pytest.approx(1.16 * alexander(stress), rel=0.05)
    assert force == pytest.approx(0.91 * abramowicz_jones(stress), rel=0.05)
