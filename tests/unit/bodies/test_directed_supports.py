"""Supports along directions: their degrees of freedom, normals of sides, and what is refused."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.dof_map import NodalDofs
from softway.bodies.setup.directions import directions, held_directions
from softway.bodies.setup.motion_laws import Haversine
from softway.bodies.solid import Carried, Driven, Fixed, Guided, Solid, Support
from softway.errors import InputError
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh
from softway.model.build import build, with_dofs
from softway.model.model import Model
from softway.model.scene import Scene

S = np.sqrt(0.5)
PULSE = Haversine(height=1.0, duration=1.0)


def model(*supports: Support, mesh: Mesh | None = None, **options: object) -> Model:
    solid = Solid(
        mesh=rectangle((2.0, 1.0), (4, 2)) if mesh is None else mesh,
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        supports=supports,
        **options,
    )
    other = Solid(mesh=solid.mesh, material=sw.LinearElastic(E=1.0), density=1.0)
    return build(Scene(bodies={"other": other, "block": solid}))


def test_unknowns_move_the_nodes_perpendicular_to_the_direction() -> None:
    built = model(Fixed(on="left", direction=(3.0, 3.0)), Fixed(on="right", components="y"))
    dofs, first = built.dofs, built.parts[1].nodes.start
    left, right = (built.meshes["block"].nodes(tag) + first for tag in ("left", "right"))
    assert dofs.size == built.free.size - len(left) - len(right) and dofs.components is None
    field = dofs.nodes(np.random.default_rng(0).normal(size=dofs.size))
    assert np.abs(field[left].sum(axis=1)).max() < 1e-15 and np.abs(field[left]).min() > 1e-3
    assert not field[right, 1].any()
    np.testing.assert_allclose(dofs.nodes(dofs.unknowns(field)), field, atol=1e-15)
    force = np.random.default_rng(1).normal(size=built.shape)
    held = dofs.supported(force)
    np.testing.assert_allclose(held[left], S * np.outer(force[left] @ [S, S], [1.0, 1.0]), atol=1e-15)
    np.testing.assert_allclose(held[right], np.outer(force[right, 1], [0.0, 1.0]), atol=1e-15)
    assert np.abs(dofs.forces(held)).max() < 1e-15, "the supported part has no power"
    np.testing.assert_allclose(dofs.supported(dofs.supported(force)), held, atol=1e-15)
    assert dofs.unsupported.sum() == built.shape[0] - len(left) - len(right)


def test_given_velocities_are_added() -> None:
    built = model(Driven(on="left", direction=(1.0, 1.0), velocity=2.0), Fixed(on="bottom", components="y"))
    mesh, first = built.meshes["block"], built.parts[1].nodes.start
    corner = np.intersect1d(mesh.nodes("left"), mesh.nodes("bottom"))
    given = built.prescribed(0.3)[first:]
    np.testing.assert_allclose(given[np.setdiff1d(mesh.nodes("left"), corner)], 2.0 * S, atol=1e-15)
    np.testing.assert_allclose(given[corner], [[2.0 / S, 0.0]], atol=1e-14)
    assert not given[np.setdiff1d(np.arange(len(given)), mesh.nodes("left"))].any()
    w = np.random.default_rng(2).normal(size=built.dofs.size)
    field = built.dofs.nodes(w, built.prescribed(0.3))
    np.testing.assert_allclose(field - built.dofs.nodes(w), built.prescribed(0.3), atol=1e-14)


def test_two_directions_of_a_node_hold_both_and_three_hold_it() -> None:
    mesh = box((1.0, 1.0, 1.0), (1, 1, 1))
    pair = (Fixed(on="left", direction=(1.0, 1.0, 0.0)), Driven(on="left", direction=(0.0, 1.0, 1.0), velocity=1.0))
    built = model(*pair, mesh=mesh)
    left, first = built.meshes["block"].nodes("left"), built.parts[1].nodes.start
    assert built.dofs.size == built.free.size - 2 * len(left)
    w = np.random.default_rng(0).normal(size=built.dofs.size)
    moved = built.dofs.nodes(w, built.prescribed(0.0))[first + left]
    np.testing.assert_allclose(moved @ [S, S, 0.0], 0.0, atol=1e-15)
    np.testing.assert_allclose(moved @ [0.0, S, S], 1.0, atol=1e-15)
    whole = model(*pair, Fixed(on="left", direction=(0.0, 0.0, 2.0)), mesh=mesh)
    assert not whole.free[first + left].any() and whole.dofs.size == built.free.size - 3 * len(left)


def test_equal_directions_are_one() -> None:
    twice = model(Fixed(on="left", direction=(1.0, 2.0)), Fixed(on="all", direction=(-2.0, -4.0)))
    assert twice.dofs.size == twice.free.size - twice.parts[1].mesh.n_nodes
    driven = Driven(on="left", direction=(1.0, 2.0), velocity=(0.0, 1.0), times=(0.0, 1.0))
    assert model(driven, driven).dofs.size == twice.free.size - 3


def test_a_direction_along_an_axis_is_a_component() -> None:
    built = model(Fixed(on="left", direction=(0.0, -2.0)))
    plain = model(Fixed(on="left", components="y"))
    assert (built.free == plain.free).all() and (built.dofs.jacobian != plain.dofs.jacobian).nnz == 0
    assert isinstance(plain.dofs, NodalDofs)


@pytest.mark.parametrize("cell", ["quad4", "tri3", "hex8", "tet4"])
def test_normals_of_a_side(cell: str) -> None:
    """Of a turned block: those of its sides, also at their rims."""
    turn = sw.bodies.Rotation(angle=0.7, axis=(0.0, 0.0, 1.0) if cell in ("quad4", "tri3") else (1.0, 2.0, 0.5))
    d = 2 if cell in ("quad4", "tri3") else 3
    mesh = rectangle((1.0, 2.0), (2, 3), cell=cell) if d == 2 else box((1.0, 2.0, 1.5), (2, 2, 2), cell=cell)
    placed = sw.bodies.Placement(rotations=(turn,)).applied(mesh)
    for tag, axis, sign in (("left", 0, -1.0), ("right", 0, 1.0), ("bottom", d - 1, -1.0), ("top", d - 1, 1.0)):
        nodes, normals = directions(Fixed(on=tag, direction="normal"), placed)
        assert (nodes == mesh.nodes(tag)).all()
        np.testing.assert_allclose(normals, np.tile(sign * turn.matrix()[:d, axis], (len(nodes), 1)), atol=1e-14)


@pytest.mark.parametrize(
    ("supports", "where"),
    [
        ((Fixed(on="left", direction=(1.0, 0.0, 0.0)),), "supports[0].direction"),
        ((Fixed(on="lefd", direction=(1.0, 0.0)),), "supports[0].on"),
        ((Fixed(on="corner", direction="normal"),), "supports[0].direction"),
        (
            (Fixed(on="left", direction=(1.0, 1.0)), Driven(on="left", direction=(1.0, 1.0), velocity=0.0)),
            "supports[1].direction",
        ),
        (
            (Driven(on="all", velocity=1.0), Guided(on="left", direction=(1.0, 1.0), travel=PULSE)),
            "supports[1].direction",
        ),
    ],
)  # fmt: skip
def test_what_is_refused(supports: tuple[Support, ...], where: str) -> None:
    mesh = rectangle((2.0, 1.0), (4, 2)).with_tag("corner", lambda x: (x < 0.1).all(axis=1))
    with pytest.raises(InputError) as error:
        model(*supports, mesh=mesh)
    assert error.value.where == f"bodies.block.{where}"


def test_carried_nodes_take_no_direction() -> None:
    mesh = rectangle((1.0, 1.0), (1, 1))
    pair = (Carried(on="left", by="body"), Fixed(on="bottom", direction=(1.0, 1.0)))
    masks = [np.zeros((4, 2), bool) for _ in pair]
    masks[0][mesh.nodes("left")] = True
    with pytest.raises(InputError) as error:
        held_directions(pair, mesh, masks)
    assert error.value.where == "supports[0].on"


@pytest.mark.parametrize(
    ("options", "where"),
    [({"direction": (0.0, 0.0)}, "direction"), ({"direction": (1.0, 0.0), "components": "x"}, "direction")],
)
def test_no_direction_is_refused(options: dict[str, object], where: str) -> None:
    for make in (Fixed, lambda **given: Driven(velocity=1.0, **given)):
        with pytest.raises(InputError) as error:
            make(on="left", **options)
        assert error.value.where == where


def test_initial_fields_along_a_held_direction_are_refused_and_velocities_are_taken_away() -> None:
    roller = Fixed(on="all", direction=(1.0, 1.0))
    built = model(
        roller, velocity=sw.bodies.Uniform(value=(0.6, 0.2)), displacement=sw.bodies.Uniform(value=(0.1, -0.1))
    )
    np.testing.assert_allclose(built.velocity[built.parts[1].nodes], [[0.2, -0.2]] * 15, atol=1e-15)
    np.testing.assert_allclose(built.displacement[built.parts[1].nodes], [[0.1, -0.1]] * 15, atol=1e-16)
    with pytest.raises(InputError) as error:
        model(roller, displacement=sw.bodies.Uniform(value=(0.1, 0.1)))
    assert error.value.where == "bodies.block.displacement"


def test_own_unknowns_must_leave_driven_directions_alone() -> None:
    built = model(Driven(on="left", direction=(1.0, 1.0), velocity=2.0))
    assert with_dofs(built, built.dofs).dofs is built.dofs
    with pytest.raises(InputError, match="driven"):
        with_dofs(built, NodalDofs(np.ones(built.shape, bool)))
