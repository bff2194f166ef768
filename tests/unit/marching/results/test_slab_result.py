"""Results of slabs."""

import numpy as np

from softway.marching.results.slab_result import ordered_events
from softway.marching.results.step import Event
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks


def event(time: float, contact: str, kind: str, node: int) -> Event:
    return Event(
        time=time,
        contact=contact,
        kind=kind,
        node=node,
        position=np.zeros(2),
        velocity_before=0.0,
        velocity_after=0.0,
        impulse=0.0,
    )


def test_events_are_ordered_by_time_contact_and_node() -> None:
    slab = Slab(start=1.0, end=3.0, weight=EndPeaks())
    late, rounded = event(2.5, "a", "touch", 0), event(2.0 + 1e-12, "a", "touch", 3)
    node, contact = event(2.0, "a", "touch", 4), event(2.0, "b", "touch", 1)
    assert ordered_events([late, contact, node, rounded], slab) == (rounded, node, contact, late)


def test_equal_events_keep_their_order() -> None:
    slab = Slab(start=0.0, end=1.0, weight=EndPeaks())
    touch, release = event(0.5, "a", "touch", 2), event(0.5, "a", "release", 2)
    assert ordered_events([touch, release], slab) == (touch, release)
