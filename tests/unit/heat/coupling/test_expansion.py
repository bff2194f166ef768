"""Thermal expansion against exact solutions: free and clamped bodies, the adiabatic modulus, order in time."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies import Axisymmetric, Fixed, PlaneStrain, PlaneStress, Thermal
from softway.heat.coupled.build import build
from softway.heat.heat_balance import logarithmic_mean
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.scenario.scenario import Scenario, Time

E, NU, ALPHA, THETA, RHO, C = 3.0, 0.25, 1e-4, 300.0, 2.0, 0.5
LAW = sw.heat.Conduction(conductivity=0.1, capacity=C)
HEAT = Thermal(law=LAW, temperature=THETA, expansion=ALPHA)
LINEAR, LOGARITHMIC = sw.LinearElastic(E=E, nu=NU), sw.laws.Hencky(E=E, nu=NU)


def heated(body: sw.Solid, rise: float, inertia: object = sw.bodies.Off(), steps: int = 4) -> list[sw.Step]:
    """A body whose temperature rises uniformly within one second."""
    source = sw.heat.HeatSource(of="b", value=RHO * C * rise)
    scene = sw.Scene(bodies={"b": body}, loads=(source,), inertia=inertia)
    return list(sw.march(scene, until=1.0, step=1.0 / steps))


def block(dim: int, section: object, material: object, cell: str, dilatation: str = "point") -> sw.Solid:
    mesh = rectangle((2.0, 1.0), (2, 2), cell=cell) if dim == 2 else box((2.0, 1.0, 1.0), (2, 1, 1), cell=cell)
    sides = ("left", "bottom") if dim == 2 else ("left", "front", "bottom")
    supports = tuple(Fixed(on=side, components=letter) for side, letter in zip(sides, "xyz", strict=False))
    return sw.Solid(
        mesh=mesh, material=material, density=RHO, section=section, supports=supports, dilatation=dilatation,
        thermal=HEAT,
    )  # fmt: skip


FREE = {
    "plate": (2, PlaneStress(), LINEAR, "quad4", 1.0),
    "strain": (2, PlaneStrain(), LINEAR, "tri3", 1.0 + NU),
    "ring": (2, Axisymmetric(), LINEAR, "quad4", 1.0),
    "block": (3, None, LINEAR, "hex8", 1.0),
    "tetrahedra": (3, None, LINEAR, "tet4", 1.0),
}


@pytest.mark.parametrize("kind", FREE)
def test_a_free_body_expands_without_stress(kind: str) -> None:
    dim, section, material, cell, factor = FREE[kind]
    body = block(dim, section, material, cell)
    *_, last = heated(body, 50.0)
    rise = last.after.fields["temperature"]["b"] - THETA
    assert np.ptp(rise) < 1e-10 and 49.9 < rise[0, 0] < 50.0
    np.testing.assert_allclose(last.after.displacement["b"], factor * ALPHA * rise * body.mesh.points, atol=1e-11)
    assert np.abs(last.reactions["b"]).max() < 1e-11


@pytest.mark.parametrize("kind", ["plate", "ring", "tetrahedra", "logarithmic", "bar", "clamped"])
def test_the_recorded_stress_contains_that_of_the_temperature(kind: str) -> None:
    """None in a free body, and that of the strain which supports suppress."""
    if kind in ("bar", "clamped"):
        supports = (Fixed(on="left"), Fixed(on="right"))[: 1 + (kind == "clamped")]
        mesh, material = interval(1.0, cells=2), LINEAR
        body = sw.Solid(mesh=mesh, material=material, density=RHO, supports=supports, thermal=HEAT)
    else:
        dim, section, material, cell, _ = FREE.get(kind, (3, None, LOGARITHMIC, "hex8", 1.0))
        body = block(dim, section, material, cell)
    load = sw.heat.HeatSource(of="b", value=RHO * C * 50.0)
    time = Time(end=1.0, step=0.5)
    run = sw.run(Scenario(bodies={"b": body}, loads=(load,), inertia=sw.bodies.Off(), time=time))
    stress, rise = run.fields[-1].stress, run.fields[-1]["temperature"].mean() - THETA
    expected = -E * ALPHA * rise if kind == "clamped" else 0.0
    np.testing.assert_allclose(stress[:, 0], expected, atol=1e-10)
    np.testing.assert_allclose(stress[:, 1:], 0.0, atol=1e-10)


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("law", ["linear", "strong"])
def test_plane_strain_holds_the_expansion_out_of_the_plane(law: str, clamped: bool) -> None:
    """Along the held axes ``-E e`` of one and ``-E e / (1 - nu)`` of two, and von Mises the same in both cases."""
    laws = {"linear": LINEAR, "strong": sw.laws.J2(E=E, nu=NU, yield_stress=1.0)}
    body = block(2, PlaneStrain(), laws[law], "quad4")
    if clamped:
        body = replace(body, supports=(*body.supports, Fixed(on="right", components="x")))
    load = sw.heat.HeatSource(of="b", value=RHO * C * 50.0)
    run = sw.run(Scenario(bodies={"b": body}, loads=(load,), inertia=sw.bodies.Off(), time=Time(end=1.0, step=0.5)))
    frame = run.fields[-1]
    held = E * ALPHA * (frame["temperature"].mean() - THETA) / (1.0 - NU if clamped else 1.0)
    expected = [-held if clamped else 0.0, 0.0, -held, 0.0, 0.0, 0.0]
    small = 1e-9 if law == "linear" else 0.02 * held  # Cauchy stress of finite strains
    np.testing.assert_allclose(frame.stress, np.tile(expected, (len(frame.stress), 1)), atol=small)
    np.testing.assert_allclose(frame.von_mises, held, atol=small)


def test_a_free_body_has_the_heat_capacity_at_constant_pressure() -> None:
    """It is greater by ``9 kappa alpha^2 theta``, the heat that the strain takes."""
    *_, last = heated(block(3, None, LINEAR, "hex8"), 50.0)
    rise, kappa = last.after.fields["temperature"]["b"][0, 0] - THETA, E / (3.0 * (1.0 - 2.0 * NU))
    heat = RHO * C * rise + 9.0 * kappa * ALPHA**2 * 0.5 * ((THETA + rise) ** 2 - THETA**2)
    assert heat == pytest.approx(RHO * C * 50.0, rel=1e-8)
    assert last.ledger.heat.brought == pytest.approx(2.0 * RHO * C * 50.0, rel=1e-13)


@pytest.mark.parametrize("dilatation", ["point", "mean"])
@pytest.mark.parametrize("dim", [2, 3])
def test_logarithmic_strain_expands_by_the_exponential(dim: int, dilatation: str) -> None:
    body = block(dim, None, LOGARITHMIC, "quad4" if dim == 2 else "hex8", dilatation)
    *_, last = heated(body, 50.0)
    rise = last.after.fields["temperature"]["b"] - THETA
    stretch = np.exp((1.0 if dim == 3 else 1.0 + NU) * ALPHA * rise)
    np.testing.assert_allclose(last.after.displacement["b"], (stretch - 1.0) * body.mesh.points, atol=1e-11)


def test_a_clamped_bar_has_the_exact_stress() -> None:
    ends = (Fixed(on="left"), Fixed(on="right"))
    mesh = interval(1.0, cells=4)
    body = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=E, nu=NU), density=RHO, supports=ends, thermal=HEAT)
    steps = heated(body, 50.0, sw.bodies.Full(), steps=8)
    for k, step in enumerate(steps):
        assert step.after.fields["temperature"]["b"] == pytest.approx(THETA + 50.0 * (k + 1) / 8, rel=1e-13)
        assert np.abs(step.after.displacement["b"]).max() < 1e-15
        ends = np.array([THETA + 50.0 * k / 8, THETA + 50.0 * (k + 1) / 8])
        mean = float(logarithmic_mean(ends[0], ends[1]))
        if k:
            assert step.reactions["b"][-1, 0] == pytest.approx(-E * ALPHA * (mean - THETA), rel=1e-11)
    assert steps[-1].ledger.energy_strain == pytest.approx(0.0, abs=1e-14)
    assert steps[-1].ledger.heat.brought == pytest.approx(RHO * C * 50.0, rel=1e-13)


@pytest.mark.parametrize("material", [LINEAR, LOGARITHMIC])
def test_a_static_start_has_the_thermal_expansion(material: object) -> None:
    body = replace(block(2, PlaneStress(), material, "quad4"), thermal=replace(HEAT, reference=THETA - 50.0))
    scene = sw.Scene(bodies={"b": body}, start=sw.model.StaticStart())
    first, *rest = steps = list(sw.march(scene, until=5.0, step=0.25))
    assert len(steps) == 20 and max(step.report.iterations for step in steps) < 12
    grown = ALPHA * 50.0 if material is LINEAR else np.expm1(ALPHA * 50.0)
    np.testing.assert_allclose(first.before.displacement["b"], grown * body.mesh.points, atol=1e-14)
    assert np.abs(rest[-1].after.velocity["b"]).max() < 1e-13


def test_massless_nodes_start_in_equilibrium_with_the_thermal_stress() -> None:
    """The bar is hotter than without stress: its node of contact, without inertia, begins where that is balanced."""
    hot = Thermal(law=LAW, temperature=THETA + 50.0, expansion=ALPHA, reference=THETA)
    body = sw.Solid(mesh=interval(1.0, cells=5), material=LOGARITHMIC, density=RHO, thermal=hot)
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.1, normal=-1.0))
    scene = sw.Scene(bodies={"b": body, "wall": wall}, contacts=(sw.Contact(between=("b.right", "wall")),))
    steps = list(sw.march(scene, until=2.0, step=0.1))
    assert len(steps) == 20 and not any(step.report.rejections for step in steps)
    whole = [s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content for s in steps]
    assert np.ptp(whole) < 1e-12 * max(s.ledger.energy_kinetic for s in steps) + 1e-14 * max(whole)


def mode(cells: int) -> float:
    """Error of the free end of a bar in its first adiabatic mode, relative to the amplitude."""
    alpha, size, law = 0.02, 1e-6, sw.heat.Conduction(conductivity=1e-12, capacity=C)
    heat = Thermal(law=law, temperature=THETA, expansion=alpha)
    frequency = 0.5 * np.pi * np.sqrt((E + (E * alpha) ** 2 * THETA / (RHO * C)) / RHO)
    body = sw.Solid(
        mesh=interval(1.0, cells=cells), material=sw.LinearElastic(E=E, nu=0.0), density=RHO, thermal=heat,
        supports=(Fixed(on="left"),), velocity=lambda x: size * frequency * np.sin(0.5 * np.pi * x),
    )  # fmt: skip
    steps = list(sw.march(sw.Scene(bodies={"b": body}), until=2.0, step=0.2 / cells))
    found = np.array([s.after.displacement["b"][-1, 0] for s in steps])
    return float(np.abs(found / size - np.sin(frequency * np.array([s.after.time for s in steps]))).max())


@pytest.mark.slow
def test_a_bar_without_conduction_has_the_adiabatic_modulus() -> None:
    coarse, fine = mode(6), mode(12)
    assert fine < 5e-3
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.2)


def smooth(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and temperature of a bar that vibrates and conducts, after ``count`` slabs."""
    heat = Thermal(law=LAW, temperature=lambda x: THETA + 20.0 * np.cos(np.pi * x[:, 0]), expansion=0.01)
    body = sw.Solid(
        mesh=interval(1.0, cells=6), material=LOGARITHMIC, density=RHO, thermal=heat, supports=(Fixed(on="left"),),
        velocity=lambda x: 0.05 * np.sin(0.5 * np.pi * x),
    )  # fmt: skip
    *_, last = sw.march(sw.Scene(bodies={"b": body}), until=1.0, step=1.0 / count)
    return last.after.displacement["b"], last.after.fields["temperature"]["b"]


@pytest.mark.slow
def test_motion_and_temperature_are_of_second_order_in_time() -> None:
    reference, coarse, fine = smooth(320), smooth(40), smooth(80)
    for exact, one, two in zip(reference, coarse, fine, strict=True):
        assert np.log2(np.abs(one - exact).max() / np.abs(two - exact).max()) == pytest.approx(2.0, abs=0.25)


def test_the_heat_of_all_loads_is_in_the_ledger() -> None:
    loads = (
        sw.heat.Temperature(on="b.left", value=1.0, ramp=sw.bodies.Ramp(times=(0.0, 0.3), factors=(310.0, 350.0))),
        sw.heat.Convection(on="b.right", coefficient=2.0, ambient=280.0),
        sw.heat.Radiation(on="b.top", emissivity=0.9, ambient=900.0),
        sw.bodies.Gravity(acceleration=(0.0, -1.0)),
    )
    scene = sw.Scene(bodies={"b": block(2, PlaneStrain(), LOGARITHMIC, "quad4")}, loads=loads)
    steps = list(sw.march(build(scene), until=0.6, step=0.05))
    last = steps[-1].ledger
    assert any(abs(s.slab.end - 0.3) < 1e-12 for s in steps)
    assert max(abs(s.ledger.heat.error) for s in steps) < 1e-11 * last.heat.brought
    whole = last.energy_kinetic + last.energy_strain + last.heat.content - last.work_external - last.heat.brought
    first = steps[0].ledger
    start = first.energy_kinetic + first.energy_strain + first.heat.content - first.work_external - first.heat.brought
    assert whole - start == pytest.approx(0.0, abs=1e-11 * last.heat.brought)
    assert steps[-1].after.fields["temperature"]["b"][0, 0] == pytest.approx(350.0)
