"""Exchange of heat between two surfaces that touch, whose meshes need not match."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.elements.section import Section
from softway.bodies.setup.heat_loads import surface_points
from softway.contact.surfaces.facet_geometry import nearest
from softway.errors import InputError, positive
from softway.meshes.mesh import Mesh
from softway.units import WattPerSquareMetreKelvin

TOUCHING = 0.05
"""Greatest distance of two surfaces that touch, relative to the shortest edge of the second body."""
BLOCK = 1 << 18
"""Greatest number of pairs of points and facets that are looked at together."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatContact:
    """Exchange of heat between two surfaces where they touch: the heat flux from the first to the second one is
    ``conductance (first temperature - second temperature)``.

    Parameters
    ----------
    between
        The two surfaces, ``("block.top", "plate.bottom")``; those of the finer mesh first.
    conductance
        Conductance of the contact [W/(m^2 K)], positive; a large one for perfect contact.

    Raises
    ------
    InputError
        If there are not two surfaces of different bodies, or the conductance is not positive.

    Examples
    --------
    >>> HeatContact(between=("block.top", "plate.bottom"), conductance=5000.0).conductance
    5000.0
    """

    between: tuple[str, str]
    conductance: WattPerSquareMetreKelvin

    def __post_init__(self) -> None:
        positive(conductance=self.conductance)
        names = {name.partition(".")[0] for name in self.between}
        if len(self.between) != 2 or len(names) != 2:
            problem = f"{list(self.between)} are not surfaces of two bodies"
            raise InputError("between", problem, 'two surfaces, such as ["block.top", "plate.bottom"]')


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatExchange:
    """Exchange at points of a surface.

    Parameters
    ----------
    jump
        (p, n) temperature of the first surface less that of the second one, from the temperatures of the nodes.
    conductances
        (p,) conductances of the points [W/K].
    ambient
        (p,) temperature of the second surface where it has no nodes, zero elsewhere [K].
    """

    jump: sp.csr_array
    conductances: Array
    ambient: Array | float = 0.0

    def heat(self, temperature: Array) -> Array:
        """Heat (p,) from the first to the second surface at temperatures (n,) of the nodes [W]."""
        return np.asarray(self.conductances * (self.jump @ temperature - self.ambient))

    def matrix(self) -> sp.csr_array:
        """Derivative (n, n) of the heat that flows out of the nodes [W/K]."""
        return sp.csr_array(self.jump.T @ sp.diags_array(self.conductances) @ self.jump)


Placed = tuple[Mesh, Section, int]
"""Mesh of a body, its section, and its first node among those of all bodies."""


def heat_exchange(contact: HeatContact, bodies: Mapping[str, Placed], n: int) -> HeatExchange:
    """Exchange of a contact between bodies, among ``n`` nodes of all bodies.

    The points of the first surface exchange heat with the nearest points of the second one.

    Raises
    ------
    InputError
        For an unknown body or tag, or surfaces that nowhere touch.
    """
    for name in contact.between:
        body = name.partition(".")[0]
        if body not in bodies:
            raise InputError("between", f"there is no body {body!r}", ", ".join(repr(known) for known in bodies))
    (one, section, first), (other, _, second) = (bodies[name.partition(".")[0]] for name in contact.between)
    tags = [name.partition(".")[2] or "surface" for name in contact.between]
    table, areas = surface_points(one, section, tags[0])
    nodes, shapes, distance = _feet(other, tags[1], table @ one.points)
    meets = np.flatnonzero(distance <= TOUCHING * other.edge())
    if not meets.size:
        problem = f"the surfaces are {distance.min():.3g} m apart where they are nearest"
        raise InputError("between", problem, "surfaces that touch")
    table = sp.csr_array(table[meets])
    mine = sp.csr_array((table.data, table.indices + first, table.indptr), shape=(len(meets), n))
    rows = np.repeat(np.arange(len(meets)), nodes.shape[1])
    theirs = sp.csr_array((shapes[meets].ravel(), (rows, nodes[meets].ravel() + second)), shape=(len(meets), n))
    return HeatExchange(jump=sp.csr_array(mine - theirs), conductances=contact.conductance * areas[meets])


def _feet(mesh: Mesh, tag: str, points: Array) -> tuple[IntArray, Array, Array]:
    """Nodes (p, b) and shape functions (p, b) of the nearest points of a surface, and their distances (p,) [m].

    Facets of fewer nodes have the last of them again, with a shape function of zero.
    """
    facets = mesh.facets_on(tag)
    if not facets:
        raise InputError("between", f"tag {tag!r} contains no whole facet of the boundary", "a tag of a side")
    p, width = len(points), max(nodes.shape[1] for nodes in facets.values())
    found, shapes, best = np.zeros((p, width), int), np.zeros((p, width)), np.full(p, np.inf)
    for kind, nodes in facets.items():
        size = max(1, BLOCK // len(nodes))
        for low in range(0, p, size):
            part = np.arange(low, min(low + size, p))
            x = np.repeat(points[part], len(nodes), axis=0)
            corners = np.tile(mesh.points[nodes], (len(part), 1, 1))
            feet = nearest(kind, x, corners, np.ones(len(x)))
            away = np.linalg.norm(feet.offset, axis=1).reshape(len(part), len(nodes))
            facet = away.argmin(axis=1)
            least = away[np.arange(len(part)), facet]
            closer = least < best[part]
            rows, chosen = part[closer], facet[closer]
            values = feet.shapes.reshape(len(part), len(nodes), -1)[closer, chosen]
            found[rows] = nodes[chosen][:, -1:]
            found[rows, : nodes.shape[1]], shapes[rows] = nodes[chosen], 0.0
            shapes[rows, : nodes.shape[1]], best[rows] = values, least[closer]
    return found, shapes, best
