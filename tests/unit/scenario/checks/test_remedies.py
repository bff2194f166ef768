"""Refusals of combinations of rules: the check finds all of them, and every remedy leads to a run.

A case is a choice for each of several keys.  Every remedy in a message is one of ``REMEDIES``, with the changes that
follow it.
"""

from collections.abc import Iterator, Mapping
from itertools import islice, product

import pytest

from softway.errors import InputError
from softway.marching.march import march
from softway.model.build import build
from softway.scenario.checks.check import check
from softway.scenario.files import loads
from softway.scenario.hints.units_text import Units
from softway.scenario.scenario import Scenario

pytestmark = pytest.mark.slow

UNITS = Units.standard()
CHOICES = {
    "inertia": ("Full", "Off"),
    "solver": ("FixedPoint", "Newton", "Explicit"),
    "timing": (
        '{ kind = "Energy" }',
        '{ kind = "Energy", located = true }',
        '{ kind = "Impulse" }',
        '{ kind = "Paper" }',
        '{ kind = "Paper", split = "triangle" }',
    ),
    "weight": ('"EndPeaks"', '"Momentum"', '{ kind = "Collocation", at = [0.25], weights = [1] }'),
    "friction": ('"Frictionless"', '{ kind = "Coulomb", mu = 0.3 }'),
    "layers": ("1", "2"),
    "material": ("LinearElastic", "Hypoelastic"),
    "motion": ('"Still"', '{ kind = "Translation", velocity = [0, 0.1] }'),
    "step": ('"auto"', "2", "1"),
}
REMEDIES: Mapping[str, Mapping[str, str]] = {
    "the rule Energy, located = false": {"timing": '{ kind = "Energy" }'},
    "the timing Energy": {"timing": '{ kind = "Energy" }'},
    "located = false": {"timing": '{ kind = "Energy" }'},
    "split = 'product'": {"timing": '{ kind = "Paper" }'},
    "the solver FixedPoint": {"solver": "FixedPoint"},
    "the default weight": {"weight": '"EndPeaks"'},
    "the weight EndPeaks": {"weight": '"EndPeaks"'},
    "EndPeaks with theta = 0.5": {"weight": '"EndPeaks"'},
    "a mean instant of at least 1/2": {"weight": '{ kind = "Collocation", at = [0.5], weights = [1] }'},
    "with inertia": {"inertia": "Full"},
    "with inertia and without friction the rule Impulse": {
        "inertia": "Full",
        "friction": '"Frictionless"',
        "timing": '{ kind = "Impulse" }',
    },
    "without friction the rule Impulse with FixedPoint or Newton": {
        "friction": '"Frictionless"',
        "timing": '{ kind = "Impulse" }',
        "solver": "FixedPoint",
    },
    "two layers of elements or quadratic elements there": {"layers": "2"},
    "a smaller contact tag": {"tag": "bottom"},
    "the material LinearElastic": {"material": "LinearElastic"},
    "half-spaces at rest": {"motion": '"Still"'},
    "which is stable for every step": {},
}
TEXT = """
inertia = {{ kind = "{inertia}" }}
solver = {{ kind = "{solver}" }}
[bodies.b]
kind = "Solid"
mesh = {{ kind = "Rectangle", size = [3, 1], cells = [{layers}, {layers}], cell = "quad8", origin = [0, 0.01] }}
material = {{ kind = "{material}", E = 1, nu = 0.3 }}
density = 1
supports = [{{ on = "left" }}]
[bodies.w]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0, 0], normal = [0, 1] }}
motion = {motion}
[[contacts]]
between = ["b.{tag}", "w"]
timing = {timing}
friction = {friction}
[time]
end = 2
step = {step}
weight = {weight}
"""


def scenario(case: Mapping[str, str]) -> Scenario:
    return loads(TEXT.format(**{"tag": "surface", **case}), units=UNITS)


every = pytest.mark.parametrize("every", [31, pytest.param(13, marks=pytest.mark.minutes)])


def cases(every: int) -> Iterator[dict[str, str]]:
    """Every so many cases, a number that divides no number of choices; all pairs of choices occur."""
    for values in islice(product(*CHOICES.values()), 0, None, every):
        yield dict(zip(CHOICES, values, strict=True))


def refusal(case: Mapping[str, str]) -> InputError | None:
    try:
        check(scenario(case))
    except InputError as error:
        return error
    return None


def ways(remedy: str) -> Iterator[Mapping[str, str]]:
    """Changes by each of the alternatives of a remedy, which commas separate."""
    if remedy in REMEDIES:
        yield REMEDIES[remedy]
        return
    for way in remedy.split(", "):
        alone = way.removeprefix("or ")
        if alone.startswith("a step of at most "):
            yield {"step": alone.split()[5]}
        elif REMEDIES[alone]:
            yield REMEDIES[alone]


@every
def test_every_remedy_leads_to_a_run_and_none_in_a_circle(every: int) -> None:
    """Followed one after another, in every order, remedies never lead back to a case that was refused before."""
    refused: dict[tuple[tuple[str, str], ...], InputError | None] = {}

    def follow(case: dict[str, str], before: tuple[tuple[tuple[str, str], ...], ...]) -> None:
        key = tuple(sorted(case.items()))
        assert key not in before, f"in a circle: {refused[key]}"
        if key in refused:
            return
        refused[key] = error = refusal(case)
        if error is None:
            return
        changes = list(ways(error.remedy))
        assert changes, f"no remedy: {error}"
        for change in changes:
            new = {**case, **change}
            assert new != case, f"{error}: changes nothing of {case}"
            follow(new, (*before, key))
            other = refused[tuple(sorted(new.items()))]
            assert other is None or other.problem != error.problem, f"{change} has no effect: {error}"

    for case in cases(every):
        follow(case, ())
    problems = {e.problem for e in refused.values() if e is not None}
    assert len(problems) > 15, problems


def marched(case: Mapping[str, str]) -> str:
    """Refusal by the march itself, without the check; nothing if its first slab is accepted."""
    given = scenario(case)
    time = given.time
    try:
        steps = march(build(given.scene), until=time.end, step=time.step, weight=time.weight, method=given.solver)
        next(steps)
    except InputError as error:
        return str(error)
    return ""


@every
def test_the_check_refuses_all_that_a_march_refuses(every: int) -> None:
    for case in cases(every):
        error = refusal(case)
        assert marched(case) == ("" if error is None else str(error)), case
