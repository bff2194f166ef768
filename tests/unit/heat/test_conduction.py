"""Conduction against exact solutions: orders in time and space, boundary conditions, sections."""

from math import pi

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import erf, j0, jn_zeros

import softway as sw
from softway.heat.operators import STEFAN_BOLTZMANN
from softway.meshes.generators.shapes import rectangle

heat = sw.heat
STEEL = heat.Conduction(conductivity=50.0, capacity=500.0)
DENSITY = 7800.0
UNIT = heat.Conduction(conductivity=1.0, capacity=1.0)


def bar(cells: int, length: float = 1.0, law: heat.Conduction = UNIT, **given: object) -> heat.Conductor:
    parts = {"law": law, "density": 1.0, "temperature": 300.0, **given}
    return heat.Conductor(mesh=sw.meshes.Interval(length=length, cells=cells), **parts)


def last(*bodies: heat.Conductor, loads: tuple = (), **given: object) -> heat.HeatStep:
    scene = heat.HeatScene(bodies={f"b{k}": body for k, body in enumerate(bodies)}, loads=loads)
    *_, step = heat.march_heat(scene, **given)
    return step


def test_a_wall_put_to_a_temperature_heats_a_long_bar() -> None:
    body = bar(200, 0.2, STEEL, density=DENSITY)
    wall = heat.Temperature(on="b0.left", value=400.0)
    step = last(body, loads=(wall,), until=60.0, step=0.5)
    x = np.linspace(0.0, 0.2, 201)
    diffusivity = 50.0 / (DENSITY * 500.0)
    exact = 400.0 - 100.0 * erf(x / (2.0 * np.sqrt(diffusivity * 60.0)))
    assert np.abs(step.temperature["b0"] - exact).max() < 0.02
    brought = 100.0 * 2.0 * np.sqrt(50.0 * DENSITY * 500.0 * 60.0 / pi)
    assert step.ledger.heat_in == pytest.approx(brought, rel=2e-3)
    assert step.ledger.relative_error < 1e-12


def mode(x: np.ndarray) -> np.ndarray:
    return 300.0 + np.cos(pi * x[:, 0])


@pytest.mark.parametrize("damped", [False, True])
def test_an_insulated_rod_is_of_second_order_in_time(damped: bool) -> None:
    cells = 8
    rate = 4.0 * cells**2 * np.sin(0.5 * pi / cells) ** 2
    errors = []
    for slabs in (8, 16, 32, 64):
        step = last(bar(cells, temperature=mode), until=0.1, step=0.1 / slabs, damped=damped)
        errors.append(abs(step.temperature["b0"][0] - 300.0 - np.exp(-0.1 * rate)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert ((orders > 1.9) & (orders < 2.1)).all() or (damped and orders[-1] > 1.9), orders


@pytest.mark.parametrize("cell", ["bar2", "bar3"])
def test_an_insulated_rod_is_of_second_order_in_space_at_least(cell: str) -> None:
    errors = []
    for cells in (4, 8, 16):
        body = heat.Conductor(
            mesh=sw.meshes.Interval(length=1.0, cells=cells, cell=cell), law=UNIT, density=1.0, temperature=mode
        )
        step = last(body, until=0.1, step=4e-4, damped=False)
        errors.append(abs(step.temperature["b0"][0] - 300.0 - np.exp(-0.1 * pi**2)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 1.9).all(), (errors, orders)
    assert cell == "bar3" or (orders < 2.1).all(), orders


@pytest.mark.parametrize("cell", ["quad4", "tri3"])
def test_an_orthotropic_plate_conducts_along_its_axes(cell: str) -> None:
    law = heat.Conduction(conductivity=(2.0, 0.5), capacity=1.0)
    errors = []
    for cells in (6, 12):
        mesh = rectangle((1.0, 1.0), (cells, cells), cell=cell)
        plate = heat.Conductor(
            mesh=mesh,
            law=law,
            density=1.0,
            temperature=lambda x: 300.0 + np.cos(pi * x[:, 0]) * np.cos(2.0 * pi * x[:, 1]),
        )
        step = last(plate, until=0.05, step=0.05 / cells**2, damped=False)
        corner = mesh.nearest((0.0, 0.0))
        errors.append(abs(step.temperature["b0"][corner] - 300.0 - np.exp(-0.05 * pi**2 * (2.0 + 0.5 * 4.0))))
    assert 1.85 < np.log2(errors[0] / errors[1]) < 2.2
    assert errors[1] < 0.015


def test_a_slab_cools_in_a_fluid_as_its_series_tells() -> None:
    biot, time = 2.0, 0.3
    roots = [brentq(lambda z: z * np.tan(z) - biot, k * pi, (k + 0.5) * pi - 1e-9) for k in range(12)]
    series = sum(
        4.0 * np.sin(z) / (2.0 * z + np.sin(2.0 * z)) * np.exp(-z * z * time) for z in roots
    )  # in the middle of a slab of half width one
    errors = []
    for cells in (20, 40):
        cooled = heat.Convection(on="b0.right", coefficient=biot, ambient=300.0)
        step = last(bar(cells, temperature=400.0), loads=(cooled,), until=time, step=0.2 / cells)
        errors.append(abs((step.temperature["b0"][0] - 300.0) / 100.0 - series))
        assert step.ledger.relative_error < 1e-12 and step.ledger.heat_in == 0.0
    assert errors[1] < 1e-4 and errors[0] / errors[1] > 3.0


def test_a_hot_body_radiates_as_the_closed_form_tells() -> None:
    start, ambient, emissivity = 1200.0, 300.0, 0.6
    law = heat.Conduction(conductivity=1e4, capacity=500.0)
    body = bar(2, 0.01, law, density=DENSITY, temperature=start)
    scale = DENSITY * 500.0 * 0.01 / (4.0 * emissivity * STEFAN_BOLTZMANN * ambient**3)

    def elapsed(hot: float) -> float:
        u = np.array([hot, start]) / ambient
        parts = np.log((u + 1.0) / (u - 1.0)) + 2.0 * np.arctan(u)
        return scale * float(parts[0] - parts[1])

    errors = []
    for slabs in (20, 40):
        radiates = heat.Radiation(on="b0.right", emissivity=emissivity, ambient=ambient)
        step = last(body, loads=(radiates,), until=600.0, step=600.0 / slabs)
        hot = step.temperature["b0"].mean()
        errors.append(abs(elapsed(hot) / 600.0 - 1.0))
        assert step.ledger.relative_error < 1e-10
    assert errors[1] < 1e-3 and errors[0] / errors[1] > 3.0


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad8", "tri6", "quad9"])
def test_a_cylinder_cools_in_a_mode_of_bessel(cell: str) -> None:
    root = float(jn_zeros(0, 1)[0])
    errors = []
    for cells in (8, 16):
        body = heat.Conductor(
            mesh=rectangle((1.0, 1.0 / cells), (cells, 1), cell=cell),
            law=UNIT,
            density=1.0,
            section=sw.bodies.Axisymmetric(),
            temperature=lambda x: 300.0 + j0(root * x[:, 0]),
        )
        rim = heat.Temperature(on="b0.right", value=300.0)
        step = last(body, loads=(rim,), until=0.1, step=2e-3, damped=False)
        exact = 300.0 + j0(root * body.mesh.points[:, 0]) * np.exp(-0.1 * root**2)
        mass = heat.build_heat(heat.HeatScene(bodies={"b0": body})).mass
        errors.append(np.sqrt(mass @ (step.temperature["b0"] - exact) ** 2 / mass.sum()))
        assert step.ledger.relative_error < 1e-12
    assert errors[1] < 1e-3 and np.log2(errors[0] / errors[1]) > 1.8


def test_a_conductivity_over_temperature_has_the_steady_state_of_kirchhoff() -> None:
    table = heat.TemperatureTable(temperatures=(300.0, 500.0), values=(1.0, 3.0))
    law = heat.Conduction(conductivity=table, capacity=1.0)
    ends = heat.Temperature(on="b0.left", value=300.0), heat.Temperature(on="b0.right", value=500.0)
    step = last(bar(8, law=law), loads=ends, until=6.0, step=0.05)
    x = np.linspace(0.0, 1.0, 9)
    exact = 300.0 + 100.0 * (np.sqrt(1.0 + 8.0 * x) - 1.0)  # u + u^2 / 200 = 400 x of the rise u
    assert step.temperature["b0"] == pytest.approx(exact, abs=1e-6)
    assert step.ledger.relative_error < 1e-9


def test_a_conductivity_and_a_capacity_over_temperature_are_of_second_order() -> None:
    table = heat.TemperatureTable(temperatures=(280.0, 420.0), values=(1.0, 2.0))
    law = heat.Conduction(conductivity=table, capacity=table)
    found = []
    for slabs in (10, 20, 40, 320):
        step = last(
            bar(8, law=law, temperature=lambda x: 350.0 + 50.0 * np.cos(pi * x[:, 0])),
            until=0.1,
            step=0.1 / slabs,
            damped=False,
        )
        found.append(step.temperature["b0"][0])
        assert abs(step.ledger.error) < 1e-9
    errors = np.abs(np.array(found[:-1]) - (16.0 * found[-1] - found[-2]) / 15.0)  # extrapolated
    orders = np.log2(errors[:-1] / errors[1:])
    assert ((orders > 1.9) & (orders < 2.1)).all(), orders
