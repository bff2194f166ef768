"""B06: the press fit of two rings in plane stress, pressed apart before the march, against Lame.

Facets are straight: two polygons on one circle differ by more than the interference, 6 um at 32 facets on a quarter.
Meshes that do not match have a common polygon here, on which some facets of the one are two of the other.
"""

from dataclasses import replace

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.contact import b06_press_fit
from softway.apps.verify.cases.contact.b06_press_fit import EXACT, FITS, MIDDLE, QUARTER, SIDES, Fitted, rings, tube


@pytest.fixture(scope="module", params=FITS)
def fitted(request: pytest.FixtureRequest) -> Fitted:
    """The rings of the case."""
    return b06_press_fit.fitted(request.param)


def test_case():
    assert results.missed("B06") == set()


@pytest.mark.parametrize("name", SIDES)
def test_the_pressure_is_lames_and_uniform(fitted, name):
    """The case allows 1 percent for the pressure and 2 for its uniformity over the nodes."""
    pressure = fitted.pressure(name)
    assert pressure.mean() == pytest.approx(EXACT.pressure, rel=0.002)
    assert np.ptp(pressure) <= 0.02 * EXACT.pressure


@pytest.mark.parametrize("name", SIDES)
def test_the_rings_move_and_are_stressed_as_lames(fitted, name):
    """The hoop stress jumps from -52.5 to 52.5 MPa at the contact."""
    exact = tube(name)
    assert fitted.displacement(name) == pytest.approx(float(exact.displacement(MIDDLE)), rel=0.002)
    radius, radial, hoop = fitted.stress(name)
    expected = exact.stress(radius)
    assert radial == pytest.approx(expected[0], abs=0.02 * EXACT.pressure)
    assert hoop == pytest.approx(expected[1], abs=0.02 * EXACT.pressure)


@pytest.mark.slow
def test_they_stay_at_rest(fitted):
    """A march from the fit, of slabs in which a wave crosses two cells, moves nothing.

    The coordinates are rounded to 3e-18 m, the energy therefore to that times the forces, 4e6 N on the whole rings.
    """
    steps = list(sw.march(fitted.model, until=5e-6, step=5e-7))
    strain = steps[0].ledger.energy_strain
    assert max(s.ledger.energy_kinetic for s in steps) <= 1e-20 * strain
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-12 * strain
    assert steps[-1].ledger.contacts["fit"].force_n == pytest.approx(fitted.start.pressure.sum(), rel=1e-9)


def test_the_pressure_error_of_polygons_on_one_circle():
    """32 and 40 facets on the circle: the mean radius of a polygon is short by two thirds of its sagitta, and what one
    lacks more than the other is missing of the interference.  The pressure is uneven by 120 MPa, whatever the
    interference: it is four times the pressure of the case, where part of the nodes would be open.
    """
    sagitta = [MIDDLE * (1.0 - np.cos(QUARTER / (2.0 * n))) for n in (32, 40)]
    lost = 2.0 / 3.0 * (sagitta[0] - sagitta[1])
    for fit in (5e-5, 1e-4):
        uneven = Fitted.of(rings((32, 40), fit=fit))
        expected = replace(EXACT, interference=fit - lost).pressure
        for name in SIDES:
            force, length = uneven.force(name)
            assert force.sum() / length.sum() == pytest.approx(expected, rel=0.006)
            assert np.ptp(force / length) == pytest.approx(2.0 * 120e6, rel=0.04)
