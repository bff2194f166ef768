"""Forces, work and dissipation of friction in one slab (time step) of the Energy rule."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.march.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import moments
from softway.solve.constraints.return_map import NO_SLIP, SlipConditions
from softway.solve.equations.energy_balance import body_groups
from softway.solve.methods.iteration import Solution

AHEAD = 0.5
"""Extrapolation of the change of the mean speed from slab to slab, to the end of the slab."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FrictionResult:
    """Friction over a slab.

    Parameters
    ----------
    traction
        (m, d) tangential forces of the rows at the end [N].
    sliding
        (m,) rows that slip.
    mean
        (m, d) tangential forces over the slab [N].
    push
        (n, d) their nodal forces [N].
    work
        Work of driven tools along their surfaces [J].
    dissipation
        Energy dissipated by friction [J], never negative: groups of touching bodies to which the friction force at the
        start would give energy count as zero.
    """

    traction: Array
    sliding: BoolArray
    mean: Array
    push: Array
    work: float
    dissipation: float

    @classmethod
    def none(cls, rows: ContactRows, shape: tuple[int, int]) -> "FrictionResult":
        """No friction on the rows (m,) of a field of ``shape`` (n, d)."""
        m = len(rows.node)
        traction = np.zeros((m, shape[1]))
        return cls(
            traction=traction,
            sliding=np.zeros(m, bool),
            mean=traction,
            push=np.zeros(shape),
            work=0.0,
            dissipation=0.0,
        )


def slipping(model: Model, now: ModelState, slab: Slab, rows: ContactRows, stick: bool) -> SlipConditions:
    """Slip conditions of a slab with these initial rows; with ``stick``, rows at rest stick at any force."""
    if model.friction.frictionless:
        return NO_SLIP
    h, shear = slab.span, rows.shear
    return SlipConditions(
        friction=model.friction.at(now.start.displacement + 0.5 * h * now.start.velocity),
        shift=np.zeros(shear.tangents.shape[:2]),
        speed_factor=0.5,
        unit=1.0 / (h * moments(slab.weight)[1]),
        ahead=AHEAD if model.inert else 0.0,
        before=np.where(rows.near, np.linalg.norm(shear.slip(h * now.start.velocity), axis=1) / h, 0.0),
        sliding=now.sliding,
        stick_at_any_force=stick,
    )


def first_impulses(now: ModelState, slab: Slab, rows: ContactRows) -> tuple[Array, BoolArray]:
    """Initial multipliers and active rows of a slab, from the forces at its start."""
    unit = slab.span * moments(slab.weight)[1]
    pressed = now.pressure * unit
    if not rows.shear.count:
        return pressed, pressed != 0.0
    active = np.concatenate([pressed != 0.0, now.sliding])
    return np.concatenate([pressed, unit * rows.shear.flat(now.traction).ravel()]), active


def friction_result(
    model: Model, now: ModelState, slab: Slab, solution: Solution, rows: tuple[ContactRows, ContactRows], a: Array
) -> FrictionResult:
    """Friction over a slab with its contact rows at both ends and the scalars a (parts,)."""
    first, last = rows
    if not last.shear.count:
        return FrictionResult.none(last, solution.end.displacement.shape)
    m = len(first.node)
    moved = solution.end.displacement - now.start.displacement
    flat = last.shear.components(solution.last.impulse[m:]) / (slab.span * moments(slab.weight)[1])
    traction = last.shear.vectors(flat)
    share = a[model.part_of[last.node]][:, None]
    old, new = (0.5 - share) * now.traction, (0.5 + share) * traction
    works = old * first.shear.slip(moved), new * last.shear.slip(moved)
    touching = (now.pressure > 0.0) | (solution.last.impulse[:m] > 0.0)
    by_group = np.bincount(body_groups(model, touching)[model.part_of[last.node]], (works[0] + works[1]).sum(axis=1))
    created = float(np.maximum(by_group, 0.0).sum())
    return FrictionResult(
        traction=traction,
        sliding=solution.last.active[m:],
        mean=old + new,
        push=first.shear.spread(old) + last.shear.spread(new),
        work=float(np.sum(old * first.shear.moved) + np.sum(new * last.shear.moved)),
        dissipation=max(created - float(np.sum(works[0]) + np.sum(works[1])), 0.0),
    )
