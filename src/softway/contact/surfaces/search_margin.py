"""Margin of the contact search: how far the motion in a slab may differ from the expected one."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.broad_phase import Sweep, near, sweep

FRACTION = 0.1
"""Margin of the search in a slab, in mean edges of the coarser surface of a contact."""
LEBESGUE = {"bar3": 5.0 / 3.0, "tri6": 5.0 / 3.0, "quad8": 3.0, "quad9": 5.0 / 3.0}
"""Greatest motion of a point of a quadratic facet, relative to that of its nodes; 1 on linear facets."""
SWELLING = {"bar3": 0.5, "tri6": 0.5, "quad8": 1.0, "quad9": 0.5}
"""Distance, relative to its width, by which a quadratic facet and its control points may extend beyond its nodes."""
FEW = 4
"""Number of pairs of surfaces whose facets are compared before the search of a contact."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SearchMargin:
    """Margin of a contact of deformable surfaces.

    Parameters
    ----------
    distance
        Distance within which surfaces are paired in a slab [m].
    sides
        The surfaces.
    meet
        (k, k) symmetric; True for surfaces that may touch each other.
    raised
        Greatest distance of their facets at which they touch, since they are curved [m].

    Examples
    --------
    >>> sides = tuple(ContactSurface(facets={"bar2": np.array([ends])}) for ends in ([0, 1], [3, 2]))
    >>> margin = SearchMargin(distance=0.1, sides=sides, meet=~np.eye(2, dtype=bool))
    >>> round(margin.needed(np.array([0.1, 0.2, 0.4, 0.3])), 12)
    0.6
    >>> x = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.2], [1.0, 0.2]])
    >>> margin.apart(x, x, 0.1), margin.apart(x, x, 0.3), margin.apart(x, x + [0.0, 5.0], 0.1)
    (True, False, True)
    """

    distance: float
    sides: tuple[ContactSurface, ...]
    meet: BoolArray
    raised: float = 0.0

    def needed(self, deviation: Array) -> float:
        """Distance [m] within which the surfaces had to be paired, with a ``deviation`` (n,) of each node from the
        expected motion: the greatest sum for two surfaces that may touch.
        """
        found = np.array([magnified(side) * deviation[side.nodes].max(initial=0.0) for side in self.sides])
        return self.raised + float(np.where(self.meet, found[:, None] + found, 0.0).max(initial=0.0))

    def apart(self, x0: Array, x1: Array, distance: float) -> bool:
        """True if no facets of two surfaces come within a distance [m] on the way from x0 to x1 (n, d).

        False also where this is not known: boxes around whole surfaces are compared, and the facets of a few pairs.
        """
        if self.meet.diagonal().any():
            return False
        whole = _joined([_whole(side, x0, x1) for side in self.sides])
        path = [c[:, None] - c for c in (whole.start, whole.end)]
        wide = whole.half[:, None] + whole.half + 0.5 * np.abs(path[1] - path[0]) + distance
        close = (np.abs(0.5 * (path[0] + path[1])) <= wide).all(axis=2) & self.meet
        pairs = np.argwhere(np.triu(close))
        if len(pairs) > FEW:
            return False
        boxes = {k: sweep(x0, x1, self.sides[k].table, swelling(self.sides[k])) for k in np.unique(pairs).tolist()}
        return not any(len(near(boxes[k], boxes[m], distance)[0]) for k, m in pairs.tolist())


def _whole(side: ContactSurface, x0: Array, x1: Array) -> Sweep:
    """Box around a whole surface."""
    low, high = ([np.asarray(of(x[side.nodes], axis=0)) for x in (x0, x1)] for of in (np.min, np.max))
    half = np.maximum(high[0] - low[0], high[1] - low[1]) * (0.5 + swelling(side))
    return Sweep(start=0.5 * (low[0] + high[0])[None], end=0.5 * (low[1] + high[1])[None], half=half[None])


def _joined(found: list[Sweep]) -> Sweep:
    """Boxes one after another."""
    start, end, half = (np.concatenate([getattr(b, name) for b in found]) for name in ("start", "end", "half"))
    return Sweep(start=start, end=end, half=half)


def swelling(side: ContactSurface) -> float:
    """Distance, relative to its width, by which a surface may extend beyond its nodes."""
    return max((SWELLING.get(kind, 0.0) for kind in side.facets), default=0.0)


def magnified(side: ContactSurface) -> float:
    """Greatest motion of a point of a surface, relative to that of its nodes."""
    return max((LEBESGUE.get(kind, 1.0) for kind in side.facets), default=1.0)
