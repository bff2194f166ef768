"""Laws with a history on meshes that change: balances, dissipation, the limits of the law, and the finest mesh."""

import numpy as np
import pytest
from adapting import adaptive_march
from passing import finest, keeps_its_balances

import softway as sw
from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric
from softway.kernels.linalg import tensors
from softway.laws.plasticity.deviator import deviator, equivalent_stress
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.generators.shapes import disc, rectangle

LEVELS = 4
HARDENING = sw.laws.LinearHardening(modulus=0.1)
J2 = sw.J2(E=1.0, nu=0.3, yield_stress=0.01, hardening=HARDENING)
KELVIN = sw.laws.Kelvin(E=1.0, nu=0.3, shear_viscosity=0.05)
MAXWELL = sw.laws.Maxwell(E=1.0, nu=0.3, shares=(0.5,), times=(0.5,))
LAWS = {
    "J2": J2,
    "kinematic": sw.J2(E=1.0, nu=0.3, yield_stress=0.01, kinematic=0.1),
    "logarithmic": sw.J2(E=1.0, nu=0.3, yield_stress=0.01, hardening=HARDENING, rate=sw.laws.Logarithmic()),
    "viscoplastic": sw.J2(E=1.0, nu=0.3, yield_stress=5e-3, flow=sw.laws.Perzyna(drag=5e-3, reference=0.2)),
    "Kelvin": KELVIN,
    "Maxwell": MAXWELL,
    "regions": {"low": J2, "high": sw.NeoHookean(E=1.0, nu=0.3)},
    "viscous regions": {"low": KELVIN, "high": MAXWELL},
}


def thrown(law: object) -> sw.Scene:
    """A disc that hits a floor."""
    mesh = disc(0.5, 4, cell="tri3")
    mesh = mesh.with_region("low", lambda x: x[:, 1] < 0.0).with_region("high", lambda x: x[:, 1] > 0.0)
    body = sw.Solid(mesh=mesh, material=law, density=1.0, velocity=sw.bodies.Uniform(value=(0.0, -0.1)))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.505), normal=(0.0, 1.0)))
    return sw.Scene(bodies={"body": body, "floor": floor}, contacts=(sw.Contact(between=("body.boundary", "floor")),))


def adapted(scene: sw.Scene, until: float, step: float, adapt: Adapt) -> list[sw.Step]:
    return list(adaptive_march(scene, {"body": adapt}, until=until, step=step))


@pytest.mark.slow
@pytest.mark.few(3)
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_balances_and_dissipation(law: object) -> None:
    scene = thrown(law)
    steps = adapted(scene, 2.0, 0.05, Adapt(levels=LEVELS, smooth=0.0, tolerance=1.0, buffer=2, contact_cells=4))
    assert keeps_its_balances(steps) > 4
    *_, fine = sw.march(finest(scene, LEVELS, "body"), until=2.0, step=0.05)
    one, other = steps[-1].ledger, fine.ledger
    assert one.dissipation == pytest.approx(other.dissipation, rel=0.02)
    assert one.momentum[1] == pytest.approx(other.momentum[1], abs=0.02 * 0.1 * np.pi / 4)
    assert abs(one.remeshing) < 1e-12 * 0.004


def test_stresses_stay_within_the_yield_surface() -> None:
    steps = adapted(
        thrown(J2), 1.6, 0.05, Adapt(levels=LEVELS, smooth=0.0, tolerance=2.0, every=2, buffer=1, contact_cells=1)
    )
    changes = 0
    for taken in steps:
        state = taken.before.memory["body"]
        limit = J2.yield_stress + HARDENING.modulus * state.law["plastic_strain"]
        if taken.transfers:
            changes += 1
            assert (equivalent_stress(deviator(state.stress)) <= limit * (1.0 + 1e-9)).all()
        assert (tensors.double_dot(state.stress, state.stress) >= 0.0).all()
    assert changes > 4


def volumes(taken: sw.Step) -> Array:
    return taken.model.parts[0].internal.sampling.volume


def test_histories_keep_their_totals_but_for_the_contact() -> None:
    steps = adapted(
        thrown(J2), 1.6, 0.05, Adapt(levels=LEVELS, smooth=0.0, tolerance=2.0, every=2, buffer=1, contact_cells=1)
    )
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        old, new = last.after.memory["body"], taken.before.memory["body"]
        before, after = (float(volumes(s) @ m.law["plastic_strain"]) for s, m in ((last, old), (taken, new)))
        assert after == pytest.approx(before, rel=1e-3)
        assert float(volumes(taken) @ new.dissipated) >= float(volumes(last) @ old.dissipated) * (1.0 - 1e-12)


@pytest.mark.slow
def test_a_taylor_bar() -> None:
    law = sw.J2(E=117e9, nu=0.35, yield_stress=0.4e9, hardening=sw.laws.LinearHardening(modulus=0.1e9))
    mesh, levels = rectangle((0.0032, 0.0324), (2, 20), cell="tri3"), 2
    bar = sw.Solid(
        mesh=mesh, material=law, density=8930.0, velocity=sw.bodies.Uniform(value=(0.0, -150.0)),
        section=Axisymmetric(), supports=(sw.bodies.Fixed(on="left", components="x"),),
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1e-6), normal=(0.0, 1.0)))
    scene = sw.Scene(bodies={"body": bar, "wall": wall}, contacts=(sw.Contact(between=("body.bottom", "wall")),))
    steps = adapted(scene, 40e-6, 1e-7, Adapt(levels=levels, smooth=0.0, every=8, buffer=2, contact_cells=3))
    *_, fine = sw.march(finest(scene, levels, "body"), until=40e-6, step=1e-7)

    def length(step: sw.Step) -> float:
        return float(np.ptp((step.model.points + step.after.displacement["body"])[:, 1]))

    one, other = steps[-1], fine
    assert length(one) == pytest.approx(length(other), rel=1e-4)
    assert one.ledger.dissipation == pytest.approx(other.ledger.dissipation, rel=1e-4)
    assert keeps_its_balances(steps, around=True) > 20
    assert sum(taken.model.shape[0] for taken in steps) < 0.85 * 400 * other.model.shape[0]
