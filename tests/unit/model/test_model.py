"""A scene turned into arrays."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.assembled.nodal_loads import dead_load
from softway.bodies.elements.section import Bar, PlaneStrain
from softway.bodies.inertia.mass_matrix import nodal_mass
from softway.bodies.setup.initial_fields import Affine, Uniform
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.solid import Fixed, Solid, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, Impulse, Paper
from softway.errors import InputError
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.meshes.generators.recipes import Rectangle
from softway.meshes.generators.shapes import interval, rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace

SOFT = LinearElastic(E=2.0, nu=0.25)


def square(**changes: object) -> Solid:
    return Solid(**{"mesh": rectangle((2.0, 1.0), (4, 2)), "material": SOFT, "density": 3.0, **changes})


def half_space(point: tuple[float, ...] = (0.0, -0.5), normal: tuple[float, ...] = (0.0, 2.0)) -> Tool:
    return Tool(shape=HalfSpace(point=point, normal=normal))


def pair(**scene: object) -> Scene:
    """Two solids, of which the second may touch the floor."""
    bodies = {"a": square(), "b": square(material=NeoHookean(E=1.0, nu=0.3), density=5.0), "floor": half_space()}
    return Scene(**{"bodies": bodies, "contacts": (Contact(between=("b.bottom", "floor")),), **scene})


def refused(scene: Scene, where: str) -> InputError:
    with pytest.raises(InputError) as error:
        build(scene)
    assert error.value.where == where
    assert error.value.remedy
    return error.value


@pytest.fixture(scope="module")
def model() -> Model:
    return build(pair())


def test_nodes_of_all_solids_are_in_one_order(model: Model) -> None:
    assert model.shape == (30, 2)
    assert [(p.name, p.nodes) for p in model.parts] == [("a", slice(0, 15)), ("b", slice(15, 30))]
    assert set(model.meshes) == {"a", "b"}
    field = np.random.default_rng(0).normal(size=model.shape)
    np.testing.assert_array_equal(model.join(model.split(field)), field)
    np.testing.assert_allclose(model.space.totals(field), [field[:15].sum(), field[15:].sum()], atol=1e-14)


def test_energy_force_and_tangent_are_those_of_the_solids(model: Model) -> None:
    u = 0.01 * np.random.default_rng(1).normal(size=model.shape)
    energy, force = model.energy_and_force(u)
    np.testing.assert_array_equal(force, model.force(u))
    for k, part in enumerate(model.parts):
        assert energy[k] == part.internal.energy(u[part.nodes])
        np.testing.assert_array_equal(force[part.nodes], part.internal.force(u[part.nodes]))
        np.testing.assert_array_equal(model.stress(part.name, u[part.nodes]), part.internal.stress(u[part.nodes]))
    tangent, w = model.tangent(u), 1e-6 * np.random.default_rng(2).normal(size=model.shape)
    change = (model.force(u + w) - model.force(u - w)).ravel() / 2
    np.testing.assert_allclose(tangent @ w.ravel(), change, atol=1e-14)
    assert tangent[:30, 30:].nnz == 0
    assert not model.linear
    assert build(Scene(bodies={"a": square()})).linear


def test_only_contact_nodes_of_the_energy_rule_lose_their_mass(model: Model) -> None:
    bottom = 15 + model.meshes["b"].nodes("bottom")
    assert np.flatnonzero(~model.massive).tolist() == bottom.tolist()
    assert model.space.totals(np.asarray(model.mass.sum(axis=1))) == pytest.approx([6.0, 10.0])
    plain = nodal_mass(model.meshes["a"], 3.0, PlaneStrain(), square().mass)
    np.testing.assert_array_equal(model.mass[:15, :15].toarray(), plain.toarray())
    for timing in (Impulse(), Paper()):
        carrying = build(pair(contacts=(Contact(between=("b.bottom", "floor"), timing=timing),)))
        assert carrying.massive.all()
        assert carrying.timing == timing


def test_kinetic_energy_of_a_rigid_motion(model: Model) -> None:
    v = np.tile([0.3, -0.4], (30, 1))
    assert model.kinetic(v) == pytest.approx([0.5 * 6.0 * 0.25, 0.5 * 10.0 * 0.25])


def test_contact_rows(model: Model) -> None:
    rows = model.rows(model.displacement)
    assert rows.labels == ("b.bottom-floor",)
    assert rows.node.tolist() == (15 + model.meshes["b"].nodes("bottom")).tolist()
    np.testing.assert_array_equal(rows.normal, [[0.0, 1.0]] * 5)
    np.testing.assert_allclose(rows.offset, 0.5)
    moved = np.tile([7.0, -0.2], (30, 1))
    np.testing.assert_allclose(rows.gap(moved), 0.3)


def test_a_node_may_face_several_obstacles() -> None:
    bodies = {"a": square(), "floor": half_space(), "wall": half_space((-0.5, 0.0), (1.0, 0.0))}
    contacts = (Contact(between=("a.surface", "floor")), Contact(between=("a.left", "wall"), name="side"))
    model = build(Scene(bodies=bodies, contacts=contacts))
    rows = model.rows(model.displacement)
    assert rows.labels == ("a.surface-floor", "side")
    assert rows.of_contact(0).sum() == 12
    assert rows.of_contact(1).sum() == 3
    assert set(rows.node[rows.of_contact(1)]) <= set(rows.node[rows.of_contact(0)])


def test_supports_hold_components() -> None:
    supports = (Fixed(on="left"), Fixed(on="bottom", components="y"))
    x, y = rectangle((2.0, 1.0), (4, 2)).points.T
    flow = Affine(value=(1.0, 2.0), gradient=((0.5, 0.0), (0.0, 0.5)))
    model = build(
        Scene(bodies={"a": square(supports=supports, velocity=flow, displacement=0.1 * np.stack([x, x * y], axis=1))})
    )
    mesh = model.meshes["a"]
    assert not model.free[mesh.nodes("left")].any()
    inner = np.setdiff1d(mesh.nodes("bottom"), mesh.nodes("left"))
    assert model.free[inner].tolist() == [[True, False]] * 4
    assert model.free.sum() == 30 - 6 - 4
    for field in (model.velocity, model.displacement):
        assert not field[~model.free].any()
        assert field[model.free].all()


def test_loads_add_up() -> None:
    loads = (Gravity(acceleration=(0.0, -2.0)), Traction(on="b.top", value=(0.5, 0.0)))
    model = build(pair(loads=loads))
    assert model.load[:15].sum(axis=0) == pytest.approx([0.0, -12.0])
    assert model.load[15:].sum(axis=0) == pytest.approx([0.5 * 2.0, -20.0])
    assert not model.load[~model.massive].any(), "gravity pulls the inertia"
    np.testing.assert_array_equal(dead_load(model.parts, model.weight, loads, "loads").at(0.0), model.load)
    assert not dead_load(model.parts, model.weight, (), "loads").at(0.0).any()


def test_recipes_and_sections() -> None:
    recipe = square(mesh=Rectangle(size=(2.0, 1.0), cells=(4, 2)), section=PlaneStrain(thickness=0.5))
    model = build(Scene(bodies={"a": recipe}))
    assert model.mass.sum() == pytest.approx(3.0)
    bar = Solid(mesh=interval(1.0, 2), material=SOFT, density=3.0, section=Bar(area=2.0))
    assert build(Scene(bodies={"a": bar})).mass.sum() == pytest.approx(6.0)


def test_wrong_scenes_name_the_place() -> None:
    floor = half_space()
    refused(Scene(bodies={"floor": floor}), "bodies")
    bar = Solid(mesh=interval(1.0, 2), material=SOFT, density=3.0)
    refused(Scene(bodies={"a": square(), "bar": bar}), "bodies")
    one = {"a": square(), "floor": floor}

    def touching(*between: tuple[str, str], bodies: dict[str, Solid | Tool] = one) -> Scene:
        return Scene(bodies=bodies, contacts=tuple(Contact(between=b) for b in between))

    refused(touching(("a.botom", "floor")), "contacts[0].between")
    refused(touching(("a.bottom", "flor")), "contacts[0].between")
    refused(touching(("a.bottom", "floor"), ("nobody.bottom", "floor")), "contacts[1].between")
    point = Tool(shape=HalfSpace(point=0.0, normal=1.0))
    refused(touching(("a.bottom", "floor"), bodies={"a": square(), "floor": point}), "bodies.floor.shape.point")
    coarse = square(mesh=rectangle((2.0, 1.0), (1, 1), cell="quad8"))
    refused(touching(("a", "floor"), bodies={"a": coarse, "floor": floor}), "bodies.a")
    refused(Scene(bodies={"a": square(density=-1.0)}), "bodies.a.density")
    refused(Scene(bodies={"a": square(supports=(Fixed(on="nowhere"),))}), "bodies.a.supports[0].on")
    refused(
        Scene(bodies={"a": square(supports=(Fixed(on="left", components="z"),))}), "bodies.a.supports[0].components"
    )
    refused(Scene(bodies={"a": square(supports=(Fixed(on="left", components=""),))}), "bodies.a.supports[0].components")
    refused(Scene(bodies={"a": square(velocity=Uniform(value=(1.0, 2.0, 3.0)))}), "bodies.a.velocity.value")
    refused(Scene(bodies=one, loads=(Traction(on="nobody.top", value=(1.0, 0.0)),)), "loads[0].on")
    refused(Scene(bodies=one, loads=(Gravity(acceleration=1.0),)), "loads[0].acceleration")


def test_one_rule_in_a_scene() -> None:
    contacts = (
        Contact(between=("b.bottom", "floor"), timing=Impulse()), Contact(between=("b.top", "floor"), timing=Energy())
    )  # fmt: skip
    assert "2 different timing rules" in refused(pair(contacts=contacts), "contacts").problem


def test_two_contacts_need_two_names() -> None:
    contacts = (Contact(between=("b.bottom", "floor")), Contact(between=("b.bottom", "floor")))
    refused(pair(contacts=contacts), "contacts[1].name")


def test_a_model_of_the_motion_alone_refuses_heat() -> None:
    """It would leave it out without a word; ``softway.build`` takes it."""
    law = sw.heat.Conduction(conductivity=1.0, capacity=1.0)
    thermal = sw.bodies.Thermal(law=law, temperature=300.0, expansion=1e-3)
    parts = {"mesh": interval(1.0, cells=2), "material": sw.LinearElastic(E=1.0), "density": 1.0}
    cold, hot = sw.Solid(**parts), sw.Solid(**parts, thermal=thermal)
    meets = sw.Contact(between=("a.right", "b.left"), heat=sw.heat.ContactHeat(conductance=1.0))
    apart = sw.Solid(**{**parts, "mesh": interval(1.0, cells=2, origin=1.1)})
    refused = {
        "bodies.a.thermal": sw.Scene(bodies={"a": hot}),
        "loads[0]": sw.Scene(bodies={"a": cold}, loads=(sw.heat.HeatSource(of="a", value=1.0),)),
        "contacts[0].heat": sw.Scene(bodies={"a": cold, "b": apart}, contacts=(meets,)),
    }
    for where, scene in refused.items():
        with pytest.raises(InputError) as error:
            build(scene)
        assert error.value.where == where
    assert [field.name for field in sw.build(refused["bodies.a.thermal"]).fields] == ["displacement", "temperature"]
