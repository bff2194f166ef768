"""Attempts at a slab: what is tried after a failure, what the next slab inherits, and when a march ends."""

import importlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, cast

import numpy as np
import pytest

import softway as sw
from softway.errors import Halts, NoConvergence, Unbalanced
from softway.marching.results.trying import Trying
from softway.marching.rules.equilibrated import equilibrated
from softway.marching.rules.slab_rule import Attempt, Method, SlabRule
from softway.model.model import Model
from softway.model.time_weight import TimeWeight
from softway.solve.operators.operator_memory import OperatorMemory

attempts = importlib.import_module("softway.marching.attempts.accept")
STEP = 0.125
Failure = Callable[[int], Exception | None]


@dataclass(frozen=True, kw_only=True)
class Failing:
    """The rule Energy, but for ``failure`` of attempts by their number, which may have an operator that cannot be
    factored; it notes the attempts.
    """

    massless: ClassVar[bool] = True

    spread: int = 5
    failure: Failure
    indefinite: bool = False
    attempts: list[Attempt] = field(default_factory=list, compare=False)

    def slab_rule(self, model: Model, method: Method, weight: TimeWeight) -> SlabRule:
        return Failed(rule=equilibrated(model, method, weight), declared=self)


@dataclass(frozen=True, kw_only=True)
class Failed:
    """Slabs of another rule, with failures."""

    rule: SlabRule
    declared: Failing

    def solve(self, model: Model, now: Any, slab: Any, memory: OperatorMemory, attempt: Attempt) -> Iterator[Any]:
        self.declared.attempts.append(attempt)
        failure = self.declared.failure(len(self.declared.attempts))
        if failure is not None:
            if self.declared.indefinite:
                attempt.effort.factor(1, 1.0)
            raise failure
        yield from self.rule.solve(model, now, slab, memory, attempt)


def flight(rule: Failing, until: float = 0.5, **options: Any) -> list[sw.Step]:
    """A block that flies along a floor, in four slabs if none fails."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 4)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(1.0, 0.0)),
        place=sw.bodies.Placement(bottom=1.0),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), timing=rule)
    scene = sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,))
    return list(sw.march(scene, until=until, step=STEP, **options))


def resting(rule: Any) -> sw.Scene:
    """A block that falls on the floor where it stands."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 4)),
        material=sw.NeoHookean(E=1e3, nu=0.3),
        density=1.0,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), timing=rule)
    return sw.Scene(
        bodies={"block": block, "floor": floor}, contacts=(contact,), loads=(sw.Gravity(acceleration=(0.0, -1.0)),)
    )


def spans(steps: list[sw.Step]) -> list[float]:
    return [step.slab.span / STEP for step in steps]


def test_a_slab_that_fails_with_an_old_operator_keeps_its_length_and_gets_a_new_one() -> None:
    steps = flight(Failing(failure=lambda k: NoConvergence("once") if k == 3 else None))
    assert spans(steps) == [1.0] * 4
    assert [len(step.report.rejections) for step in steps] == [0, 0, 1, 0]
    assert [step.report.factorisations for step in steps] == [1, 1, 2, 2]


def test_a_slab_that_fails_with_a_new_operator_is_halved() -> None:
    """The first one has a new operator in any case, the third one at its second attempt."""
    first = flight(Failing(failure=lambda k: NoConvergence("once") if k == 1 else None))
    assert spans(first)[0] == 0.5 and len(first[0].report.rejections) == 1
    third = flight(Failing(failure=lambda k: NoConvergence("twice") if k in (3, 4) else None))
    assert spans(third)[:3] == [1.0, 1.0, 0.5] and len(third[2].report.rejections) == 2


@pytest.mark.parametrize(("method", "tries"), [(sw.FixedPoint(), 3), (sw.Newton(), 2)], ids=["fixed", "newton"])
def test_a_slab_with_an_indefinite_operator_gets_definite_ones_before_it_is_halved(method: Method, tries: int) -> None:
    """The second attempt at the third slab is one of the fixed point, a third one of Newton's method."""
    failing = range(3, 3 + tries)
    rule = Failing(failure=lambda k: NoConvergence("again") if k in failing else None, indefinite=True)
    steps = flight(rule, method=method)
    assert spans(steps)[:3] == [1.0, 1.0, 0.5] and len(steps[2].report.rejections) == tries
    assert [a.positive_definite for a in rule.attempts[:6]] == [k in failing[1:] for k in range(1, 7)]


def test_what_the_scalar_cannot_close_at_half_the_length_is_closed_along_the_motion() -> None:
    """In this slab; the next one needs it no more, because its scalar is far from the bound."""
    rule = Failing(failure=lambda k: Unbalanced("twice") if k == 2 else None)
    steps = flight(rule)
    assert [a.energy_along_motion for a in rule.attempts[:4]] == [False, False, True, False]
    assert spans(steps)[:2] == [1.0, 0.5]


def test_a_slab_ends_where_a_body_comes_to_rest_and_the_next_one_is_damped() -> None:
    """The one after it has the weight and the length of the march again."""
    steps = flight(Failing(failure=lambda k: Halts(0.25) if k == 2 else None))
    assert spans(steps)[:2] == pytest.approx([1.0, 0.25], rel=1e-12)
    weights = [step.slab.weight.theta for step in steps]
    assert weights[:4] == [0.5, 0.5, 1.0, 0.5] and spans(steps)[2:4] == pytest.approx([0.5**0.5, 1.0], rel=1e-12)
    assert not any(step.report.rejections for step in steps)


def test_a_march_that_crawls_ends_when_its_patience_is_used_up() -> None:
    """A rejection is tried again before, and ends the march after too many in slabs that are far too short."""
    begun = flight(Failing(failure=lambda k: None))[1].march_state
    patience = begun.settings.control.patience

    def going_on(rejections: float) -> list[sw.Step]:
        state = replace(begun, step_history=replace(begun.step_history, recent_rejections=rejections))
        return flight(Failing(failure=lambda k: NoConvergence("once") if k == 1 else None), state=state)

    assert [len(step.report.rejections) for step in going_on(patience)] == [1, 0]
    with pytest.raises(sw.NumericsError, match="301 rejections among slabs shorter than 0.01 of the step; last: h"):
        going_on(patience + 0.25)


def test_a_march_whose_slabs_stay_far_too_short_ends() -> None:
    """Slabs of 1e-9 of the length that was asked for are all accepted, but a hundred million are left."""
    begun = flight(Failing(failure=lambda k: None))[1].march_state
    control = sw.StepControl(patience=2, least=1e-12)
    history = replace(begun.step_history, length=1e-9 * STEP, last_rejection="h = 0.1 s: friction of 3 contact rows")
    crawling = replace(begun, settings=replace(begun.settings, control=control), step_history=history)
    told = r"t = 0.25 s: the time step stays at h = \S+ s of the 0.125 s given, \de\+08 more of them lead to the end; "
    with pytest.raises(sw.NumericsError, match=told) as failed:
        flight(Failing(failure=lambda k: None), state=crawling, control=control)
    assert failed.value.what.endswith("rejection: h = 0.1 s: friction of 3 contact rows")
    assert failed.value.remedy.endswith(", or to go on regardless time.control.patience = 20")
    patient = replace(control, patience=20)
    crawling = replace(crawling, settings=replace(begun.settings, control=patient))
    assert len(flight(Failing(failure=lambda k: None), state=crawling, control=patient)) > 20


def test_an_attempt_is_given_up_when_its_steps_are_used_up(monkeypatch) -> None:
    """One step of the contact problems for an attempt is too few for any slab on the floor."""
    monkeypatch.setattr(attempts, "STEPS", 0.02)
    told = "attempt given up after 1 iterations, 1 factors and 2 steps of the contact problems, of 1 allowed; the"
    with pytest.raises(sw.NumericsError, match=told):
        list(sw.march(resting(sw.contact.Energy()), until=0.5, step=STEP))


ALONE = sw.Newton(handover=False)


@pytest.mark.parametrize(("method", "named"), [(ALONE, True), (sw.FixedPoint(), False)], ids=["newton", "fixed"])
def test_the_fixed_point_is_a_remedy_where_newton_alone_fails(method: Method, named: bool) -> None:
    rule = Failing(failure=lambda k: NoConvergence("always"))
    with pytest.raises(sw.NumericsError, match="after 5 cutbacks; last: h = 0.00781 s: always") as failed:
        flight(rule, method=method, control=sw.StepControl(least=0.05))
    assert ("FixedPoint" in failed.value.remedy) == named


def test_the_fixed_point_takes_over_a_slab_in_which_newton_fails() -> None:
    """One iteration of Newton is never enough for a law that is not linear: alone, it is left without a slab."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Affine(gradient=((0.1, 0.2), (0.0, -0.1))),
    )
    scene = sw.Scene(bodies={"block": block})
    few = sw.Newton(limit=1)
    steps = list(sw.march(scene, until=0.5, step=0.1, method=few))
    assert [(len(s.report.rejections), round(s.slab.span, 12)) for s in steps] == [(1, 0.1)] * 5
    for step, other in zip(steps, sw.march(scene, until=0.5, step=0.1), strict=True):
        np.testing.assert_allclose(step.after.velocity["block"], other.after.velocity["block"], rtol=0, atol=1e-12)
    with pytest.raises(sw.NumericsError, match="1 iterations leave"):
        list(sw.march(scene, until=0.5, step=0.1, method=replace(few, handover=False)))


def test_every_iterate_of_every_attempt_is_told() -> None:
    """A second slab whose first attempt fails before its first iterate: numbers, instants and lengths are those of the
    attempts.
    """
    seen: list[Trying] = []
    rule = Failing(failure=lambda n: NoConvergence("now") if n == 2 else None)
    steps = flight(rule, until=0.25, trying=seen.append)
    assert seen[0] == Trying(slab=0, iteration=0)
    firsts = [(t.slab, t.time, t.span) for t in seen[1:] if t.iteration == 0 and not t.doing]
    begun = [(k + 1, s.slab.start, s.slab.span) for k, s in enumerate(steps)]
    assert firsts == [begun[0], begun[1], begun[1]]
    iterates = [t for t in seen if t.slab == 1 and t.iteration and not t.doing]
    assert [t.iteration for t in iterates] == list(range(1, steps[0].report.iterations + 1))
    assert all(t.active == 0 and t.change >= 0.0 for t in iterates)
    assert any(t.doing.startswith("factoring ") and t.seconds < 1e-3 for t in seen)
    assert [s.report.iterations for s in steps] == [s.report.iterations for s in flight(rule, until=0.25)]


def test_a_march_that_ends_in_contact_names_it() -> None:
    """A block that rests on a floor."""
    rule = Failing(failure=lambda n: NoConvergence("always") if n > 1 else None)
    with pytest.raises(sw.NumericsError, match="always; in contact: block.bottom-floor"):
        list(sw.march(resting(rule), until=0.5, step=STEP))


@pytest.mark.parametrize(
    "material", [sw.laws.StVenantKirchhoff(E=1.0, nu=0.3), sw.NeoHookean(E=1.0)], ids=["soft", "stiff"]
)
@pytest.mark.parametrize(("stretch", "told"), [(0.68, "; 'block' is crushed to 68 % of its volume"), (0.8, "")])
def test_a_march_that_ends_names_crushed_bodies_and_a_law_that_resists(
    material: sw.NeoHookean | sw.laws.StVenantKirchhoff, stretch: float, told: str
) -> None:
    rule = Failing(failure=lambda n: NoConvergence("always"))
    scene = resting(rule)
    start = sw.bodies.Affine(gradient=((0.0, 0.0), (0.0, stretch - 1.0)))
    block = replace(cast(sw.Solid, scene.bodies["block"]), material=material, displacement=start)
    with pytest.raises(sw.NumericsError, match="always") as failed:
        list(sw.march(replace(scene, bodies={**scene.bodies, "block": block}), until=0.5, step=STEP))
    assert failed.value.what.endswith("in contact: block.bottom-floor" + told) or not told
    assert ("is crushed" in failed.value.what) == bool(told)
    softens = isinstance(material, sw.laws.StVenantKirchhoff)
    assert ("NeoHookean" in failed.value.remedy) == (softens and bool(told))
