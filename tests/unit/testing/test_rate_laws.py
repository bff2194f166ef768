"""The examinations of laws with a history pass ours and name the mistakes of others."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pytest

from softway.arrays import Array
from softway.laws.bulk import J2, Hypoelastic, Kelvin, Maxwell, NortonHoff
from softway.laws.law import Increment, Response
from softway.laws.objective_rates import GreenNaghdi, Jaumann, Logarithmic, Rate, Truesdell
from softway.laws.plasticity.hardening import LinearHardening, PowerHardening, Voce
from softway.laws.plasticity.rate_dependence import JohnsonCook, NortonFlow, Perzyna
from softway.testing import check_law, examine_law
from softway.units import Pascal

STEEL = {"E": 2.1e11, "nu": 0.3, "yield_stress": 2.35e8}
RATES = [Jaumann(), Jaumann(increment="polar"), GreenNaghdi(), Logarithmic(), Truesdell()]
LAWS = [
    J2(**STEEL),
    J2(**STEEL, hardening=LinearHardening(modulus=1e9), kinematic=2e9),
    J2(**STEEL, hardening=Voce(saturation=4e8, exponent=12.0)),
    J2(**STEEL, hardening=PowerHardening(modulus=5e8, exponent=0.3), flow=JohnsonCook(C=0.02)),
    J2(**STEEL, flow=Perzyna(drag=1e8, reference=10.0, exponent=3.0)),
    J2(E=2.1e11, nu=0.3, yield_stress=0.0, flow=NortonFlow(K=1e8, m=0.2)),
    NortonHoff(K=1e8, m=0.1),
    NortonHoff(K=1e3, m=1.0),
    Kelvin(E=1e9, nu=0.3, shear_viscosity=1e5, bulk_viscosity=1e4),
    Maxwell(E=1e9, nu=0.4, shares=(0.3, 0.5), times=(1e-3, 1.0)),
]


@pytest.mark.few(3)
@pytest.mark.parametrize("law", LAWS, ids=str)
def test_our_laws_pass(law) -> None:
    check_law(law)


@pytest.mark.parametrize("rate", RATES, ids=str)
def test_in_every_rate(rate: Rate) -> None:
    check_law(Hypoelastic(E=2.0, nu=0.3, rate=rate))
    check_law(Kelvin(E=1e9, nu=0.3, shear_viscosity=1e5, rate=rate))


@dataclass(frozen=True, slots=True, kw_only=True)
class Altered:
    """Hooke's law and a dashpot, with one mistake."""

    E: Pascal = 1.0
    mistake: str = ""
    rate: Rate = Jaumann()

    def _law(self) -> Kelvin:
        return Kelvin(E=self.E, nu=0.2, shear_viscosity=0.5)

    def virgin(self, points: int) -> Mapping[str, Array]:
        return self._law().virgin(points)

    def respond(self, increment: Increment) -> Response:
        out = self._law().respond(increment)
        match self.mistake:
            case "negative":
                return replace(out, dissipated=-out.dissipated, stored=out.stored + 2.0 * out.dissipated)
            case "energy":
                return replace(out, stored=1.5 * out.stored)
            case "axes":
                stress = out.stress + 0.1 * increment.strain[..., :1, :1] * np.diag([1.0, 0.0, 0.0])
                return replace(out, stress=stress, memory={"elastic_stress": stress - out.viscous})
            case "creep":
                return replace(out, memory={"elastic_stress": out.memory["elastic_stress"] + 0.01 * np.eye(3)})
            case "forgetful":
                return replace(out, memory={})
            case "shape":
                return replace(out, stored=out.stored[..., None])
        return out

    def moduli(self, increment: Increment) -> Array:
        return self._law().moduli(increment) * (1.001 if self.mistake == "moduli" else 1.0)

    def elastic_moduli(self) -> Array:
        return self._law().elastic_moduli() * (1.01 if self.mistake == "elastic" else 1.0)


@pytest.mark.parametrize(
    ("mistake", "complaint"),
    [
        ("negative", "the dissipation of strain"),
        ("energy", "stored plus dissipated energy is not the work"),
        ("axes", "stress does not rotate with the body"),
        ("creep", "an instant of rest changes the stress|gained at rest|elastic moduli"),
        ("forgetful", "memory .*elastic_stress.* becomes"),
        ("shape", "stored of strains .4, 3, 3. has shape"),
        ("moduli", "moduli are not the derivative of the stress"),
        ("elastic", "does not follow the elastic moduli"),
    ],
)
def test_mistakes_are_named(mistake: str, complaint: str) -> None:
    complaints = [f.complaint for f in examine_law(Altered(mistake=mistake)) if not f.passed]

    assert any(re.search(complaint, c) for c in complaints), complaints


def test_without_a_mistake_it_passes() -> None:
    check_law(Altered())


def test_what_is_no_law_is_told_what_it_lacks() -> None:
    with pytest.raises(AssertionError, match="for a RateLaw it lacks rate, moduli"):
        check_law(Half())


class Half:
    """A beginning."""

    virgin = respond = elastic_moduli = None
