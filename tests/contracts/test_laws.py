"""Every law that softway exports passes its examination, with the parameters of its own example."""

import pytest

from softway.laws import bulk, friction
from softway.scenario.example_law import law_named
from softway.testing import check_law

BULK = list(bulk.__all__)
FRICTION = [f"friction.{name}" if name in BULK else name for name in friction.__all__]


@pytest.mark.parametrize("name", [*BULK, *FRICTION])
def test_laws_pass(name: str) -> None:
    check_law(law_named(name))
