"""Change of phase: Neumann's solution, and every kind of cell melts through."""

import numpy as np
import pytest

import softway as sw
from neumann import DENSITY, MELTING, front, ice, neumann
from softway.meshes.generators.shapes import box, interval, rectangle

pytestmark = pytest.mark.slow
heat = sw.heat


def freezing(law: heat.Conduction, cells: int, latent: str, step: float) -> list[heat.HeatStep]:
    body = heat.Conductor(
        mesh=interval(0.1, cells=cells), law=law, density=DENSITY, temperature=MELTING + 5.0, latent=latent
    )
    wall = heat.Temperature(on="water.left", value=MELTING - 10.0)
    return list(heat.march_heat(heat.HeatScene(bodies={"water": body}, loads=(wall,)), until=3600.0, step=step))


@pytest.mark.parametrize(
    ("latent", "half_range", "at_end", "always", "at_centimetre", "greatest"),
    [
        ("cell", 0.0, 5e-3, 1e-2, 0.02, 0.3),
        ("node", 0.0, 1e-3, 5e-3, 0.1, 1.5),
        ("cell", 0.25, 2e-3, 5e-3, 0.02, 1.0),
    ],
)
def test_water_freezes_as_neumann_found(
    latent: str, half_range: float, at_end: float, always: float, at_centimetre: float, greatest: float
) -> None:
    found = freezing(ice(half_range), 100, latent, 10.0)
    x = np.linspace(0.0, 0.1, 101)
    late = [step for step in found if step.time > 600.0]
    frozen = [0.1 - step.liquid_volume["water"] for step in late]
    missed = [ice_front / front(step.time) - 1.0 for ice_front, step in zip(frozen, late, strict=True)]
    assert abs(missed[-1]) < at_end and np.abs(missed).max() < always
    last = found[-1]
    assert abs(last.temperature["water"][10] - MELTING + 5.069627568716798) < at_centimetre
    errors = [np.abs(step.temperature["water"] - neumann(x, step.time)).max() for step in late]
    assert max(errors) < greatest
    assert last.ledger.relative_error < (1e-9 if latent == "cell" and not half_range else 1e-12)


def test_smaller_cells_and_slabs_bring_the_front_closer() -> None:
    errors = []
    for cells, step in ((25, 40.0), (50, 20.0)):
        last = freezing(ice(), cells, "cell", step)[-1]
        errors.append(abs((0.1 - last.liquid_volume["water"]) / front(3600.0) - 1.0))
    assert errors[1] < 0.6 * errors[0]


@pytest.mark.parametrize("latent", ["cell", "node"])
def test_a_single_slab_of_an_hour_converges(latent: str) -> None:
    """Twenty cells freeze in one slab of two halves; its ledger closes, although it is not accurate."""
    (step,) = freezing(ice(), 100, latent, 3600.0)
    assert step.ledger.relative_error < 1e-9
    assert abs((0.1 - step.liquid_volume["water"]) / front(3600.0) - 1.0) < 0.05


def test_water_freezes_on_irregular_triangles() -> None:
    mesh = rectangle((0.1, 0.006), (50, 3), cell="tri3")
    inner = np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes("surface"))
    points = mesh.points.copy()
    points[inner] += 0.4e-3 * np.random.default_rng(1).uniform(-1.0, 1.0, (len(inner), 2))
    mesh = sw.Mesh(points=points, blocks=mesh.blocks, tags=mesh.tags)
    body = heat.Conductor(mesh=mesh, law=ice(), density=DENSITY, temperature=MELTING + 5.0)
    wall = heat.Temperature(on="water.left", value=MELTING - 10.0)
    *_, last = heat.march_heat(heat.HeatScene(bodies={"water": body}, loads=(wall,)), until=3600.0, step=20.0)
    frozen = 0.1 - last.liquid_volume["water"] / 0.006
    assert abs(frozen / front(3600.0) - 1.0) < 1e-2
    assert np.abs(last.temperature["water"] - neumann(mesh.points[:, 0], 3600.0)).max() < 0.3
    assert last.ledger.relative_error < 1e-9


MELTS = [("bar2", "cell"), ("bar3", "cell"), ("tri6", "cell"), ("quad4", "cell"), ("quad8", "cell"), ("tet4", "cell")]
MELTS += [("tet10", "cell"), ("hex8", "cell"), ("hex27", "cell"), ("hex20", "node"), ("quad9", "node")]


@pytest.mark.parametrize(("cell", "latent"), MELTS)
def test_every_kind_of_cell_melts_through(cell: str, latent: str) -> None:
    """The heat that a body has taken in when all of it is liquid is what its parts need one by one."""
    mesh = {
        "b": lambda: interval(1.0, cells=4, cell=cell),
        "t": lambda: (
            rectangle((1.0, 1.0), (2, 2), cell=cell) if cell[1] == "r" else box((1.0,) * 3, (2, 2, 2), cell=cell)
        ),
        "q": lambda: rectangle((1.0, 1.0), (2, 2), cell=cell),
        "h": lambda: box((1.0,) * 3, (2, 1, 1), cell=cell),
    }[cell[0]]()
    liquid = heat.Conduction(conductivity=1.0, capacity=2.0)
    law = heat.Conduction(conductivity=2.0, capacity=1.0, latent=heat.Latent(heat=10.0, melting=300.0, liquid=liquid))
    body = heat.Conductor(mesh=mesh, law=law, density=3.0, temperature=298.0, latent=latent)
    scene = heat.HeatScene(bodies={"b": body}, loads=(heat.Convection(on="b.left", coefficient=20.0, ambient=310.0),))
    found = list(heat.march_heat(scene, until=16.0, step=0.25))
    volumes = np.array([step.liquid_volume["b"] for step in found])
    assert 0.0 < volumes[4] < 0.99 and volumes[-1] == pytest.approx(1.0, rel=1e-12)
    model = heat.build_heat(scene)
    taken = model.mass @ (2.0 * (found[-1].temperature["b"] - 300.0) + 10.0 + 2.0)
    assert found[-1].ledger.heat_in == pytest.approx(taken, rel=1e-9)
    assert found[-1].ledger.relative_error < 1e-9


@pytest.mark.parametrize(("latent", "cells", "coldest"), [("cell", 4, -2.0), ("cell", 8, -1.0), ("node", 4, 0.0)])
def test_the_node_ahead_of_a_front_lends_its_heat(latent: str, cells: int, coldest: float) -> None:
    """Tin that starts at melting gets colder ahead of the front, by a part of the fall q dx/k across a cell."""
    law = heat.Conduction(conductivity=60.0, capacity=240.0, latent=heat.Latent(heat=60e3, melting=505.15))
    mesh = interval(0.02, cells=cells)
    bar = heat.Conductor(mesh=mesh, law=law, density=7300.0, temperature=505.15, latent=latent)
    scene = heat.HeatScene(bodies={"b": bar}, loads=(heat.HeatFlux(on="b.left", value=1e5),))
    found = list(heat.march_heat(scene, until=40.0, step=1.0))
    below = min(step.temperature["b"].min() - 505.15 for step in found)
    assert below == pytest.approx(coldest, rel=5e-3, abs=1e-9) and below >= -0.25 * 1e5 * 0.02 / cells / 60.0
    tenth = found[9]  # all the heat is in the liquid and in the temperatures
    taken = 7300.0 * (60e3 * tenth.liquid_volume["b"] + 240.0 * (np.full(cells + 1, 0.02 / cells) @ (
        tenth.temperature["b"] - 505.15
    ) - 0.01 / cells * (tenth.temperature["b"][[0, -1]] - 505.15).sum()))  # fmt: skip
    assert taken == pytest.approx(1e6, rel=1e-9)
