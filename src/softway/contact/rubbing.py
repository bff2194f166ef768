"""The laws of friction of all contact rows, in forces."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.laws.friction_law import FrictionLaw
from softway.typing import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rubbing:
    """Friction of contact rows (m,): a law for each contact, and the area that turns forces into tractions.

    Parameters
    ----------
    laws
        Law of each contact.
    contact
        (m,) number of the contact of each row.
    area
        (m,) positive [m^2].

    Examples
    --------
    >>> from softway.laws.friction import Coulomb
    >>> rows = Rubbing(laws=(Coulomb(mu=0.3),), contact=np.zeros(1, int), area=np.full(1, 0.1))
    >>> rows.limit(np.array([2.0])).round(12).tolist()
    [0.6]
    """

    laws: Sequence[FrictionLaw]
    contact: IntArray
    area: Array

    def part(self, which: IntArray) -> "Rubbing":
        """Some of the rows."""
        return Rubbing(laws=self.laws, contact=self.contact[which], area=self.area[which])

    def limit(self, force: Array) -> Array:
        """Greatest tangential force (m,) held at rest under normal forces (m,) [N]."""
        out = np.zeros(len(self.contact))
        for k, law in enumerate(self.laws):
            here = np.flatnonzero(self.contact == k)
            if len(here) and not law.frictionless:
                out[here] = self.area[here] * law.limit(force[here] / self.area[here])
        return out

    def resistance(self, speed: Array, force: Array) -> tuple[Array, Array, Array]:
        """Tangential force (m,) of slip [N], with its derivatives to the speed and to the normal force."""
        value, slope, share = np.zeros((3, len(self.contact)))
        for k, law in enumerate(self.laws):
            here = np.flatnonzero(self.contact == k)
            if len(here) and not law.frictionless:
                area = self.area[here]
                t, to_speed, to_pressure = law.resistance(speed[here], force[here] / area)
                value[here], slope[here], share[here] = area * t, area * to_speed, to_pressure
        return value, slope, share
