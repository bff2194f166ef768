"""B03: a cylinder on a rigid plane, Hertz's line contact in plane strain, from nodal forces without regularisation."""

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.contact.b03_cylinder_on_plane import HERTZ, LOAD, MODULUS, pressed
from softway.apps.verify.exact.contact import LineContact
from softway.apps.verify.scenes.pressing import Footprint, approached
from softway.meshes.generators.recipes import GradedDisc


@pytest.fixture(scope="module")
def contact() -> Footprint:
    """Ten elements across b."""
    return pressed(10)


def test_case():
    assert results.missed("B03") == set()


def test_the_peak_and_the_half_width(contact):
    """The case allows 3 and 10 percent."""
    peak, width = contact.fitted
    assert peak == pytest.approx(HERTZ.peak, rel=0.005)
    assert contact.pressure[0] == pytest.approx(HERTZ.peak, rel=0.005)
    assert width == pytest.approx(HERTZ.half_width, rel=0.005)
    inside, outside = contact.edge
    assert inside <= 1.003 * HERTZ.half_width <= outside


def test_the_forces_bear_the_load(contact):
    """The case allows 1e-8."""
    assert 2.0 * contact.force.sum() == pytest.approx(LOAD, rel=1e-10)


def test_the_pressure_is_that_of_hertz_at_every_node(contact):
    """No oscillation: nodal values miss the ellipse by parts of a percent, by 5 percent at the last two nodes."""
    missed = (contact.pressure - HERTZ.pressure(contact.place)) / HERTZ.peak
    inner = contact.place < 0.85 * HERTZ.half_width
    assert np.abs(missed[inner]).max() < 0.006
    assert np.abs(missed).max() < 0.08
    assert (np.diff(contact.pressure[contact.closed]) < 0.0).all()


@pytest.mark.slow
def test_the_remaining_error_is_the_finite_radius_of_the_cylinder():
    """On a finer mesh the peak stays 0.29 percent below Hertz's, b^2/(4 R^2); at a quarter of the load a quarter."""
    missed = [
        1.0 - pressed(20, load=load).fitted[0] / LineContact(load=load, radius=1.0, modulus=MODULUS).peak
        for load in (LOAD, 0.25 * LOAD)
    ]
    assert missed[0] == pytest.approx(0.25 * HERTZ.half_width**2, rel=0.1)
    assert missed[1] == pytest.approx(0.25 * missed[0], rel=0.25)


def test_quadratic_cells():
    """Five of them across b; forces of middles and corners make one smooth pressure."""
    contact = pressed(5, "quad9")
    peak, width = contact.fitted
    assert 2.0 * contact.force.sum() == pytest.approx(LOAD, rel=1e-10)
    assert peak == pytest.approx(HERTZ.peak, rel=0.01)
    assert width == pytest.approx(HERTZ.half_width, rel=0.03)


@pytest.mark.parametrize("approach", [0.0025, 0.01])
def test_the_compression_of_the_whole_cylinder(approach):
    """The centre approaches the plane as in a cylinder between two planes, Johnson's formula."""
    mesh = GradedDisc(radius=1.0, focus=3.2 * approach**0.5 * 0.3, cells=12, part="quarter")
    force = 2.0 * approached(approach, mesh, sw.bodies.PlaneStrain()).force.sum()
    exact = LineContact(load=force, radius=1.0, modulus=MODULUS).compression()
    assert exact == pytest.approx(approach, rel=1e-3)
