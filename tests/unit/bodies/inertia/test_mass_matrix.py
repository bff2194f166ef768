"""Inertia: mass and centre of mass in every rule, exact values of single cells, redistribution."""

import dataclasses
import logging

import numpy as np
import pytest
from scipy import sparse
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric, Bar, PlaneStrain, PlaneStress, Section, Volume
from softway.bodies.inertia.mass_matrix import Consistent, Lumped, MassRule, nodal_mass
from softway.bodies.inertia.mass_redistribution import redistribute_mass
from softway.bodies.internal_force.elastic.elastic_force import elastic_force
from softway.errors import InputError
from softway.laws.bulk import LinearElastic
from softway.meshes.generators.shapes import KINDS, ball, box, cylinder, disc, interval, rectangle
from softway.meshes.mesh import Mesh

RULES = [Consistent(), Lumped()]


def bodies() -> list[tuple[Mesh, Section, float, tuple[float, ...]]]:
    """Meshes with sections, exact volume and centroid; straight cells."""
    found: list[tuple[Mesh, Section, float, tuple[float, ...]]] = []
    for cell in KINDS[1]:
        found.append((interval(2.0, 6, origin=1.0, cell=cell), Bar(area=3.0), 6.0, (2.0,)))
        found.append((interval(5.0, 6, direction=(3.0, 4.0), cell=cell), Bar(area=3.0), 15.0, (1.5, 2.0)))
    for cell in KINDS[2]:
        plane = rectangle((2.0, 1.0), (6, 4), origin=(1.0, 0.0), cell=cell)
        found.append((plane, PlaneStrain(thickness=0.5), 1.0, (2.0, 0.5)))
        found.append((plane, PlaneStress(thickness=2.0), 4.0, (2.0, 0.5)))
    for cell in KINDS[3]:
        found.append((box((2.0, 1.0, 1.0), (4, 4, 4), cell=cell), Volume(), 2.0, (1.0, 0.5, 0.5)))
    return found


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(("mesh", "section", "volume", "centre"), bodies())
def test_mass_and_centre_are_exact(mesh, section, volume, centre, rule) -> None:  # type: ignore[no-untyped-def]
    mass = nodal_mass(mesh, 7.0, section, rule)
    assert mass.sum() == pytest.approx(7.0 * volume, rel=1e-13)
    assert np.abs(mass.sum(axis=1) @ mesh.points / mass.sum() - centre).max() < 1e-13
    assert abs(mass - mass.T).max() < 1e-15 * mass.max() or abs(mass - mass.T).max() < 1e-15
    assert mass.diagonal().min() > 0.0


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize(("mesh", "section", "volume", "centre"), bodies())
def test_redistribution_keeps_mass_and_centre(mesh, section, volume, centre, rule) -> None:  # type: ignore[no-untyped-def]
    for tag in ("right", "surface"):
        nodes = mesh.nodes(tag)
        mass = redistribute_mass(mesh, 7.0, section, rule, nodes)
        assert mass[nodes].nnz == 0 and mass[:, nodes].nnz == 0
        assert mass.sum() == pytest.approx(7.0 * volume, rel=1e-13)
        assert np.abs(mass.sum(axis=1) @ mesh.points / mass.sum() - centre).max() < 1e-12
        others = np.setdiff1d(np.arange(mesh.n_nodes), nodes)
        np.linalg.cholesky(mass.toarray()[np.ix_(others, others)])  # positive definite, or it raises
        if isinstance(rule, Lumped):
            assert mass.nnz == len(others)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("cell", ["quad4", "tri6"])
def test_axisymmetric_ring(cell: str, rule) -> None:  # type: ignore[no-untyped-def]
    """Ring 1 < r < 3, 0 < y < 1: volume 8 pi; integral of r over it 2 pi (27 - 1) / 3."""
    mesh = rectangle((2.0, 1.0), (6, 4), origin=(1.0, 0.0), cell=cell)
    volume, radius = 8.0 * np.pi, 2.0 * np.pi * 26.0 / 3.0 / (8.0 * np.pi)
    assert nodal_mass(mesh, 1.0, Axisymmetric(), rule).sum() == pytest.approx(volume, rel=1e-13)
    moved = redistribute_mass(mesh, 1.0, Axisymmetric(), rule, mesh.nodes("left"))
    assert moved.sum() == pytest.approx(volume, rel=1e-13)
    assert moved.sum(axis=1) @ mesh.points / volume == pytest.approx([radius, 0.5], rel=1e-12)


@pytest.mark.parametrize(
    ("cell", "diagonal"),
    [
        ("bar3", (1 / 6, 1 / 6, 2 / 3)),
        ("quad8", (3 / 76,) * 4 + (16 / 76,) * 4),
        ("quad9", (1 / 36,) * 4 + (1 / 9,) * 4 + (4 / 9,)),
        ("tri6", (3 / 57,) * 3 + (16 / 57,) * 3),
        ("tet10", (1 / 36,) * 4 + (4 / 27,) * 6),
    ],
)
def test_scaled_diagonals_of_quadratic_cells(cell: str, diagonal: tuple[float, ...]) -> None:
    """Hinton, Rock and Zienkiewicz: shares of the squares of the shape functions in the mass of the cell."""
    from softway.meshes.element import CELLS

    points = CELLS[cell].nodes
    mesh = Mesh(points=points, blocks={cell: np.arange(len(points))[None]})
    section = {1: Bar(), 2: PlaneStrain(), 3: Volume()}[mesh.dim]
    mass = nodal_mass(mesh, 1.0, section, Lumped()).diagonal()
    assert mass / mass.sum() == pytest.approx(diagonal, rel=1e-12)


def test_consistent_quad4() -> None:
    """1/36 of (4 2 1 2) around the unit square."""
    mass = nodal_mass(rectangle((1.0, 1.0), (1, 1)), 36.0, PlaneStrain(), Consistent()).toarray()
    assert np.abs(mass - [[4, 2, 2, 1], [2, 4, 1, 2], [2, 1, 4, 2], [1, 2, 2, 4]]).max() < 1e-13


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("cell", ["tet10", "hex20", "hex27", "hex8"])
def test_round_bodies_lose_all_inertia_on_their_surface(cell: str, rule) -> None:  # type: ignore[no-untyped-def]
    for mesh in (ball(0.5, 4, centre=(1.0, 2.0, 3.0), cell=cell), cylinder(0.5, 1.0, (4, 4), cell=cell)):
        plain = nodal_mass(mesh, 1.0, Volume(), Consistent())
        centre = plain.sum(axis=1) @ mesh.points / plain.sum()
        mass = redistribute_mass(mesh, 1.0, Volume(), rule, mesh.nodes("side" if "side" in mesh.tags else "surface"))
        assert mass.sum() == pytest.approx(plain.sum(), rel=1e-13)
        assert np.abs(mass.sum(axis=1) @ mesh.points / mass.sum() - centre).max() < 1e-12


def test_bar_with_one_massless_end() -> None:
    """Six nodes, lumped: the end's half mass moves one edge inwards, the density grows linearly towards that end."""
    mesh = interval(1.0, 5)
    mass = redistribute_mass(mesh, 1.0, Bar(), Lumped(), np.array([5]), cells=1).diagonal()
    assert mass[5] == 0.0
    steps = np.diff(mass[1:4])
    assert steps[0] == pytest.approx(steps[1], rel=1e-12)
    assert mass @ mesh.points[:, 0] == pytest.approx(0.5, rel=1e-14)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("cells", [1, 3, 5])
def test_moments_of_inertia_are_kept(cells: int, rule) -> None:  # type: ignore[no-untyped-def]
    """Unit square, all sides massless: 1/12 about each axis through the centre, no product; 1/(6 N^2) more lumped."""
    mesh = rectangle((1.0, 1.0), (20, 20))
    mass = redistribute_mass(mesh, 1.0, PlaneStrain(), rule, mesh.nodes("surface"), cells)
    x = mesh.points - 0.5
    more = 1.0 / (6.0 * 20**2) if rule == Lumped() else 0.0
    assert x.T @ (mass @ x) == pytest.approx(np.eye(2) * (1.0 / 12.0 + more), abs=1e-13)


@pytest.mark.parametrize("tags", [("right",), ("left", "right")])
@pytest.mark.parametrize("cell", ["quad4", "quad9", "hex8"])
def test_columns_of_a_product_mesh_are_in_exact_proportion(cell: str, tags: tuple[str, ...]) -> None:
    """M = A x B, B the plain matrix across: a motion that does not vary across stays so, and nothing moves sideways."""
    across = rectangle((1.0, 1.0), (1, 3), cell=cell) if cell != "hex8" else box((1.0, 1.0, 0.5), (1, 3, 2))
    mesh = rectangle((2.0, 1.0), (9, 3), cell=cell) if cell != "hex8" else box((2.0, 1.0, 0.5), (9, 3, 2))
    section = PlaneStrain() if cell != "hex8" else Volume()
    nodes = np.unique(np.concatenate([mesh.nodes(t) for t in tags]))
    blocks = by_column(mesh, redistribute_mass(mesh, 1.0, section, Consistent(), nodes).toarray())
    one = by_column(across, nodal_mass(across, 1.0, section, Consistent()).toarray())[0]
    share = blocks @ one / (one @ one)
    assert share.max() > 0.05
    assert np.abs(blocks - np.outer(share, one)).max() <= 1e-14 * np.abs(blocks).max()


def by_column(mesh: Mesh, mass: Array) -> Array:
    """Blocks (m m, n n) that couple the m columns, of n nodes each, at the same first coordinate."""
    x = mesh.points.round(9)
    order, m = np.lexsort(x.T[::-1]), len(np.unique(x[:, 0]))
    n = len(x) // m
    return mass[np.ix_(order, order)].reshape(m, n, m, n).transpose(0, 2, 1, 3).reshape(m * m, n * n)


def test_fewer_cells_are_filled_before_the_moments_are_given_up(caplog: pytest.LogCaptureFixture) -> None:
    """Eight by eight cells, all sides massless: two cells would need a negative density, one does not."""
    mesh = rectangle((1.0, 1.0), (8, 8))
    nodes = mesh.nodes("surface")
    with caplog.at_level(logging.INFO):
        mass = redistribute_mass(mesh, 1.0, PlaneStrain(), Consistent(), nodes)
    assert not caplog.text
    x = mesh.points - 0.5
    assert x.T @ (mass @ x) == pytest.approx(np.eye(2) / 12.0, abs=1e-13)
    assert abs(mass - redistribute_mass(mesh, 1.0, PlaneStrain(), Consistent(), nodes, cells=1)).max() < 1e-15
    others = np.setdiff1d(np.arange(mesh.n_nodes), nodes)
    assert np.linalg.eigvalsh(mass.toarray()[np.ix_(others, others)]).min() > 0.0


def test_where_one_cell_is_too_much_the_moments_of_inertia_change(caplog: pytest.LogCaptureFixture) -> None:
    mesh = rectangle((1.0, 1.0), (6, 6))
    with caplog.at_level(logging.INFO):
        mass = redistribute_mass(mesh, 1.0, PlaneStrain(), Consistent(), mesh.nodes("surface"))
    assert [r.levelname for r in caplog.records] == ["INFO"]
    x = mesh.points - 0.5
    assert np.abs(mass.sum(axis=1) @ x).max() < 1e-14
    assert x.T @ (mass @ x) == pytest.approx(0.8343 * np.eye(2) / 12.0, abs=1e-4)


def test_a_thin_body_gives_up_what_is_across_it_first(caplog: pytest.LogCaptureFixture) -> None:
    """Strips of two cells, all sides massless, with slanted columns: centre and moment along them stay exact."""
    mesh, wave = rectangle((1.0, 0.05), (20, 2)), np.sin(np.arange(63.0) ** 2)
    slanted = dataclasses.replace(mesh, points=mesh.points + 0.01 * wave[:, None] * [1.0, 0.0])
    with caplog.at_level(logging.INFO):
        found = redistribute_mass(slanted, 1.0, PlaneStrain(), Consistent(), slanted.nodes("surface"))
    assert "moves across the body" in caplog.text
    plain = nodal_mass(slanted, 1.0, PlaneStrain(), Consistent())
    x, y = slanted.points.T
    for field in (np.ones(63), x):
        assert field @ (found @ x) == pytest.approx(field @ (plain @ x), rel=1e-13)
    assert np.abs((found - plain).sum(axis=1) @ y) < 0.01 * 0.05 * plain.sum()


def test_a_wavy_strip_keeps_its_centre_and_the_moment_along_it(caplog: pytest.LogCaptureFixture) -> None:
    """Of the polar moment only the share of the cross-section goes, (t / L)^2."""
    mesh = rectangle((1.0, 0.05), (20, 2))
    bent = mesh.points + 0.02 * np.sin(6.0 * mesh.points[:, :1]) * [0.0, 1.0]
    mesh = dataclasses.replace(mesh, points=bent)
    with caplog.at_level(logging.INFO):
        found = redistribute_mass(mesh, 1.0, PlaneStrain(), Consistent(), mesh.nodes("surface"))
    assert not caplog.text
    plain = nodal_mass(mesh, 1.0, PlaneStrain(), Consistent())
    assert found.sum(axis=1) @ bent == pytest.approx(plain.sum(axis=1) @ bent, rel=1e-13)
    centred = bent - plain.sum(axis=1) @ bent / plain.sum()
    polar = [np.einsum("ni,ni->", centred, mass @ centred) for mass in (found, plain)]
    assert polar[0] / polar[1] == pytest.approx(1.0 / (1.0 + 0.05**2), abs=1e-3)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("cells", [1, 2, 5])
@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8", "quad9"])
def test_positive_definite_on_distorted_meshes(cell: str, cells: int, rule) -> None:  # type: ignore[no-untyped-def]
    """A congruence of the matrix of a positive density: never less than that density."""
    mesh = rectangle((1.0, 1.0), (12, 12), cell=cell)
    corners = mesh.points - 0.5
    mesh = dataclasses.replace(mesh, points=mesh.points + 0.02 * np.sin(9.0 * corners[:, ::-1]))
    plain = nodal_mass(mesh, 1.0, PlaneStrain(), rule).toarray()
    for tag in ("bottom", "surface"):
        mass = redistribute_mass(mesh, 1.0, PlaneStrain(), rule, mesh.nodes(tag), cells).toarray()
        heavy = np.ix_(*2 * [np.setdiff1d(np.arange(mesh.n_nodes), mesh.nodes(tag))])
        assert eigh(mass[heavy], plain[heavy], eigvals_only=True)[0] >= 0.1


def test_a_bar_spreads_the_inertia_of_its_end_over_five_cells() -> None:
    """Two thirds of a cell's mass, a fifth to each of the next five nodes, before the density is adjusted."""
    mesh = interval(1.0, 100)
    mass = redistribute_mass(mesh, 100.0, Bar(), Consistent(), np.array([100]))
    more = np.asarray(mass.sum(axis=1)).ravel()[:100] - 1.0
    assert more[95:99] == pytest.approx(2.0 / 15.0, rel=0.15)
    assert more[5:94].max() < 0.02


def test_candidates_without_other_nodes_in_their_cells_reach_further() -> None:
    mesh = rectangle((4.0, 1.0), (8, 2))
    right = np.flatnonzero(mesh.points[:, 0] > 2.4)
    mass = redistribute_mass(mesh, 1.0, PlaneStrain(), Consistent(), right)
    assert mass.sum() == pytest.approx(4.0, rel=1e-13)
    assert mass[right].nnz == 0


def test_centre_is_given_up_with_a_warning_where_density_would_vanish(caplog: pytest.LogCaptureFixture) -> None:
    mesh = interval(1.0, 2)
    with caplog.at_level(logging.WARNING):
        mass = redistribute_mass(mesh, 1.0, Bar(), Consistent(), np.array([2]))
    assert "centre of mass" in caplog.text
    assert mass.sum() == pytest.approx(1.0, rel=1e-14)
    assert mass[2].nnz == 0


def test_what_has_no_inertia_left_is_refused() -> None:
    mesh = disc(1.0, 4)
    with pytest.raises(InputError, match="the part is one element thick there"):
        redistribute_mass(mesh, 1.0, PlaneStrain(), Consistent(), mesh.nodes("all"))
    for density in (0.0, -1.0, float("nan")):
        with pytest.raises(InputError) as caught:
            nodal_mass(mesh, density, PlaneStrain(), Consistent())
        assert caught.value.where == "density"


def frequency_error(cell: str, cells: int, rule: MassRule) -> float:
    """Relative error of the square of a frequency: a unit cube or square between slippery walls.

    The wave is u = grad prod cos(pi x_i): it has no shear, and omega^2 = pi^2 d c^2, c the speed of pressure waves.
    """
    solid = cell.startswith(("hex", "tet"))
    mesh = box((1.0,) * 3, (cells,) * 3, cell=cell) if solid else rectangle((1.0,) * 2, (cells,) * 2, cell=cell)
    section, law = Volume() if solid else PlaneStrain(), LinearElastic(E=1.0, nu=0.3)
    x, exact = mesh.points, np.pi**2 * mesh.dim * 0.7 / (1.3 * 0.4)
    free = np.flatnonzero((x > 1e-9) & (x < 1.0 - 1e-9))
    stiffness = elastic_force(mesh, law, section).tangent(np.zeros_like(x)).tocsc()[free][:, free]
    mass = sparse.kron(nodal_mass(mesh, 1.0, section, rule), sparse.eye_array(mesh.dim)).tocsc()[free][:, free]
    wave = [np.sin(np.pi * x[:, i]) * np.prod(np.cos(np.pi * np.delete(x, i, axis=1)), axis=1) for i in range(mesh.dim)]
    found, modes = eigsh(stiffness, k=6, M=mass, sigma=1.0001 * exact, v0=np.ones(len(free)))
    return float(found[np.abs(modes.T @ (mass @ np.stack(wave, axis=1).ravel()[free])).argmax()] / exact - 1.0)


@pytest.mark.parametrize(
    ("cell", "rule", "order"),
    [("quad8", Consistent(), 4.0), ("quad8", Lumped(), 2.0), ("quad9", Consistent(), 4.0), ("quad9", Lumped(), 4.0)],
)
def test_frequencies_converge(cell: str, rule: MassRule, order: float) -> None:
    """Scaled diagonals are a quadrature rule of Lobatto on quad9, and of a lower order without the middle node."""
    coarse, fine = (frequency_error(cell, n, rule) for n in (4, 8))
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.2)


def test_consistent_hex20_has_the_frequency_of_hex27() -> None:
    coarse, fine = (frequency_error("hex20", n, Consistent()) for n in (2, 4))
    assert coarse / fine > 2.0**4
    assert 0.0 < fine < 3e-4
