"""Heat of strain, of dissipation and of sources in quadratic cells whose shape functions have no positive integrals."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import softway as sw
from softway.bodies import Axisymmetric, Driven, Fixed, PlaneStress, Thermal
from softway.bodies.elements.heat_functions import QUADRATIC, heat_functions
from softway.bodies.elements.quadrature import sampled_cells
from softway.bodies.elements.section import PlaneStrain, Volume
from softway.bodies.inertia.mass_matrix import Lumped, nodal_mass
from softway.bodies.inertia.nodal_heat import heat_masses
from softway.heat.coupled.build import build
from softway.heat.coupled.strain.expansion import strained
from softway.meshes.cells import CELLS
from softway.meshes.generators.shapes import box, rectangle

E, NU, ALPHA, THETA, RHO, C = 3.0, 0.25, 1e-2, 300.0, 2.0, 0.5
COLD = sw.heat.Conduction(conductivity=1e-12, capacity=C)
LAWS = {"linear": sw.LinearElastic(E=E, nu=NU), "logarithmic": sw.laws.Hencky(E=E, nu=NU)}
CELL = tuple(QUADRATIC)


def mesh_of(cell: str, bend: float = 0.0) -> sw.Mesh:
    """A unit square or cube whose inner edges and faces are curved by ``bend``; its sides stay plane."""
    dim = CELLS[cell].dim
    mesh = rectangle((1.0, 1.0), (2, 2), cell=cell) if dim == 2 else box((1.0,) * 3, (2, 2, 2), cell=cell)
    x = mesh.points
    moved = np.stack([np.sin(np.pi * x[:, k]) * np.cos(2.0 * x[:, k - 1]) for k in range(dim)], axis=1)
    return sw.Mesh(points=x + bend * moved, blocks=mesh.blocks, tags=mesh.tags)


def body(cell: str, bend: float = 0.06, material: object = LAWS["linear"], **given: object) -> sw.Solid:
    """A block on rollers along its low sides."""
    mesh = mesh_of(cell, bend)
    sides = ("left", "bottom") if mesh.dim == 2 else ("left", "front", "bottom")
    supports = tuple(Fixed(on=side, components=letter) for side, letter in zip(sides, "xyz", strict=False))
    parts = {"thermal": Thermal(law=COLD, temperature=THETA, expansion=ALPHA), "supports": supports, **given}
    return sw.Solid(mesh=mesh, material=material, density=RHO, **parts)


def still(solid: sw.Solid, *loads: object) -> sw.Step:
    """End of a march without inertia."""
    scene = sw.Scene(bodies={"b": solid}, loads=loads, inertia=sw.bodies.Off())
    *_, last = sw.march(scene, until=1.0, step=0.5)
    return last


def section_of(cell: str) -> object:
    return PlaneStrain() if CELLS[cell].dim == 2 else Volume()


@pytest.mark.parametrize("cell", CELL)
def test_the_functions_have_the_integrals_of_the_scaled_diagonal(cell: str) -> None:
    mesh, section = mesh_of(cell), section_of(cell)
    wanted = nodal_mass(mesh, RHO, section, Lumped()).diagonal()
    np.testing.assert_allclose(heat_masses(mesh, section, RHO), wanted, rtol=1e-13)


@pytest.mark.parametrize("cell", CELL)
def test_the_functions_reproduce_linear_temperatures_between_straight_edges(cell: str) -> None:
    mesh = mesh_of(cell)
    sheared = mesh.points + 0.3 * np.roll(mesh.points, 1, axis=1)
    skew = sw.Mesh(points=sheared, blocks=mesh.blocks)
    for cells in sampled_cells(skew, section_of(cell), "point", small=False).kinds:
        values = heat_functions(cells)
        places = np.einsum("qa,ead->eqd", cells.element.N, cells.corners)
        np.testing.assert_allclose(np.einsum("eqa,ead->eqd", values, cells.corners), places, atol=1e-14)
        np.testing.assert_allclose(values.sum(axis=2), 1.0, atol=1e-14)


@pytest.mark.parametrize("cell", ["tri6", "quad8"])
def test_nodes_on_an_axis_have_capacities(cell: str) -> None:
    masses = [heat_masses(mesh_of(cell, bend), Axisymmetric(), RHO) for bend in (0.0, 0.06)]
    assert min(m.min() for m in masses) > 0.0
    assert masses[0].sum() == pytest.approx(np.pi * RHO, rel=1e-13)


@pytest.mark.parametrize("cell", CELL)
def test_a_source_warms_all_nodes_evenly(cell: str) -> None:
    """The shape functions would cool the corners of ``quad8``, ``tet10`` and ``hex20``, and leave those of ``tri6``."""
    sections = (None, Axisymmetric()) if CELLS[cell].dim == 2 else (None,)
    for bend, section in [(0.06, section) for section in sections]:
        block = sw.heat.Conductor(mesh=mesh_of(cell, bend), law=COLD, density=RHO, temperature=THETA, section=section)
        load = sw.heat.HeatSource(of="b", value=RHO * C * 50.0)
        scene = sw.heat.HeatScene(bodies={"b": block}, loads=(load,))
        *_, last = sw.heat.march_heat(scene, until=1.0, step=0.5)
        np.testing.assert_allclose(last.temperature["b"], THETA + 50.0, rtol=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("cell", CELL)
def test_a_free_body_of_curved_cells_expands_without_stress(cell: str, law: str) -> None:
    section = PlaneStress() if CELLS[cell].dim == 2 else None
    solid = body(cell, material=LAWS[law], section=section)
    last = still(solid, sw.heat.HeatSource(of="b", value=RHO * C * 5.0))
    rise = last.after.fields["temperature"]["b"] - THETA
    assert np.ptp(rise) < 1e-12 * THETA and 0.0 < rise[0, 0] < 5.0
    free = ALPHA * rise if law == "linear" else np.expm1(ALPHA * rise)
    np.testing.assert_allclose(last.after.displacement["b"], free * solid.mesh.points, atol=1e-11)
    assert np.abs(last.reactions["b"]).max() < 1e-11


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("cell", CELL)
def test_a_uniform_strain_of_curved_cells_takes_the_same_entropy_per_mass_at_all_nodes(cell: str, law: str) -> None:
    solid = body(cell, material=LAWS[law])
    temperature = build(sw.Scene(bodies={"b": solid})).companions[0]
    slope = np.array([[-0.1, 0.05, 0.02], [0.03, 0.2, 0.01], [0.04, -0.02, -0.05]])[: solid.mesh.dim, : solid.mesh.dim]
    entropy = strained(temperature.expansions, solid.mesh.points @ slope.T).held() / temperature.model.mass
    assert abs(entropy[0]) > 1e-4 and np.ptp(entropy) < 1e-12 * abs(entropy[0])


def pushed(cell: str, **given: object) -> sw.Step:
    """A block that is compressed; ``tet10`` with straight edges, as no curved one has a uniform stress."""
    solid = body(cell, 0.0 if cell == "tet10" else 0.06, **given)
    push = Driven(on="top", components="xyz"[solid.mesh.dim - 1], velocity=-0.1)
    return still(replace(solid, supports=(*solid.supports, push)))


@pytest.mark.parametrize("cell", CELL)
def test_a_compression_without_conduction_heats_all_nodes_equally(cell: str) -> None:
    rise = pushed(cell).after.fields["temperature"]["b"][:, 0] - THETA
    assert rise.min() > 0.5 and np.ptp(rise) < 1e-12 * rise.max()


@pytest.mark.slow
@pytest.mark.parametrize("cell", CELL)
def test_dissipation_heats_all_nodes_equally(cell: str) -> None:
    metal = sw.laws.J2(E=100.0, nu=0.3, yield_stress=1.0)
    last = pushed(cell, material=metal, thermal=Thermal(law=COLD, temperature=THETA))
    rise = last.after.fields["temperature"]["b"] - THETA
    np.testing.assert_allclose(rise, 0.9 * last.ledger.dissipation / (RHO * C), rtol=1e-10)


@pytest.mark.parametrize("cell", CELL)
def test_a_linear_temperature_bends_a_free_body_without_stress(cell: str) -> None:
    """Strain alpha times the rise: a parabola, which quadratic cells with straight edges have."""
    solid = body(cell, bend=0.0, section=PlaneStress() if CELLS[cell].dim == 2 else None, supports=())
    model = build(sw.Scene(bodies={"b": solid}))
    (part,), temperature = model.parts, model.companions[0]
    x, slope = part.mesh.points, np.array([3.0, -2.0, 1.5])[: part.mesh.dim]
    along = x @ slope
    u = ALPHA * (along[:, None] * x - 0.5 * (x**2).sum(axis=1)[:, None] * slope)
    force = temperature.at((THETA + along)[:, None], u).force
    own = part.internal.force(u).reshape(u.shape)
    assert np.abs(force).max() > 1e-2
    np.testing.assert_allclose(own + force, 0.0, atol=1e-14)


@pytest.mark.slow
def test_an_impact_keeps_energy_with_heat_and_its_entropy_never_falls() -> None:
    thermal = Thermal(
        law=sw.heat.Conduction(conductivity=3e-5, capacity=1.0 / THETA), temperature=THETA, expansion=5e-4
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(1.01, 0.0), normal=(-1.0, 0.0)))
    solid = sw.Solid(
        mesh=mesh_of("tri6", 0.04), material=sw.laws.Hencky(E=1.0, nu=0.3), density=1.0, thermal=thermal,
        velocity=sw.bodies.Uniform(value=(0.1, 0.02)),
    )  # fmt: skip
    scene = sw.Scene(bodies={"b": solid, "wall": wall}, contacts=(sw.Contact(between=("b.right", "wall")),))
    steps = list(sw.march(scene, until=3.5, step=0.07, method=sw.FixedPoint(tolerance=1e-13)))
    assert any(e.kind == "release" for s in steps for e in s.events) and steps[-1].ledger.momentum[0] < 0.0
    whole = [s.ledger.energy_kinetic + s.ledger.energy_strain + s.ledger.heat.content for s in steps]
    kinetic = steps[0].ledger.energy_kinetic
    assert np.ptp(whole) < 1e-10 * kinetic
    assert min(s.ledger.heat.produced for s in steps) > -1e-12 / THETA


def test_a_steady_state_with_a_source_is_of_second_order() -> None:
    law, errors = sw.heat.Conduction(conductivity=1.0, capacity=1.0), []
    for count in (2, 4, 8):
        square = sw.heat.Conductor(
            mesh=rectangle((1.0, 1.0), (count, count), cell="tri6"), law=law, density=1.0, temperature=THETA
        )
        walls = [sw.heat.Temperature(on=f"b.{side}", value=THETA) for side in ("left", "right")]
        scene = sw.heat.HeatScene(bodies={"b": square}, loads=(*walls, sw.heat.HeatSource(of="b", value=8.0)))
        *_, last = sw.heat.march_heat(scene, until=4.0, step=0.05)
        x = square.mesh.points[:, 0]
        errors.append(float(np.abs(last.temperature["b"] - THETA - 4.0 * x * (1.0 - x)).max()))
    assert errors[-1] < 5e-3
    assert all(np.log2(coarse / fine) > 1.95 for coarse, fine in pairwise(errors)), errors
