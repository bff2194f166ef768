"""Velocity jumps of nodes with inertia at the instants of touch: literal (Paper) or mass-consistent (Impulse)."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from softway.contact.candidates import Candidates
from softway.contact.path import Passage
from softway.contact.timing import Paper
from softway.kernels.dense import shared
from softway.model import Model
from softway.solve.reaction import Reaction
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Jump:
    """One jump: its ``instant`` tau, the rows that are hit (m,), the velocity change (n, d), the normal impulses (m,)
    and the normal velocities (m,) of the rows that are hit, just before.
    """

    instant: float
    hits: BoolArray
    field: Array
    impulse: Array
    speed: Array


SIMULTANEOUS = 1e-9
"""Fraction of a slab within which touches are one jump."""


def instants(tau: Array) -> list[float]:
    """The distinct finite instants in order; those within ``SIMULTANEOUS`` of the first of them are one.

    Examples
    --------
    >>> instants(np.array([0.5, np.nan, 0.25, 0.5 + 1e-12]))
    [0.25, 0.5]
    """
    found: list[float] = []
    for t in np.unique(tau[np.isfinite(tau)]):
        if not found or t > found[-1] + SIMULTANEOUS:
            found.append(float(t))
    return found


def at(tau: Array, instant: float) -> BoolArray:
    """Rows (m,) whose ``tau`` belongs to the instant."""
    return np.asarray((tau >= instant) & (tau <= instant + SIMULTANEOUS))


def jumps(
    model: Model, rows: Candidates, way: Passage, closed: BoolArray, inertia: Reaction, span: float
) -> tuple[Jump, ...]:
    """The jumps of a slab in order of time; ``closed`` (m,) are the rows closed at its start.

    The Paper rule resets the normal velocity of the node alone; the momentum that leaves is that of its row of the
    mass matrix.  Between two bodies the nodes of the row on both sides share the change, by the sums of their rows.
    The Impulse rule moves every node, so that momentum is balanced.
    """
    speed, found = way.approach - np.where(np.isfinite(way.touch), rows.drive / span, 0.0), []
    for instant in instants(way.touch):
        hits = at(way.touch, instant)
        approach = np.where(hits, speed, 0.0)
        if isinstance(model.timing, Paper):
            field, impulse = _literal(model, rows, approach, hits)
        else:
            gone = way.release <= instant
            stopped = ((closed | (way.touch < instant)) & ~gone) | hits
            field, impulse = inertia.jump(rows, approach, stopped)
            later = np.isfinite(way.touch) & (way.touch > instant) & ~hits
            speed = speed + np.where(later, rows.along(field), 0.0)
        found.append(Jump(instant=instant, hits=hits, field=field, impulse=impulse, speed=approach))
    return tuple(found)


def _literal(model: Model, rows: Candidates, approach: Array, hits: BoolArray) -> tuple[Array, Array]:
    """Velocity change (n, d) that resets the rows that are hit, of their own nodes only, and its impulses (m,)."""
    inertia = np.asarray(model.mass.sum(axis=1)).reshape(-1, 1)
    index = np.flatnonzero(hits & rows.reachable(model.free))
    some = rows.gradient[index]
    if np.unique(some.tocoo().coords[1] // model.shape[1]).size <= np.unique(rows.node[index]).size:
        field = rows.motion(-approach, hits, model.free)
        return field, rows.shares(inertia * field, hits, model.free)
    mobility = np.where(model.free & (inertia > 0.0), 1.0 / np.where(inertia > 0.0, inertia, 1.0), 0.0).ravel()
    impulse = np.zeros(len(hits))
    impulse[index] = shared((some @ sparse.diags_array(mobility) @ some.T).toarray(), -approach[index])
    return mobility.reshape(model.shape) * rows.spread(impulse, model.shape), impulse


def loss(
    model: Model, rows: Candidates, way: Passage, found: tuple[Jump, ...], v0: Array, v1: Array, span: float
) -> float:
    """Kinetic energy lost in the jumps [J]: ``-(v . M J + J . M J / 2)`` with v just before each."""
    total, tool = 0.0, rows.drive / span
    before, smooth = v0, v1 - sum((jump.field for jump in found), v0)
    for jump in found:
        if isinstance(model.timing, Paper):
            v = before + jump.instant * smooth
            before = before + jump.field
            stopped = (way.closed & ~np.isfinite(way.touch)) | (way.touch < jump.instant)
            normal = np.where(jump.hits, jump.speed + tool, np.where(stopped, tool, rows.along(v)))
            v = v + rows.motion(normal - rows.along(v), way.kinked, model.free)
            total += float(jump.impulse @ tool - np.sum((v + 0.5 * jump.field) * (model.mass @ jump.field)))
        else:
            total -= 0.5 * float(jump.impulse @ jump.speed)
    return total
