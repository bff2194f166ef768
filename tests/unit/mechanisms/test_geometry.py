"""Inertia from geometry: analytic values, exact polyhedra, parallel axes, and surfaces that are refused."""

from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.mechanisms import (
    Hinge,
    Mechanism,
    Rigid,
    march,
    rigid_ball,
    rigid_box,
    rigid_cylinder,
    rigid_disc,
    rigid_file,
    rigid_mesh,
    rigid_rectangle,
    rigid_rod,
    rigid_surface,
)
from softway.meshes.generators.graded import grid
from softway.meshes.mesh import Mesh
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cylinder, Sphere
from softway.obstacles.triangulated import Surface

SIZE, CENTRE, DENSITY = (0.4, 0.7, 1.1), (3.0, -2.0, 5.0), 2700.0
FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
"""Faces of a box, anticlockwise from outside; corner k has the bits of k as its coordinates."""


def box(size: tuple[float, ...] = SIZE, centre: tuple[float, ...] = CENTRE) -> tuple[np.ndarray, np.ndarray]:
    """Closed surface of a box."""
    corners = np.array([[(k >> i & 1) - 0.5 for i in range(3)] for k in range(8)])
    cells = np.array([(f[0], f[k], f[k + 1]) for f in FACES for k in (1, 2)])
    return corners * size + centre, cells


def same(one: Rigid, other: Rigid, rel: float = 1e-13) -> None:
    assert one.mass == pytest.approx(other.mass, rel=rel)
    np.testing.assert_allclose(one.centre, other.centre, atol=rel * 10.0)
    np.testing.assert_allclose(one.tensor, other.tensor, atol=rel * np.abs(other.tensor).max())


def turned() -> np.ndarray:
    """Rotation by a skew axis."""
    q, _ = np.linalg.qr(np.array([[1.0, 2.0, 3.0], [0.5, -1.0, 2.0], [1.0, 0.0, 1.0]]))
    return q * np.linalg.det(q)


def test_a_closed_surface_is_exact() -> None:
    """A box far from the origin, upright and turned, against the formula."""
    points, cells = box()
    same(rigid_surface(points, cells, density=DENSITY), rigid_box(size=SIZE, density=DENSITY, centre=CENTRE), 1e-12)
    R = turned()
    edges = tuple(R[:, 0]), tuple(R[:, 1])
    skew = rigid_surface((points - CENTRE) @ R.T + CENTRE, cells, density=DENSITY)
    same(skew, rigid_box(size=SIZE, density=DENSITY, centre=CENTRE, edges=edges), 1e-12)


def test_a_tetrahedron_has_its_exact_inertia() -> None:
    """Unit corner tetrahedron: mass 1/6, centre 1/4, moments 1/80 and products 1/480 about the centre."""
    points = np.vstack([np.zeros(3), np.eye(3)])
    body = rigid_surface(points, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], density=1.0)
    np.testing.assert_allclose([body.mass, *body.centre], [1 / 6, 0.25, 0.25, 0.25], rtol=1e-14)
    np.testing.assert_allclose(body.tensor, (1 / 80 - 1 / 480) * np.eye(3) + 1 / 480, rtol=1e-13)
    same(rigid_mesh(Mesh(points=points, blocks={"tet4": np.array([[0, 1, 2, 3]])}), density=1.0), body)


def test_shells_inside_are_cavities() -> None:
    """A hollow box is the outer one minus the inner one, by parallel axes."""
    inner, shifted = (0.1, 0.2, 0.3), (3.05, -2.1, 5.2)
    (points, cells), (hole, sides) = box(), box(inner, shifted)
    hollow = rigid_surface(np.vstack([points, hole]), np.vstack([cells, sides[:, ::-1] + 8]), density=1.0)
    whole, part = rigid_box(size=SIZE, density=1.0, centre=CENTRE), rigid_box(size=inner, density=1.0, centre=shifted)
    mass = whole.mass - part.mass
    centre = (whole.mass * np.array(CENTRE) - part.mass * np.array(shifted)) / mass

    def about(body: Rigid) -> np.ndarray:
        arm = np.array(body.centre) - centre
        return body.tensor + body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))

    np.testing.assert_allclose([hollow.mass, *hollow.centre], [mass, *centre], rtol=1e-12)
    np.testing.assert_allclose(hollow.tensor, about(whole) - about(part), atol=1e-12)


@pytest.mark.parametrize("cell", ["hex8", "tet4"])
def test_a_mesh_of_a_box_is_exact(cell: str) -> None:
    sides = [np.linspace(c - 0.5 * s, c + 0.5 * s, 3) for c, s in zip(CENTRE, SIZE, strict=True)]
    same(
        rigid_mesh(grid(*sides, cell=cell), density=DENSITY),
        rigid_box(size=SIZE, density=DENSITY, centre=CENTRE),
        1e-12,
    )


def test_a_curved_cell_counts_with_its_curved_edges() -> None:
    """A quadratic triangle with one parabolic edge: area 1/2 + 2/3 of its height times its length."""
    rise = 0.1
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, -rise], [0.5, 0.5], [0, 0.5]], dtype=float)
    body = rigid_mesh(Mesh(points=nodes, blocks={"tri6": np.arange(6)[None]}), density=1.0)
    assert body.mass == pytest.approx(0.5 + 2.0 / 3.0 * rise, rel=1e-13)


def test_bodies_in_the_plane() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 4001)[:-1]
    circle = np.stack([2.0 + 0.5 * np.cos(turn), 1.0 + 0.5 * np.sin(turn)], axis=1)
    cells = np.stack([np.arange(4000), np.roll(np.arange(4000), -1)], axis=1)
    disc = rigid_disc(radius=0.5, density=3.0, centre=(2.0, 1.0), thickness=0.2)
    same(rigid_surface(circle, cells, density=3.0, thickness=0.2), disc, 1e-5)
    rectangle = rigid_rectangle(size=(2.0, 1.0), density=3.0, centre=(1.0, 0.5), thickness=0.1)
    same(rigid_mesh(grid((0.0, 0.7, 2.0), (0.0, 1.0)), density=3.0, thickness=0.1), rectangle)


def test_round_bodies_in_space() -> None:
    """A ball of 1 kg/m^3, and a cylinder about a skew axis that becomes a rod."""
    ball = rigid_ball(radius=2.0, density=1.0, centre=(0, 0, 0))
    assert ball.tensor[1, 1] == pytest.approx(8.0 / 15.0 * np.pi * 32.0, rel=1e-14)
    axis = turned()[:, 0]
    ends = tuple(np.array(CENTRE) - 0.5 * axis), tuple(np.array(CENTRE) + 0.5 * axis)
    rod = rigid_rod(ends=ends, line_density=2.0)
    thin = rigid_cylinder(radius=1e-7, length=1.0, density=2.0 / (np.pi * 1e-14), centre=CENTRE, axis=tuple(axis))
    same(thin, rod, 1e-12)
    assert axis @ rod.tensor @ axis == pytest.approx(0.0, abs=1e-15)
    shaft = rigid_cylinder(radius=0.3, length=1.0, density=2.0, centre=CENTRE, axis=tuple(axis))
    moments = np.linalg.eigvalsh(shaft.tensor) / shaft.mass
    np.testing.assert_allclose(moments, [0.045, 0.0225 + 1 / 12, 0.0225 + 1 / 12], rtol=1e-12)


def test_a_file_of_a_surface(tmp_path: Path) -> None:
    """STL in millimetres; open and inside-out ones are refused with the name of the file."""
    points, cells = box(tuple(1e3 * s for s in SIZE), (0.0, 0.0, 0.0))
    for name, kept in (("box.stl", cells), ("open.stl", cells[:-1]), ("inside.stl", cells[:, ::-1])):
        meshio.Mesh(points, [("triangle", kept)]).write(tmp_path / name)
    body = rigid_file(tmp_path / "box.stl", density=DENSITY, scale=1e-3, velocity=(1.0, 0.0, 0.0))
    same(body, rigid_box(size=SIZE, density=DENSITY, centre=(0, 0, 0), velocity=(1.0, 0.0, 0.0)), 1e-6)
    with pytest.raises(sw.InputError, match=r"open.stl.cells: the surface of 11 facets is open"):
        rigid_file(tmp_path / "open.stl", density=DENSITY)
    with pytest.raises(sw.InputError, match=r"inside.stl: the closed surface is inside out"):
        rigid_file(tmp_path / "inside.stl", density=DENSITY)


def test_a_body_from_a_mesh_swings_like_its_formula() -> None:
    """A rectangle that hangs from a corner: the period of a physical pendulum."""
    body = rigid_mesh(grid((0.0, 0.4), (0.0, 0.3)), density=100.0)
    arm = 0.25
    hinge = Hinge(between=("ground", "plate"), at=(0.0, 0.0))
    steps = list(
        march(Mechanism(bodies={"plate": body}, joints={"h": hinge}, gravity=(0, -9.81)), until=0.5, step=0.001)
    )
    height = np.array([s.bodies["plate"].centre[1] for s in steps])
    inertia = body.mass * (0.25 / 12.0 + arm**2)
    turning = [0.5 * inertia * s.bodies["plate"].spin[0] ** 2 for s in steps]
    np.testing.assert_allclose(turning, body.mass * 9.81 * (0.15 - height), atol=1e-9)


BAR = Mesh(points=np.array([[0.0, 0.0], [1.0, 0.0]]), blocks={"bar2": np.array([[0, 1]])})


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: rigid_ball(radius=0.0, density=1.0, centre=(0, 0, 0)), "radius: 0 is not positive"),
        (lambda: rigid_disc(radius=1.0, density=-1.0, centre=(0, 0)), "density: -1 is not positive"),
        (lambda: rigid_box(size=(1, 0, 1), density=1.0, centre=(0, 0, 0)), "size: 0 is not positive"),
        (
            lambda: rigid_box(size=(1, 1, 1), density=1.0, centre=(0, 0, 0), edges=((1, 0, 0), (1, 1, 0))),
            "edges: .* perpendicular",
        ),
        (lambda: rigid_rod(ends=((0, 0), (0, 0)), line_density=1.0), "ends: .* are no two places"),
        (lambda: rigid_mesh(BAR, density=1.0), "mesh: cells of dimension 1 in 2D enclose no volume"),
        (lambda: rigid_mesh(grid((0.0, 1.0), (0.0, 1.0)), density=0.0), "density: 0 is not positive"),
        (lambda: rigid_mesh(grid((0.0, 1.0), (0.0, 1.0)), density=1.0, thickness=0.0), "thickness: 0 m"),
        (
            lambda: rigid_surface([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2)], density=1.0),
            "cells: the surface of 2 facets is open",
        ),
    ],
)
def test_wrong_geometry_is_refused(make, told: str) -> None:
    with pytest.raises(sw.InputError, match=told):
        make()


SHAPES = {
    "ball": (Sphere(centre=(1.0, 2.0, 3.0), radius=0.5), rigid_ball(radius=0.5, density=3.0, centre=(1.0, 2.0, 3.0))),
    "disc": (Sphere(centre=(1.0, 2.0), radius=0.5), rigid_disc(radius=0.5, density=3.0, centre=(1.0, 2.0))),
    "cylinder": (
        Cylinder(start=(0.0, 0.0, 0.0), end=(0.0, 3.0, 4.0), radius=0.5),
        rigid_cylinder(radius=0.5, length=5.0, density=3.0, centre=(0.0, 1.5, 2.0), axis=(0.0, 3.0, 4.0)),
    ),
    "box": (
        Block(low=(0.0, 0.0, 0.0), high=(1.0, 2.0, 3.0)),
        rigid_box(size=(1.0, 2.0, 3.0), density=3.0, centre=(0.5, 1.0, 1.5)),
    ),
    "rectangle": (
        Block(low=(0.0, 0.0), high=(1.0, 2.0)),
        rigid_rectangle(size=(1.0, 2.0), density=3.0, centre=(0.5, 1.0)),
    ),
}


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_a_shape_and_a_density_give_the_body_of_the_shape(name):
    shape, other = SHAPES[name]
    body = Rigid(shape=shape, density=3.0)
    assert body.mass == pytest.approx(other.mass, rel=1e-13)
    assert body.centre == pytest.approx(other.centre, rel=1e-13)
    assert body.tensor == pytest.approx(other.tensor, rel=1e-13, abs=1e-14)
    assert replace(body, spin=0.0).mass == body.mass
    if name != "box":
        x = np.random.default_rng(1).normal(size=(20, shape.dim))
        assert other.shape.gap(x) == pytest.approx(shape.gap(x), abs=1e-14)


def test_a_surface_of_a_file_and_a_density_give_a_body_with_its_surface():
    stamp = Surface(file=Path(__file__).parents[3] / "scenarios" / "stamp.stl", scale=1e-3)
    body = Rigid(shape=stamp, density=7800.0)
    assert body.mass == pytest.approx(rigid_file(stamp.file, density=7800.0, scale=1e-3).mass, rel=1e-12)
    assert rigid_file(stamp.file, density=7800.0, scale=1e-3).shape.closed


@pytest.mark.parametrize(
    ("given", "place"),
    [
        ({"density": 3.0}, "density"),
        ({"density": -3.0, "shape": Block(low=(0.0, 0.0), high=(1.0, 1.0))}, "density"),
        ({"density": 3.0, "shape": HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0))}, "shape"),
        ({"density": 3.0, "shape": Block(low=(0.0, 0.0), high=(1.0, 1.0)), "mass": 1.0}, "mass"),
        ({"density": 3.0, "shape": Block(low=(0.0, 0.0), high=(1.0, 1.0)), "centre": (9.0, 9.0)}, "centre"),
    ],
    ids=["no shape", "negative", "no volume", "another mass", "another centre"],
)
def test_densities_that_do_not_fit_are_refused(given, place):
    with pytest.raises(InputError) as refused:
        Rigid(**given)
    assert refused.value.where == place
