"""Turning and moving a mesh."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies.setup.directions import directions
from softway.bodies.setup.placement import Mirror, Placement, Rotation
from softway.bodies.solid import Fixed, placed_together
from softway.errors import InputError
from softway.marching.remeshing.adapted_scene import adapted_scene
from softway.meshes.adaptive.refinement import refined
from softway.meshes.generators.recipes import Ring
from softway.meshes.generators.shapes import box, interval, rectangle

BOX = box((3.0, 2.0, 1.0), (1, 1, 1))
QUARTER = np.pi / 2


def test_nothing_to_do_keeps_the_mesh():
    assert Placement().applied(BOX) is BOX


def test_a_quarter_turn_exchanges_the_sides_and_keeps_the_centre():
    turned = Placement(rotations=(Rotation(axis=(0.0, 0.0, 2.0), angle=QUARTER),)).applied(BOX)
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), [2.0, 3.0, 1.0], atol=1e-14)
    np.testing.assert_allclose(turned.points.mean(axis=0), BOX.points.mean(axis=0), atol=1e-14)


def test_turns_are_about_fixed_axes_in_order():
    turns = (Rotation(axis=(1.0, 0.0, 0.0), angle=QUARTER), Rotation(axis=(0.0, 0.0, 1.0), angle=QUARTER))
    turned = Placement(rotations=turns).applied(BOX)
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), [1.0, 3.0, 2.0], atol=1e-14)


def test_rotation_matrices_are_proper():
    matrix = Rotation(axis=(1.0, -2.0, 0.5), angle=1.234).matrix()
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(matrix) == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(matrix @ [1.0, -2.0, 0.5], [1.0, -2.0, 0.5], atol=1e-14)


def test_the_bottom_is_set_after_the_turn_and_the_shift():
    place = Placement(rotations=(Rotation(axis=(1.0, 1.0, 0.0), angle=0.7),), translation=(5.0, 0.0, 9.0), bottom=0.25)
    placed = place.applied(BOX)
    assert placed.points[:, 2].min() == 0.25
    assert placed.points[:, 0].mean() == pytest.approx(6.5)
    assert sorted(placed.tags) == sorted(BOX.tags)


def test_one_and_two_dimensions():
    assert Placement(translation=2.0).applied(interval(1.0, cells=1)).points.ravel().tolist() == [2.0, 3.0]
    turned = Placement(rotations=(Rotation(angle=QUARTER),), bottom=0.0).applied(rectangle((2.0, 1.0), (1, 1)))
    np.testing.assert_allclose(np.ptp(turned.points, axis=0), [1.0, 2.0], atol=1e-15)


def test_rotations_about_a_point():
    place = Placement(rotations=(Rotation(angle=QUARTER),), about=(1.0, 0.0))
    turned = place.applied(rectangle((2.0, 1.0), (2, 1)))
    np.testing.assert_allclose(turned.points[0], [1.0, -1.0], atol=1e-15)
    np.testing.assert_allclose(turned.points[2], [1.0, 1.0], atol=1e-15)


def volume(mesh):
    """Volumes around the points of quadrature."""
    solid = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0)
    return sw.build(sw.Scene(bodies={"body": solid})).parts[0].internal.sampling.volume


VOLUMES = ["hex8", "hex20", "hex27", "tet4", "tet10"]
SHEETS = ["quad4", "quad8", "quad9", "tri3", "tri6"]


@pytest.mark.parametrize("cell", [*SHEETS, *VOLUMES, "bar2", "bar3"])
def test_a_mirror_image_has_its_cells_the_right_way_round(cell):
    """Same volume, tags at the images of their nodes, outward normals of its sides, and twice mirrored the mesh."""
    if cell in SHEETS:
        mesh = rectangle((2.0, 1.0), (2, 3), cell=cell)
    else:
        mesh = box((1.0, 2.0, 1.5), (2, 1, 2), cell=cell) if cell in VOLUMES else interval(1.0, cells=3, cell=cell)
    mirror = Mirror(normal=(1.0, 2.0, -0.5)[: mesh.dim], point=(0.3, 0.1, 0.2)[: mesh.dim])
    place = Placement(mirror=mirror)
    image = place.applied(mesh)
    n = np.array(mirror.normal) / np.linalg.norm(mirror.normal)
    expected = mesh.points - 2.0 * np.outer((mesh.points - mirror.point) @ n, n)
    np.testing.assert_allclose(image.points, expected, atol=1e-15)
    volumes = [volume(m) for m in (mesh, image)]
    assert (volumes[1] > 0.0).all() and volumes[1].sum() == pytest.approx(volumes[0].sum(), rel=1e-14)
    for tag in mesh.tags:
        assert (image.nodes(tag) == mesh.nodes(tag)).all()
    if mesh.dim > 1:
        for tag in ("left", "top"):
            plain, turned = (directions(Fixed(on=tag, direction="normal"), m)[1] for m in (mesh, image))
            np.testing.assert_allclose(turned, plain - 2.0 * np.outer(plain @ n, n), atol=1e-14)
    np.testing.assert_allclose(place.applied(image).points, mesh.points, atol=1e-15)


def march_of(angle, mirrored):
    """Two blocks of a group that meet, turned together about a point, or mirrored as well."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 0.6), cells=(2, 2)), material=sw.NeoHookean(E=10.0, nu=0.3), density=1.0
    )
    far = replace(block, place=Placement(rotations=(Rotation(angle=0.1),), translation=(1.1, 0.17)))
    place = Placement(
        mirror=Mirror(normal=(1.0, 0.4)) if mirrored else None, rotations=(Rotation(angle=angle),), about=(0.4, -2.0)
    )
    image = placed_together({"one": block, "other": far}, place)
    n = np.array([1.0, 0.4]) / np.linalg.norm([1.0, 0.4])
    frame = Rotation(angle=angle).matrix()[:2, :2] @ (np.eye(2) - 2.0 * mirrored * np.outer(n, n))
    speed = sw.bodies.Uniform(value=tuple((frame @ [0.3, 0.1]).tolist()))
    image["one"] = replace(image["one"], velocity=speed)
    contact = sw.Contact(between=("one.right", "other.left"))
    return list(sw.march(sw.Scene(bodies=image, contacts=(contact,)), until=1.5, step=0.05))


@pytest.mark.slow
@pytest.mark.parametrize("mirrored", [False, True], ids=["turned", "mirrored"])
def test_a_group_that_is_placed_together_moves_the_same(mirrored):
    """The same energies and contact forces, whatever the frame."""
    plain, image = march_of(0.0, False), march_of(0.7, mirrored)
    assert len(plain) == len(image) and sum(len(s.events) for s in plain) > 0
    for s, t in zip(plain, image, strict=True):
        assert t.ledger.energy_strain == pytest.approx(s.ledger.energy_strain, abs=1e-13)
        assert t.ledger.energy_kinetic == pytest.approx(s.ledger.energy_kinetic, abs=1e-13)
        assert abs(t.ledger.energy_error) < 1e-12


@pytest.mark.parametrize(
    ("place", "mesh", "where"),
    [
        (Placement(translation=(1.0, 2.0)), BOX, "translation"),
        (Placement(about=(1.0, 2.0)), BOX, "about"),
        (Placement(mirror=Mirror(normal=(1.0, 2.0))), BOX, "mirror"),
        (Placement(rotations=(Rotation(angle=1.0),)), interval(1.0, cells=1), "rotations[0].axis"),
        (
            Placement(rotations=(Rotation(angle=1.0, axis=(1.0, 0.0, 0.0)),)),
            rectangle((1.0, 1.0), (1, 1)),
            "rotations[0].axis",
        ),
    ],
)
def test_what_does_not_fit_the_space_is_refused(place, mesh, where):
    with pytest.raises(InputError) as found:
        place.applied(mesh)
    assert found.value.where == where
    assert found.value.remedy


@pytest.mark.parametrize("axis", [(0.0, 0.0, 0.0), (1.0, 0.0), (float("nan"), 0.0, 1.0)])
def test_an_axis_is_a_direction(axis):
    with pytest.raises(InputError, match="not a direction"):
        Rotation(angle=1.0, axis=axis)


@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_bottom_of_a_body_that_adapts_is_that_of_its_curved_boundary(cell: str) -> None:
    """A disc whose corners are at 17 degrees: in its centre it has the height of its radius above the bottom."""
    place = Placement(rotations=(Rotation(angle=np.radians(17.0)),), bottom=0.5)
    disc = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=4, cell=cell), material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0,
        place=place, adapt="auto",
    )  # fmt: skip
    stays = sw.build(sw.Scene(bodies={"disc": replace(disc, adapt=None)})).parts[0].mesh
    assert stays.points[:, 1].min() == pytest.approx(0.5, abs=1e-14)
    checked = sw.check(sw.Scenario(bodies={"disc": disc}, time=sw.Time(end=1.0)))
    for model in (sw.build(sw.Scene(bodies={"disc": disc})), checked.model):
        base = adapted_scene(model).meshes["disc"].base
        fine = refined(base, np.full(base.n_cells, 6)).mesh
        rim = fine.points[fine.nodes("boundary")]
        np.testing.assert_allclose(np.linalg.norm(rim - [0.0, 1.5], axis=1), 1.0, atol=1e-8)


@pytest.mark.parametrize("cell", ["tri6", "quad8", "quad9"])
def test_bottom_of_quadratic_cells_that_adapt_is_the_lowest_place_of_their_edges(cell: str) -> None:
    """Nodes of finer cells lie on the parabolas of the base cells, below its lowest node."""
    place = Placement(rotations=(Rotation(angle=np.radians(17.0)),), bottom=0.5)
    ring = sw.Solid(
        mesh=Ring(inner=0.6, outer=1.0, cells=(2, 16), cell=cell),
        material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0, place=place, adapt="auto",
    )  # fmt: skip
    stays = sw.build(sw.Scene(bodies={"ring": replace(ring, adapt=None)})).parts[0].mesh
    assert stays.points[:, 1].min() == pytest.approx(0.5, abs=1e-14)
    base = adapted_scene(sw.build(sw.Scene(bodies={"ring": ring}))).meshes["ring"].base
    assert base.points[:, 1].min() > 0.501
    fine = refined(base, np.full(base.n_cells, 8 if cell != "tri6" else 10)).mesh
    assert 0.0 <= fine.points[:, 1].min() - 0.5 < 1e-5
