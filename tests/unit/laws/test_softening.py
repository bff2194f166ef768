"""Laws at a temperature: the factor of the flow stress and of the viscosity, moduli, bounds, and what is refused."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pytest

from softway.arrays import Array
from softway.errors import InputError
from softway.laws.bulk import J2, NortonHoff
from softway.laws.kernel_laws import compiled_rate
from softway.laws.law import Increment, Response
from softway.laws.objective_rates import Rate
from softway.laws.plasticity.deviator import deviator, equivalent_stress
from softway.laws.plasticity.hardening import LinearHardening, PowerHardening, Voce
from softway.laws.plasticity.rate_dependence import JohnsonCook, Perzyna
from softway.laws.plasticity.softening import Arrhenius, JohnsonCookSoftening, Softening, SofteningTable
from softway.testing import check_law
from softway.units import Kelvin

STEEL = {"E": 2.1e11, "nu": 0.3, "yield_stress": 2e8}
COOK = JohnsonCookSoftening(reference=300.0, melting=1800.0, exponent=0.55)
TABLE = SofteningTable(temperatures=(200.0, 300.0, 900.0), values=(1.2, 1.0, 0.4))
HARD = {"hardening": PowerHardening(modulus=4e8, exponent=0.3), "flow": JohnsonCook(C=0.02)}


@dataclass(frozen=True, slots=True, kw_only=True)
class At:
    """A law at one temperature [K]."""

    law: J2 | NortonHoff
    temperature: Kelvin

    @property
    def rate(self) -> Rate:
        return self.law.rate

    def virgin(self, points: int) -> Mapping[str, Array]:
        return self.law.virgin(points)

    def _warm(self, increment: Increment) -> Increment:
        return replace(increment, temperature=np.full(increment.strain.shape[:-2], self.temperature))

    def respond(self, increment: Increment) -> Response:
        return self.law.respond(self._warm(increment))

    def moduli(self, increment: Increment) -> Array:
        return self.law.moduli(self._warm(increment))

    def elastic_moduli(self) -> Array:
        return self.law.elastic_moduli()


@pytest.mark.few(3)
@pytest.mark.parametrize(
    "law",
    [
        J2(**STEEL, **HARD, softening=COOK),
        J2(**STEEL, hardening=Voce(saturation=4e8, exponent=12.0), kinematic=2e9, softening=TABLE),
        J2(**STEEL, flow=Perzyna(drag=1e8, reference=10.0, exponent=3.0), softening=COOK),
    ],
    ids=["Johnson-Cook", "table", "Perzyna"],
)
def test_a_warm_law_passes(law: J2) -> None:
    check_law(At(law=law, temperature=700.0))


def pulled(law: J2 | NortonHoff, temperature: float | None, size: float = 0.2) -> Response:
    """A long uniaxial pull in a fiftieth of a second."""
    strain = size * np.diag([1.0, -0.5, -0.5])[None]
    warm = None if temperature is None else np.array([temperature])
    given = Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=strain, span=0.02, temperature=warm)
    return law.respond(given)


def mises(response: Response) -> float:
    return float(equivalent_stress(deviator(response.stress))[0])


@pytest.mark.parametrize("temperature", [100.0, 300.0, 450.0, 1000.0, 1799.0])
def test_the_three_factors_of_johnson_and_cook(temperature: float) -> None:
    response = pulled(J2(**STEEL, **HARD, softening=COOK), temperature)
    p = float(response.memory["plastic_strain"][0])
    warm = max(temperature - 300.0, 0.0) / 1500.0
    flow = (2e8 + 4e8 * p**0.3) * (1.0 + 0.02 * np.log(p / 0.02)) * (1.0 - warm**0.55)
    assert mises(response) == pytest.approx(flow, rel=1e-9)
    assert response.dissipated[0] == pytest.approx(flow * p, rel=1e-9)


def test_molten_matter_has_no_strength() -> None:
    for temperature in (1800.0, 5000.0):
        response = pulled(J2(**STEEL, **HARD, softening=COOK), temperature)
        assert mises(response) < 1e-12 * STEEL["yield_stress"] and abs(response.dissipated[0]) < 1e-6
        assert response.memory["plastic_strain"][0] == pytest.approx(0.2, rel=1e-12)


@pytest.mark.parametrize(
    ("softening", "temperature", "factor"),
    [(TABLE, 600.0, 0.7), (TABLE, 100.0, 1.2), (Arrhenius(activation=3000.0, reference=1000.0), 1500.0, np.exp(-1.0))],
)
def test_a_factor_of_the_viscosity(softening: Softening, temperature: float, factor: float) -> None:
    plain = NortonHoff(K=5e7, m=0.2)
    law = replace(plain, softening=softening)
    given = Increment(
        stress=np.zeros((1, 3, 3)), memory={}, strain=np.diag([0.1, -0.05, -0.02])[None], span=0.1,
        temperature=np.array([temperature]),
    )  # fmt: skip
    cold, warm = plain.respond(given), law.respond(given)
    np.testing.assert_allclose(warm.viscous, factor * cold.viscous, rtol=1e-12)
    np.testing.assert_allclose(law.viscous_moduli(given), factor * plain.viscous_moduli(given), rtol=1e-12)
    assert warm.dissipated[0] == pytest.approx(factor * cold.dissipated[0], rel=1e-12)


def test_without_a_temperature_it_is_that_of_the_reference() -> None:
    plain, soft = J2(**STEEL, **HARD), J2(**STEEL, **HARD, softening=COOK)
    for one, other in ((pulled(plain, None), pulled(soft, None)), (pulled(plain, 900.0), pulled(soft, 300.0))):
        np.testing.assert_array_equal(one.stress, other.stress)
        np.testing.assert_array_equal(one.memory["plastic_strain"], other.memory["plastic_strain"])


def test_laws_without_softening_keep_their_kernels() -> None:
    assert compiled_rate(J2(**STEEL)) is not None
    assert compiled_rate(J2(**STEEL, softening=COOK)) is None


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: JohnsonCookSoftening(reference=300.0, melting=300.0), "melting"),
        (lambda: JohnsonCookSoftening(reference=300.0, melting=np.inf), "melting"),
        (lambda: JohnsonCookSoftening(reference=0.0, melting=300.0), "reference"),
        (lambda: JohnsonCookSoftening(reference=300.0, melting=400.0, exponent=0.0), "exponent"),
        (lambda: Arrhenius(activation=-1.0, reference=300.0), "activation"),
        (lambda: Arrhenius(activation=1.0, reference=0.0), "reference"),
        (
            lambda: J2(E=1.0, nu=0.0, yield_stress=1.0, hardening=LinearHardening(modulus=-1.3), softening=TABLE),
            "hardening",
        ),
    ],
)
def test_bad_parameters_are_named(make, name: str) -> None:
    with pytest.raises(InputError) as found:
        make()
    assert found.value.where == name


def test_a_falling_slope_counts_with_its_greatest_factor() -> None:
    J2(E=1.0, nu=0.0, yield_stress=1.0, hardening=LinearHardening(modulus=-1.2), softening=TABLE)
    J2(E=1.0, nu=0.0, yield_stress=1.0, hardening=LinearHardening(modulus=-1.3), softening=COOK)
