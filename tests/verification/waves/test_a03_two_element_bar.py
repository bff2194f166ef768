"""A03: the thrown bar of two elements, exact in time: release, loss and motion converge at second order in h."""

import numpy as np
import pytest

import results
import softway as sw
from orders import order
from softway.apps.verify.cases.waves.a03_two_element_bar import at_the_wall
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.scenes import bars

STEPS = (0.02, 0.01, 0.005)
UNTIL = 2.5
RULES = {
    "paper": (sw.contact.Paper(), sw.bodies.Consistent(), "literal", 1.88972, 1.0 / 3.0),
    "paper, extrapolated": (
        sw.contact.Paper(approach="extrapolated"),
        sw.bodies.Consistent(),
        "literal",
        1.88972,
        1.0 / 3.0,
    ),
    "impulse": (sw.contact.Impulse(), sw.bodies.Consistent(), "impulse", 1.84115, 1.0 / 7.0),
    "lumped": (sw.contact.Impulse(), sw.bodies.Lumped(), "impulse", 2.09858, 1.0 / 4.0),
}
every = pytest.mark.parametrize("name", RULES)


def marched(name: str, step: float) -> bars.Record:
    """The march of a rule from the wall."""
    rule, mass, *_ = RULES[name]
    return at_the_wall(rule, step, mass, UNTIL)


def solved(name: str) -> discrete.Motion:
    """The exact motion of the same mesh."""
    _, mass, rule, *_ = RULES[name]
    mesh = discrete.bar(2, lumped=mass == sw.bodies.Lumped())
    return discrete.solve(mesh, np.zeros(3), np.ones(3), gap=0.0, until=UNTIL, rule=rule)


@pytest.mark.minutes
def test_case() -> None:
    assert results.missed("A03") == set()


@every
def test_the_exact_motion_has_the_known_release_and_loss(name: str) -> None:
    *_, release, lost = RULES[name]
    motion = solved(name)
    assert motion.times("release") == [pytest.approx(release, abs=5e-6)]
    assert motion.energy(UNTIL) == pytest.approx(0.5 * (1.0 - lost), abs=1e-12)


@pytest.mark.slow
@pytest.mark.few(2)
@every
def test_the_loss_is_exact(name: str) -> None:
    *_, lost = RULES[name]
    for step in STEPS:
        assert marched(name, step).dissipation[-1] == pytest.approx(0.5 * lost, rel=1e-12)


@pytest.mark.slow
@pytest.mark.few(2)
@every
def test_the_energy_that_is_left_converges(name: str) -> None:
    """Kinetic and strain energy at the end; what the balance lacks falls with h^2 or faster."""
    *_, lost = RULES[name]
    for step in STEPS:
        march = marched(name, step)
        assert march.energy[-1] == pytest.approx(0.5 * (1.0 - lost), abs=0.01 * step**2)
        assert np.abs(march.error).max() <= 0.01 * step**2


@pytest.mark.slow
@pytest.mark.few(2)
@every
def test_the_release_converges_at_second_order(name: str) -> None:
    exact = solved(name).times("release")[0]
    errors = [abs(marched(name, step).first("release") - exact) for step in STEPS]
    assert marched(name, STEPS[-1]).kinds == ["touch", "release"]
    assert order(errors, STEPS) >= 1.8
    assert errors[-1] <= 2.1 * STEPS[-1] ** 2


@pytest.mark.slow
@every
def test_the_motion_converges_at_second_order(name: str) -> None:
    motion, instants = solved(name), np.linspace(0.0, UNTIL, 26)
    table = np.array([motion.at(t)[0] for t in instants])
    errors = [np.abs(marched(name, step).at(instants) - table).max() for step in STEPS]
    assert order(errors, STEPS) >= 1.9
    speeds = [abs(marched(name, step).momentum[-1] - motion.mean_velocity(UNTIL)) for step in STEPS]
    assert order(speeds, STEPS) >= 1.9


@pytest.mark.slow
def test_better_weights_have_smaller_phase_errors() -> None:
    """Table of the case at h = 0.01: 9.5e-4 with the end peaks, 4e-5 with the fourth-order weight; it admits 1e-4."""
    quantity = next(q for q in results.case("A03")["qoi"] if q["name"] == "u(t) table csv")
    times, table = results.case("A03")["definition"]["times"], np.array(quantity["value"])
    errors = []
    for weight in (sw.model.EndPeaks(), bars.FOURTH):
        march = at_the_wall(sw.contact.Impulse(), 0.01, until=times[-1], weight=weight)
        errors.append(np.abs(march.at(times) - table).max())
    assert errors == pytest.approx([9.5e-4, 3.8e-5], rel=0.05)


@pytest.mark.parametrize("gap", [0.25, 0.3, 1.0 / 3.0])
@pytest.mark.parametrize(
    "rule",
    [sw.contact.Paper(), sw.contact.Paper(approach="extrapolated"), sw.contact.Impulse(), sw.contact.Energy()],
    ids=str,
)
def test_the_instant_of_the_touch_is_exact(
    rule: sw.contact.Paper | sw.contact.Impulse | sw.contact.Energy, gap: float
) -> None:
    march = bars.thrown(2, rule, gap=gap, until=gap + 0.1, step=0.03)
    assert march.first("touch") == pytest.approx(gap, abs=1e-12)


@pytest.mark.parametrize("gap", [0.25, 0.3, 1.0 / 3.0])
def test_the_located_form_finds_the_touch_to_third_order(gap: float) -> None:
    """Its instants lie on the chord of the slab, whose end the contact force has already moved: an error of 0.1 h^3."""
    for step in (0.06, 0.03):
        march = bars.thrown(2, sw.contact.Energy(located=True), gap=gap, until=gap + 0.1, step=step)
        assert march.first("touch") == pytest.approx(gap, abs=0.2 * step**3)
