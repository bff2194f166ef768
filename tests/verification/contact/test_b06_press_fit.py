"""B06: the press fit of two rings in plane stress, pressed apart before the march, against Lame."""

import numpy as np
import pytest

import results
import softway as sw
from softway.apps.verify.cases.contact import b06_press_fit
from softway.apps.verify.cases.contact.b06_press_fit import EXACT, FITS, MIDDLE, SIDES, Fitted, rings, tube


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
@pytest.mark.few(3)
def test_they_stay_at_rest(fitted):
    """A march from the fit, of slabs in which a wave crosses two cells, moves nothing.

    The coordinates are rounded to 3e-18 m, the energy therefore to that times the forces, 4e6 N on the whole rings.
    """
    steps = list(sw.march(fitted.model, until=5e-6, step=5e-7))
    strain = steps[0].ledger.energy_strain
    assert max(s.ledger.energy_kinetic for s in steps) <= 1e-20 * strain
    assert max(abs(s.ledger.energy_error) for s in steps) <= 1e-12 * strain
    assert steps[-1].ledger.contacts["fit"].force_n == pytest.approx(fitted.start.pressure.sum(), rel=1e-9)


CELLS = {"quad4": 0.01, "tri3": 0.01, "quad8": 0.002, "quad9": 0.002, "tri6": 0.002}
"""Error of the mean pressure by the cells of the rings."""


@pytest.mark.slow
@pytest.mark.few(8)
@pytest.mark.parametrize("facets", [(40, 32), (32, 40), (20, 32)])
@pytest.mark.parametrize("cell", CELLS)
def test_rings_whose_meshes_do_not_match(cell, facets):
    """Chords of the circle differ by up to 30 um, three times the interference; the curved surfaces do not."""
    uneven = Fitted.of(rings(facets, cell))
    for name in SIDES:
        force, length = uneven.force(name)
        assert force.sum() / length.sum() == pytest.approx(EXACT.pressure, rel=CELLS[cell])
        assert force.min() > 0.0
