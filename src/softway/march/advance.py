"""One slab: from a situation to the next, by the contact rule of the model."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.bodies import past
from softway.contact.fig4 import Split
from softway.contact.located import LocatedMean, located_mean
from softway.contact.timing import Energy, Paper
from softway.errors import Cancel, InputError, Unbalanced
from softway.march.carrying import solve_carrying
from softway.march.explicit import Central, central, solve_explicit
from softway.march.massless import solve_massless
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.carry import Carry
from softway.solve.explicit import Explicit
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.solve.reaction import Reaction, reaction
from softway.solve.values import Start
from softway.solve.watched import Watched
from softway.time.slab import Slab
from softway.time.weight import EndPeaks, TimeWeight

Method = FixedPoint | Newton | Explicit


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rule:
    """What the contact rule of a model needs all through the march, and whom it asks whether to go on."""

    model: Model
    method: Method
    inertia: Reaction | None
    located: LocatedMean | None
    split: Split | None = None
    central: Central | None = None
    cancel: Cancel | None = None

    def watched(self, slab: Slab) -> FixedPoint | Newton | Watched:
        """The method for a slab, which asks between its iterates."""
        assert not isinstance(self.method, Explicit)
        return self.method if self.cancel is None else Watched(method=self.method, cancel=self.cancel, when=slab.start)


def rule(model: Model, method: Method, weight: TimeWeight) -> Rule:
    """Prepare the contact rule.

    Raises
    ------
    InputError
        If the rule does not go with the law or the time weight.
    """
    if isinstance(method, Explicit):
        if weight != EndPeaks():
            raise InputError("time.weight", f"{weight} with Explicit, whose peak is at the start", "the default weight")
        return Rule(model=model, method=method, inertia=None, located=None, central=central(model))
    if not isinstance(model.timing, Energy):
        if model.rubbing is not None:
            raise InputError("contacts[0].friction", f"friction with {model.timing}", "the rule Energy")
        triangle = isinstance(model.timing, Paper) and model.timing.split == "triangle"
        split = split_elements(model) if triangle else None
        return Rule(model=model, method=method, inertia=reaction(model), located=None, split=split)
    if weight != EndPeaks() and not model.massive.all():
        raise InputError(
            "time.weight",
            f"{weight} with the Energy rule, whose contact nodes are in equilibrium at the slab's ends",
            "EndPeaks with theta = 0.5, or the rule Impulse or Paper",
        )
    if model.timing.located and model.rubbing is not None:
        raise InputError("contacts[0].friction", "friction with the located Energy rule", "located = false")
    if not model.timing.located:
        return Rule(model=model, method=method, inertia=None, located=None)
    if not (model.linear and model.encounters.fixed):
        raise InputError(
            "contacts[0].timing.located",
            "the located Energy rule is for small strain and resting half-spaces",
            "the material LinearElastic, or located = false",
        )
    stiffness = model.tangent(np.zeros(model.shape))
    located = located_mean(model.rows(model.displacement), model.free, model.massive, model.load, stiffness)
    return Rule(model=model, method=method, inertia=None, located=located)


def advance(
    rule: Rule,
    now: Situation,
    slab: Slab,
    carry: Carry,
    approach: float = np.inf,
    fallback: bool = False,
    held: bool = False,
) -> Iterator[tuple[Situation, Outcome, Carry]]:
    """Situations at the end of the slab, each from a closer solution than the one before; the old one stays.

    With ``held`` friction holds what rests at any force.

    Raises
    ------
    NoConvergence, TooFast, Unbalanced
        If the method does not settle, the slab is too long for the approach, or the energy balance cannot be closed.
    """
    model = rule.model.during(now.start.memory, slab.span).pushed(slab.start, slab.end)
    match rule.method:
        case Explicit() as method:
            assert rule.central is not None
            found = iter([solve_explicit(model, now, slab, carry, method, rule.central, approach)])
        case _ if rule.inertia is None:
            watched, located = rule.watched(slab), rule.located
            found = solve_massless(model, now, slab, carry, watched, located, approach, fallback, held)
        case _:
            watched = rule.watched(slab)
            found = solve_carrying(model, now, slab, carry, watched, rule.inertia, approach, rule.split)
    for out, after in found:
        yield _situation(rule, slab, out), out, after


def _situation(rule: Rule, slab: Slab, out: Outcome) -> Situation:
    """The situation at the end of a solved slab.

    Raises
    ------
    Unbalanced
        If the energy balance cannot be closed.
    """
    model = rule.model
    if out.solution.end.clipped:
        raise Unbalanced("the scalar that closes the energy balance leaves [-1/2, 1/2]")
    return Situation(
        time=slab.end,
        start=_arrived(out),
        acceleration=out.acceleration,
        closed=out.closed,
        pressure=out.pressure,
        traction=None if out.rub is None else out.rub.traction,
        sliding=None if out.rub is None else out.rub.sliding,
        rows=out.rows if rule.inertia is None and model.encounters.paired else None,
    )


def _arrived(out: Outcome) -> Start:
    """What the slab after starts from."""
    model, end = out.system.model, out.solution.end
    memory = past.settled(model.parts, end.displacement)
    return Start(
        displacement=end.displacement,
        velocity=out.velocity,
        force=end.force,
        energy=past.stored(model.parts, memory, end.energy),
        memory=memory,
        viscous=past.remembered_viscous(model.parts, memory),
    )


def split_elements(model: Model) -> Split:
    """The two-node bars beside the contact rows, for the split of Fig. 4.

    Raises
    ------
    InputError
        If the scene is not made of straight two-node bars of LinearElastic in one dimension, touching at their ends.
    """
    where = "contacts[0].timing.split"
    bars = model.shape[1] == 1 and all(set(p.mesh.blocks) == {"bar2"} for p in model.parts)
    if not (bars and model.linear):
        raise InputError(where, "'triangle' is for two-node bars of LinearElastic in 1D", "split = 'product'")
    stiffness = model.tangent(np.zeros(model.shape)).tocsr()
    inner, value = [], []
    for node in model.encounters.node:
        row = stiffness[[node]].tocoo()
        others = row.coords[1] != node
        if others.sum() != 1:
            raise InputError(where, f"node {node} is not the end of a bar", "contact tags at the ends of bars")
        inner.append(int(row.coords[1][others][0]))
        value.append(-float(row.data[others][0]))
    return Split(inner=np.array(inner, int), stiffness=np.array(value))
