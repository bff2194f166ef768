"""One answer, whatever the way to it: methods, restarts, what is kept between slabs, rejected tries."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from softway.contact.impact_rule import Energy, ImpactRule, Impulse, Paper
from softway.errors import NoConvergence, NumericsError
from softway.marching import march as module
from softway.marching.attempts import audited_slab
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.solve.operators.operator_memory import OperatorMemory

RULES = [Energy(), Energy(located=True), Impulse(), Paper(), Paper(approach="extrapolated")]
NEAR = 2e-11
rules = pytest.mark.parametrize("rule", RULES, ids=str)


@pytest.fixture(scope="module")
def fall(shop) -> Callable[..., object]:
    """A turned block that slides and bounces."""

    def make(rule: ImpactRule, **options: object):
        law = shop.linear if rule == Energy(located=True) else shop.neo
        solid = shop.block((0.03, -0.1), angle=0.2, material=law)
        return shop.move(solid, shop.floor, timing=rule, until=1.6, **options)

    return make


@pytest.fixture(scope="module")
def plain(fall) -> Callable[[ImpactRule], object]:
    """The same with nothing changed, computed once for each rule."""
    return cache(fall)


def same(a, b) -> bool:
    return all(
        np.array_equal(x, y)
        for one, two in zip(a.steps, b.steps, strict=True)
        for kind in ("displacement", "velocity", "acceleration", "closed", "pressure")
        for x, y in zip(getattr(one.after, kind).values(), getattr(two.after, kind).values(), strict=True)
    )


@rules
def test_two_runs_are_equal_to_the_last_bit(fall, plain, rule: ImpactRule) -> None:
    assert same(fall(rule), plain(rule))


@rules
def test_a_march_can_be_continued_from_any_state(shop, fall, plain, rule: ImpactRule) -> None:
    whole = plain(rule)
    for k in (5, 14, 24):
        rest = fall(rule, state=whole.steps[k].after)
        assert len(rest.steps) == len(whole.steps) - k - 1
        assert shop.distance(rest, whole) <= NEAR
        kinds = [[(e.kind, e.node) for s in m.steps for e in s.events] for m in (whole, rest)]
        assert kinds[0][len(kinds[0]) - len(kinds[1]) :] == kinds[1]


@pytest.mark.few(10)
@rules
@pytest.mark.parametrize(
    "method", [Newton(), FixedPoint(depth=0, limit=200), FixedPoint(depth=2), FixedPoint(tolerance=1e-13)], ids=str
)
def test_methods_agree(shop, fall, plain, rule: ImpactRule, method: FixedPoint | Newton) -> None:
    assert shop.distance(fall(rule, method=method), plain(rule)) <= NEAR


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_the_answer_follows_the_tolerance(shop, fall, plain, tolerance: float) -> None:
    loose = fall(Energy(), method=FixedPoint(tolerance=tolerance))
    assert shop.distance(loose, plain(Energy())) <= 10.0 * tolerance


@rules
def test_nothing_but_the_state_matters(shop, fall, plain, rule: ImpactRule, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = plain(rule)
    advance = audited_slab.advance
    monkeypatch.setattr(
        audited_slab, "advance", lambda r, now, slab, memory, *rest: advance(r, now, slab, OperatorMemory(), *rest)
    )
    assert shop.distance(fall(rule), kept) <= NEAR


def test_one_factor_serves_the_whole_march(plain) -> None:
    for rule in RULES:
        assert plain(rule).last.report.factorisations <= 2


@rules
def test_a_failed_attempt_changes_nothing_but_the_rejections(
    shop, fall, plain, rule: ImpactRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = plain(rule)
    advance, calls = audited_slab.advance, []

    def stumbling(r, now, slab, memory, *rest):
        out = advance(r, now, slab, memory, *rest)
        calls.append(slab)
        if len(calls) % 5 == 2:
            raise NoConvergence("stumbled")
        return out

    monkeypatch.setattr(audited_slab, "advance", stumbling)
    motion = fall(rule)
    assert shop.distance(motion, kept) <= NEAR
    reasons = [reason for s in motion.steps for reason in s.report.rejections]
    assert len(reasons) == len(calls) - len(motion.steps) >= 6
    assert all("stumbled" in r for r in reasons)


def test_a_slab_that_fails_is_halved_and_the_length_recovers(shop, monkeypatch: pytest.MonkeyPatch) -> None:
    advance = audited_slab.advance

    def short_of_breath(r, now, slab, memory, *rest):
        if slab.span > 0.02 and 0.3 < slab.end < 0.6:
            raise NoConvergence("too long")
        return advance(r, now, slab, memory, *rest)

    monkeypatch.setattr(audited_slab, "advance", short_of_breath)
    motion = shop.move(shop.block(), shop.floor, until=1.0, step=0.05)
    spans = np.array([s.slab.span for s in motion.steps])
    ends = np.array([s.slab.end for s in motion.steps])
    assert ends[-1] == 1.0
    np.testing.assert_allclose(np.cumsum(spans), ends, atol=1e-12)
    assert spans.min() == pytest.approx(0.0125)
    assert spans[-1] == pytest.approx(0.05)
    assert motion.energy_error <= 1e-12


def test_a_march_that_cannot_go_on_says_so_and_stops(shop, monkeypatch: pytest.MonkeyPatch) -> None:
    advance = audited_slab.advance
    calls = []

    def blocked(r, now, slab, memory, *rest):
        calls.append(slab.span)
        if slab.end > 0.5 + 1e-12:
            raise NoConvergence("a stone")
        return advance(r, now, slab, memory, *rest)

    monkeypatch.setattr(audited_slab, "advance", blocked)
    found = []
    with pytest.raises(NumericsError, match="a stone") as error:
        found.extend(module.march(shop.move(shop.bar(), until=0.05).model, until=1.0, step=0.05))
    assert error.value.when == pytest.approx(0.5, abs=1e-3)
    assert error.value.remedy
    assert len(calls) < 200, "it does not creep towards the obstacle for ever"


def test_a_model_may_be_marched_again(shop) -> None:
    first = shop.move(shop.block(), shop.floor, until=0.5)
    again = list(module.march(first.model, until=0.5, step=0.05))
    assert np.array_equal(again[-1].after.velocity["body"], first.last.after.velocity["body"])


def test_the_accepted_state_does_not_change_afterwards(shop) -> None:
    model = shop.move(shop.block(), shop.floor, until=0.05).model
    states, copies = [], []
    for s in module.march(model, until=0.5, step=0.05):
        states.append(s.after)
        copies.append(replace(s.after, velocity={k: v.copy() for k, v in s.after.velocity.items()}))
    for state, copy in zip(states, copies, strict=True):
        assert np.array_equal(state.velocity["body"], copy.velocity["body"])
