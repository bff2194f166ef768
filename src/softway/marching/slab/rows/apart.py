"""Surfaces of solids that may touch each other, for compiled slabs in which they stay apart."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.contact.contact_set import ContactSet
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.search_margin import SearchMargin, magnified, swelling
from softway.kernels.slab.apart import Surfaces


@dataclass(frozen=True, slots=True, eq=False)
class _Group:
    """Nodes (z,) of the surface of this number of a contact, with its ``side``: all, or one end of a bar."""

    number: int
    side: ContactSurface
    nodes: IntArray


def may_stay_apart(contacts: ContactSet) -> bool:
    """True if boxes can tell that the search of a slab finds no pairs of deformable surfaces.

    A body that may touch itself is within its own box, unless its surface is the two ends of a bar.
    """
    margins = [m for m in contacts.margins if m is not None]
    return all(_of_bars(m) or not m.meet.diagonal().any() for m in margins)


def surfaces_of(contacts: ContactSet) -> Surfaces | None:
    """Table of the surfaces; None if there are none."""
    groups: list[_Group] = []
    pairs: list[tuple[int, int, float, float]] = []
    for margin in contacts.margins:
        if margin is not None:
            first, found = len(groups), list(_groups(margin))
            meet = np.argwhere(np.triu(_meeting(margin, found)))
            pairs += [(first + a, first + b, margin.distance, margin.raised) for a, b in meet.tolist()]
            groups += found
    return _table(groups, pairs, contacts.points.shape[1]) if groups else None


def _of_bars(margin: SearchMargin) -> bool:
    return all(side.dim == 1 for side in margin.sides)


def _groups(margin: SearchMargin) -> Iterator[_Group]:
    """Surfaces of a contact; of bars every end alone."""
    for k, side in enumerate(margin.sides):
        for nodes in side.nodes[:, None] if _of_bars(margin) else (side.nodes,):
            yield _Group(k, side, nodes)


def _meeting(margin: SearchMargin, groups: list[_Group]) -> BoolArray:
    """True for groups (k, k) that may touch each other."""
    number = [g.number for g in groups]
    return np.asarray(margin.meet[np.ix_(number, number)] & ~np.eye(len(groups), dtype=bool))


def _table(groups: list[_Group], pairs: list[tuple[int, int, float, float]], d: int) -> Surfaces:
    """Table of groups of nodes and their pairs."""
    one, other, distance, raised = (np.array([p[k] for p in pairs]) for k in range(4))
    k = len(groups)
    return Surfaces(
        start=np.cumsum([0, *(len(g.nodes) for g in groups)], dtype=np.int64),
        node=np.concatenate([g.nodes for g in groups]).astype(np.int64),
        swelling=np.array([swelling(g.side) for g in groups]),
        magnified=np.array([magnified(g.side) for g in groups]),
        one=one.astype(np.int64),
        other=other.astype(np.int64),
        distance=distance.astype(float),
        raised=raised.astype(float),
        centre=np.zeros((k, d)),
        shift=np.zeros((k, d)),
        half=np.zeros((k, d)),
        spread=np.zeros(d),
        strayed=np.zeros(k),
    )
