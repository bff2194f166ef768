"""The laws of friction of all contact rows, in forces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.loads import facets_measure
from softway.bodies.section import Section
from softway.laws.friction_law import FrictionLaw
from softway.typing import Array, IntArray

POINT = 1e-9
"""Area of a row without a surface of its own, as a share of the greatest one: a corner beside a mortar surface."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Surface:
    """A declared surface of a solid: its ``nodes`` in the model, their ``points`` (n, d), its section and facets."""

    nodes: slice
    points: Array
    section: Section
    facets: Mapping[str, IntArray]


def around(surfaces: Sequence[Surface], u: Array) -> Array:
    """Area (n,) of surfaces around each node of the model at its displacement u (n, d) [m^2]."""
    out = np.zeros(len(u))
    for it in surfaces:
        out[it.nodes] += facets_measure(it.points + u[it.nodes], it.section, it.facets)
    return out


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Patch:
    """Numbers of ``rows`` (r,) with a surface around them: their ``node`` (r,), and the surfaces of their contact."""

    rows: IntArray
    node: IntArray
    surfaces: tuple[Surface, ...]


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
    patches
        What the area is measured on.

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
    patches: tuple[Patch, ...] = ()

    def at(self, u: Array) -> "Rubbing":
        """The same with the areas that the rows have at the displacement u (n, d) [m]."""
        area = np.zeros(len(self.contact))
        for patch in self.patches:
            area[patch.rows] = around(patch.surfaces, u)[patch.node]
        return replace(self, area=np.maximum(area, POINT * float(area.max(initial=0.0))) if area.any() else area + 1.0)

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
