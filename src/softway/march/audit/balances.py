"""Energies and momenta of a state, and the contact forces that they ask for, computed again from the fields."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.elements.section import Axisymmetric
from softway.march.audit.ledger import momentum
from softway.march.model_state import join_states
from softway.march.results.step import Step
from softway.model.model import Model
from softway.model.scene import State


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Balances:
    """Energies [J], momentum (3,) and sum of the sizes of the momenta of all nodes [kg m/s], from the fields."""

    kinetic: float
    strain: float
    momentum: Array
    moving: float


def balances(model: Model, state: State) -> Balances:
    """Balances of the bodies of a model: the strain energy is evaluated from the displacements and the memory."""
    now = join_states(model, state).start
    momenta = model.mass @ now.velocity
    return Balances(
        kinetic=0.5 * model.space.dot(now.velocity, momenta),
        strain=float(now.energy.sum()),
        momentum=momentum(model.space, momenta),
        moving=model.space.total(np.abs(momenta)),
    )


@dataclass(frozen=True, slots=True, eq=False)
class Pushed:
    """Resultant (d,) of the contact forces on a body over a slab, and the sum of the sizes of its parts [N]."""

    resultant: Array
    scale: float


def contact_forces(model: Model, step: Step) -> Mapping[str, Pushed]:
    """Mean contact force that each body needs for its change of momentum, besides its loads and supports.

    The radial direction of axisymmetric bodies is left out. Bodies that companion fields push on are not looked at.
    """
    if model.companions or step.report.scalars is None:
        return {}
    slab = model.pushed(step.slab.start, step.slab.end)
    load = slab.slab_load(np.array([step.report.scalars[p.name] for p in model.parts]))
    momenta = [model.mass @ model.join(state.velocity) for state in (step.before, step.after)]
    out = {}
    for part in model.parts:
        before, after = (p[part.nodes] / step.slab.span for p in momenta)
        terms = (after, -before, -load[part.nodes], -step.reactions[part.name])
        keep = np.ones(model.shape[1])
        keep[0] = not isinstance(part.internal.section, Axisymmetric)
        resultant = sum(model.space.sums(term) for term in terms) * keep
        out[part.name] = Pushed(np.asarray(resultant), sum(model.space.total(np.abs(term)) for term in terms))
    return out
