"""Marches over threads as ranks, and every number of their steps as bits."""

from dataclasses import fields

import numpy as np

import softway as sw
from softway.cluster.march import march_on
from softway.marching.results.step import Step
from softway.marching.state.march_state import MarchState, Settings
from softway.marching.state.step_control import StepControl
from softway.model.model import Model
from softway.model.time_weight import EndPeaks
from softway.ranks.alone import Alone
from softway.ranks.interface import Ranks
from softway.ranks.threads import in_threads

GIVEN = Settings(until=0.006, step=5e-4, weight=EndPeaks(), method=sw.FixedPoint(), control=StepControl())


def told(step: Step) -> list[object]:
    """Every number of a step, as bits."""
    kinds = ("displacement", "velocity", "acceleration", "pressure", "traction", "sliding", "slip")
    numbers = [value for kind in kinds for _, value in sorted(getattr(step.after, kind).items())]
    numbers += [step.reactions[name] for name in sorted(step.reactions)]
    for solid in step.march_state.state.start.states:
        for state in () if solid is None else (solid, *solid.regions.values()):
            numbers += [state.displacement, state.stress, state.stored, state.dissipated, *state.law.values()]
            numbers.append(np.array([state.elastic]))
    for field in step.after.fields.values():
        numbers += [values for _, values in sorted(field.items())]
    for kind in (step.certificate, step.ledger):
        numbers += [np.asarray(getattr(kind, f.name), float).ravel() for f in fields(kind) if _numeric(kind, f.name)]
    events = [(e.kind, e.contact, e.node, e.time, e.impulse) for e in step.events]
    heat = repr(step.ledger.heat)
    return [step.report.iterations, step.report.factorisations, events, heat, *(x.tobytes() for x in numbers)]


def _numeric(kind: object, name: str) -> bool:
    """True for a number, or an array of numbers."""
    return isinstance(getattr(kind, name), float | np.ndarray)


def steps(ranks: Ranks, model: Model, given: Settings = GIVEN, state: MarchState | None = None) -> list[Step]:
    """Steps of a march on rank 0; empty on the others."""
    return [step for step in march_on(ranks, model, given, state) if step is not None]


def over(size: int, model: Model, given: Settings = GIVEN, state: MarchState | None = None) -> list[Step]:
    """Steps of a march over a number of threads."""
    return in_threads(size, lambda ranks: steps(ranks, model, given, state))[0]


def require_equal(model: Model, given: Settings = GIVEN) -> list[Step]:
    """Steps on one rank, which have the bits of those on two, and on three from a state of two."""
    one, two = steps(Alone(), model, given), over(2, model, given)
    middle = len(one) // 2 + 1
    assert [told(s) for s in two] == [told(s) for s in one]
    assert [told(s) for s in over(3, model, given, two[middle].march_state)] == [told(s) for s in one[middle + 1 :]]
    return one
