"""Closures of the energy balance of a slab: corrections of the mean force."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.model.model import Model
from softway.solve.equations.end_forces import EndForces
from softway.solve.equations.energy_balance import EnergyClosure, close_energy, end_force_closure


class Closure(Protocol):
    """Completion of the mean internal force of a slab."""

    def close(self, model: Model, ends: EndForces) -> EnergyClosure:
        """Complete the mean force of a slab from the values at its two ends."""
        ...


@dataclass(frozen=True, slots=True)
class Unclosed:
    """No closure: for rules that need no scalar, and for first iterates."""

    def close(self, model: Model, ends: EndForces) -> EnergyClosure:
        """Return the mean force unchanged."""
        none = np.zeros(len(model.parts))
        return EnergyClosure(mean=ends.mean, scalar=none, missing_work=none, clipped=False)


@dataclass(frozen=True, slots=True)
class EnergyScalar:
    """One scalar for each group of touching bodies, see :func:`softway.solve.equations.energy_balance.close_energy`.

    Parameters
    ----------
    along_motion
        True if a balance that the bounded scalar cannot close is closed along the motion.
    """

    along_motion: bool = False

    def close(self, model: Model, ends: EndForces) -> EnergyClosure:
        """Close the balances of energy and spin."""
        return close_energy(model, ends, self.along_motion)


@dataclass(frozen=True, slots=True)
class EndForcesOnly:
    """The forces at the end act over the whole slab; the dissipated energy is recorded."""

    def close(self, model: Model, ends: EndForces) -> EnergyClosure:
        """Compute the energy that the end forces dissipate."""
        return end_force_closure(model, ends)
