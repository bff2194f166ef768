"""Friction laws of all contact rows, in terms of forces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import Section
from softway.bodies.setup.loads import facet_measures, facets_measure
from softway.contact.contact import Contact
from softway.laws.friction_law import FrictionLaw

POINT = 1e-9
"""Area of a row without own surface, relative to the greatest area: a corner next to a mortar surface."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DeclaredSurface:
    """Declared surface of a solid: its ``nodes`` in the model, their ``points`` (n, d), section and facets."""

    nodes: slice
    points: Array
    section: Section
    facets: Mapping[str, IntArray]


def nodal_areas(surfaces: Sequence[DeclaredSurface], u: Array) -> Array:
    """Surface area (n,) of each node of the model at the displacement u (n, d) [m^2]."""
    out = np.zeros(len(u))
    for it in surfaces:
        out[it.nodes] += facets_measure(it.points + u[it.nodes], it.section, it.facets)
    return out


def row_areas(surfaces: Sequence[DeclaredSurface], u: Array) -> Array:
    """Surface area (n,) of the contact rows of each node at the displacement u (n, d) [m^2], nowhere negative.

    A corner of an eight-node facet has a negative area as a node; as a row it takes a quarter of the area of both
    mid-nodes beside it (docs/theory/contact/mortar.md).
    """
    out = nodal_areas(surfaces, u)
    for it in surfaces:
        cells = it.facets.get("quad8", np.zeros((0, 8), dtype=np.int64))
        given = 0.25 * facet_measures((it.points + u[it.nodes])[cells], it.section, "quad8")[:, 4:]
        own = out[it.nodes]
        for ends in (cells[:, :4], np.roll(cells[:, :4], -1, axis=1)):
            np.add.at(own, ends, given)
            np.add.at(own, cells[:, 4:], -given)
    return out


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AreaPatch:
    """Numbers of the ``rows`` (r,) that have a surface area, their ``node`` (r,), and the surfaces of their contact."""

    rows: IntArray
    node: IntArray
    surfaces: tuple[DeclaredSurface, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FrictionRows:
    """Friction of contact rows (m,): a law for each contact, and the area that converts forces to tractions.

    Parameters
    ----------
    laws
        Law of each contact.
    contact
        (m,) number of the contact of each row.
    area
        (m,) positive areas [m^2].
    patches
        Surfaces from which the areas are computed.

    Examples
    --------
    >>> from softway.laws.friction import Coulomb
    >>> rows = FrictionRows(laws=(Coulomb(mu=0.3),), contact=np.zeros(1, int), area=np.full(1, 0.1))
    >>> rows.limit(np.array([2.0])).round(12).tolist()
    [0.6]
    """

    laws: Sequence[FrictionLaw]
    contact: IntArray
    area: Array
    patches: tuple[AreaPatch, ...] = ()

    @property
    def frictionless(self) -> bool:
        """True if no contact has friction."""
        return all(law.frictionless for law in self.laws)

    @property
    def pointed(self) -> BoolArray:
        """Rows (m,) without a surface of their own."""
        return np.asarray(self.area <= POINT * float(self.area.max(initial=0.0)))

    def at(self, u: Array) -> "FrictionRows":
        """Friction with the areas of the rows at the displacement u (n, d) [m]."""
        area = np.zeros(len(self.contact))
        for patch in self.patches:
            area[patch.rows] = row_areas(patch.surfaces, u)[patch.node]
        return replace(self, area=np.maximum(area, POINT * float(area.max(initial=0.0))) if area.any() else area + 1.0)

    def subset(self, which: IntArray) -> "FrictionRows":
        """Subset of the rows."""
        return FrictionRows(laws=self.laws, contact=self.contact[which], area=self.area[which])

    def limit(self, force: Array) -> Array:
        """Greatest tangential force (m,) of sticking rows under normal forces (m,) [N]."""
        out = np.zeros(len(self.contact))
        for k, law in enumerate(self.laws):
            here = np.flatnonzero(self.contact == k)
            if len(here) and not law.frictionless:
                out[here] = self.area[here] * law.limit(force[here] / self.area[here])
        return out

    def resistance(self, speed: Array, force: Array) -> tuple[Array, Array, Array]:
        """Tangential force (m,) of slip [N], with its derivatives with respect to speed and normal force."""
        value, slope, pressure_slope = np.zeros((3, len(self.contact)))
        for k, law in enumerate(self.laws):
            here = np.flatnonzero(self.contact == k)
            if len(here) and not law.frictionless:
                area = self.area[here]
                t, to_speed, to_pressure = law.resistance(speed[here], force[here] / area)
                value[here], slope[here], pressure_slope[here] = area * t, area * to_speed, to_pressure
        return value, slope, pressure_slope


def surfaces_of(contact: Contact, parts: Sequence[DiscreteSolid]) -> tuple[DeclaredSurface, ...]:
    """Declared surfaces of a contact."""
    return tuple(
        DeclaredSurface(
            nodes=part.nodes, points=part.mesh.points, section=part.internal.section, facets=part.mesh.facets_on(tag)
        )
        for name, tag in contact.surfaces
        for part in parts
        if part.name == name
    )
