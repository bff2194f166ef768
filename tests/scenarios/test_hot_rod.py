"""The rod of ``taylor_bar_hot``, held on the wall as by two other codes, and in contact: shape, strain and temperature.

Pantale (2020), DynELA finite element code, manual, axisymmetric Taylor impact: 5 x 50 cells, foot held on the wall.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import softway as sw
from softway.model.model import Model
from variants import whole

pytestmark = pytest.mark.minutes

DYNELA, ABAQUS = (26.52, 11.15, 582.34, 1.78), (26.56, 11.16, 590.96, 1.81)
"""Length and diameter of the foot [mm], temperature [degrees Celsius] and plastic strain of the cell at its centre."""


@dataclass(frozen=True)
class Shot:
    """Steps of a march, and the model."""

    model: Model
    steps: list[sw.Step]

    @property
    def places(self) -> np.ndarray:
        """Places (n, 2) of the nodes at the end [mm]."""
        return 1e3 * (self.model.points + self.steps[-1].after.displacement["rod"])

    @property
    def temperature(self) -> np.ndarray:
        """Temperatures (n,) of the nodes at the end [degrees Celsius]."""
        return self.steps[-1].after.fields["temperature"]["rod"][:, 0] - 273.15


def shot(held: bool, step: float) -> Shot:
    scenario = whole("taylor_bar_hot")
    rod, contacts = scenario.bodies["rod"], scenario.contacts
    if held:
        rod, contacts = replace(rod, supports=(*rod.supports, sw.Fixed(on="bottom", components="y"))), ()
    model = sw.build(sw.Scene(bodies={**scenario.bodies, "rod": rod}, contacts=contacts))
    return Shot(model, list(sw.march(model, until=80e-6, step=step, method=scenario.solver)))


def test_the_held_rod_ends_as_in_two_other_codes() -> None:
    found = shot(held=True, step=0.25e-6)
    x, memory = found.places, found.steps[-1].after.memory["rod"]
    strain, spent = (a.reshape(250, -1)[0].mean() for a in (memory.law["plastic_strain"], memory.dissipated))
    ours = np.ptp(x[:, 1]), 2.0 * x[:, 0].max(), 20.0 + 0.9 * spent / (7830.0 * 460.0), strain
    assert found.temperature.max() == pytest.approx(ours[2], rel=0.01)
    for theirs in (DYNELA, ABAQUS):
        for mine, wanted, tolerance in zip(ours, theirs, (0.003, 0.015, 0.03, 0.03), strict=True):
            assert mine == pytest.approx(wanted, rel=tolerance)


def test_the_rod_in_contact_keeps_the_laws_of_heat() -> None:
    found = shot(held=False, step=0.4e-6)
    ledgers = [s.ledger for s in found.steps]
    energy = 0.5 * 7830.0 * np.pi * 3.2e-3**2 * 32.4e-3 * 287.0**2
    assert max(abs(one.energy_error) for one in ledgers) < 1e-9 * energy
    assert abs(ledgers[-1].heat.error) < 1e-12 * ledgers[-1].heat.received
    assert min(one.heat.produced for one in ledgers) > 0.0
    spent = ledgers[-1].dissipation
    assert ledgers[-1].heat.received == pytest.approx(0.9 * spent, rel=1e-9) and 0.98 * energy < spent < energy
    assert np.ptp(found.places[:, 1]) == pytest.approx(26.5, rel=0.003)
    assert 590.0 < found.temperature.max() < 660.0
    assert found.temperature[found.model.points[:, 1] > 20e-3].max() < 40.0
