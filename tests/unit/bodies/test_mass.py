"""Inertia: mass and centre of mass in every rule, exact values of single cells, redistribution."""

import logging

import numpy as np
import pytest

from softway.bodies.mass import Consistent, Lumped, nodal_mass
from softway.bodies.redistribution import redistributed
from softway.bodies.section import Axisymmetric, Bar, PlaneStrain, PlaneStress, Section, Volume
from softway.errors import InputError
from softway.space.mesh import Mesh
from softway.space.shapes import KINDS, ball, box, cylinder, disc, interval, rectangle

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
        mass = redistributed(mesh, 7.0, section, rule, nodes)
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
    moved = redistributed(mesh, 1.0, Axisymmetric(), rule, mesh.nodes("left"))
    assert moved.sum() == pytest.approx(volume, rel=1e-13)
    assert moved.sum(axis=1) @ mesh.points / volume == pytest.approx([radius, 0.5], rel=1e-12)


@pytest.mark.parametrize(
    ("cell", "diagonal"),
    [
        ("bar3", (1 / 6, 1 / 6, 2 / 3)),
        ("quad9", (1 / 36,) * 4 + (1 / 9,) * 4 + (4 / 9,)),
        ("tri6", (3 / 57,) * 3 + (16 / 57,) * 3),
        ("tet10", (1 / 36,) * 4 + (4 / 27,) * 6),
    ],
)
def test_scaled_diagonals_of_quadratic_cells(cell: str, diagonal: tuple[float, ...]) -> None:
    """Hinton, Rock and Zienkiewicz: shares of the squares of the shape functions in the mass of the cell."""
    from softway.space.element import CELLS

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
@pytest.mark.parametrize("cell", ["tet10", "hex27", "hex8"])
def test_round_bodies_lose_all_inertia_on_their_surface(cell: str, rule) -> None:  # type: ignore[no-untyped-def]
    for mesh in (ball(0.5, 4, centre=(1.0, 2.0, 3.0), cell=cell), cylinder(0.5, 1.0, (4, 4), cell=cell)):
        plain = nodal_mass(mesh, 1.0, Volume(), Consistent())
        centre = plain.sum(axis=1) @ mesh.points / plain.sum()
        mass = redistributed(mesh, 1.0, Volume(), rule, mesh.nodes("side" if "side" in mesh.tags else "surface"))
        assert mass.sum() == pytest.approx(plain.sum(), rel=1e-13)
        assert np.abs(mass.sum(axis=1) @ mesh.points / mass.sum() - centre).max() < 1e-12


def test_bar_with_one_massless_end() -> None:
    """Six nodes, lumped: the end's half mass moves one edge inwards, the density grows linearly towards that end."""
    mesh = interval(1.0, 5)
    mass = redistributed(mesh, 1.0, Bar(), Lumped(), np.array([5]), cells=1).diagonal()
    assert mass[5] == 0.0
    steps = np.diff(mass[1:4])
    assert steps[0] == pytest.approx(steps[1], rel=1e-12)
    assert mass @ mesh.points[:, 0] == pytest.approx(0.5, rel=1e-14)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("cells", [1, 3, 5])
def test_moments_of_inertia_are_kept(cells: int, rule) -> None:  # type: ignore[no-untyped-def]
    """Unit square, all sides massless: 1/12 about each axis through the centre, no product."""
    mesh = rectangle((1.0, 1.0), (20, 20))
    mass = redistributed(mesh, 1.0, PlaneStrain(), rule, mesh.nodes("surface"), cells)
    x = mesh.points - 0.5
    assert x.T @ (mass @ x) == pytest.approx(np.eye(2) / 12.0, abs=1e-13)


def test_a_bar_spreads_the_inertia_of_its_end_over_five_cells() -> None:
    """Two thirds of a cell's mass, a fifth to each of the next five nodes, before the density is adjusted."""
    mesh = interval(1.0, 100)
    mass = redistributed(mesh, 100.0, Bar(), Consistent(), np.array([100]))
    more = np.asarray(mass.sum(axis=1)).ravel()[:100] - 1.0
    assert more[95:99] == pytest.approx(2.0 / 15.0, rel=0.15)
    assert more[5:94].max() < 0.02


def test_candidates_without_other_nodes_in_their_cells_reach_further() -> None:
    mesh = rectangle((4.0, 1.0), (8, 2))
    right = np.flatnonzero(mesh.points[:, 0] > 2.4)
    mass = redistributed(mesh, 1.0, PlaneStrain(), Consistent(), right)
    assert mass.sum() == pytest.approx(4.0, rel=1e-13)
    assert mass[right].nnz == 0


def test_centre_is_given_up_with_a_warning_where_density_would_vanish(caplog: pytest.LogCaptureFixture) -> None:
    mesh = interval(1.0, 2)
    with caplog.at_level(logging.WARNING):
        mass = redistributed(mesh, 1.0, Bar(), Consistent(), np.array([2]))
    assert "centre of mass" in caplog.text
    assert mass.sum() == pytest.approx(1.0, rel=1e-14)
    assert mass[2].nnz == 0


def test_what_has_no_inertia_left_is_refused() -> None:
    mesh = disc(1.0, 4)
    with pytest.raises(InputError, match="candidate nodes have no other node"):
        redistributed(mesh, 1.0, PlaneStrain(), Consistent(), mesh.nodes("all"))
    for density in (0.0, -1.0, float("nan")):
        with pytest.raises(InputError) as caught:
            nodal_mass(mesh, density, PlaneStrain(), Consistent())
        assert caught.value.where == "density"
