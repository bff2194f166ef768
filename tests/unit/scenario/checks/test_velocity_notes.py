"""Notes on initial velocities under supports: number of nodes, energy and momentum of the start."""

import pytest

import softway as sw
from softway.bodies import Driven, Fixed, Profile, Uniform
from softway.bodies.solid import Support
from softway.scenario.checks.check import Checked


def checked(*supports: Support, velocity: Uniform | Profile = Uniform(value=(3.0, 4.0)), **more: object) -> Checked:
    """Check of a square with a velocity, whose mass is lumped: 1/16 kg at nodes of the sides, 1/4 kg inside."""
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        mass=sw.bodies.Lumped(),
        velocity=velocity,
        supports=supports,
    )
    return sw.check(sw.Scenario(bodies={"b": body}, time=sw.Time(end=0.1), **more))  # type: ignore[arg-type]


def test_a_clamped_end_is_noted_with_the_energy_and_momentum_that_it_takes() -> None:
    """A quarter of the mass is at the left side: of 12.5 J and 5 N s three quarters are left."""
    (note,) = checked(Fixed(on="left")).notes
    assert note.where == "bodies.b.velocity"
    assert note.problem.startswith("supports[0] on 'left' holds 3 nodes with a velocity")
    assert note.problem.endswith("the body starts with 9.375 J and 3.75 N s, not 12.5 J and 5 N s")
    assert note.remedy.startswith("nothing, if this is meant; or") and "zero on 'left'" in note.remedy


def test_the_note_tells_the_energy_of_the_march() -> None:
    found = checked(Fixed(on="left"))
    start = next(sw.march(found.model, until=0.1)).ledger
    assert start.energy_kinetic + start.energy_strain == pytest.approx(9.375, rel=1e-9)


def test_each_remedy_ends_the_note() -> None:
    assert checked(Fixed(on="left"), velocity=Profile(at=(0.0, 0.4), values=((0.0, 0.0), (3.0, 4.0)))).notes == ()
    assert checked(Driven(on="left", velocity=4.0, components="y"), Fixed(on="right", components="x")).notes != ()
    assert checked(Driven(on="left", velocity=4.0, components="y")).notes == ()


def test_a_support_that_drives_nodes_at_rest_is_no_loss() -> None:
    assert checked(Driven(on="left", velocity=1.0), velocity=Uniform()).notes == ()
    assert checked(Fixed(on="left", components="x"), velocity=Uniform(value=(0.0, 4.0))).notes == ()


def test_without_inertia_no_velocity_matters() -> None:
    assert checked(Fixed(on="left"), inertia=sw.bodies.Off()).notes == ()


def test_massless_nodes_take_no_energy_and_are_not_noted() -> None:
    """A held surface that may touch has no inertia: the body starts with all of its energy."""
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.0), normal=(0.0, 1.0)))
    body = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 3)),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=Uniform(value=(0.0, 2.0)),
        supports=(Fixed(on="bottom"),),
    )
    contact = sw.Contact(between=("b.bottom", "floor"))
    found = sw.check(sw.Scenario(bodies={"b": body, "floor": floor}, contacts=(contact,), time=sw.Time(end=0.1)))
    assert not [note for note in found.notes if note.where.endswith("velocity")]
    start = next(sw.march(found.model, until=0.1)).ledger
    assert start.energy_kinetic + start.energy_strain == pytest.approx(2.0, rel=1e-9)
