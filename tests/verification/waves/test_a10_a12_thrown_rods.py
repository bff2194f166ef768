"""A10 and A12: thrown bars in inches and pounds, read from a scenario file, and in SI units."""

import pytest

import results
import softway as sw
from softway.apps.verify.scenes import bars


@pytest.mark.slow
def test_rod_in_inches_and_pounds() -> None:
    assert results.missed("A10") == set()


@pytest.mark.slow
def test_steel_bar() -> None:
    assert results.missed("A12") == set()


@pytest.mark.slow
def test_the_instant_of_the_touch_in_units_is_exact() -> None:
    """To the rounding of the coordinates, L / v times 1e-16."""
    assert results.verdicts("A10")["t_impact"].error <= 1e-15 * 10.0 / 202.2
    assert results.verdicts("A12")["t_contact"].error <= 1e-15 * 1.0 / 0.1


def test_the_scale_does_not_matter() -> None:
    """The steel bar of A12 is the bar of A02 with gap c / (v L) = 2.594..., in other units."""
    d = results.case("A12")["definition"]
    c = (d["youngs"] / d["density"]) ** 0.5
    steel = bars.thrown(
        20,
        sw.contact.Energy(),
        gap=d["gap"],
        until=6.0 / c,
        step=0.04 / c,
        material=sw.LinearElastic(E=d["youngs"]),
        density=d["density"],
        area=d["area"],
        speed=d["speed"],
    )
    plain = bars.thrown(20, sw.contact.Energy(), gap=d["gap"] * c / d["speed"], until=6.0, step=0.04)
    assert steel.kinds == plain.kinds == ["touch", "release"]
    assert abs(steel.instants * c - plain.instants).max() <= 1e-9
    scale = d["area"] * d["speed"] * (d["youngs"] * d["density"]) ** 0.5
    assert abs(steel.force / scale - plain.force).max() <= 1e-8
