"""Surfaces of solids that may touch each other, for compiled slabs in which they stay apart."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import BoolArray, IntArray
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import ContactSet
from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.search_margin import SearchMargin, magnified, swelling
from softway.kernels.slab.apart import Surfaces
from softway.marching.slab.rows.driven import tool_rows
from softway.marching.state.model_state import ModelState
from softway.model.model import Model


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MetSurfaces:
    """Contact ``rows`` of slabs, with the pairs of the ``table`` that are near in them; without a table none may be."""

    rows: ContactRows
    table: Surfaces | None


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


def met_surfaces(model: Model, table: Surfaces | None, now: ModelState, span: float) -> MetSurfaces | None:
    """Rows of the slabs from a state on; None if they change with the motion.

    Ends of bars that are near each other have a row that never changes.  Its offset is computed from the reference
    positions, so that it does not depend on the state.
    """
    contacts, rows = model.contacts, tool_rows(model.contacts)
    if table is None or model.shape[1] > 1:
        return MetSurfaces(rows=rows, table=table)
    near = _near(model, table, now)
    if not near.any():
        return MetSurfaces(rows=rows, table=table)
    u0 = now.start.displacement
    rate = now.start.velocity + span * now.acceleration
    coasting = u0 + span * np.where(model.massive[:, None], 0.5 * (now.start.velocity + rate), rate)
    pairs = contacts.meet(u0, coasting, now.time, now.time + span, contacts.closest)
    found = pairs.start(u0)
    fresh = found.near & ~rows.near
    if pairs.found != found.near.sum() or not _among(found, fresh, table, near):
        return None
    offset = np.where(fresh, found.gradient @ model.points.ravel(), rows.offset)
    return MetSurfaces(rows=replace(found, offset=offset), table=_with_near(table, near, contacts.reach))


def _near(model: Model, table: Surfaces, now: ModelState) -> BoolArray:
    """True for pairs (p,) of ends of bars that are within the distance of the search at the start."""
    x = (model.points + now.start.displacement)[table.node, 0]
    return np.asarray(np.abs(x[table.one] - x[table.other]) < table.distance)


def _among(rows: ContactRows, fresh: BoolArray, table: Surfaces, near: BoolArray) -> bool:
    """True if each of the ``fresh`` (m,) rows is of two ends of bars that are ``near`` (p,)."""
    some = rows.gradient[np.flatnonzero(fresh)]
    if (np.diff(some.indptr) != 2).any():
        return False
    met = {frozenset(ends) for ends in table.node[np.stack([table.one, table.other], axis=1)[near]].tolist()}
    return {frozenset(ends) for ends in some.indices.reshape(-1, 2).tolist()} == met


def _with_near(table: Surfaces, near: BoolArray, reach: float) -> Surfaces:
    """Table with pairs that are near; ends that have a row are searched for within the whole ``reach`` [m]."""
    ends = np.unique(table.node[np.concatenate([table.one[near], table.other[near]])])
    searched = (np.isin(table.node[table.one], ends) | np.isin(table.node[table.other], ends)) & ~near
    return table._replace(near=near, distance=np.where(searched, np.maximum(table.distance, reach), table.distance))


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
        near=np.zeros(len(pairs), bool),
        centre=np.zeros((k, d)),
        shift=np.zeros((k, d)),
        half=np.zeros((k, d)),
        spread=np.zeros(d),
        strayed=np.zeros(k),
    )
