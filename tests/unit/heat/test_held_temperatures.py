"""Two prescribed temperatures: at common edges of surfaces the last one holds, on the same nodes they are refused."""

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.meshes.generators.shapes import interval, rectangle

heat = sw.heat
LAW = heat.Conduction(conductivity=1.0, capacity=1.0)
SQUARE = rectangle((1.0, 1.0), (1, 1))
CORNER = rectangle((1.0, 1.0), (2, 2)).with_tag("corner", lambda x: (x < 0.1).all(axis=1))


def scene(mesh: sw.Mesh, *walls: tuple[str, float]) -> heat.HeatScene:
    """A body with temperatures of its tags."""
    body = heat.Conductor(mesh=mesh, law=LAW, density=1.0, temperature=350.0)
    loads = tuple(heat.Temperature(on=on, value=value) for on, value in walls)
    return heat.HeatScene(bodies={"b": body}, loads=loads)


@pytest.mark.parametrize(("order", "free"), [(1, 375.0), (-1, 325.0)])
def test_the_last_temperature_holds_the_corner_of_two_sides(order: int, free: float) -> None:
    """One square cell, whose free node has 1/4, 1/4 and 1/2 of the temperatures of its neighbours and the corner."""
    walls = (("b.left", 300.0), ("b.bottom", 400.0))[::order]
    *_, last = heat.march_heat(scene(SQUARE, *walls), until=100.0, step=1.0)
    corner, right, top, opposite = (
        last.temperature["b"][SQUARE.nearest(at)] for at in ((0, 0), (1, 0), (0, 1), (1, 1))
    )
    assert [corner, right, top] == pytest.approx([walls[-1][1], 400.0, 300.0], abs=1e-12)
    assert opposite == pytest.approx(free, abs=1e-9)


@pytest.mark.parametrize(
    ("mesh", "walls", "told"),
    [
        (interval(1.0, cells=2), (("b.right", 250.0), ("b.right", 350.0)), "350 K of 'b.right', but 250 K of"),
        (interval(1.0, cells=2), (("b", 250.0), ("b.right", 350.0)), "350 K of 'b.right', but 250 K of 'b'"),
        (CORNER, (("b.corner", 250.0), ("b.left", 350.0)), "350 K of 'b.left', but 250 K of 'b.corner'"),
    ],
)  # fmt: skip
def test_two_temperatures_of_the_same_nodes_are_refused(
    mesh: sw.Mesh, walls: tuple[tuple[str, float], ...], told: str
) -> None:
    with pytest.raises(InputError, match=told) as found:
        heat.build_heat(scene(mesh, *walls))
    assert found.value.where == "loads[1].on" and "one temperature for each surface" in found.value.remedy


def test_the_same_temperature_twice_is_admitted() -> None:
    model = heat.build_heat(scene(CORNER, ("b.left", 300.0), ("b.corner", 300.0)))
    assert [len(nodes) for _, nodes in model.held] == [2, 1]
    assert np.isfinite(model.initial).all()


def test_solids_and_rigid_bodies_have_one_temperature_too() -> None:
    thermal = sw.bodies.Thermal(law=LAW, temperature=300.0)
    solid = sw.Solid(mesh=SQUARE, material=sw.LinearElastic(E=1.0, nu=0.2), density=1.0, thermal=thermal)
    warm = sw.bodies.RigidThermal(temperature=300.0, capacity=1.0)
    rigid = sw.mechanisms.Rigid(mass=1.0, centre=(5.0, 0.0), inertia=1.0, thermal=warm)
    for name in ("b", "r"):
        loads = tuple(heat.Temperature(on=name, value=value) for value in (300.0, 310.0))
        mechanism = sw.mechanisms.Mechanism(bodies={"r": rigid})
        with pytest.raises(InputError, match=r"300 K of '.' in loads.0."):
            sw.build(sw.Scene(bodies={"b": solid}, loads=loads, mechanism=mechanism))
