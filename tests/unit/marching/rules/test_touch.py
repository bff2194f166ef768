"""Effect of a touch on the velocities: what a supported opponent takes part in."""

import pytest

import softway as sw


@pytest.mark.parametrize(("held", "share"), [(True, 1.0), (False, 0.5)])
def test_a_supported_node_stops_another_one_as_a_wall_does(held: bool, share: float) -> None:
    """The literal rule: the mass of an end node, an eighth of the bar, loses its speed, or half to an equal one."""
    both = {"mesh": sw.meshes.Interval(length=1.0, cells=4), "material": sw.LinearElastic(E=1.0), "density": 1.0}
    bodies = {
        "thrown": sw.Solid(**both, velocity=sw.bodies.Uniform(value=1.0)),
        "struck": sw.Solid(
            **both, place=sw.bodies.Placement(translation=1.1), supports=(sw.Fixed(on="left"),) if held else ()
        ),
    }
    contact = sw.Contact(between=("thrown.right", "struck.left"), timing=sw.contact.Paper())
    steps = list(sw.march(sw.Scene(bodies=bodies, contacts=(contact,)), until=0.15, step=0.05))
    (event,) = (e for s in steps for e in s.events)
    assert event.impulse == pytest.approx(0.125 * share, rel=1e-9)
    velocity = [steps[-1].after.velocity[name][node, 0] for name, node in (("thrown", -1), ("struck", 0))]
    assert velocity[0] == pytest.approx(velocity[1], abs=1e-12) and (velocity[1] == 0.0) == held


@pytest.mark.parametrize("cell", ["tri6", "quad8"])
def test_all_nodes_take_part_in_the_touch_of_a_corner_without_inertia(cell: str) -> None:
    """The row of the mass at such a corner has a sum of zero or less: stopped alone, it would create energy."""
    square = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2), cell=cell), material=sw.LinearElastic(E=1.0, nu=0.3),
        density=1.0, velocity=sw.bodies.Uniform(value=(0.0, -1.0)),
        place=sw.bodies.Placement(rotations=(sw.bodies.Rotation(axis=(0.0, 0.0, 1.0), angle=0.6),), bottom=0.005),
    )  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    lost, pushed = [], []
    for timing in (sw.contact.Paper(), sw.contact.Impulse()):
        contact = sw.Contact(between=("square", "floor"), timing=timing, name="drop")
        scene = sw.Scene(bodies={"square": square, "floor": floor}, contacts=(contact,))
        (step,) = sw.march(scene, until=0.01, step=0.01)
        assert step.events[0].kind == "touch"
        lost.append(step.ledger.dissipation)
        pushed.append(step.events[0].impulse)
    assert lost[0] == pytest.approx(lost[1], rel=1e-6) and lost[0] > 1e-4
    assert pushed[0] == pytest.approx(pushed[1], rel=1e-6) and pushed[0] > 1e-3
