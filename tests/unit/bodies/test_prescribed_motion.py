"""Poses of tools: where they stand, distances there, and how their material points move."""

import numpy as np
import pytest

from softway.bodies.prescribed_motion import PlacedShape, Pose, Still, Table, Translation, Turning, carried_tool
from softway.bodies.solid import Tool
from softway.errors import InputError
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Cavity, Cylinder, Sphere
from softway.obstacles.triangulated import Facets
from softway.testing import check_obstacle

TABLE = Table(times=(1.0, 2.0, 4.0), displacements=((1.0, 0.0), (3.0, -1.0), (3.0, 5.0)))
TURN = Turning(point=(0.2, -0.1, 0.3), axis=(1.0, 2.0, -0.5), rate=3.0)
POINTS = np.random.default_rng(5).uniform(-2.0, 2.0, (50, 3))


@pytest.mark.parametrize("motion", [Still(), Translation(velocity=(1.0, 2.0, 3.0)), TURN])
def test_at_the_start_the_shape_is_where_it_was_described(motion):
    pose = motion.at(0.0)
    assert np.abs(pose.place(POINTS) - POINTS).max() < 1e-15 and np.abs(pose.back(POINTS) - POINTS).max() < 1e-15


@pytest.mark.parametrize(
    ("time", "shift"),
    [(-3.0, (1, 0)), (1.0, (1, 0)), (1.25, (1.5, -0.25)), (2.0, (3, -1)), (3.0, (3, 2)), (9.0, (3, 5))],
)
def test_a_table_is_linear_between_its_knots(time, shift):
    np.testing.assert_allclose(TABLE.at(time).shift, shift, rtol=0.0, atol=1e-15)


def test_a_table_of_one_knot_and_of_one_dimension():
    assert Table(times=(0.0,), displacements=((2.0, 1.0),)).at(5.0).shift.tolist() == [2.0, 1.0]
    press = Table(times=(0.0, 0.2), displacements=(0.0, -1.0))
    assert press.dim == 1 and press.at(0.1).shift.tolist() == [-0.5]
    ram = Tool(shape=HalfSpace(point=1.0, normal=-1.0), motion=press)
    assert ram.at(0.1).gap(np.array([[0.0], [0.75]])).tolist() == [0.5, -0.25]
    assert carried_tool(press, 0.0, 0.3, np.zeros((2, 1))).tolist() == [[-1.0], [-1.0]]


def test_a_rotation_keeps_lengths_and_its_axis():
    rotation = TURN.at(0.7).rotation
    assert np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-15 and np.linalg.det(rotation) == pytest.approx(1.0)
    assert np.abs(TURN.at(0.7).place(np.array(TURN.point)) - TURN.point).max() < 1e-15
    assert np.abs(rotation @ TURN.axis - TURN.axis).max() < 1e-15
    whole = TURN.at(2.0 * np.pi / 3.0)
    assert np.abs(whole.place(POINTS) - POINTS).max() < 1e-14
    flat = Turning(point=(1.0, 2.0), rate=np.pi / 2.0).at(1.0)
    assert np.abs(flat.place(np.array([2.0, 2.0])) - [1.0, 3.0]).max() < 1e-15


@pytest.mark.parametrize("motion", [Translation(velocity=(1.0, -0.5, 0.2)), TURN])
def test_distances_move_with_the_shape(motion):
    """The gap of a material point of space that moves along stays the same, and the normal turns with it."""
    cells = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    shapes = [
        HalfSpace(point=(0.0, 0.1, 0.0), normal=(1.0, 1.0, 0.0)),
        Block(low=(0.0, 0.0, 0.0), high=(1.0, 0.5, 0.2)),
        Cylinder(start=(0.0, 0.0, 0.0), end=(0.0, 1.0, 1.0), radius=0.3),
        Cavity(of=Facets(points=points, cells=cells)),
    ]
    pose = motion.at(0.6)
    for shape in shapes:
        placed = PlacedShape(shape=shape, pose=pose)
        moved = pose.place(POINTS)
        assert np.abs(placed.gap(moved) - shape.gap(POINTS)).max() < 1e-14
        assert np.abs(placed.normal_at(moved) - pose.turn(shape.normal_at(POINTS))).max() < 1e-13
        gap, normal = placed.gap_and_normal(moved)
        assert np.array_equal(gap, placed.gap(moved)) and np.array_equal(normal, placed.normal_at(moved))
    check_obstacle(PlacedShape(shape=shapes[2], pose=pose), pose.place(np.array([[1.0, 0.4, 0.2], [0.1, 2.0, 3.0]])))


def test_a_still_tool_is_the_shape_to_the_last_digit():
    shape = Sphere(centre=(0.1, 0.2, 0.3), radius=0.7)
    placed = Tool(shape=shape).at(3.0)
    assert np.array_equal(placed.gap(POINTS), shape.gap(POINTS)) and placed.dim == 3
    assert np.array_equal(placed.normal_at(POINTS), shape.normal_at(POINTS))
    assert not carried_tool(Still(), 0.0, 1.0, POINTS).any()


@pytest.mark.parametrize("motion", [Still(), Translation(velocity=(1.0, -0.5, 0.2)), TURN])
def test_material_points_are_carried(motion):
    y = POINTS
    before, after = motion.at(0.3).place(y), motion.at(0.8).place(y)
    assert np.abs(carried_tool(motion, 0.3, 0.8, after) - (after - before)).max() < 1e-14


def test_a_small_displacement_keeps_its_digits():
    """1 nm of a tool that is 1 km away."""
    moved = carried_tool(Translation(velocity=(1e-6, 0.0)), 0.0, 1e-3, np.full((1, 2), 1e3))
    assert moved.tolist() == [[1e-9, 0.0]]


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: Translation(velocity=()), "velocity"),
        (lambda: Translation(velocity=(np.nan, 0.0)), "velocity"),
        (lambda: Table(times=(0.0, 0.0), displacements=(0.0, 1.0)), "times"),
        (lambda: Table(times=(1.0, 0.0), displacements=(0.0, 1.0)), "times"),
        (lambda: Table(times=(), displacements=()), "times"),
        (lambda: Table(times=(0.0, np.inf), displacements=(0.0, 1.0)), "times"),
        (lambda: Table(times=(0.0, 1.0), displacements=(0.0,)), "displacements"),
        (lambda: Table(times=(0.0, 1.0), displacements=((0.0, 1.0), (1.0,))), "displacements"),
        (lambda: Table(times=(0.0, 1.0), displacements=((0.0, 1.0), (1.0, np.inf))), "displacements[1]"),
        (lambda: Turning(point=(0.0,), rate=1.0), "point"),
        (lambda: Turning(point=(0.0, 0.0), axis=(0.0, 0.0, 1.0), rate=1.0), "axis"),
        (lambda: Turning(point=(0.0, 0.0, 0.0), rate=1.0), "axis"),
        (lambda: Turning(point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 0.0), rate=1.0), "axis"),
        (lambda: Turning(point=(0.0, 0.0), rate=np.nan), "rate"),
        (lambda: Tool(shape=Sphere(centre=(0.0, 0.0), radius=1.0), motion=TURN), "motion"),
    ],
)
def test_what_is_no_motion_is_refused(make, where):
    with pytest.raises(InputError) as found:
        make()
    assert found.value.where == where and found.value.remedy


def test_a_pose_of_numbers():
    pose = Pose(rotation=np.array([[0.0, -1.0], [1.0, 0.0]]), shift=np.array([1.0, 0.0]))
    x = np.random.default_rng(0).random((4, 3, 2))
    assert np.abs(pose.back(pose.place(x)) - x).max() < 1e-15
