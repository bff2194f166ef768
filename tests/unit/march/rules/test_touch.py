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
