"""Energies and momentum of a state, computed again from its fields."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.march.audit.ledger import momentum
from softway.march.model_state import join_states
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
