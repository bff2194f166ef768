"""Conductors and solids with several laws of conduction and densities: exact layers, interfaces, balances."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

import softway as sw
from softway.bodies import Fixed, Thermal
from softway.heat.regional_laws import regional_laws
from softway.meshes.cells import CELLS
from softway.meshes.generators.shapes import box, interval, rectangle

heat = sw.heat
STEEL = heat.Conduction(conductivity=5.0, capacity=2.0)
FELT = heat.Conduction(conductivity=0.2, capacity=1.0)
WOOD = heat.Conduction(conductivity=1.0, capacity=3.0)
LAYERS = {"in": STEEL, "middle": FELT, "out": WOOD}
EDGES = (0.0, 0.25, 0.5, 1.0)


def layered(cell: str, cells: int = 4, edges: tuple[float, ...] = EDGES) -> sw.Mesh:
    """A unit bar, square or cube with layers along x between the ``edges``."""
    dim = CELLS[cell].dim
    shape = (cells, *(1,) * (dim - 1))
    make = {1: lambda: interval(1.0, cells=cells, cell=cell), 2: lambda: rectangle((1.0, 1.0), shape, cell=cell)}
    mesh = make.get(dim, lambda: box((1.0,) * 3, shape, cell=cell))()
    for name, (low, high) in zip(LAYERS, pairwise(edges), strict=False):
        mesh = mesh.with_region(name, lambda x, low=low, high=high: (low < x[:, 0]) & (x[:, 0] < high))
    return mesh


def marched(body: heat.Conductor, *loads: object, **given: object) -> heat.HeatStep:
    times = {"until": 1.0, "step": 0.1, **given}
    *_, last = heat.march_heat(heat.HeatScene(bodies={"b": body}, loads=loads), **times)
    return last


@pytest.mark.parametrize("cell", ["bar2", "bar3", "tri6", "quad4", "tet10", "hex8", "hex20"])
def test_a_wall_of_layers_conducts_by_the_sum_of_their_resistances(cell: str) -> None:
    body = heat.Conductor(mesh=layered(cell), law=LAYERS, density=1.0, temperature=300.0)
    ends = (heat.Temperature(on="b.left", value=400.0), heat.Temperature(on="b.right", value=300.0))
    last = marched(body, *ends, until=40.0, step=0.1)
    resistances = np.diff(EDGES) / [law.conductivity for law in LAYERS.values()]
    flux = 100.0 / resistances.sum()
    falls = 400.0 - flux * np.cumsum([0.0, *resistances])
    wanted = np.interp(body.mesh.points[:, 0], EDGES, falls)
    np.testing.assert_allclose(last.temperature["b"], wanted, atol=1e-9)
    assert last.ledger.relative_error < 1e-12


K, RHO, C, AT = (3.0, 0.5), (2.0, 5.0), (0.7, 0.2), 0.25
DIFFUSIVITY = [k / (rho * c) for k, rho, c in zip(K, RHO, C, strict=True)]


def mode() -> tuple[float, float, float]:
    """Rate of the slowest mode of an insulated bar of two layers, and its wave numbers."""

    def unbalanced(rate: float) -> float:
        first, last = (np.sqrt(rate / d) for d in DIFFUSIVITY)
        return K[0] * first * np.sin(first * AT) * np.cos(last * (1 - AT)) + K[1] * last * np.sin(
            last * (1 - AT)
        ) * np.cos(first * AT)

    rates = np.linspace(0.1, 20.0, 400)
    low = next(k for k, (a, b) in enumerate(pairwise(rates)) if unbalanced(a) * unbalanced(b) < 0.0)
    rate = brentq(unbalanced, rates[low], rates[low + 1], xtol=1e-14)
    return rate, *(float(np.sqrt(rate / d)) for d in DIFFUSIVITY)


@pytest.mark.parametrize("cell", ["bar2", "quad4"])
def test_a_mode_of_two_layers_decays_as_it_should(cell: str) -> None:
    rate, first, last = mode()
    laws = {name: heat.Conduction(conductivity=k, capacity=c) for name, k, c in zip(LAYERS, K, C, strict=False)}
    densities = dict(zip(LAYERS, RHO, strict=False))

    def shape(x: np.ndarray) -> np.ndarray:
        left = np.cos(first * x[:, 0]) / np.cos(first * AT)
        return 300.0 + np.where(x[:, 0] < AT, left, np.cos(last * (1.0 - x[:, 0])) / np.cos(last * (1.0 - AT)))

    errors = []
    for cells in (8, 16, 32):
        mesh = layered(cell, cells, (0.0, AT, 1.0))
        body = heat.Conductor(mesh=mesh, law=laws, density=densities, temperature=shape)
        end = marched(body, until=0.1, step=0.2 / cells**2, damped=False)
        exact = 300.0 + (shape(mesh.points) - 300.0) * np.exp(-0.1 * rate)
        errors.append(float(np.abs(end.temperature["b"] - exact).max()))
        assert end.ledger.relative_error < 1e-12 and abs(end.ledger.heat_content) > 1.0
    assert errors[-1] < 1e-3 * np.ptp(exact), errors
    assert all(1.9 < np.log2(coarse / fine) < 2.1 for coarse, fine in pairwise(errors)), errors


WATER = heat.Conduction(conductivity=0.6, capacity=4.0)
ICE = heat.Conduction(conductivity=2.0, capacity=2.0, latent=heat.Latent(heat=300.0, melting=273.0, liquid=WATER))
TABLE = heat.TemperatureTable(temperatures=(250.0, 350.0), values=(1.0, 4.0))
STEEP = heat.Conduction(conductivity=TABLE, capacity=TABLE)


@pytest.mark.slow
@pytest.mark.parametrize("law", [FELT, STEEP, ICE], ids=["constant", "table", "melting"])
@pytest.mark.parametrize("cell", ["bar2", "tri6", "quad9", "tet10"])
def test_regions_of_one_law_are_one_body(cell: str, law: heat.Conduction) -> None:
    mesh = layered(cell)
    loads = (heat.Temperature(on="b.left", value=310.0), heat.HeatSource(of="b.out", value=30.0))
    found = []
    for laws, density in ((law, 2.0), (dict.fromkeys(LAYERS, law), dict.fromkeys(LAYERS, 2.0))):
        body = heat.Conductor(mesh=mesh, law=laws, density=density, temperature=265.0)
        found.append(marched(body, *loads))
        assert found[-1].ledger.relative_error < 1e-12
    one, other = found
    np.testing.assert_allclose(other.temperature["b"], one.temperature["b"], rtol=1e-10)
    assert other.ledger.heat_content == pytest.approx(one.ledger.heat_content, rel=1e-9)
    assert other.entropy_produced == pytest.approx(one.entropy_produced, rel=1e-8)
    assert other.liquid_volume == pytest.approx(one.liquid_volume, rel=1e-9)


@pytest.mark.parametrize("cell", ["bar3", "quad4", "tri6", "tet4"])
def test_a_layer_melts_between_others_by_the_heat_that_it_takes(cell: str) -> None:
    """All heat of a source is in the capacities and in the latent heat of the layer, to rounding."""
    laws, densities = {**LAYERS, "middle": ICE}, {"in": 2.0, "middle": 1.5, "out": 1.0}
    body = heat.Conductor(mesh=layered(cell), law=laws, density=densities, temperature=263.0)
    of_solid, of_liquid = 2.0 * 2.0 * 0.25 + 3.0 * 0.5, 1.5 * 4.0 * 0.25
    wanted = of_solid * 20.0 + of_liquid * 10.0 + 1.5 * 0.25 * (2.0 * 10.0 + 300.0)
    ramp = sw.bodies.Ramp(times=(0.0, wanted - 0.5, wanted + 0.5, wanted + 50.0), factors=(1.0, 1.0, 0.0, 0.0))
    last = marched(body, heat.HeatSource(of="b", value=1.0, ramp=ramp), until=wanted + 50.0, step=5.0)
    assert last.ledger.relative_error < 1e-12
    assert last.ledger.heat_in == pytest.approx(wanted, rel=1e-12)
    assert last.liquid_volume["b"] == pytest.approx(0.25, rel=1e-12)
    np.testing.assert_allclose(last.temperature["b"], 283.0, atol=1e-6)


def test_a_node_between_regions_has_the_sum_of_their_capacities() -> None:
    laws = {"in": STEEP, "middle": WOOD, "out": ICE}
    mesh = layered("bar2")
    scene = heat.HeatScene(bodies={"b": heat.Conductor(mesh=mesh, law=laws, density=2.0, temperature=260.0)})
    model = heat.build_heat(scene)
    (part,) = model.parts
    slope = 1.0 + 3.0 * (300.0 - 250.0) / 100.0
    wanted = 0.25 * np.array([slope, slope + 3.0, 3.0 + 4.0, 8.0, 4.0])
    np.testing.assert_allclose(model.mass * part.curve.capacity(np.full(5, 300.0)), wanted, rtol=1e-13)


def test_a_solid_of_two_laws_and_densities_expands_without_stress() -> None:
    """Sources by its heat capacities warm it evenly, also at the nodes that its regions share."""
    mesh = layered("tri6", 4, (0.0, 0.5, 1.0))
    cold = {name: heat.Conduction(conductivity=1e-12, capacity=c) for name, c in (("in", 2.0), ("middle", 3.0))}
    density, alpha = {"in": 1.0, "middle": 4.0}, 1e-4
    steel = sw.LinearElastic(E=3.0, nu=0.25)
    body = sw.Solid(
        mesh=mesh, material=dict.fromkeys(density, steel), density=density, section=sw.bodies.PlaneStress(),
        thermal=Thermal(law=cold, temperature=300.0, expansion=alpha, reference=300.0),
        supports=(Fixed(on="left", components="x"), Fixed(on="bottom", components="y")),
    )  # fmt: skip
    taken = 2.0 * 3.0 / 0.75 * alpha**2 * 325.0  # 2 E/(1 - nu) alpha^2 theta of the strain, in both regions
    loads = [
        heat.HeatSource(of=f"b.{name}", value=(rho * cold[name].capacity + taken) * 50.0)
        for name, rho in density.items()
    ]
    scene = sw.Scene(bodies={"b": body}, loads=tuple(loads), inertia=sw.bodies.Off())
    *_, last = sw.march(scene, until=1.0, step=0.25)
    rise = last.after.fields["temperature"]["b"] - 300.0
    np.testing.assert_allclose(rise, 50.0, rtol=1e-10)
    np.testing.assert_allclose(last.after.displacement["b"], alpha * rise * mesh.points, atol=1e-12)
    assert abs(last.ledger.heat.error) < 1e-12 * last.ledger.heat.brought


def test_a_node_between_regions_has_the_mean_of_their_effusivities() -> None:
    mesh = layered("bar2", 4, (0.0, 0.5, 1.0))
    body = heat.Conductor(
        mesh=mesh, law={"in": STEEL, "middle": WOOD}, density={"in": 10.0, "middle": 3.0}, temperature=300.0
    )  # fmt: skip
    found = regional_laws(body, mesh).effusivity(mesh, np.full(4, 0.25))
    np.testing.assert_allclose(found, [10.0, 10.0, 6.5, 3.0, 3.0], rtol=1e-14)


@pytest.mark.parametrize(
    ("wrong", "where"),
    [
        ({"law": {"in": STEEL, "nowhere": FELT}}, "bodies.b.thermal.law"),
        ({"temperature": (300.0, 310.0)}, "bodies.b.thermal.temperature"),
    ],
)
def test_wrong_heat_of_a_solid_is_named_where_it_stands(wrong: dict, where: str) -> None:
    thermal = Thermal(**{"law": LAYERS, "temperature": 300.0} | wrong)
    solid = sw.Solid(mesh=layered("quad4"), material=sw.LinearElastic(E=1.0), density=1.0, thermal=thermal)
    with pytest.raises(sw.InputError) as found:
        sw.build(sw.Scene(bodies={"b": solid}))
    assert found.value.where.startswith(where)
