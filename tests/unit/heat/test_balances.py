"""Heat is kept: every kind of cell, every load, jumps, tables, continuation; and bounds of the temperature."""

import numpy as np
import pytest

import softway as sw
from softway.bodies import Axisymmetric, PlaneStrain, PlaneStress, Ramp
from softway.heat import march as heat_march
from softway.heat.build_heat import build_heat
from softway.heat.heat_model import HeatModel
from softway.meshes.generators.shapes import box, interval, rectangle

heat = sw.heat
UNIT = heat.Conduction(conductivity=1.0, capacity=2.0)
KINDS = ("bar2", "bar3", "tri3", "tri6", "quad4", "quad8", "quad9", "tet4", "tet10", "hex8", "hex20", "hex27")


def mesh_of(cell: str) -> sw.Mesh:
    match cell[:3]:
        case "bar":
            return interval(2.0, cells=3, cell=cell)
        case "tri" | "qua":
            return rectangle((2.0, 1.0), (3, 2), cell=cell)
        case _:
            return box((2.0, 1.0, 1.0), (2, 2, 2), cell=cell)


def steps(body: heat.Conductor, *loads: object, **given: object) -> list[heat.HeatStep]:
    return list(heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=loads), **given))


@pytest.mark.parametrize("cell", KINDS)
def test_a_linear_temperature_is_steady_in_every_cell(cell: str) -> None:
    mesh = mesh_of(cell)
    wanted = 300.0 + mesh.points @ np.array([3.0, 2.0, 1.0])[: mesh.dim]
    body = heat.Conductor(mesh=mesh, law=UNIT, density=3.0, temperature=wanted)
    model = build_heat(heat.HeatScene(bodies={"b": body}))
    assert model.mass.sum() == pytest.approx(3.0 * mesh_volume(mesh), rel=1e-13)
    assert (model.mass > 0.0).all()
    names = [("left", "right"), *([("bottom", "top")] if mesh.dim == 2 else [("front", "back"), ("bottom", "top")])]
    loads = [
        heat.HeatFlux(on=f"b.{side}", value=sign * gradient)
        for sides, gradient in zip(names[: mesh.dim], (3.0, 2.0, 1.0), strict=False)
        for side, sign in zip(sides, (-1.0, 1.0), strict=True)
    ]
    *_, last = steps(body, *loads, until=0.1, step=0.02)
    assert last.temperature["b"] == pytest.approx(wanted, abs=1e-9)


def mesh_volume(mesh: sw.Mesh) -> float:
    return float(np.prod(np.ptp(mesh.points, axis=0)))


@pytest.mark.parametrize("cell", KINDS)
def test_heat_that_comes_in_is_the_content_of_every_cell(cell: str) -> None:
    mesh = mesh_of(cell)
    body = heat.Conductor(mesh=mesh, law=UNIT, density=3.0, temperature=300.0)
    loads = (
        heat.HeatFlux(on="b.right", value=5.0, ramp=Ramp(times=(0.0, 0.3), factors=(0.0, 1.0))),
        heat.Convection(on="b", coefficient=2.0, ambient=310.0),
        heat.HeatSource(of="b", value=7.0),
        heat.Temperature(on="b.left", value=290.0),
    )
    found = steps(body, *loads, until=0.5, step=0.05)
    assert found[-1].ledger.relative_error < 1e-12
    assert sum(found[-1].ledger.by_load) == pytest.approx(found[-1].ledger.heat_in - found[-1].ledger.heat_out)
    assert found[-1].ledger.by_load[1 + 1] == pytest.approx(7.0 * 0.5 * mesh_volume(mesh), rel=1e-12)
    assert found[-1].ledger.by_load[0] == pytest.approx(5.0 * (0.15 + 0.2), rel=1e-12)


SECTIONS = [(PlaneStrain(thickness=0.5), 1.0), (PlaneStress(thickness=2.0), 4.0), (Axisymmetric(), 4.0 * np.pi)]


@pytest.mark.parametrize(("section", "volume"), SECTIONS)
def test_sections_have_their_volume_and_surface(section: object, volume: float) -> None:
    body = heat.Conductor(mesh=mesh_of("quad4"), law=UNIT, density=3.0, section=section, temperature=300.0)
    *_, last = steps(body, heat.HeatSource(of="b", value=6.0), until=1.0, step=0.25)
    assert last.temperature["b"] == pytest.approx(np.full(12, 301.0), abs=1e-10)
    assert last.ledger.heat_in == pytest.approx(6.0 * volume, rel=1e-12)
    *_, last = steps(body, heat.HeatFlux(on="b.right", value=1.0), until=1.0, step=0.25)
    side = {PlaneStrain: 0.5, PlaneStress: 2.0, Axisymmetric: 4.0 * np.pi}[type(section)]
    assert last.ledger.heat_in == pytest.approx(side, rel=1e-12)


def test_capacity_over_temperature_has_its_exact_integral() -> None:
    table = heat.TemperatureTable(temperatures=(290.0, 310.0), values=(1.0, 3.0))
    law = heat.Conduction(conductivity=1.0, capacity=table)
    body = heat.Conductor(mesh=mesh_of("bar2"), law=law, density=1.0, temperature=280.0)
    *_, last = steps(body, heat.HeatSource(of="b", value=70.0), until=1.0, step=0.1)
    assert last.temperature["b"] == pytest.approx(np.full(4, 310.0 + 20.0 / 3.0), abs=1e-9)
    assert last.ledger.relative_error < 1e-11


def test_the_heat_of_a_jump_to_a_temperature_is_booked() -> None:
    body = heat.Conductor(mesh=interval(1.0, cells=4), law=UNIT, density=3.0, temperature=300.0)
    first, *_ = steps(body, heat.Temperature(on="b.left", value=400.0), until=1e-9, step=1e-9)
    assert first.ledger.heat_in == pytest.approx(100.0 * 0.125 * 6.0, rel=1e-6)
    assert first.damped


def test_slabs_end_at_knots_and_are_damped_after_them() -> None:
    body = heat.Conductor(mesh=interval(1.0, cells=4), law=UNIT, density=3.0, temperature=300.0)
    wall = heat.Temperature(on="b.left", value=1.0, ramp=Ramp(times=(0.15, 0.35), factors=(300.0, 400.0)))
    found = steps(body, wall, until=1.0, step=0.1)
    assert {0.15, 0.35, 1.0} <= {round(step.time, 12) for step in found}
    damped = [round(step.time, 6) for step in found if step.damped]
    assert damped == pytest.approx([0.075, 0.25, 0.35 + 0.65 / 7.0], abs=1e-6)
    assert found[-1].ledger.relative_error < 1e-12


@pytest.mark.parametrize("cell", ["bar2", "quad4", "tri3", "tet4"])
def test_no_temperature_leaves_its_bounds(cell: str) -> None:
    """Lumped capacity, cells without obtuse angles: bounded if h K_ii / 2 is at most C_ii, which consistent is not."""
    mesh = mesh_of(cell)
    body = heat.Conductor(mesh=mesh, law=UNIT, density=3.0, temperature=300.0)
    loads = (heat.Temperature(on="b.left", value=400.0), heat.Convection(on="b.right", coefficient=50.0, ambient=350.0))
    for step in (1e-4, 1e-3, 1e-2):
        for found in steps(body, *loads, until=10 * step, step=step):
            low, high = found.temperature["b"].min(), found.temperature["b"].max()
            assert low >= 300.0 - 1e-9 and high <= 400.0 + 1e-9


def test_a_march_has_the_same_bits_again_and_goes_on_from_a_state() -> None:
    body = heat.Conductor(mesh=mesh_of("quad4"), law=UNIT, density=3.0, temperature=300.0)
    loads = (heat.Convection(on="b.top", coefficient=50.0, ambient=350.0),)
    once, again = (steps(body, *loads, until=1.0, step=0.125) for _ in range(2))
    assert all((a.temperature["b"] == b.temperature["b"]).all() for a, b in zip(once, again, strict=True))
    scene = heat.HeatScene(bodies={"b": body}, loads=loads)
    rest = list(heat.march_heat(scene, until=1.0, step=0.125, state=once[3].state, damped=False))
    assert rest[-1].temperature["b"] == pytest.approx(once[-1].temperature["b"], abs=1e-10)
    assert rest[-1].ledger.heat_in == pytest.approx(once[-1].ledger.heat_in, rel=1e-12)
    assert [s.state.slabs for s in (once[3], *rest)] == [4, 5, 6, 7, 8]


def test_two_bodies_do_not_know_each_other() -> None:
    one = heat.Conductor(mesh=mesh_of("bar2"), law=UNIT, density=3.0, temperature=300.0)
    other = heat.Conductor(mesh=mesh_of("quad4"), law=UNIT, density=3.0, temperature=350.0)
    loads = (heat.Temperature(on="one.left", value=400.0),)
    *_, both = heat.march_heat(heat.HeatScene(bodies={"one": one, "other": other}, loads=loads), until=1.0, step=0.1)
    *_, alone = heat.march_heat(heat.HeatScene(bodies={"one": one}, loads=loads), until=1.0, step=0.1)
    assert both.temperature["one"] == pytest.approx(alone.temperature["one"], abs=1e-10)
    assert both.temperature["other"] == pytest.approx(np.full(12, 350.0), abs=1e-10)


def test_later_temperatures_hold_where_two_meet() -> None:
    body = heat.Conductor(mesh=mesh_of("quad4"), law=UNIT, density=3.0, temperature=300.0)
    loads = (heat.Temperature(on="b.left", value=400.0), heat.Temperature(on="b.bottom", value=350.0))
    *_, last = steps(body, *loads, until=0.1, step=0.05)
    corner = mesh_of("quad4").nearest((0.0, 0.0))
    assert last.temperature["b"][corner] == pytest.approx(350.0)


def test_a_model_is_built_once_for_several_marches() -> None:
    body = heat.Conductor(mesh=mesh_of("bar2"), law=UNIT, density=3.0, temperature=300.0)
    model = build_heat(heat.HeatScene(bodies={"b": body}))
    assert isinstance(model, HeatModel)
    assert len(list(heat_march.march_heat(model, until=1.0, step=0.5))) == 2


def test_a_march_can_be_cancelled() -> None:
    body = heat.Conductor(mesh=mesh_of("bar2"), law=UNIT, density=3.0, temperature=300.0)
    with pytest.raises(sw.Cancelled):
        list(heat.march_heat(heat.HeatScene(bodies={"b": body}), until=1.0, step=0.5, cancel=lambda: True))
