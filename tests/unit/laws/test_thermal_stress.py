"""Laws that flow limit the stress of a hindered expansion in bars and in plane stress: closed forms and both laws."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

import softway as sw
from softway.arrays import Array
from softway.bodies import Driven, Fixed, PlaneStress, Ramp, Thermal
from softway.heat.coupled.solid_temperature import temperatures_of
from softway.laws.law import Material
from softway.model.model import Model
from softway.record.storage.serialisation import packed, unpacked

START, EXPANSION, YIELD, NU = 320.0, 1e-5, 1.2e-3, 0.3
METAL = sw.J2(E=1.0, nu=NU, yield_stress=YIELD)
LINE = sw.heat.StiffnessTable(temperatures=(200.0, 800.0), values=(1.2, 0.2))
WEAKER = sw.laws.SofteningTable(temperatures=(320.0, 720.0), values=(1.0, 0.1))
UP_AND_DOWN = Ramp(times=(0.0, 1.9, 2.1, 4.0), factors=(1.0, 1.0, -1.0, -1.0))
BAR = sw.meshes.Interval(length=1.0, cells=2)
SQUARE = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2))
ENDS = (Fixed(on="left"), Fixed(on="right"))
X, Y = (
    tuple(Fixed(on=side, components=c) for side in sides) for c, sides in (("x", ("left", "right")), ("y", ("bottom",)))
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Heated:
    """A body after slabs: its free strains (slabs,), total stresses (slabs, cells, 3, 3) [Pa] and displacements."""

    strain: Array
    stress: Array
    displacement: Array
    steps: tuple[sw.Step, ...]

    @property
    def uniform(self) -> Array:
        """Stresses (slabs, 3, 3), the same in all cells."""
        assert np.ptp(self.stress, axis=1).max() < 1e-12
        return np.asarray(self.stress.mean(axis=1))


def heated(material: object, *, mesh: object = BAR, supports: object = ENDS, **given: object) -> Heated:
    """A body without inertia that is heated by 100 K/s without conduction, and cooled from 2 s on."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-12, capacity=1e3), temperature=START, expansion=EXPANSION, heating=0.0,
        stiffness=given.get("stiffness"),
    )  # fmt: skip
    body = sw.Solid(
        mesh=mesh, material=material, density=1.0, thermal=heat, supports=supports,
        section=PlaneStress() if mesh is SQUARE else None,
    )  # fmt: skip
    load = sw.heat.HeatSource(of="b", value=1e5, ramp=UP_AND_DOWN)
    scene = sw.Scene(bodies={"b": body}, loads=(load,), inertia=sw.bodies.Off())
    steps = tuple(sw.march(scene, until=given.get("end", 4.0), step=given.get("step", 0.25)))
    theta = np.array([step.after.fields["temperature"]["b"][:, 0] for step in steps])
    assert np.ptp(theta, axis=1).max() < 1e-7
    return Heated(
        strain=EXPANSION * (theta.mean(axis=1) - START), stress=np.array(list(total_stresses(sw.build(scene), steps))),
        displacement=np.array([step.after.displacement["b"] for step in steps]), steps=steps,
    )  # fmt: skip


def total_stresses(model: Model, steps: tuple[sw.Step, ...]) -> Iterator[Array]:
    """Stresses (cells, 3, 3) of the body with those of its temperature [Pa]."""
    (_, heat), *_ = temperatures_of(model.companions)
    for step in steps:
        u, state = step.after.displacement["b"], step.after.memory["b"]
        own = model.stress("b", u, state)
        yield own + heat.in_states((state,)).stress("b", len(own), step.after.fields["temperature"]["b"], u)


def driven(strain: Array, modulus: float, flow: Callable[[float], float], kinematic: float = 0.0) -> Array:
    """Stress of a point that yields at ``flow(p)`` along a strain that begins at zero: one-dimensional plasticity."""
    out, plastic, p = [], 0.0, 0.0

    def excess(x: float, trial: float) -> float:
        return abs(trial) - (modulus + kinematic) * x - flow(p + x)

    for e in strain:
        trial = modulus * (e - plastic) - kinematic * plastic
        if excess(0.0, trial) > 0.0:
            x = brentq(excess, 0.0, 1.0, args=(trial,), xtol=1e-18, rtol=1e-15)
            plastic, p = plastic + np.sign(trial) * x, p + x
        out.append(modulus * (e - plastic))
    return np.array(out)


VOCE = sw.laws.Voce(saturation=2e-3, exponent=900.0)
LAWS = {
    "perfect": (METAL, lambda p: YIELD, 0.0),
    "linear": (replace(METAL, hardening=sw.laws.LinearHardening(modulus=0.1)), lambda p: YIELD + 0.1 * p, 0.0),
    "falling": (replace(METAL, hardening=sw.laws.LinearHardening(modulus=-0.1)), lambda p: YIELD - 0.1 * p, 0.0),
    "kinematic": (replace(METAL, kinematic=0.1), lambda p: YIELD, 0.1),
    "Voce": (replace(METAL, hardening=VOCE), lambda p: float(VOCE.stress(YIELD, np.array(p))), 0.0),
    "Logarithmic": (replace(METAL, kinematic=0.1, rate=sw.laws.Logarithmic()), lambda p: YIELD, 0.1),
    "polar": (replace(METAL, rate=sw.laws.Jaumann(increment="polar")), lambda p: YIELD, 0.0),
}


@pytest.mark.parametrize("name", LAWS)
def test_a_clamped_bar_yields_by_its_thermal_stress(name: str) -> None:
    """``-E alpha (theta - theta_r)`` up to the yield stress; cooled, it keeps the exact residual stress."""
    law, flow, kinematic = LAWS[name]
    found = heated(law)
    stress, strain = found.uniform, found.strain
    np.testing.assert_allclose(stress[:, 0, 0], driven(-strain, 1.0, flow, kinematic), rtol=1e-9, atol=1e-12)
    assert abs(stress[:, 1:]).max() < 1e-14
    assert strain.max() > 1.5 * YIELD and abs(strain[-1]) < 1e-9 and stress[-1, 0, 0] > 3e-4
    if name == "linear":  # E H/(E + H) beyond the yield strain
        assert stress[6, 0, 0] == pytest.approx(-(YIELD + 0.1 / 1.1 * (strain[6] - YIELD)), rel=1e-9)


def test_a_clamped_plate_yields_along_both_axes() -> None:
    """``-E alpha (theta - theta_r)/(1 - nu)`` along both axes up to the yield stress."""
    found = heated(METAL, mesh=SQUARE, supports=(*X, *Y, Fixed(on="top", components="y")))
    expected = driven(-found.strain, 1.0 / (1.0 - NU), lambda p: YIELD)
    for k in (0, 1):
        np.testing.assert_allclose(found.uniform[:, k, k], expected, rtol=1e-9, atol=1e-12)
    assert abs(found.uniform[:, 2]).max() < 1e-14 and abs(found.uniform[:, 0, 1]).max() < 1e-14


def test_a_plate_clamped_along_one_axis_yields_as_a_bar() -> None:
    """To the size of the strains: the free axis is of other length."""
    found = heated(METAL, mesh=SQUARE, supports=(*X, *Y))
    expected = driven(-found.strain, 1.0, lambda p: YIELD)
    np.testing.assert_allclose(found.uniform[:, 0, 0], expected, atol=1e-3 * YIELD)
    assert abs(found.uniform[:, 1:]).max() < 1e-9 and expected[-1] > 0.5 * YIELD


FREE = {
    "plastic": METAL,
    "Maxwell": sw.laws.Maxwell(E=1.0, nu=NU, shares=(1.0,), times=(1.0,)),
    "Kelvin": sw.laws.Kelvin(E=1.0, nu=NU, shear_viscosity=0.1, bulk_viscosity=0.1),
}


@pytest.mark.parametrize("mesh", [BAR, SQUARE], ids=["bar", "plate"])
@pytest.mark.parametrize("law", FREE.values(), ids=FREE)
def test_a_free_body_expands_without_stress(law: Material, mesh: object) -> None:
    """By ``exp(e)``, without inelastic strain: heating does no work."""
    supports = (Fixed(on="left"),) if mesh is BAR else (X[0], *Y)
    found = heated(law, mesh=mesh, supports=supports, end=1.0)
    assert abs(found.stress).max() < 1e-9  # 1e-3 where it is clamped
    np.testing.assert_allclose(found.displacement.max(axis=(1, 2)), np.expm1(found.strain), rtol=1e-6)


def test_moduli_and_strength_that_depend_on_the_temperature_limit_it() -> None:
    """The least of ``m E alpha (theta - theta_r)`` and of the yield stress at the middle of the slab."""
    found = heated(replace(METAL, softening=WEAKER, yield_stress=6e-4), stiffness=LINE, end=1.75)
    theta = START + found.strain / EXPANSION
    elastic, flow = LINE.curve().at(theta) * found.strain, 6e-4 * WEAKER.at(theta - 12.5)
    np.testing.assert_allclose(-found.uniform[:, 0, 0], np.minimum(elastic, flow), rtol=1e-9)
    assert (flow < elastic).sum() > 2 and (elastic < flow).sum() > 1


def test_each_region_of_a_bar_has_its_own_limit() -> None:
    """A half that yields beside a stiffer one that does not: both have its yield stress, to the size of the strains."""
    halves = BAR.build().with_region("soft", lambda x: x[:, 0] < 0.5).with_region("hard", lambda x: x[:, 0] > 0.5)
    found = heated({"soft": METAL, "hard": sw.laws.Hencky(E=2.0, nu=NU)}, mesh=halves, end=2.0)
    limit = -np.minimum(found.strain * 4.0 / 3.0, YIELD)
    np.testing.assert_allclose(found.stress[:, :, 0, 0], np.stack([limit, limit], axis=1), rtol=1e-2)
    np.testing.assert_allclose(found.stress[-3:, 0, 0, 0], -YIELD, rtol=1e-9)
    assert limit[0] > -0.5 * YIELD


def test_a_rate_of_heating_is_a_rate_of_flow() -> None:
    """Norton and Hoff: ``sqrt(3)^(m+1) K (alpha rate)^m`` in a clamped bar, at once but for its compressibility."""
    stress = heated(sw.laws.NortonHoff(K=1.0, m=0.3), end=1.0).uniform[:, 0, 0]
    np.testing.assert_allclose(stress, -(np.sqrt(3.0) ** 1.3) * 1e-3**0.3, rtol=1e-3)
    assert stress[-1] == pytest.approx(-(np.sqrt(3.0) ** 1.3) * 1e-3**0.3, rel=1e-9)


def test_the_stress_of_a_clamped_bar_relaxes() -> None:
    """``exp(-t/t')`` with ``t' = t (3 kappa + mu)/(3 kappa)`` of a Maxwell fluid, with order two."""
    time = 1.0 + (1.0 - 2.0 * NU) / (2.0 * (1.0 + NU))
    errors = []
    for step in (0.2, 0.1):
        found = heated(FREE["Maxwell"], end=1.0, step=step)
        at = step * np.arange(1, len(found.strain) + 1)
        expected = EXPANSION * 100.0 * time * np.expm1(-at / time)
        errors.append(abs(found.uniform[:, 0, 0] - expected).max())
    assert errors[0] < 1e-6 and errors[0] / errors[1] == pytest.approx(4.0, abs=0.4)


def test_a_flow_takes_no_heat_of_expansion() -> None:
    """A bar that is pulled beyond its yield stress warms up by its plastic work at the capacity at constant stress."""
    expansion, theta0 = 1e-3, 300.0
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-12, capacity=1e-2), temperature=theta0, expansion=expansion, heating=1.0
    )  # fmt: skip
    law = sw.J2(E=1.0, nu=NU, yield_stress=YIELD)
    pull = Driven(on="right", velocity=1e-2)
    body = sw.Solid(mesh=BAR, material=law, density=1.0, thermal=heat, supports=(Fixed(on="left"), pull))
    steps = list(sw.march(sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off()), until=2.0, step=0.1))
    theta = np.array([step.after.fields["temperature"]["b"].mean() for step in steps])
    plastic = np.diff([step.after.memory["b"].dissipated.mean() for step in steps])
    capacity = 1e-2 + expansion**2 * 0.5 * (theta[1:] + theta[:-1])
    np.testing.assert_allclose((capacity * np.diff(theta))[9:], plastic[9:], rtol=5e-6)
    assert plastic.min() > 0.0


def test_a_bar_at_rest_yields_without_work() -> None:
    """With inertia, clamped, uniformly hot: nothing moves, and energy and entropy are exact."""
    heat = Thermal(law=sw.heat.Conduction(conductivity=1e-12, capacity=1e-3), temperature=START, expansion=EXPANSION)
    load = sw.heat.HeatSource(of="b", value=0.1)
    mesh = sw.meshes.Interval(length=1.0, cells=5).build()
    mesh = replace(mesh, points=mesh.points + 0.07 * np.sin(2.0 * np.pi * mesh.points))
    for table in (None, LINE):
        law = replace(METAL, kinematic=0.1)
        body = sw.Solid(
            mesh=mesh, material=law, density=1.0, thermal=replace(heat, stiffness=table), supports=ENDS,
        )  # fmt: skip
        steps = list(sw.march(sw.Scene(bodies={"b": body}, loads=(load,)), until=4.0, step=0.2))
        books = [step.ledger for step in steps]
        whole = [b.energy_strain + b.heat.content + b.heat.cold_work - b.heat.brought for b in books]
        assert np.ptp(whole) < 1e-12 * whole[0] and max(b.energy_kinetic for b in books) < 1e-28
        assert max(abs(b.energy_error) for b in books) < 1e-17 and min(b.heat.produced for b in books) > -1e-17
        assert len(steps) == 20 and max(step.report.iterations for step in steps) < 10
        assert table is not None or steps[-1].after.memory["b"].law["plastic_strain"].min() > 1e-3


IMPACTS = {
    "perfect": sw.J2(E=1.0, nu=NU, yield_stress=0.03),
    "hardening": sw.J2(
        E=1.0, nu=NU, yield_stress=0.03, kinematic=0.1, hardening=sw.laws.Voce(saturation=0.05, exponent=20.0)
    ),
    "weaker": sw.J2(E=1.0, nu=NU, yield_stress=0.04, softening=WEAKER),
    "Maxwell": sw.laws.Maxwell(E=1.0, nu=NU, shares=(0.7,), times=(0.5,)),
}


def thrown(law: Material, expansion: float, *, plate: bool = False) -> sw.Scene:
    """A body, hot at its far end, that hits a wall and yields; it conducts heat."""
    heat = Thermal(
        law=sw.heat.Conduction(conductivity=1e-4, capacity=1e-2), temperature=lambda x: 330.0 + 200.0 * x[:, 0],
        reference=START, expansion=expansion, heating=1.0,
    )  # fmt: skip
    mesh = sw.meshes.Rectangle(size=(1.0, 0.5), cells=(4, 2)) if plate else sw.meshes.Interval(length=1.0, cells=6)
    speed = (-0.1, 0.01) if plate else (-0.1,)
    body = sw.Solid(
        mesh=mesh, material=law, density=1.0, thermal=heat, velocity=lambda x: 0.0 * x + np.array(speed),
        section=PlaneStress() if plate else None,
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(-0.005, 0.0)[: len(speed)], normal=(1.0, 0.0)[: len(speed)]))
    return sw.Scene(bodies={"b": body, "wall": wall}, contacts=(sw.Contact(between=("b", "wall")),))


@cache
def flown(name: str, expansion: float, plate: bool) -> tuple[sw.Step, ...]:
    scene = thrown(IMPACTS[name], expansion, plate=plate)
    return tuple(sw.march(scene, until=1.2, step=0.06, method=sw.FixedPoint(tolerance=1e-13)))


@pytest.mark.slow
@pytest.mark.few(4)
@pytest.mark.parametrize("plate", [False, True], ids=["bar", "plate"])
@pytest.mark.parametrize("name", IMPACTS)
def test_an_impact_keeps_energy_and_entropy_never_falls(name: str, plate: bool) -> None:
    """In at most 1.2 times the iterations of a slab without expansion."""
    steps = flown(name, 5e-5, plate)
    books = [step.ledger for step in steps]
    energy = books[0].energy_kinetic + books[0].energy_strain
    whole = [b.energy_kinetic + b.energy_strain + b.heat.content + b.heat.cold_work for b in books]
    assert np.ptp(whole) < 1e-11 * energy
    assert max(abs(b.energy_error) for b in books) < 1e-12 * energy
    assert min(b.heat.produced for b in books) > 0.0
    spent = np.array([step.after.memory["b"].dissipated for step in steps])
    assert (np.diff(spent, axis=0) >= 0.0).all() and books[-1].dissipation > 0.1 * energy
    cold = flown(name, 0.0, plate)
    per_slab = [np.mean([step.report.iterations for step in found]) for found in (steps, cold)]
    assert per_slab[0] <= 1.2 * per_slab[1]
    assert cold[-1].after.memory["b"].eigenstrain is None


@pytest.mark.slow
def test_a_march_goes_on_with_the_same_bits() -> None:
    steps = flown("hardening", 5e-5, True)
    kept = unpacked(*packed(steps[9].march_state))
    scene = thrown(IMPACTS["hardening"], 5e-5, plate=True)
    *_, same = sw.march(scene, until=1.2, step=0.06, state=kept, method=sw.FixedPoint(tolerance=1e-13))
    mine = steps[-1]
    for name in ("displacement", "velocity"):
        np.testing.assert_array_equal(getattr(same.after, name)["b"], getattr(mine.after, name)["b"])
    for name in ("stress", "lateral", "eigenstrain", "unforeseen", "stored", "dissipated"):
        np.testing.assert_array_equal(getattr(same.after.memory["b"], name), getattr(mine.after.memory["b"], name))
    assert same.ledger.heat == mine.ledger.heat
