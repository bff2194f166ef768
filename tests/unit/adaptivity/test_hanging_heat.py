"""Heat on meshes with hanging nodes: linear temperatures, capacities, diffusion, and transfer between such meshes."""

from dataclasses import replace

import numpy as np
import pytest
from turning import on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.heat import Heated, carried_heat
from softway.adaptivity.projections.projection import projection
from softway.arrays import Array
from softway.bodies.elements.following_heat import following_heat, kept_nodes
from softway.bodies.inertia.nodal_heat import cell_heat_masses, heat_masses
from softway.heat.build_heat import build_heat
from softway.heat.heat_model import HeatModel
from softway.heat.march import march_heat
from softway.meshes.adaptive.refinement import refined
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

CELLS = ["quad4", "quad8", "quad9", "hex8", "hex20", "hex27"]
SECTIONS = {2: sw.bodies.PlaneStrain(), 3: sw.bodies.Volume()}
LAW = sw.heat.Conduction(conductivity=2.0, capacity=3.0)


def mixed(cell: str, warp: float = 0.0, n: int = 4) -> Mesh:
    """A square or a cube of cells of several sizes, with inner nodes of the base mesh moved by up to ``warp``."""
    solid_ = cell.startswith("hex")
    base = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell) if solid_ else rectangle((1.0, 1.0), (n, n), cell=cell)
    inner = ((base.points > 0.0) & (base.points < 1.0)).all(axis=1)
    shift = np.random.default_rng(2).uniform(-warp, warp, base.points.shape)
    base = replace(base, points=base.points + shift * inner[:, None])
    near = np.linalg.norm(base.centres() - 0.3, axis=1) < (0.4 if solid_ else 0.3)
    return refined(base, np.where(near, base.dim, 0)).mesh


def model_of(mesh: Mesh, *loads: object, temperature: object = 300.0) -> HeatModel:
    body = sw.heat.Conductor(mesh=mesh, law=LAW, density=1.5, temperature=temperature)  # type: ignore[arg-type]
    return build_heat(sw.heat.HeatScene(bodies={"b": body}, loads=loads))  # type: ignore[arg-type]


@pytest.mark.parametrize("cell", CELLS)
def test_linear_temperature_of_a_flux(cell: str) -> None:
    mesh = mixed(cell, warp=0.03)
    assert mesh.hanging is not None
    flux = sw.heat.HeatFlux(on="b.right", value=20.0)
    model = model_of(mesh, sw.heat.Temperature(on="b.left", value=300.0), flux)
    matrix, free, (surface,) = model.conduction, model.free_nodes(), model.surfaces
    assert matrix is not None
    dense = matrix.toarray()
    assert dense == pytest.approx(dense.T, abs=1e-13)
    assert np.linalg.eigvalsh(dense)[0] == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.eigvalsh(dense)[1] > 1e-3
    power = surface.points.T @ (surface.areas * 20.0)
    over = np.zeros(model.n_nodes)
    over[free] = np.linalg.solve(dense[free][:, free], power[free])
    assert model.everywhere(over) == pytest.approx(10.0 * mesh.points[:, 0], abs=1e-12 * 10.0)


@pytest.mark.parametrize("cell", CELLS)
def test_capacities_are_positive_with_the_mass_and_its_centre(cell: str) -> None:
    mesh = mixed(cell)
    model, full = (
        model_of(mesh),
        heat_masses(mesh, SECTIONS[mesh.dim], 1.5),
    )
    assert model.mass.min() > 0.0
    assert model.mass.sum() == pytest.approx(1.5, rel=1e-13)
    assert model.mass @ mesh.points[kept_nodes(mesh)] == pytest.approx(full @ mesh.points, rel=1e-13)


@pytest.mark.parametrize("cell", ["quad4", "quad9"])
def test_a_mode_decays_with_second_order(cell: str) -> None:
    errors = []
    for n in (4, 8) if cell == "quad4" else (8, 16):
        mesh = mixed(cell, n=n)
        x, rate = mesh.points, 2.0 * np.pi**2 * 2.0 / (1.5 * 3.0)
        mode = np.cos(np.pi * x[:, 0]) * np.cos(np.pi * x[:, 1])
        model = model_of(mesh, temperature=300.0 + mode)
        *_, last = march_heat(model, until=0.08, step=0.04 / n, damped=False)
        found = last.temperature["b"] - 300.0
        errors.append(float(np.abs(found - mode * np.exp(-0.08 * rate)).max()))
        assert last.ledger.relative_error < 1e-12
    assert errors[1] < 0.32 * errors[0]
    assert errors[1] < 0.02


def heated(on: AdaptedSolid) -> Heated:
    return Heated(adapted=on.adapted, shares=cell_heat_masses(on.adapted.mesh, on.part.internal.section, 3.0))


def capacities(on: AdaptedSolid) -> Array:
    """Capacities of all nodes, zero of hanging ones."""
    mesh, out = on.adapted.mesh, heat_masses(on.adapted.mesh, on.part.internal.section, 3.0)
    follows = following_heat(mesh)
    if follows is None:
        return out
    whole = np.zeros(mesh.n_nodes)
    whole[kept_nodes(mesh)] = follows.spread.T @ out
    return whole


def followed(on: AdaptedSolid, values: Array) -> Array:
    hanging = on.adapted.mesh.hanging
    return values if hanging is None else hanging.following(values[:, None])[:, 0]


@pytest.mark.parametrize("cell", CELLS)
def test_contents_ranges_and_entropies_pass(cell: str) -> None:
    base = (
        box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell)
        if cell.startswith("hex")
        else rectangle((1.0, 1.0), (3, 3), cell=cell)
    )
    rng, body = np.random.default_rng(3), solid(base)
    for _ in range(2 if base.dim == 3 else 4):
        before, after = (on_levels(body, base.dim * rng.integers(0, 3, base.n_cells)) for _ in range(2))
        random = 1.0 + rng.uniform(size=len(before.points)) + 2.0 * before.points[:, 0] ** 2
        values, kept = followed(before, random), kept_nodes(before.adapted.mesh)
        at_nodes = projection(before, after).at_nodes  # type: ignore[union-attr]
        found, (one, other) = (
            carried_heat(heated(before), heated(after), at_nodes, values, np.log),
            map(capacities, (before, after)),
        )
        assert other @ found == pytest.approx(one @ values, rel=1e-14)
        assert found == pytest.approx(followed(after, found), rel=1e-14)
        own = found[kept_nodes(after.adapted.mesh)]
        assert values[kept].min() - 1e-12 <= own.min()
        assert own.max() <= values[kept].max() + 1e-12
        assert other @ np.log(found) >= one @ np.log(values) - 1e-12 * one.sum()


@pytest.mark.parametrize("cell", ["quad4", "hex8"])
def test_refined_cells_interpolate_a_linear_temperature(cell: str) -> None:
    base = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell) if cell == "hex8" else rectangle((1.0, 1.0), (3, 3), cell=cell)
    body, cut = solid(base), base.dim * (base.centres()[:, 0] < 0.5)
    before, after = on_levels(body, cut), on_levels(body, cut + base.dim * (base.centres()[:, 1] < 0.5))
    values = 300.0 + before.points @ np.array([4.0, 3.0, 2.0])[: base.dim]
    at_nodes = projection(before, after).at_nodes  # type: ignore[union-attr]
    found = carried_heat(heated(before), heated(after), at_nodes, values, np.log)
    assert found == pytest.approx(300.0 + after.points @ np.array([4.0, 3.0, 2.0])[: base.dim], rel=1e-14)
