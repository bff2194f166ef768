"""Instants of touch and release inside slabs, where the motion between is known."""

import pytest

import softway as sw


@pytest.mark.parametrize("step", [0.3, 0.7])
def test_a_bar_without_inertia_is_touched_and_left_by_a_wall_at_its_own_length(step: float) -> None:
    """The wall moves by 0.1 within one second and returns; the bar of unit length is 0.05 away from it."""
    there_and_back = sw.bodies.Table(times=(0.0, 1.0, 3.5), displacements=((0.0,), (-0.1,), (0.15,)))
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=3),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.05, normal=-1.0), motion=there_and_back)
    contact = sw.Contact(between=("bar.right", "wall"))
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,), inertia=sw.bodies.Off())
    events = [e for s in sw.march(scene, until=3.3, step=step) for e in s.events]
    assert [e.kind for e in events] == ["touch", "release"]
    assert [e.time for e in events] == pytest.approx([0.5, 1.5], abs=1e-9)


def thrown(rule: object, step: float, method: object = sw.FixedPoint()) -> list[sw.Step]:
    """A bar of unit data and speed, 0.103 before a wall, until it is back."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.103, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), timing=rule)
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,))
    return list(sw.march(scene, until=3.0, step=step, method=method))


@pytest.mark.parametrize("rule", [sw.contact.Energy(), sw.contact.Energy(located=True), sw.contact.Impulse()], ids=str)
def test_a_released_node_leaves_with_its_velocity(rule: object) -> None:
    """That of its state at the end of the slab, away from a wall at rest; without inertia the mean of the slab."""
    events = [(s, e) for s in thrown(rule, 0.05) for e in s.events if e.kind == "release"]
    assert events
    for step, event in events:
        assert event.velocity_before == 0.0
        assert event.velocity_after == pytest.approx(-step.after.velocity["bar"][-1, 0], abs=1e-14)
        assert event.velocity_after > 0.0


@pytest.mark.parametrize("rule", [sw.contact.Impulse(), sw.contact.Paper()], ids=str)
def test_the_slope_of_a_node_with_inertia_is_that_after_its_last_event(rule: object) -> None:
    """None while it is kept at the wall; after a release its velocity grows evenly from zero to the end of the slab."""
    kinds = set()
    for step in thrown(rule, 0.05):
        slope, velocity = (x["bar"][-1, 0] for x in (step.after.acceleration, step.after.velocity))
        for event in step.events[-1:]:
            left = step.slab.end - event.time
            expected = 0.0 if event.kind == "touch" else velocity / left
            assert slope == pytest.approx(expected, abs=1e-12 / left)
            kinds.add(event.kind)
    assert kinds == {"touch", "release"}


def test_a_node_that_is_pulled_back_when_it_touches_leaves_at_this_instant() -> None:
    """A bar of one cell against gravity, just up to the wall: its reaction would be in tension from the touch on."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.3, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), timing=sw.contact.Impulse())
    loads = (sw.Gravity(acceleration=-1.0),)
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,), loads=loads)
    (step,) = sw.march(scene, until=0.5, step=0.5, control=sw.StepControl(approach=9.0))
    instant = 1.0 - 0.4**0.5  # of a throw with unit speed and gravity to the height 0.3
    assert [e.kind for e in step.events] == ["touch", "release"]
    assert [e.time for e in step.events] == pytest.approx([instant, instant], abs=1e-12)
