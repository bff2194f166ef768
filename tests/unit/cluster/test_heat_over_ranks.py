"""Heat of solids over ranks: conduction, loads, contacts, plastic heating and expansion, with equal bits."""

from collections.abc import Callable

import numpy as np
import pytest
from over_ranks import GIVEN, over, require_equal

import softway as sw
from softway.bodies import Thermal
from softway.heat.coupled.build import build
from softway.model.model import Model

PLASTIC = {"E": 1e4, "nu": 0.3, "yield_stress": 40.0}
SOFT = sw.laws.JohnsonCookSoftening(reference=250.0, melting=700.0, exponent=1.5)
PLAIN = sw.meshes.Rectangle(size=(1.0, 0.6), cells=(3, 2), origin=(0.1, 0.62))
HALVES = PLAIN.build().with_region("core", lambda x: x[:, 0] < 0.4).with_region("skin", lambda x: x[:, 0] > 0.4)
LOADS = (
    sw.heat.Convection(on="block.top", coefficient=30.0, ambient=290.0),
    sw.heat.HeatFlux(on="block.right", value=40.0),
    sw.heat.HeatSource(of="bed", value=100.0),
    sw.heat.Temperature(on="bed.left", value=310.0),
)


def thermal(temperature: float, conductivity: float = 50.0, **more: object) -> Thermal:
    """Heat of a body."""
    law = sw.heat.Conduction(conductivity=conductivity, capacity=5.0)
    return Thermal(law=law, temperature=temperature, **more)


HOT, COLD = thermal(500.0), thermal(300.0)


def struck(
    material: object = sw.J2(**PLASTIC),
    mesh: object = PLAIN,
    hot: Thermal | None = HOT,
    cold: Thermal = COLD,
    loads: tuple[object, ...] = LOADS,
    method: object = None,
) -> Model:
    """Hot block thrown aslant at a cold bed, which stands above an inclined tool with a temperature."""
    block = sw.Solid(
        mesh=mesh, material=material, density=1.0, velocity=sw.bodies.Uniform(value=(0.5, -5.0)), thermal=hot
    )
    bed = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.3, 0.6), cells=(4, 2)),
        material=sw.NeoHookean(E=2e4, nu=0.3),
        density=1.0,
        thermal=cold,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.05, 1.0)))
    across = None if hot is None else sw.heat.ContactHeat(conductance=100.0)
    onto = sw.heat.ContactHeat(conductance=80.0, tool_temperature=290.0)
    contacts = (
        sw.Contact(between=("block.bottom", "bed.top"), friction=sw.Coulomb(mu=0.2), heat=across, method=method),
        sw.Contact(between=("bed.bottom", "floor"), friction=sw.Coulomb(mu=0.2), heat=onto),
    )
    return build(sw.Scene(bodies={"block": block, "bed": bed, "floor": floor}, contacts=contacts, loads=loads))


CASES: dict[str, Callable[[], Model]] = {
    "plastic, with all loads": struck,
    "nodes on facets": lambda: struck(method=sw.contact.NodeToSurface()),
    "softening": lambda: struck(material=sw.J2(**PLASTIC, softening=SOFT)),
    "strongly coupled nodes": lambda: struck(hot=thermal(500.0, 5e4), cold=thermal(300.0, 5e4)),
    "expansion": lambda: struck(hot=thermal(500.0, expansion=1e-5)),
    "several materials": lambda: struck(
        material={"core": sw.J2(**PLASTIC), "skin": sw.NeoHookean(E=3e4, nu=0.3)}, mesh=HALVES
    ),
    "one of two bodies": lambda: struck(hot=None, loads=LOADS[2:]),
}


FIRST, *REST = CASES


@pytest.mark.parametrize("name", [FIRST, *(pytest.param(name, marks=pytest.mark.slow) for name in REST)])
def test_heat_has_the_same_bits_on_any_number_of_ranks_and_is_that_of_one_process(name: str) -> None:
    model = CASES[name]()
    ours = require_equal(model)
    theirs = list(sw.march(model, until=GIVEN.until, step=GIVEN.step, method=GIVEN.method))
    assert len(ours) == len(theirs)
    assert {e.kind for step in ours for e in step.events} >= {"touch"}
    for mine, other in zip(ours, theirs, strict=True):
        heat, known = mine.ledger.heat, other.ledger.heat
        assert heat is not None and known is not None
        assert abs(heat.error) < 1e-13 * heat.content * len(ours)
        assert abs(mine.certificate.energy_error) < 1e-11 * 7.5
        for quantity in ("content", "brought", "received", "friction", "cold_work", "entropy"):
            assert getattr(heat, quantity) == pytest.approx(getattr(known, quantity), abs=1e-10)
        assert heat.through == pytest.approx(known.through, abs=1e-9)
        for body, values in mine.after.fields["temperature"].items():
            assert values == pytest.approx(other.after.fields["temperature"][body], abs=1e-9)
            assert mine.after.displacement[body] == pytest.approx(other.after.displacement[body], abs=1e-11)
    last = ours[-1].ledger.heat
    assert last is not None
    assert (last.friction > 0.0) == (last.cold_work > 0.0) == ("one of" not in name)


def test_a_cosine_decays_as_its_mode_does() -> None:
    """Body at rest, insulated: the temperature of the mesh's lowest mode falls by the factor of Crank and Nicolson.

    With lumped capacity the mode cos(pi x / L) of n cells has the rate ``4 k sin^2(pi / 2 n) / (rho c h^2)``.
    """
    n, k, h = 8, 50.0, 5e-4
    law = sw.heat.Conduction(conductivity=k, capacity=5.0)
    bar = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.25), cells=(n, 2)),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        thermal=Thermal(law=law, temperature=lambda x: 300.0 + np.cos(np.pi * x[:, 0])),
    )
    model = build(sw.Scene(bodies={"bar": bar}))
    found = over(2, model)
    rate = 4.0 * k * np.sin(np.pi / (2 * n)) ** 2 / (5.0 / n**2)
    half = 0.5 * h * rate
    sizes = [np.ptp(step.after.fields["temperature"]["bar"]) for step in found]
    ratios = np.array(sizes[1:]) / np.array(sizes[:-1])
    assert ratios == pytest.approx((1.0 - half) / (1.0 + half), abs=1e-10)
