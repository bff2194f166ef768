"""Thickness of bodies behind their surfaces, and the overlap that it admits at the start of a slab."""

import numpy as np
import pytest

import softway as sw
from softway.contact.mortar.mortar import Mortar
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.stencils import SurfacePair
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.wall_thickness import DEPTH, nodal_thickness
from softway.meshes.generators.recipes import Ring
from softway.meshes.mesh import Mesh
from softway.model.model import Model


def surface(mesh: Mesh, tag: str = "surface") -> ContactSurface:
    return ContactSurface(facets=mesh.facets_on(tag))


@pytest.mark.parametrize("cell", ["quad4", "quad9", "tri3", "tri6"])
def test_a_strip_is_as_thick_as_it_is(cell: str) -> None:
    mesh = sw.meshes.Rectangle(size=(3.0, 0.2), cells=(6, 2), cell=cell).build()
    found = nodal_thickness(mesh.points, [surface(mesh)])
    assert found[mesh.nodes("top")] == pytest.approx(0.2, rel=1e-9)
    assert found[mesh.nodes("bottom")] == pytest.approx(0.2, rel=1e-9)


@pytest.mark.parametrize("cell", ["hex8", "hex27", "tet4", "tet10"])
def test_a_plate_is_as_thick_as_it_is(cell: str) -> None:
    mesh = sw.meshes.Box(size=(1.0, 1.0, 0.1), cells=(3, 3, 1), cell=cell).build()
    found = nodal_thickness(mesh.points, [surface(mesh)])
    assert found[mesh.nodes("top")] == pytest.approx(0.1, rel=1e-9)


def test_a_ring_has_the_thickness_of_its_wall_and_a_disc_none_within_a_facet() -> None:
    ring = Ring(inner=0.9, outer=1.0, cells=(2, 16)).build()
    assert nodal_thickness(ring.points, [surface(ring)])[ring.nodes("surface")] == pytest.approx(0.1, rel=0.05)
    disc = sw.meshes.Disc(radius=1.0, cells=6).build()
    assert np.isinf(nodal_thickness(disc.points, [surface(disc)])).all()


def test_a_fine_wall_against_coarse_facets_is_thin() -> None:
    """The overlap that is taken for contact goes by the size of the opponent's facets."""
    wall = sw.meshes.Rectangle(size=(1.0, 0.4), cells=(20, 8)).build()
    coarse = sw.meshes.Rectangle(size=(4.0, 4.0), cells=(1, 1)).build()
    first = len(wall.points)
    shifted = ContactSurface(facets={k: f + first for k, f in coarse.facets_on("surface").items()})
    found = nodal_thickness(np.concatenate([wall.points, coarse.points]), [surface(wall), shifted])
    assert found[wall.nodes("top")] == pytest.approx(0.4)


def folded(points: np.ndarray, t: float) -> np.ndarray:
    """Places of the nodes of a strip of length 8 that is folded about its middle, its legs 2 t rad to each other."""
    angle = t
    s, inner = points[:, 0] - 4.0, 0.5 * t - points[:, 1]
    along, across = np.abs(s), np.where(s < 0.0, -1.0, 1.0)
    legs = [along * np.cos(angle) + inner * np.sin(angle), across * (along * np.sin(angle) - inner * np.cos(angle))]
    mitre = [inner / np.sin(angle), np.zeros_like(s)]
    return np.where(np.abs(s) < 1e-9, mitre, legs).T


@pytest.mark.parametrize("t", [0.02, 0.05, 0.15, 0.3])
@pytest.mark.parametrize("mortar", [True, False])
@pytest.mark.parametrize("fold", [True, False])
def test_a_strip_does_not_touch_its_own_back(t: float, mortar: bool, fold: bool) -> None:
    """Facets of length 1, walls down to a fiftieth of it: without the thickness the thin ones are paired."""
    mesh = sw.meshes.Rectangle(size=(8.0, t), cells=(8, 2)).build()
    x, top, bottom = mesh.points, surface(mesh, "top"), surface(mesh, "bottom")
    x = folded(x, t) if fold else x

    def rows(thickness: np.ndarray | None) -> int:
        pair: SurfacePair = NodeToFacet(slaves=top.nodes, side=bottom, own=top, thickness=thickness)
        if mortar:
            pair = Mortar(slave_facets=top.facets, master_facets=bottom.facets, thickness=thickness)
        return int(np.isfinite(pair.meet(x, x, 1.0).at(x).gap).sum())

    assert rows(nodal_thickness(mesh.points, [surface(mesh)])) == 0
    assert (rows(None) > 0) == (t <= (0.2 if mortar else 0.1))


def test_a_folded_strip_meets_its_other_leg_and_not_its_back() -> None:
    """A body with itself, its thickness a twentieth of its facets: pairs through the wall have gaps of minus that."""
    t = 0.05
    mesh = sw.meshes.Rectangle(size=(8.0, t), cells=(8, 2)).build()
    body = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0)
    model = sw.build(sw.Scene(bodies={"a": body}, contacts=(sw.Contact(between=("a", "a")),)))
    u = folded(model.points, t) - model.points
    rows = model.contacts.rest(u, 0.0).at(u)
    gap = rows.gap(u)[rows.near]
    assert len(gap) >= 4 and gap.min() > 0.5 * t
    assert set(rows.node[rows.near]) <= set(model.parts[0].mesh.nodes("bottom"))


def plates(gap: float, method: object) -> tuple[Model, float]:
    """Two plates whose thickness is a tenth of their facets, over each other, 810 nodes; the upper one flies down."""
    side, count = 0.4, 8
    t = 0.1 * side / count
    names, levels, speeds = ("lower", "upper"), (0.0, (1.0 + gap) * t), (0.0, -10.0)
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Box(size=(side, side, t), cells=(count, count, 4), origin=(0.0, 0.0, level)),
            material=sw.NeoHookean(E=2e9, nu=0.3), density=1000.0, velocity=sw.bodies.Uniform(value=(0.0, 0.0, speed)),
        )
        for name, level, speed in zip(names, levels, speeds, strict=True)
    }  # fmt: skip
    contact = sw.Contact(between=("upper", "lower"), method=method)
    return sw.build(sw.Scene(bodies=bodies, contacts=(contact,))), t


@pytest.mark.parametrize("method", [None, sw.contact.NodeToSurface(nodes="both")], ids=["mortar", "nodes"])
def test_no_row_of_two_plates_starts_deeper_than_a_quarter_of_their_thickness(method: object) -> None:
    """Their outer faces look at each other, closer than a fifth of a facet through both plates."""
    model, t = plates(0.01, method)
    u, sunk = model.displacement, model.displacement.copy()
    for start in (u, sunk):
        gap = model.contacts.rest(start, 0.0).at(start).gap(start)
        near = gap[np.isfinite(gap)]
        assert len(near) >= 81 and near.min() >= -2.0 * DEPTH * t
        sunk[model.parts[1].nodes, 2] = -0.02 * t


@pytest.mark.slow
def test_two_thin_plates_march_through_touch_and_release() -> None:
    """Whole surface against whole surface."""
    model, _ = plates(0.3, None)
    steps = list(sw.march(model, until=1.9e-4, step=1e-5))
    kinds = [e.kind for s in steps for e in s.events]
    assert kinds.count("touch") > 50 and kinds.count("release") > 50
    assert sum(s.report.iterations for s in steps) < 300 and sum(len(s.report.rejections) for s in steps) < 5
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-8 * steps[0].ledger.energy_kinetic
