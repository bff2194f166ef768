"""Solids with a temperature on meshes that change: first law, entropy, friction heat, and the finest mesh."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from adapting import adaptive_march
from passing import finest, keeps_its_balances

import softway as sw
from softway.errors import InputError
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.generators.shapes import disc, rectangle

LEVELS = 3
ADAPT = Adapt(levels=LEVELS, smooth=0.0, tolerance=1.0, buffer=1, contact_cells=2)
ELASTIC = sw.NeoHookean(E=1.0, nu=0.3)
PLASTIC = sw.J2(E=1.0, nu=0.3, yield_stress=0.01, hardening=sw.laws.LinearHardening(modulus=0.1))
CONSTANT = sw.heat.Conduction(conductivity=1e-3, capacity=1.0)
CURVED = sw.heat.Conduction(
    conductivity=1e-3, capacity=sw.heat.TemperatureTable(temperatures=(290.0, 310.0), values=(1.0, 2.0))
)
STIFFNESS = sw.heat.StiffnessTable(temperatures=(290.0, 310.0), values=(1.0, 0.8))


def thrown(law: object, heat: object, expansion: float = 1e-4, cell: str = "tri3", **given: object) -> sw.Scene:
    """A disc, hot at its top, that slides on a hot floor after a fall."""
    hot = lambda x: 300.0 + 4.0 * x[:, 1]  # noqa: E731
    thermal = sw.bodies.Thermal(law=heat, temperature=hot, expansion=expansion, **given)  # type: ignore[arg-type]
    body = sw.Solid(
        mesh=disc(0.5, 4, cell=cell), material=law, density=1.0, velocity=sw.bodies.Uniform(value=(0.05, -0.1)),
        thermal=thermal,
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.505), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("body.boundary", "floor"), friction=sw.laws.Coulomb(mu=0.2))
    return sw.Scene(bodies={"body": body, "floor": floor}, contacts=(contact,))


def keeps_its_heat(steps: Sequence[sw.Step]) -> None:
    """Energy with the heat, and the content, are in the account to rounding; changes of meshes lower no entropy."""
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        old, new = last.ledger.heat, taken.ledger.heat
        assert old is not None
        assert new is not None
        assert abs(new.error) < 1e-12 * new.content
        assert new.entropy - new.produced >= old.entropy - 1e-13


CASES = {
    "expands": (ELASTIC, CONSTANT, {}),
    "plastic": (PLASTIC, CONSTANT, {}),
    "plastic quadrilaterals": (PLASTIC, CONSTANT, {"cell": "quad4"}),
    "softening quadrilaterals": (ELASTIC, CURVED, {"cell": "quad4", "stiffness": STIFFNESS}),
    "softens": (ELASTIC, CONSTANT, {"stiffness": STIFFNESS}),
    "capacity by temperature": (ELASTIC, CURVED, {}),
}
ALL = ("plastic", "softening quadrilaterals")
"""Cases that have together what the others have one by one; these are for minutes."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    [
        pytest.param(
            case, id=name, marks=[] if name in ("plastic", "softening quadrilaterals") else pytest.mark.minutes
        )
        for name, case in CASES.items()
    ],
)
def test_first_and_second_law(case: tuple[object, object, dict[str, object]]) -> None:
    law, heat, given = case
    scene = thrown(law, heat, **given)  # type: ignore[arg-type]
    levels = 4 if "cell" in given else LEVELS
    steps = list(adaptive_march(scene, {"body": replace(ADAPT, levels=levels)}, until=1.6, step=0.05))
    assert keeps_its_balances(steps) > (0 if "cell" in given else 2)
    keeps_its_heat(steps)
    *_, fine = sw.march(finest(scene, levels, "body"), until=1.6, step=0.05)
    one, other = steps[-1].ledger.heat, fine.ledger.heat
    assert one is not None
    assert other is not None
    assert one.received == pytest.approx(other.received, rel=0.02, abs=1e-6)
    temperature, exact = (s.after.fields["temperature"]["body"] for s in (steps[-1], fine))
    assert np.ptp(temperature) == pytest.approx(np.ptp(exact), rel=0.02)


@pytest.mark.slow
def test_friction_heats_two_solids_of_which_one_changes() -> None:
    thermal = sw.bodies.Thermal(law=CONSTANT, temperature=300.0)
    ball = sw.Solid(
        mesh=disc(0.5, 4, cell="tri3"), material=ELASTIC, density=1.0, velocity=sw.bodies.Uniform(value=(0.1, -0.1)),
        thermal=thermal,
    )  # fmt: skip
    mesh = rectangle((1.0, 0.5), (6, 3), cell="quad4", origin=(-0.5, -1.005))
    block = sw.Solid(mesh=mesh, material=ELASTIC, density=2.0, thermal=replace(thermal, temperature=310.0))
    contact = sw.Contact(
        between=("ball.boundary", "block.top"), friction=sw.laws.Coulomb(mu=0.2),
        heat=sw.heat.ContactHeat(conductance=0.1),
    )  # fmt: skip
    scene = sw.Scene(bodies={"ball": ball, "block": block}, contacts=(contact,))
    steps = list(adaptive_march(scene, {"ball": replace(ADAPT, levels=4)}, until=1.2, step=0.05))
    assert keeps_its_balances(steps) > 1
    keeps_its_heat(steps)
    *_, fine = sw.march(finest(scene, 4, "ball"), until=1.2, step=0.05)
    one, other = steps[-1].ledger.heat, fine.ledger.heat
    assert one is not None
    assert other is not None
    assert one.friction == pytest.approx(other.friction, rel=0.03)
    assert one.through == pytest.approx(other.through, rel=0.03)


def test_capacities_of_several_regions_that_depend_on_the_temperature_are_refused() -> None:
    disc_ = thrown(ELASTIC, CURVED).bodies["body"]
    assert isinstance(disc_, sw.Solid)
    mesh = (
        disc(0.5, 4, cell="tri3")
        .with_region("low", lambda x: x[:, 1] < 0.0)
        .with_region("high", lambda x: x[:, 1] > 0.0)
    )
    thermal = sw.bodies.Thermal(law={"low": CURVED, "high": CONSTANT}, temperature=300.0)
    scene = replace(thrown(ELASTIC, CONSTANT), bodies={"body": replace(disc_, mesh=mesh, thermal=thermal)}, contacts=())
    with pytest.raises(InputError) as refusal:
        next(adaptive_march(scene, {"body": ADAPT}, until=0.1, step=0.05))
    assert refusal.value.where == "bodies.body.thermal.law"
    assert refusal.value.remedy
