"""The contacts of a model as rows: at both ends of a slab, with tools that stand still or move."""

import numpy as np
import pytest

from softway.bodies.prescribed_motion import Translation
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact
from softway.contact.contact_set import ContactSet
from softway.laws.bulk import LinearElastic
from softway.laws.friction import Coulomb
from softway.meshes.generators.shapes import rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Sphere

FLOOR = Tool(shape=HalfSpace(point=(0.0, -0.5), normal=(0.0, 1.0)))
LIFT = Tool(shape=FLOOR.shape, motion=Translation(velocity=(3.0, 0.2)))
BALL = Sphere(centre=(0.5, 2.0), radius=0.5)
RISING = Tool(shape=BALL, motion=Translation(velocity=(0.0, 0.2)))


def scene(**tools: Tool) -> Model:
    """A square of side one and the tools, in the order in which they are given."""
    solid = Solid(mesh=rectangle((1.0, 1.0), (3, 3)), material=LinearElastic(E=1.0), density=1.0)
    tags = {"floor": "bottom", "ball": "top", "again": "surface"}
    contacts = tuple(Contact(between=(f"square.{tags[name]}", name), name=name) for name in tools)
    return build(Scene(bodies={"square": solid, **tools}, contacts=contacts))


def field(model: Model, seed: int) -> np.ndarray:
    return 0.1 * np.random.default_rng(seed).normal(size=model.shape)


def test_rows_are_in_the_order_of_the_contacts() -> None:
    model = scene(ball=Tool(shape=BALL), again=FLOOR, floor=FLOOR)
    contacts, mesh = model.contacts, model.meshes["square"]
    rows = model.rows(model.displacement)
    assert rows.labels == contacts.labels == ("ball", "again", "floor")
    for k, tag in enumerate(("top", "surface", "bottom")):
        assert contacts.node[contacts.rows_of(k)].tolist() == mesh.nodes(tag).tolist()
        assert rows.of_contact(k).nonzero()[0].tolist() == list(range(*contacts.rows_of(k).indices(len(rows.node))))
    np.testing.assert_array_equal(contacts.points, mesh.points)
    assert model.touchable.tolist() == mesh.nodes("surface").tolist()
    assert (model.contact_solids, model.against_tool.tolist()) == (((0,),) * 3, [True] * 3)


def test_no_contact_no_rows() -> None:
    contacts = scene().contacts
    assert contacts.fixed
    assert len(contacts.node) == 0
    assert contacts.rows_of(0) == slice(0, 0)


@pytest.mark.parametrize(
    ("tools", "fixed"),
    [
        ({"floor": FLOOR}, True),
        ({"floor": FLOOR, "again": FLOOR}, True),
        ({"floor": LIFT}, False),
        ({"ball": Tool(shape=BALL)}, False),
        ({"floor": FLOOR, "ball": Tool(shape=BALL)}, False),
    ],
)
def test_resting_half_spaces_have_the_same_rows_everywhere(tools: dict[str, Tool], fixed: bool) -> None:
    model = scene(**tools)
    contacts = model.contacts
    assert contacts.fixed is fixed
    u, w = field(model, 0), field(model, 1)
    pairs = contacts.meet(u, w, 1.0, 1.5)
    if fixed:
        assert pairs.start(u) is pairs.at(u) is pairs.at(w)
        np.testing.assert_allclose(pairs.at(u).gap(w), (model.points + w)[contacts.node][:, 1] + 0.5, atol=1e-15)


def test_a_moving_floor_at_both_ends_of_a_slab() -> None:
    """Gaps belong to the floor as it stands at either end; its normal motion over the slab is the same."""
    model = scene(floor=LIFT)
    u = field(model, 0)
    pairs = model.contacts.meet(u, u, 1.0, 1.5)
    height = (model.points + u)[model.contacts.node][:, 1] + 0.5
    for rows, time in ((pairs.start(u), 1.0), (pairs.at(u), 1.5)):
        np.testing.assert_allclose(rows.gap(u), height - 0.2 * time, atol=1e-14)
        np.testing.assert_allclose(rows.tool_motion, 0.2 * 0.5, atol=1e-15)
        np.testing.assert_array_equal(rows.normal, [[0.0, 1.0]] * 4)
    rest = model.contacts.rest(u, 2.0).at(u)
    np.testing.assert_allclose(rest.gap(u), height - 0.4, atol=1e-14)
    assert not rest.tool_motion.any()
    np.testing.assert_array_equal(model.rows(u, 2.0).gap(u), rest.gap(u))


def derivative_is_exact(contacts: ContactSet, u: np.ndarray, step: np.ndarray) -> None:
    pairs = contacts.meet(u, u, 0.0, 0.5)
    rows = pairs.at(u)
    change = (pairs.at(u + step).gap(u + step) - pairs.at(u - step).gap(u - step)) / 2.0
    np.testing.assert_allclose(rows.normal_component(step), change, atol=1e-12)


@pytest.mark.parametrize("tool", [RISING, Tool(shape=BALL)], ids=["rising", "still"])
def test_curved_tools_have_exact_gaps_and_derivatives(tool: Tool) -> None:
    model = scene(ball=tool)
    u = field(model, 0)
    derivative_is_exact(model.contacts, u, 1e-5 * field(model, 1))
    centre = np.array([0.5, 2.0 + (0.2 * 0.5 if tool is RISING else 0.0)])
    pairs = model.contacts.meet(u, u, 0.0, 0.5)
    away = np.linalg.norm((model.points + u)[model.contacts.node] - centre, axis=1)
    np.testing.assert_allclose(pairs.at(u).gap(u), away - 0.5, atol=1e-14)


def test_the_normal_motion_of_a_curved_tool_is_that_beside_the_node() -> None:
    model = scene(ball=RISING)
    u = field(model, 0)
    rows = model.contacts.meet(u, u, 0.0, 0.5).at(u)
    np.testing.assert_allclose(rows.tool_motion, rows.normal @ [0.0, 0.1], atol=1e-15)
    assert np.ptp(rows.tool_motion) > 0.0


def test_frictionless_rows_have_the_same_tangential_parts_everywhere() -> None:
    model = scene(ball=RISING)
    contacts = model.contacts
    pairs, shear = contacts.meet(model.displacement, model.displacement, 0.0, 0.5), contacts.frictionless_rows
    assert shear is not None and shear.count == 0
    for u in (field(model, 0), field(model, 1)):
        rows = pairs.at(u)
        assert rows.shear is shear and rows.without_friction() is rows
        assert rows.shear.weights.shape == (len(rows.node), model.shape[0])


def test_friction_has_tangential_parts_that_turn_with_the_surface() -> None:
    solid = Solid(mesh=rectangle((1.0, 1.0), (3, 3)), material=LinearElastic(E=1.0), density=1.0)
    contact = Contact(between=("square.top", "ball"), friction=Coulomb(mu=0.1))
    model = build(Scene(bodies={"square": solid, "ball": Tool(shape=BALL)}, contacts=(contact,)))
    u = field(model, 0)
    rows = model.rows(u)
    assert model.contacts.frictionless_rows is None and rows.shear.count == len(rows.node)
    np.testing.assert_allclose(np.einsum("mkd,md->mk", rows.shear.tangents, rows.normal), 0.0, atol=1e-15)
    assert rows.without_friction().shear.count == 0
