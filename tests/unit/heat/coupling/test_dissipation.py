"""Dissipation of the material heats: adiabatic plastic and viscous work, exactly."""

import numpy as np
import pytest

import softway as sw
from softway.bodies import Driven, Fixed, Thermal
from softway.meshes.generators.shapes import box, rectangle

RHO, C = 2.0, 0.5
LAW = sw.heat.Conduction(conductivity=1e-12, capacity=C)
PLASTIC = sw.laws.J2(E=100.0, nu=0.3, yield_stress=1.0)
VISCOUS = sw.laws.Kelvin(E=10.0, nu=0.3, shear_viscosity=5.0)


def squeezed(material: object, dim: int, dilatation: str, **given: object) -> list[sw.Step]:
    """A block squeezed by a tenth within a second, without inertia; its regions are its lower and its upper half."""
    mesh = rectangle((1.0, 1.0), (2, 2)) if dim == 2 else box((1.0, 1.0, 1.0), (1, 1, 2))
    half = mesh.points[:, -1].max() / 2.0
    mesh = mesh.with_region("low", lambda x: x[:, -1] < half).with_region("high", lambda x: x[:, -1] > half)
    top, low = ("y", "bottom") if dim == 2 else ("z", "bottom")
    supports = (
        Fixed(on=low, components=top),
        Fixed(on="left", components="x"),
        *((Fixed(on="front", components="y"),) if dim == 3 else ()),
        Driven(on="top", components=top, velocity=-0.1),
    )
    thermal = Thermal(law=LAW, temperature=300.0, **given)
    body = sw.Solid(
        mesh=mesh, material=material, density=RHO, supports=supports, dilatation=dilatation, thermal=thermal
    )
    scene = sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off())
    return list(sw.march(scene, until=1.0, step=0.1))


@pytest.mark.parametrize(("dim", "dilatation"), [(2, "mean"), (3, "point")])
@pytest.mark.parametrize(
    ("material", "given", "share"),
    [(PLASTIC, {}, 0.9), (PLASTIC, {"heating": 0.5}, 0.5), (VISCOUS, {}, 1.0)],
    ids=["plastic", "half", "viscous"],
)
def test_a_block_is_heated_by_its_dissipation(
    material: object, given: dict[str, float], share: float, dim: int, dilatation: str
) -> None:
    *_, last = squeezed(material, dim, dilatation, **given)
    ledger, rise = last.ledger, last.after.fields["temperature"]["b"] - 300.0
    assert ledger.dissipation > 1e-3
    np.testing.assert_allclose(rise, share * ledger.dissipation / (RHO * C), rtol=1e-10)
    assert ledger.heat.received == pytest.approx(share * ledger.dissipation, rel=1e-12)
    assert ledger.heat.cold_work == pytest.approx((1.0 - share) * ledger.dissipation, abs=1e-14)
    assert ledger.heat.entropy == pytest.approx(RHO * C * float(np.log(1.0 + rise[0, 0] / 300.0)), rel=1e-9)


def test_each_region_heats_by_its_own_law() -> None:
    laws = {"low": PLASTIC, "high": sw.LinearElastic(E=100.0, nu=0.3)}
    *_, last = squeezed(laws, 3, "point", expansion=1e-6)
    rise = last.after.fields["temperature"]["b"][:, 0] - 300.0
    assert rise[:4].min() > 0.01 and abs(rise[-4:]).max() < 0.1 * rise[:4].min()
    heat = last.ledger.heat
    assert heat.received + heat.cold_work == pytest.approx(last.ledger.dissipation, rel=1e-12)
    assert abs(heat.error) < 1e-12 * heat.received


def test_without_heating_the_temperature_stays() -> None:
    *_, last = squeezed(PLASTIC, 2, "mean", heating=0.0)
    assert (last.after.fields["temperature"]["b"] == 300.0).all() and last.ledger.heat.received == 0.0
    assert last.ledger.dissipation > 1e-3
    assert last.ledger.heat.cold_work == pytest.approx(last.ledger.dissipation, rel=1e-12)
