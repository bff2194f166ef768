"""Forces, energies and tangents on a device: as by the kernels of the processor, and exact for uniform strain."""

import numpy as np
import pytest

from softway.bodies.elements.section import default_section
from softway.bodies.internal_force.assembled import force_of, internal_force
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.device_force import on_device, served
from softway.bodies.internal_force.materials import materials_of
from softway.laws.bulk import LinearElastic, MooneyRivlin, NeoHookean, StVenantKirchhoff
from softway.laws.law import StoredEnergy
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

LAWS = [LinearElastic(E=2.0, nu=0.3), StVenantKirchhoff(E=2.0, nu=0.3), NeoHookean(E=2.0, nu=0.3)]
CELLS = ["tri3", "quad4", "tri6", "quad9", "tet4", "hex8", "tet10"]


def mesh_of(cell: str) -> Mesh:
    if cell.startswith(("tri", "quad")):
        return rectangle((1.0, 0.7), (4, 3), cell=cell)
    return box((1.0, 0.7, 0.5), (3, 2, 2), cell=cell)


def force_on(mesh: Mesh, law: StoredEnergy) -> BodyForce:
    return force_of(mesh, law, default_section(mesh), "point")


def difference(found: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(found - exact).max() / np.abs(exact).max())


@pytest.mark.parametrize("size", [0.01, 1e-9], ids=["large", "small"])
@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("cell", CELLS)
def test_as_on_the_processor(cell: str, law: StoredEnergy, size: float, device: str) -> None:
    force = force_on(mesh_of(cell), law)
    placed = on_device(force, device)
    rng = np.random.default_rng(0)
    u, w = size * rng.standard_normal((2, *mesh_of(cell).points.shape))
    energy, f = force.energy_and_force(u)
    assert placed.energy_and_force(u)[0] == pytest.approx(energy, rel=1e-13)
    assert difference(placed.energy_and_force(u)[1], f) < 1e-13
    assert difference(placed.tangent_product(u, w), force.tangent_product(u, w)) < 1e-13
    assert difference(placed.tangent_diagonal_blocks(u), force.tangent_diagonal_blocks(u)) < 1e-13


@pytest.mark.parametrize("stretch", [1e-8, 0.3])
def test_energy_of_a_uniform_stretch_is_exact(stretch: float, device: str) -> None:
    """``W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2`` for C = diag((1 + s)^2, 1, 1)."""
    mesh, E, nu = mesh_of("hex8"), 2.0, 0.3
    mu, lam = E / (2.0 * (1.0 + nu)), E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    placed = on_device(force_on(mesh, NeoHookean(E=E, nu=nu)), device)
    u = np.zeros(mesh.points.shape)
    u[:, 0] = stretch * mesh.points[:, 0]
    logarithm = np.log1p(stretch)
    small = stretch**2 * (1.0 - stretch / 1.5)  # s^2/2 + s - ln(1 + s) to third order, where it cancels
    first = small if stretch < 1e-4 else 0.5 * stretch**2 + stretch - logarithm
    exact = 0.35 * (mu * first + 0.5 * lam * logarithm**2)
    assert placed.energy_and_force(u)[0] == pytest.approx(exact, rel=1e-7 if stretch < 1e-4 else 1e-13)


def test_an_inverted_cell_has_no_force(device: str) -> None:
    mesh = mesh_of("tet4")
    placed = on_device(force_on(mesh, LAWS[2]), device)
    u = np.zeros(mesh.points.shape)
    u[0] = 9.0
    energy, force = placed.energy_and_force(u)
    assert energy == np.inf
    assert np.isnan(force[0]).all()


def test_the_same_bits_in_every_run(device: str) -> None:
    mesh = mesh_of("hex8")
    u = 0.01 * np.random.default_rng(1).standard_normal(mesh.points.shape)
    first, second = (on_device(force_on(mesh, LAWS[2]), device).energy_and_force(u) for _ in range(2))
    assert first[0] == second[0]
    assert (first[1] == second[1]).all()


def test_several_materials(device: str) -> None:
    mesh = rectangle((1.0, 0.7), (4, 3)).with_region("a", lambda x: x[:, 0] < 0.5)
    mesh = mesh.with_region("b", lambda x: x[:, 0] > 0.5)
    materials = materials_of(mesh, {"a": LAWS[0], "b": LAWS[2]}, 1.0)
    force = internal_force(mesh, materials, default_section(mesh), "point")
    u = 0.01 * np.random.default_rng(2).standard_normal(mesh.points.shape)
    assert difference(on_device(force, device).force(u), force.force(u)) < 1e-13


def test_what_stays_on_the_processor() -> None:
    mesh = mesh_of("quad4")
    other = force_on(mesh, MooneyRivlin(c10=1.0, c01=0.2, bulk=5.0))
    mean = force_of(mesh, LAWS[2], default_section(mesh), "mean")
    assert not served(other)
    assert not served(mean)
    assert served(force_on(mesh, LAWS[0]))
