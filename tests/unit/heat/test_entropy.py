"""Entropy that conduction produces: exact in a steady state, and never negative."""

import numpy as np
import pytest

import softway as sw
from softway.meshes.generators.shapes import interval, rectangle

pytestmark = pytest.mark.slow
heat = sw.heat
WATER = heat.Conduction(conductivity=0.556, capacity=4226.0)
STEEL = heat.Conduction(
    conductivity=50.0, capacity=heat.TemperatureTable(temperatures=(290.0, 400.0), values=(450.0, 600.0))
)


def ice(half_range: float) -> heat.Conduction:
    latent = heat.Latent(heat=338e3, melting=273.15, half_range=half_range, liquid=WATER)
    return heat.Conduction(conductivity=2.22, capacity=1762.0, latent=latent)


def produced(body: heat.Conductor, *loads: object, **times: float) -> np.ndarray:
    steps = heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=loads), **times)
    return np.array([step.entropy_produced for step in steps])


def test_a_steady_flow_produces_its_heat_over_both_temperatures() -> None:
    start = 300.0 + 300.0 * np.linspace(0.0, 1.0, 11)
    law = heat.Conduction(conductivity=2.0, capacity=1.0)
    bar = heat.Conductor(mesh=interval(1.0, cells=10), law=law, density=1.0, temperature=start)
    ends = (heat.Temperature(on="b.left", value=300.0), heat.Temperature(on="b.right", value=600.0))
    found = produced(bar, *ends, until=1.0, step=0.1)
    assert found == pytest.approx(np.full(10, 600.0 * 0.1 * (1.0 / 300.0 - 1.0 / 600.0)), rel=1e-10)


def test_two_parts_that_become_equal_produce_the_entropy_of_mixing() -> None:
    law = heat.Conduction(conductivity=1.0, capacity=2.0)
    start = np.where(np.arange(21) < 10, 300.0, 500.0)
    bar = heat.Conductor(mesh=interval(1.0, cells=20), law=law, density=3.0, temperature=start)
    mass = np.full(21, 3.0 / 20.0)
    mass[[0, -1]] *= 0.5
    mean = float(mass @ start) / 3.0
    found = produced(bar, until=200.0, step=1.0)
    assert found.sum() == pytest.approx(2.0 * float(mass @ np.log(mean / start)), rel=1e-9)
    assert found.min() > -1e-12 * found.sum()


@pytest.mark.parametrize("step", [1.0, 20.0])
def test_a_bar_that_is_heated_from_one_end_never_loses_entropy(step: float) -> None:
    bar = heat.Conductor(mesh=interval(0.1, cells=20), law=STEEL, density=7800.0, temperature=300.0)
    ends = heat.Temperature(on="b.left", value=900.0), heat.Convection(on="b.right", coefficient=1e3, ambient=300.0)
    assert produced(bar, *ends, until=200.0, step=step).min() > 0.0


@pytest.mark.parametrize(("latent", "half_range"), [("cell", 0.0), ("node", 0.0), ("cell", 0.25)])
def test_water_that_freezes_never_loses_entropy(latent: str, half_range: float) -> None:
    mesh = rectangle((0.02, 0.02), (9, 9))
    body = heat.Conductor(mesh=mesh, law=ice(half_range), density=1000.0, temperature=274.15, latent=latent)
    walls = (heat.Temperature(on=f"b.{side}", value=263.15) for side in ("left", "right", "top", "bottom"))
    found = produced(body, *walls, until=600.0, step=10.0)
    assert found.min() > -1e-12 * found.sum() and found.sum() > 10.0


def test_a_uniform_body_produces_the_error_of_its_slabs_alone() -> None:
    """A capacity of 6 J/K takes 60 J in each slab; the first is of two halves whose heat flows at their ends."""
    law = heat.Conduction(conductivity=1.0, capacity=2.0)
    bar = heat.Conductor(mesh=interval(1.0, cells=4), law=law, density=3.0, temperature=300.0)
    found = produced(bar, heat.HeatSource(of="b", value=60.0), until=3.0, step=1.0)
    halves = sum(6.0 * np.log(b / (b - 5.0)) - 30.0 / b for b in (305.0, 310.0))
    whole = [6.0 * np.log((m + 5.0) / (m - 5.0)) - 60.0 / m for m in (315.0, 325.0)]
    assert found == pytest.approx([halves, *whole], rel=1e-6)
    assert halves == pytest.approx(2.0 * 3.0 * (5.0 / 305.0) ** 2, rel=5e-2)
    assert whole[0] == pytest.approx(6.0 / 12.0 * (10.0 / 315.0) ** 3, rel=1e-3)


def test_what_the_length_of_slabs_produces_falls_with_them() -> None:
    """A uniform plate is heated against its radiation."""
    law = heat.Conduction(conductivity=1e4, capacity=900.0)
    plate = heat.Conductor(mesh=rectangle((0.02, 0.01), (4, 2)), law=law, density=2700.0, temperature=300.0)
    air = heat.Radiation(on="b", emissivity=0.5, ambient=300.0)
    loads = air, heat.HeatSource(of="b", value=2e6)
    long, short = (float(produced(plate, *loads, until=3600.0, step=step).sum()) for step in (120.0, 30.0))
    assert long == pytest.approx(9.18, rel=1e-2) and short < 0.1 * long
