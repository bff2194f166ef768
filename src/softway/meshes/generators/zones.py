"""Zones of space that give the cells of a mesh their regions."""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.errors import InputError
from softway.meshes.mesh import Mesh
from softway.units import Metre


@dataclass(frozen=True, slots=True, kw_only=True)
class InBox:
    """Box along the axes; a side that is not given is open.

    Parameters
    ----------
    low, high
        Least and greatest coordinates, one for each of the first axes [m].

    Examples
    --------
    >>> InBox(high=(0.5,)).holds(np.array([[0.2, 7.0], [0.8, 7.0]]))
    array([ True, False])
    """

    low: tuple[Metre, ...] = ()
    high: tuple[Metre, ...] = ()

    def holds(self, points: Array) -> BoolArray:
        """True (k,) for the points (k, d) in the box.

        Raises
        ------
        InputError
            If the box has more coordinates than the points, or none.
        """
        d = points.shape[1]
        for name, side in (("low", self.low), ("high", self.high)):
            if len(side) > d:
                raise InputError(name, f"{len(side)} coordinates in {d}D", f"up to {d} coordinates")
        if not self.low and not self.high:
            raise InputError("high", "missing, as is low: the box is all of space", "low, high, or both")
        low, high = np.array(self.low), np.array(self.high)
        above = (points[:, : len(low)] >= low).all(axis=1)
        return np.asarray(above & (points[:, : len(high)] <= high).all(axis=1))


@dataclass(frozen=True, slots=True, kw_only=True)
class InBall:
    """Ball, or disc in the plane.

    Parameters
    ----------
    centre
        Centre (d,) [m].
    radius
        Radius, positive [m].

    Examples
    --------
    >>> InBall(centre=(0.0, 0.0), radius=1.0).holds(np.array([[0.2, 0.7], [0.8, 0.7]]))
    array([ True, False])
    """

    centre: tuple[Metre, ...]
    radius: Metre

    def holds(self, points: Array) -> BoolArray:
        """True (k,) for the points (k, d) in the ball.

        Raises
        ------
        InputError
            If the centre has another number of coordinates than the points.
        """
        d = points.shape[1]
        if len(self.centre) != d:
            raise InputError("centre", f"{len(self.centre)} coordinates in {d}D", f"{d} coordinates")
        return np.asarray(((points - np.array(self.centre)) ** 2).sum(axis=1) <= self.radius**2)


Zone = InBox | InBall


def divided(mesh: Mesh, zones: dict[str, Zone], rest: str) -> Mesh:
    """Mesh whose cells with their centres in a zone form the region of its name; the first of several zones counts.

    These cells leave the other regions of the mesh.  The cells in no region form the region ``rest``; an empty name
    leaves them in none.

    Raises
    ------
    InputError
        For a zone without cells.

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> bar = divided(interval(1.0, cells=4), {"tip": InBox(low=(0.75,))}, "shaft")
    >>> {name: cells.tolist() for name, cells in bar.regions.items()}
    {'tip': [3], 'shaft': [0, 1, 2]}
    """
    centres, found, taken = mesh.centres(), {}, np.zeros(mesh.n_cells, bool)
    for name, zone in zones.items():
        try:
            mine = zone.holds(centres) & ~taken
        except InputError as error:
            raise error.within(f"regions.{name}") from None
        if not mine.any():
            raise InputError(f"regions.{name}", "no cell has its centre in it", "a larger zone, or smaller cells")
        found[name] = np.flatnonzero(mine)
        taken |= mine
    old = {name: cells[~taken[cells]] for name, cells in mesh.regions.items() if name not in found}
    for cells in old.values():
        taken[cells] = True
    left = np.flatnonzero(~taken)
    if rest and len(left):
        found[rest] = np.union1d(found.get(rest, left), left)
    return replace(mesh, regions={**old, **found})
