"""Contact events of a slab with contact nodes with inertia."""

import numpy as np
import pytest

from single import single
from softway.contact.slab_motion.trajectory import ContactEvents
from softway.march.rules.event_iteration import EventIteration
from softway.march.rules.velocity_jumps import instants


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
