"""One slab: from a situation to the next, by the contact rule of the model."""

from dataclasses import dataclass

import numpy as np

from softway.contact.located import LocatedMean, located_mean
from softway.contact.timing import Energy
from softway.errors import InputError
from softway.march.carrying import solve_carrying
from softway.march.massless import solve_massless
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.driver import NoConvergence
from softway.solve.fixed_point import FixedPoint
from softway.solve.frozen import Carry
from softway.solve.newton import Newton
from softway.solve.reaction import Reaction, reaction
from softway.solve.system import Start
from softway.time.slab import Slab
from softway.time.weight import EndPeaks, TimeWeight


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rule:
    """What the contact rule of a model needs all through the march."""

    model: Model
    method: FixedPoint | Newton
    inertia: Reaction | None
    located: LocatedMean | None


def rule(model: Model, method: FixedPoint | Newton, weight: TimeWeight) -> Rule:
    """Prepare the contact rule.

    Raises
    ------
    InputError
        If the rule does not go with the law or the time weight.
    """
    if not isinstance(model.timing, Energy):
        return Rule(model=model, method=method, inertia=reaction(model), located=None)
    if weight != EndPeaks() and not model.massive.all():
        raise InputError(
            "time.weight",
            f"{weight} with the Energy rule, whose contact nodes are in equilibrium at the slab's ends",
            "EndPeaks with theta = 0.5, or the rule Impulse or Paper",
        )
    if not model.timing.located:
        return Rule(model=model, method=method, inertia=None, located=None)
    if not model.linear:
        raise InputError(
            "contacts[0].timing.located",
            "the located Energy rule is for small strain",
            "the material LinearElastic, or located = false",
        )
    stiffness = model.tangent(np.zeros(model.shape))
    located = located_mean(model.candidates, model.free, model.massive, model.load, stiffness)
    return Rule(model=model, method=method, inertia=None, located=located)


def advance(rule: Rule, now: Situation, slab: Slab, carry: Carry) -> tuple[Situation, Outcome, Carry]:
    """The situation at the end of the slab; nothing of the old one is changed.

    Raises
    ------
    NoConvergence
        If the method does not settle, or the energy balance cannot be closed.
    """
    if rule.inertia is None:
        out, carry = solve_massless(rule.model, now, slab, carry, rule.method, rule.located)
    else:
        out, carry = solve_carrying(rule.model, now, slab, carry, rule.method, rule.inertia)
    end = out.solution.end
    if end.clipped:
        raise NoConvergence("the scalar that closes the energy balance leaves [-1/2, 1/2]")
    after = Situation(
        time=slab.end,
        start=Start(displacement=end.displacement, velocity=out.velocity, force=end.force, energy=end.energy),
        acceleration=out.acceleration,
        closed=out.closed,
        pressure=out.pressure,
    )
    return after, out, carry
