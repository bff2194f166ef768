"""The slab."""

import pytest

from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks, Momentum


def test_span_and_weight() -> None:
    assert Slab(start=0.25, end=1.0).span == 0.75
    assert Slab(start=0.0, end=1.0).weight == EndPeaks()
    assert Slab(start=0.0, end=1.0, weight=Momentum()).weight == Momentum(points=2)


def test_a_slab_cannot_be_changed() -> None:
    slab = Slab(start=0.0, end=1.0)
    with pytest.raises(AttributeError):
        slab.end = 2.0
