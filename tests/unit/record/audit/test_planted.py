"""Faults planted in a march in the plane, around an axis and in space: each yields its finding."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from softway.arrays import Array
from softway.marching.march import march
from softway.marching.results.finding import DISSIPATION, INVERTED, KINDS, MOMENTUM, OVERLAP
from softway.marching.results.step import Event, Step
from softway.marching.results.step_states import KnownStates
from softway.record.audit.watch import APART, watcher
from softway.scenario.checks.check import Checked, check
from softway.scenario.files import loads
from softway.scenario.run import _opening

PLANE = 'kind = "Rectangle", size = [{0}, 1.0], cells = [{1}, 2], origin = [{2}, {3}]'
SPACE = 'kind = "Box", size = [{0}, {0}, 1.0], cells = [{1}, {1}, 2], origin = [{2}, {2}, {3}]'
BODY = """
[bodies.{name}]
kind = "Solid"
mesh = {{ {mesh} }}
material = {{ kind = "NeoHookean", E = "1 MPa", nu = 0.3 }}
density = "1000 kg/m^3"
velocity = {velocity}
"""
REST = """
title = "Block that falls on another one and slides on it"
[bodies.floor]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = {point}, normal = {normal} }}
[[contacts]]
name = "pair"
between = ["above.bottom", "below.top"]
{friction}
[[contacts]]
name = "floor"
between = ["below.bottom", "floor"]
[time]
end = "0.1 s"
step = "2 ms"
[output]
fields_every = "2 ms"
"""
WORLDS = ("plane", "axis", "space")


def up(dim: int) -> Array:
    """Upward unit vector: the last axis."""
    return np.eye(dim)[-1]


@cache
def marched(world: str) -> tuple[Checked, tuple[Step, ...]]:
    """Steps of two bodies that meet and slide on each other, with friction; the lower one lies on a floor."""
    shape, dim = (SPACE, 3) if world == "space" else (PLANE, 2)
    section = 'section = {{ kind = "Axisymmetric" }}\n' if world == "axis" else ""
    aside = 0.0 if world == "axis" else 0.3
    text = REST.format(point=[0.0] * dim, normal=up(dim).tolist(), friction='friction = { kind = "Coulomb", mu = 0.3 }')
    for name, mesh, velocity in (
        ("below", shape.format(2.0, 4, 0.0, 0.0), np.zeros(dim)),
        ("above", shape.format(1.0, 2, 0.0 if world == "axis" else 0.5, 1.005), aside * np.eye(dim)[0] - up(dim)),
    ):
        text += (BODY + section).format(name=name, mesh=mesh, velocity=velocity.tolist())
    checked = check(loads(text))
    steps = march(checked.model, until=checked.scenario.time.end, step=checked.step)
    return checked, tuple(step for step, _ in zip(steps, range(2 * APART), strict=False))


def told(world: str, change: Callable[[Step], Step] = lambda step: step, tools: float = 0.0) -> list[Event]:
    """Findings on the steps with a change in those of the second half, and the tools moved up."""
    checked, given = marched(world)
    audit = watcher(_opening(checked))
    if tools:
        real = audit.obstacles
        audit.obstacles = lambda state: {name: raised(tool, tools) for name, tool in real(state).items()}

    def steps() -> Iterator[Step]:
        yield from given[:APART]
        yield from (change(step) for step in given[APART:])

    return [event for step in audit.watched(steps()) for event in step.events if event.kind in KINDS]


def raised(tool, by: float):
    point = np.array(tool.shape.point)
    point[-1] += by
    return replace(tool, shape=replace(tool.shape, point=tuple(point.tolist())))


@pytest.mark.parametrize("world", WORLDS)
def test_nothing_is_found_where_nothing_is_wrong(world: str) -> None:
    assert not told(world)
    _, steps = marched(world)
    assert max(step.ledger.contacts["pair"].force_n for step in steps) > 0.0
    assert steps[-1].ledger.dissipation > 0.0


@pytest.mark.parametrize("world", WORLDS)
def test_a_body_whose_rows_are_lost_falls_into_the_other_one(world: str) -> None:
    def fallen(step: Step) -> Step:
        u = dict(step.after.displacement)
        u["above"] = u["above"] - 0.02 * up(u["above"].shape[1])
        return replace(step, states=replace(KnownStates.of(step.states), after=replace(step.after, displacement=u)))

    (seen,) = (e for e in told(world, fallen) if e.kind == OVERLAP)
    assert seen.contact == "below-above" and seen.depth == pytest.approx(0.02, rel=0.5)


@pytest.mark.parametrize("world", WORLDS)
def test_a_tool_that_is_not_where_the_rows_saw_it(world: str) -> None:
    seen = {e.kind: e for e in told(world, tools=0.01)}
    assert seen[OVERLAP].contact == "below-floor" and seen[OVERLAP].depth == pytest.approx(0.01, rel=0.2)


@pytest.mark.parametrize("world", WORLDS)
def test_a_cell_that_is_turned_inside_out(world: str) -> None:
    checked, _ = marched(world)
    points = _opening(checked).meshes["above"].points
    corner = int(np.argmax(points.sum(axis=1)))

    def turned(step: Step) -> Step:
        u = {name: field.copy() for name, field in step.after.displacement.items()}
        u["above"][corner] += 0.9 * (points.mean(axis=0) - points[corner]) / 0.5
        return replace(step, states=replace(KnownStates.of(step.states), after=replace(step.after, displacement=u)))

    assert ("above",) in {(e.contact,) for e in told(world, turned) if e.kind == INVERTED}


@pytest.mark.parametrize("world", WORLDS)
def test_friction_with_the_wrong_sign(world: str) -> None:
    _, steps = marched(world)
    start = steps[APART - 1].ledger.dissipation

    def driven(step: Step) -> Step:
        lost = 2.0 * start - step.ledger.dissipation
        return replace(step, ledger=replace(step.ledger, dissipation=lost))

    gained = np.diff([step.ledger.dissipation for step in steps[APART - 1 :]])
    rubbing = (gained > 1e-9 * steps[0].ledger.energy_kinetic).sum()
    assert sum(e.kind == DISSIPATION for e in told(world, driven)) >= rubbing > 0


@pytest.mark.parametrize("world", WORLDS)
def test_forces_that_are_lost_from_the_ledger(world: str) -> None:
    def weaker(step: Step) -> Step:
        contacts = {k: replace(c, force_n=0.0, force_t=0.0) for k, c in step.ledger.contacts.items()}
        return replace(step, ledger=replace(step.ledger, contacts=contacts))

    _, steps = marched(world)
    assert steps[2 * APART - 1].ledger.contacts["pair"].force_n > 0.0
    assert {e.contact for e in told(world, weaker) if e.kind == MOMENTUM} >= {"above"}
