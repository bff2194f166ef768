"""Fronts that close in from several sides: squares that freeze and melt, and the corner of Rathjen and Jiji."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import softway as sw
from softway.meshes.generators.shapes import rectangle

pytestmark = pytest.mark.slow
heat = sw.heat
WATER = heat.Conduction(conductivity=0.556, capacity=4226.0)
LATENT = heat.Latent(heat=338e3, melting=273.15, liquid=WATER)
ICE = heat.Conduction(conductivity=2.22, capacity=1762.0, latent=LATENT)
SIDES = ("left", "right", "top", "bottom")


def square(cell: str, start: float, latent: str, *loads: object, cells: int, until: float) -> list[heat.HeatStep]:
    mesh = rectangle((0.02, 0.02), (cells, cells), cell=cell)
    body = heat.Conductor(mesh=mesh, law=ICE, density=1000.0, temperature=start, latent=latent)
    return list(heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=loads), until=until, step=20.0))


@pytest.mark.parametrize("start", [273.16, 278.15])
@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_a_square_freezes_from_two_sides(cell: str, start: float) -> None:
    """The liquid cools to melting long before the fronts meet; the volume frozen is that of latent heat at nodes."""
    wall = heat.Temperature(on="b.left", value=263.15)
    air = heat.Convection(on="b.top", coefficient=500.0, ambient=263.15)
    found, nodal = (square(cell, start, latent, wall, air, cells=8, until=2000.0) for latent in ("cell", "node"))
    assert found[-1].ledger.relative_error < 1e-11
    volumes, others = (np.array([step.liquid_volume["b"] for step in steps]) / 4e-4 for steps in (found, nodal))
    assert (np.diff(volumes) < 1e-12).all() and volumes[-1] < 0.03
    assert np.abs(volumes - others)[10:].max() < 0.04


@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_a_square_freezes_through_from_all_sides(cell: str) -> None:
    """Cells whose corners are all at melting hold any part of their latent heat on the way."""
    *_, last = square(
        cell, 273.16, "cell", *(heat.Temperature(on=f"b.{s}", value=263.15) for s in SIDES), cells=9, until=1600.0
    )
    assert last.liquid_volume["b"] == 0.0
    assert last.temperature["b"] == pytest.approx(np.full(100, 263.15), abs=1e-2)
    lost = 0.4 * (4226.0 * 0.01 + 338e3 + 1762.0 * 10.0)
    assert last.ledger.heat_out - last.ledger.heat_in == pytest.approx(lost, rel=1e-6)
    assert last.ledger.relative_error < 1e-11


def test_a_square_that_is_at_melting_throughout_melts() -> None:
    """Solution of Stefan; of first order in the cells, since nothing beyond the front holds it back."""
    root = brentq(lambda x: x * np.exp(x * x) * np.sqrt(np.pi) * _erf(x) - 42260.0 / 338e3, 0.1, 1.0)
    depth = 2.0 * root * np.sqrt(0.556 / (1000.0 * 4226.0) * 400.0)
    missed = []
    for cells in (8, 16):
        wall = heat.Temperature(on="b.left", value=283.15)
        *_, last = square("tri3", 273.15, "cell", wall, cells=cells, until=400.0)
        assert last.ledger.relative_error < 1e-11
        missed.append(last.liquid_volume["b"] / 0.02 / depth - 1.0)
    assert abs(missed[1]) < 0.13 and abs(missed[1]) < 0.6 * abs(missed[0])


def _erf(x: float) -> float:
    return 2.0 / np.sqrt(np.pi) * quad(lambda s: np.exp(-s * s), 0.0, x)[0]


ROOT, C, M = 0.70766, 0.159, 5.02
"""Neumann's root and the constants of the front x^m = root^m + C / (y^m - root^m) for beta = 0.25 and T_i = 0.3."""
SIZE = 3.0
"""Side of the square, over the length sqrt(4 alpha t) at the end."""


def corner(cells: int, cell: str) -> tuple[np.ndarray, float, heat.HeatStep]:
    """Coordinates of the nodes along a side, frozen area, last step; the units are alpha = k = 1, and 4 t = 1."""
    law = heat.Conduction(conductivity=1.0, capacity=1.0, latent=heat.Latent(heat=0.25, melting=300.0))
    mesh = rectangle((SIZE, SIZE), (cells, cells), cell=cell)
    body = heat.Conductor(mesh=mesh, law=law, density=1.0, temperature=300.3)
    walls = tuple(heat.Temperature(on=f"b.{side}", value=299.0) for side in ("left", "bottom"))
    *_, last = heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=walls), until=0.25, step=0.25 / cells)
    return np.linspace(0.0, SIZE, cells + 1), SIZE**2 - last.liquid_volume["b"], last


def crossing(x: np.ndarray, temperature: np.ndarray) -> float:
    k = int(np.argmax(temperature > 300.0))
    return float(np.interp(300.0, temperature[k - 1 : k + 1], x[k - 1 : k + 1]))


def test_the_constant_of_the_front_is_neumanns() -> None:
    solid, liquid = np.exp(-(ROOT**2)) / _erf(ROOT), np.exp(-(ROOT**2)) / (1.0 - _erf(ROOT))
    assert solid - 0.3 * liquid == pytest.approx(np.sqrt(np.pi) * ROOT * 0.25, rel=1e-4)


@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_a_corner_freezes_as_rathjen_and_jiji_found(cell: str) -> None:
    on_diagonal = (ROOT**M + np.sqrt(C)) ** (1.0 / M)
    below = quad(lambda x: (ROOT**M + C / (x**M - ROOT**M)) ** (1.0 / M), on_diagonal, SIZE)[0]
    frozen = on_diagonal**2 + 2.0 * below
    missed = []
    for cells in (20, 40):
        x, area, last = corner(cells, cell)
        missed.append(area / frozen - 1.0)
        assert last.ledger.relative_error < 1e-11
    temperature = last.temperature["b"].reshape(41, 41)
    assert abs(missed[1]) < 8e-3 and abs(missed[1]) < 0.5 * abs(missed[0])
    assert crossing(x, np.diagonal(temperature)) == pytest.approx(on_diagonal, rel=8e-3)
    assert crossing(x, temperature[-1]) == pytest.approx(ROOT, rel=1.2e-2)
    assert temperature == pytest.approx(temperature.T, abs=1e-9 if cell == "quad4" else 0.02)
