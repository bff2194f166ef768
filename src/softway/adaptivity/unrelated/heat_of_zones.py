"""Heat of a body of several materials on a mesh that replaces another one: each material keeps its content, their
common nodes have one temperature, and the entropy never falls (docs/theory/bodies/remeshing.md#several-materials).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.unrelated.heat import HALVINGS, ROUNDING, HeatTransfer, Sampled, heat_transfer, sampled
from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.elements.section import Section

ROUNDS = 8
"""Greatest number of exchanges between neighbours within the materials, for the entropy."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ZoneTransfer:
    """Transfer within one material: its k of the n old nodes and l of the m new nodes, and the capacities (k,) there.

    Parameters
    ----------
    old, new
        Numbers (k,) and (l,) of its nodes.
    before
        (k,) capacities of the old nodes.
    own
        (l,) new nodes that belong to no other material.
    transfer
        Transfer between these nodes.
    """

    old: IntArray
    new: IntArray
    before: Array
    own: BoolArray
    transfer: HeatTransfer


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatOfZones:
    """:class:`~softway.adaptivity.unrelated.heat.HeatTransfer` of a body of several materials.

    Parameters
    ----------
    zones
        Transfers within the materials.
    capacity
        (m,) capacities of the new nodes.
    near
        (m, n) linear functions of the old nodes at the new ones, of the materials of each.
    """

    zones: tuple[ZoneTransfer, ...]
    capacity: Array
    near: sp.csr_array

    def carried(self, values: Array, least: float, entropy: Callable[[Array], Array]) -> Array:
        """Values (m,) on the new mesh of a quantity per capacity from those (n,) on the old one.

        Each material passes on what it has; a common node takes the mean by capacity, and what this gives to one
        material and takes from another one goes back to nodes of their own, as far as no node leaves the range of those
        from which it has something, and the entropy is not below ``least``.

        Parameters
        ----------
        values, least, entropy
            As for a body of one material.
        """

        def falls(found: Array) -> bool:
            terms = self.capacity * entropy(found)
            return bool(terms.sum() < least - ROUNDING * np.abs(terms).sum())

        own = [values[zone.old] for zone in self.zones]
        floors = [float(zone.before @ entropy(v)) for zone, v in zip(self.zones, own, strict=True)]
        parts = [z.transfer.carried(v, s, entropy) for z, v, s in zip(self.zones, own, floors, strict=True)]
        found = self._settled(parts, own)
        if falls(found):
            parts = [zone.transfer.plan.means(v) for zone, v in zip(self.zones, own, strict=True)]
            found = self._settled(parts, own)
        for _ in range(ROUNDS):
            if not falls(found):
                return found
            parts = [zone.transfer.mixed(part) for zone, part in zip(self.zones, parts, strict=True)]
            found = self._settled(parts, own)
        return _last_before(falls, self._joined(parts), found)

    def mixed(self, values: Array) -> Array:
        """Values (m,) on the new mesh after an exchange between neighbours, which has the same content and no less
        entropy.
        """
        return self._joined([zone.transfer.mixed(values[zone.new]) for zone in self.zones])

    def _joined(self, parts: Sequence[Array]) -> Array:
        """Values (m,) of all nodes from those (l,) of each material: means by capacity."""
        total = np.zeros_like(self.capacity)
        for zone, part in zip(self.zones, parts, strict=True):
            total[zone.new] += zone.transfer.capacity * part
        return np.asarray(total / self.capacity)

    def _settled(self, parts: Sequence[Array], values: Sequence[Array]) -> Array:
        """Values (m,) of all nodes with the content of each material, from values (l,) with this content."""
        found = self._joined(parts)
        for zone, part, old in zip(self.zones, parts, values, strict=True):
            missing = float(zone.transfer.capacity @ (part - found[zone.new]))
            found[zone.new] += _shares(zone, part, old, missing)
        return found


def _shares(zone: ZoneTransfer, part: Array, values: Array, missing: float) -> Array:
    """Changes (l,) of the own nodes of a material that add up to a content: of those beside common nodes if they have
    room for it, otherwise of all, in proportion to their room.
    """
    around = zone.transfer.room(values, part)[0 if missing > 0.0 else 1]
    beside = np.asarray(zone.transfer.links @ np.where(zone.own, 0.0, 1.0)) / zone.transfer.capacity
    for weight in (beside / max(float(beside.max()), np.finfo(float).tiny), np.ones_like(beside)):
        room = np.where(zone.own, weight * around, 0.0)
        share = abs(missing) / max(float(room.sum()), np.finfo(float).tiny)
        if share <= 1.0:
            break
    return np.asarray(np.sign(missing) * min(share, 1.0) * room / zone.transfer.capacity)


def _last_before(falls: Callable[[Array], bool], safe: Array, wanted: Array) -> Array:
    """The values nearest to those wanted, on the way from safe ones, at which nothing falls."""
    low, high = 0.0, 1.0
    for _ in range(HALVINGS if falls(wanted) else 0):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(safe + middle * (wanted - safe)) else (middle, high)
    return wanted if not falls(wanted) else safe + low * (wanted - safe)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatedZones:
    """Mesh of n nodes with the cells of each of its materials, and the capacities (n,) of the nodes in each."""

    blocks: tuple[Mapping[str, IntArray], ...]
    places: Array
    capacities: tuple[Array, ...]


def heat_of_zones(old: HeatedZones, new: HeatedZones, section: Section) -> HeatOfZones:
    """Transfer between two meshes of the same materials, each with the same capacity on both.

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> places = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]])
    >>> blocks = tuple({"quad4": np.array([cell])} for cell in ([0, 1, 4, 3], [1, 2, 5, 4]))
    >>> capacities = np.array([1.0, 1.0, 0.0, 1.0, 1.0, 0.0]), np.array([0.0, 3.0, 3.0, 0.0, 3.0, 3.0])
    >>> mesh = HeatedZones(blocks=blocks, places=places, capacities=capacities)
    >>> values = np.array([1.0, 2.0, 3.0, 1.0, 2.0, 3.0])
    >>> found = heat_of_zones(mesh, mesh, PlaneStrain())
    >>> found.carried(values, float(found.capacity @ np.log(values)), np.log).round(9).tolist()
    [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]
    """
    counts = np.sum([capacity > 0.0 for capacity in new.capacities], axis=0)
    zones = []
    for number in range(len(old.blocks)):
        sides = [_of_zone(mesh, number, section) for mesh in (old, new)]
        (nodes, one, before), (others, other, after) = sides
        transfer = heat_transfer(one, other, before, after)
        zones.append(ZoneTransfer(old=nodes, new=others, before=before, own=counts[others] == 1, transfer=transfer))
    total, size = np.sum(new.capacities, axis=0), (len(new.places), len(old.places))
    near = sp.csr_array(size)
    for zone in zones:
        local = sp.coo_array(zone.transfer.near)
        share = (zone.transfer.capacity / total[zone.new])[local.coords[0]]
        where = zone.new[local.coords[0]], zone.old[local.coords[1]]
        near = near + sp.csr_array((share * local.data, where), shape=size)
    return HeatOfZones(zones=tuple(zones), capacity=total, near=sp.csr_array(near))


def _of_zone(mesh: HeatedZones, number: int, section: Section) -> tuple[IntArray, Sampled, Array]:
    """Nodes (k,) of a material, its points, and the capacities (k,) of these nodes."""
    blocks = mesh.blocks[number]
    nodes = np.unique(np.concatenate([cells.ravel() for cells in blocks.values()]))
    local = {name: np.searchsorted(nodes, cells) for name, cells in blocks.items()}
    return nodes, sampled(local, mesh.places[nodes], section), mesh.capacities[number][nodes]
