"""Laws with a history against closed forms: plastic flow, rate dependence, relaxation, creep, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from softway.arrays import Array
from softway.errors import InputError
from softway.laws.bulk import J2, Hypoelastic, Kelvin, Maxwell, NortonHoff
from softway.laws.law import Increment, RateLaw, Response
from softway.laws.plasticity.deviator import deviator, equivalent_strain, equivalent_stress
from softway.laws.plasticity.hardening import LinearHardening, PowerHardening, Voce
from softway.laws.plasticity.rate_dependence import JohnsonCook, NortonFlow, Perzyna

E, NU, YIELD = 200.0, 0.25, 1.0
SHEAR = E / (2.0 * (1.0 + NU))
SIDES = np.array([[1.0, 0.4, 0.0], [0.4, -0.7, 0.2], [0.0, 0.2, -0.3]])
"""A deviator, direction of strains."""
SLIP = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])


def walked(law: RateLaw, strains: list[Array], span: float = 1.0) -> list[Response]:
    """Answers of one point to increments of strain."""
    given = Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=np.zeros((1, 3, 3)), span=span)
    found = []
    for strain in strains:
        found.append(law.respond(replace(given, strain=strain[None])))
        given = replace(given, stress=found[-1].stress, memory=found[-1].memory)
    return found


def mises(response: Response) -> float:
    """Equivalent stress of the one point."""
    return float(equivalent_stress(deviator(response.stress))[0])


def slipped(law: RateLaw, gamma: float, steps: int, span: float = 1.0) -> list[Response]:
    """Shear by gamma (twice the tensor's component) in equal steps of so long."""
    return walked(law, [0.5 * gamma / steps * SLIP] * steps, span)


@pytest.mark.parametrize("kinematic", [0.0, 7.0])
@pytest.mark.parametrize("modulus", [0.0, 5.0, -3.0])
def test_the_gain_of_linear_hardening(modulus: float, kinematic: float) -> None:
    """``x = (trial - yield)/(3 mu + H_iso + H_kin)``, the direction that of the trial stress."""
    law = J2(E=E, nu=NU, yield_stress=YIELD, hardening=LinearHardening(modulus=modulus), kinematic=kinematic)
    strain = 0.02 * SIDES + 0.01 * np.eye(3)
    (response,) = walked(law, [strain])
    trial = 2.0 * SHEAR * 0.02 * SIDES
    norm = float(equivalent_stress(trial))
    gain = (norm - YIELD) / (3.0 * SHEAR + modulus + kinematic)
    assert response.memory["plastic_strain"][0] == pytest.approx(gain, rel=1e-13)
    flow = 1.5 * gain * trial / norm
    bulk = E / (3.0 * (1.0 - 2.0 * NU))
    np.testing.assert_allclose(response.stress[0], trial - 2.0 * SHEAR * flow + 0.03 * bulk * np.eye(3), rtol=1e-12)
    assert response.dissipated[0] > 0.0
    if kinematic:
        np.testing.assert_allclose(response.memory["back_stress"][0], 2.0 / 3.0 * kinematic * flow, rtol=1e-12)


@pytest.mark.parametrize(
    "hardening",
    [
        LinearHardening(modulus=5.0),
        Voce(saturation=2.0, exponent=30.0, modulus=1.0),
        PowerHardening(modulus=2.0, exponent=0.3),
    ],
)
def test_the_stress_is_on_the_yield_surface(hardening) -> None:
    """In proportional loading the curve of hardening comes back, whatever the steps."""
    law = J2(E=E, nu=NU, yield_stress=YIELD, hardening=hardening)
    for steps in (1, 7):
        last = walked(law, [0.1 / steps * SIDES] * steps)[-1]
        p = last.memory["plastic_strain"]
        assert mises(last) == pytest.approx(float(hardening.stress(YIELD, p)[0]), rel=1e-12)
        elastic = mises(last) / (3.0 * SHEAR)
        assert p[0] + elastic == pytest.approx(0.1 * float(equivalent_strain(SIDES)), rel=1e-12)


def test_johnson_and_cook() -> None:
    """``(A + B p^n)(1 + C ln rate)`` at the rate of the plastic strain; none below the reference rate."""
    law = J2(
        E=E, nu=NU, yield_stress=YIELD, hardening=PowerHardening(modulus=2.0, exponent=0.5), flow=JohnsonCook(C=0.1)
    )
    for span, fast in ((1e-3, True), (10.0, False)):
        (response,) = walked(law, [0.1 * SIDES], span)
        p = response.memory["plastic_strain"][0]
        factor = 1.0 + 0.1 * np.log(p / span) if fast else 1.0
        assert mises(response) == pytest.approx((YIELD + 2.0 * np.sqrt(p)) * factor, rel=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 3.0, 20.0])
def test_the_scalar_equation_of_perzyna(exponent: float) -> None:
    law = J2(
        E=E,
        nu=NU,
        yield_stress=YIELD,
        hardening=LinearHardening(modulus=5.0),
        flow=Perzyna(drag=0.5, reference=2.0, exponent=exponent),
    )
    (response,) = walked(law, [0.02 * SIDES], 0.1)
    norm = float(equivalent_stress(2.0 * SHEAR * 0.02 * SIDES))

    def missing(x: float) -> float:
        return norm - 3.0 * SHEAR * x - (YIELD + 5.0 * x + 0.5 * (x / 0.1 / 2.0) ** (1.0 / exponent))

    assert response.memory["plastic_strain"][0] == pytest.approx(brentq(missing, 0.0, norm, xtol=1e-16), rel=1e-10)


def test_perzyna_tends_to_plasticity() -> None:
    """A reference rate that grows, or slabs that do; and for a great exponent the overstress is the drag."""
    plain = mises(walked(J2(E=E, nu=NU, yield_stress=YIELD), [0.02 * SIDES])[0])
    for scale in (1e3, 1e6):
        flow = Perzyna(drag=0.5, reference=scale, exponent=1.0)
        fast = mises(walked(J2(E=E, nu=NU, yield_stress=YIELD, flow=flow), [0.02 * SIDES])[0])
        assert fast == pytest.approx(plain, rel=0.05 / scale)
    steep = Perzyna(drag=0.5, reference=1.0, exponent=1e4)
    law = J2(E=E, nu=NU, yield_stress=YIELD, flow=steep)
    assert mises(walked(law, [0.02 * SIDES])[0]) == pytest.approx(plain + 0.5, rel=1e-3)


def test_the_stress_of_norton_relaxes() -> None:
    """``s' = -3 mu rate(s)`` at rest: ``s^(1-n) = s0^(1-n) + (n - 1) 3 mu k^-n t`` with ``n = 1/m``."""
    K, m, start = 2.0, 0.25, 3.0
    law = J2(E=E, nu=NU, yield_stress=0.0, flow=NortonFlow(K=K, m=m))
    n, k = 1.0 / m, np.sqrt(3.0) ** (m + 1.0) * K
    stress = start / np.sqrt(3.0) * SLIP[None]
    until, errors = 0.1, []
    for steps in (100, 200):
        given = Increment(stress=stress, memory=law.virgin(1), strain=np.zeros((1, 3, 3)), span=until / steps)
        for _ in range(steps):
            response = law.respond(given)
            given = replace(given, stress=response.stress, memory=response.memory)
        exact = (start ** (1.0 - n) + (n - 1.0) * 3.0 * SHEAR * k**-n * until) ** (1.0 / (1.0 - n))
        errors.append(abs(mises(response) - exact))
    assert exact < 0.7 * start
    assert errors[1] < 5e-3 * exact
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.05)  # backward Euler


def test_norton_and_hoff() -> None:
    """``s_eq = sqrt(3) K (sqrt(3) d)^m``, dissipation ``(m + 1)`` times the potential; m = 0 would be von Mises."""
    for m in (1.0, 0.2, 1e-6):
        law = NortonHoff(K=2.0, m=m)
        (response,) = walked(law, [0.3 * SIDES], 0.1)
        d = 3.0 * float(equivalent_strain(SIDES))
        assert mises(response) == pytest.approx(np.sqrt(3.0) * 2.0 * (np.sqrt(3.0) * d) ** m, rel=1e-9)
        potential = 2.0 / (m + 1.0) * (np.sqrt(3.0) * d) ** (m + 1.0)
        assert response.dissipated[0] == pytest.approx(0.1 * (m + 1.0) * potential, rel=1e-9)


def test_the_loop_of_kinematic_hardening() -> None:
    """Bauschinger: after flow to p, flow back begins when the stress has come down by twice the yield stress."""
    law = J2(E=E, nu=NU, yield_stress=YIELD, kinematic=20.0)
    there = slipped(law, 0.1, 10)
    gain = there[-1].memory["plastic_strain"][0]
    top = mises(there[-1])
    assert top == pytest.approx(YIELD + 20.0 * gain, rel=1e-12)
    step = 2.0 * YIELD / np.sqrt(3.0) / SHEAR
    back = walked(law, [0.01 / 2.0 * SLIP] * 10 + [-0.4999 * step * SLIP, -1e-3 * step * SLIP])
    assert back[-2].memory["plastic_strain"][0] == gain
    assert back[-1].memory["plastic_strain"][0] > gain
    assert mises(back[-2]) == pytest.approx(abs(top - 0.9998 * 2.0 * YIELD), rel=1e-9)
    loop = walked(law, [0.005 * SLIP] * 20 + [-0.005 * SLIP] * 20 + [0.005 * SLIP] * 20)
    assert loop[-1].stress[0, 0, 1] == pytest.approx(loop[19].stress[0, 0, 1], rel=1e-12)  # no hardening is left


def test_the_branches_of_maxwell() -> None:
    """Relaxation modulus, and the steady stress ``2 eta d`` of a constant rate, both exact for any slab."""
    law = Maxwell(E=E, nu=NU, shares=(0.3, 0.5), times=(0.2, 2.0))
    sudden, rest = 0.01 * SIDES, np.zeros((3, 3))
    given = Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=sudden[None], span=1e-12)
    first = law.respond(given)
    for spans in ([1.3], [0.1, 0.7, 0.5]):
        response = first
        for span in spans:
            still = Increment(stress=response.stress, memory=response.memory, strain=rest[None], span=span)
            response = law.respond(still)
        modulus = SHEAR * (0.2 + 0.3 * np.exp(-1.3 / 0.2) + 0.5 * np.exp(-1.3 / 2.0))
        np.testing.assert_allclose(response.stress[0], 2.0 * modulus * sudden, rtol=1e-9)
    fluid = Maxwell(E=E, nu=NU, shares=(1.0,), times=(0.2,))
    last = walked(fluid, [0.01 * SIDES] * 40, 0.1)[-1]
    np.testing.assert_allclose(last.stress[0], 2.0 * (SHEAR * 0.2) * 0.1 * SIDES, rtol=1e-8)


def test_what_maxwell_stores_and_dissipates_is_the_work() -> None:
    """To rounding, in one long slab after a short one."""
    law = Maxwell(E=E, nu=NU, shares=(1.0,), times=(0.2,))
    fine = walked(law, [0.001 * SIDES] * 400, 1e-3)
    work = sum(float(np.sum(0.5 * (a.stress + b.stress) * 0.001 * SIDES)) for a, b in zip(fine, fine[1:], strict=False))
    work += float(np.sum(0.5 * fine[0].stress * 0.001 * SIDES))
    taken = sum(float(r.stored[0] + r.dissipated[0]) for r in fine)
    assert taken == pytest.approx(work, rel=1e-5)
    whole = walked(law, [0.4 * SIDES], 0.4)[0]
    assert float(whole.stored[0] + whole.dissipated[0]) == pytest.approx(taken, rel=1e-12)


def test_kelvin_creeps() -> None:
    """Under a constant shear stress ``gamma = s/mu (1 - exp(-mu t/eta))``; the error falls with the step."""
    eta, pull, until = 30.0, 0.5, 0.4
    law = Kelvin(E=E, nu=NU, shear_viscosity=eta)
    exact = pull / SHEAR * (1.0 - np.exp(-SHEAR * until / eta))
    errors = []
    for steps in (100, 200):
        h, gamma, memory = until / steps, 0.0, law.virgin(1)
        for _ in range(steps):
            step = (pull - memory["elastic_stress"][0, 0, 1]) / (SHEAR + eta / h)  # what keeps the stress
            given = Increment(stress=np.zeros((1, 3, 3)), memory=memory, strain=0.5 * step * SLIP[None], span=h)
            response = law.respond(given)
            assert response.stress[0, 0, 1] == pytest.approx(pull, rel=1e-12)
            gamma, memory = gamma + step, response.memory
        errors.append(abs(gamma - exact))
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.05)
    assert errors[1] < 5e-3 * exact


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: Hypoelastic(E=-1.0), "E"),
        (lambda: Hypoelastic(E=1.0, nu=0.6), "nu"),
        (lambda: J2(E=1.0, nu=0.3, yield_stress=-1.0), "yield_stress"),
        (lambda: J2(E=1.0, nu=0.3, yield_stress=0.0), "yield_stress"),
        (lambda: J2(E=1.0, nu=0.3, yield_stress=1.0, kinematic=-1.0), "kinematic"),
        (lambda: J2(E=1.0, nu=0.3, yield_stress=1.0, hardening=LinearHardening(modulus=-2.0)), "hardening"),
        (lambda: Voce(saturation=1.0, exponent=0.0), "exponent"),
        (lambda: PowerHardening(modulus=-1.0, exponent=0.5), "modulus"),
        (lambda: PowerHardening(modulus=1.0, exponent=1.5), "exponent"),
        (lambda: Perzyna(drag=-1.0, reference=1.0), "drag"),
        (lambda: Perzyna(drag=1.0, reference=0.0), "reference"),
        (lambda: Perzyna(drag=1.0, reference=1.0, exponent=0.5), "exponent"),
        (lambda: JohnsonCook(C=-0.1), "C"),
        (lambda: JohnsonCook(C=0.1, reference=-1.0), "reference"),
        (lambda: NortonFlow(K=0.0, m=0.5), "K"),
        (lambda: NortonFlow(K=1.0, m=0.0), "m"),
        (lambda: NortonHoff(K=-1.0, m=0.5), "K"),
        (lambda: NortonHoff(K=1.0, m=2.0), "m"),
        (lambda: NortonHoff(K=1.0, m=0.5, bulk=0.0), "bulk"),
        (lambda: NortonHoff(K=1.0, m=0.5, still=0.0), "still"),
        (lambda: Kelvin(E=1.0, shear_viscosity=-1.0), "shear_viscosity"),
        (lambda: Kelvin(E=1.0, shear_viscosity=1.0, bulk_viscosity=-1.0), "bulk_viscosity"),
        (lambda: Maxwell(E=1.0, shares=(0.5,), times=()), "times"),
        (lambda: Maxwell(E=1.0, shares=(0.5, 0.6), times=(1.0, 2.0)), "shares"),
        (lambda: Maxwell(E=1.0, shares=(-0.5,), times=(1.0,)), "shares"),
        (lambda: Maxwell(E=1.0, shares=(0.5,), times=(0.0,)), "times"),
    ],
)  # fmt: skip
def test_bad_parameters_are_named(make, name: str) -> None:
    with pytest.raises(InputError) as refused:
        make()
    assert refused.value.where == name
