"""Contact events of a slab with contact nodes with inertia."""

import numpy as np
import pytest

import softway as sw
from single import single
from softway.contact.slab_motion.trajectory import ContactEvents
from softway.marching.rules.event_iteration import EventIteration
from softway.marching.rules.velocity_jumps import instants


def test_the_impulse_of_a_fading_force_is_a_triangle() -> None:
    """Rows that stay closed, let go, touch and let go, and let go at once: half of force times length."""
    way = ContactEvents(
        closed=np.array([True, False, False, False]),
        touch=np.array([np.nan, np.nan, 0.2, 0.7]),
        speed=np.zeros(4),
        slope=np.zeros(4),
        release=np.array([np.nan, 0.5, 0.6, 0.7]),
    )
    rows = single(np.zeros(4, int), np.ones((4, 1)), 0.0, 1)
    course = EventIteration(
        rows=rows, events=way, reaction=np.array([3.0, 4.0, 10.0, -2.0]), may_not_release=np.zeros(4, bool)
    )
    assert course.impulse == pytest.approx([0.0, 1.0, 2.0, 0.0])


def test_touches_within_rounding_are_one_instant() -> None:
    assert instants(np.array([0.3, np.nan, 0.1, 0.3 + 1e-12, 0.30001])) == [0.1, 0.3, 0.30001]
    assert instants(np.full(3, np.nan)) == []


def test_a_node_that_slides_off_its_opponent_is_released_at_the_start_of_the_next_slab() -> None:
    """The corner of a block that is pressed on another one passes its edge in the first slab."""
    law = sw.NeoHookean(E=10.0, nu=0.3)
    bodies = {
        "a": sw.Solid(
            mesh=sw.meshes.Rectangle(size=(0.6, 0.4), cells=(2, 2), origin=(0.39, 1.0)), material=law, density=1.0,
            velocity=sw.bodies.Uniform(value=(3.0, -0.1)),
        ),
        "b": sw.Solid(
            mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), material=law, density=1.0,
            supports=(sw.Fixed(on="bottom"),),
        ),
    }  # fmt: skip
    method, timing = sw.contact.NodeToSurface(), sw.contact.Impulse()
    contact = sw.Contact(between=("a.bottom", "b.top"), method=method, timing=timing)
    steps = list(sw.march(sw.Scene(bodies=bodies, contacts=(contact,)), until=0.06, step=0.02))
    corner = [(e.kind, e.time) for s in steps for e in s.events if e.node == 2]
    assert steps[0].after.displacement["a"][2, 0] > 0.01, "it is beyond the edge"
    assert [kind for kind, _ in corner] == ["touch", "release"]
    assert corner[1][1] == pytest.approx(steps[1].slab.start, abs=1e-12)
