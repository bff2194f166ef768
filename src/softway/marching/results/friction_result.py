"""Forces, work and dissipation of friction in one slab (time step) of the Energy rule."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.contact.tangential_rows import TangentialRows
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.slab import Slab
from softway.model.time_weight import EndPeaks, moments
from softway.solve.constraints.return_map import NO_SLIP, SlipConditions, turned
from softway.solve.equations.energy_balance import body_groups
from softway.solve.equations.friction_work import row_heats
from softway.solve.methods.iteration import Solution

RESTED = 1e-3
"""Power of the friction of a contact, relative to that in the slab before, below which it has come to rest."""


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
    slip
        (m, d) mean velocity of the slip [m/s]; None without friction.
    """

    traction: Array
    sliding: BoolArray
    mean: Array
    push: Array
    work: float
    dissipation: float
    slip: Array | None = None

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
    ahead = h / (h + now.span) if model.inert else 0.0
    before = _slip_before(now, slab, rows)
    sliding = now.sliding & ~_rested(model, now, slab, rows)
    way = ahead * _directions(before) * (sliding & now.closed)[:, None] if _turns(shear, ahead, slab) else None
    return SlipConditions(
        friction=model.friction.at(now.start.displacement + 0.5 * h * now.start.velocity),
        shift=np.zeros(shear.tangents.shape[:2]),
        speed_factor=0.5,
        unit=1.0 / (h * moments(slab.weight)[1]),
        ahead=ahead,
        before=np.linalg.norm(before, axis=1),
        sliding=sliding,
        stick_at_any_force=stick,
        way=way,
        turning=turned(way, shear),
    )


def _slip_before(now: ModelState, slab: Slab, rows: ContactRows) -> Array:
    """Mean velocity of the slip (m, d) in the previous slab: of rows that were open, that of their nodes."""
    h = slab.span
    passing = np.where(rows.near[:, None], rows.shear.slip(h * now.start.velocity) / h, 0.0)
    return passing if now.slip is None else np.where(now.closed[:, None], now.slip, passing)


def _directions(vectors: Array) -> Array:
    """Unit vectors (m, d) along vectors (m, d); zero along none."""
    size = np.linalg.norm(vectors, axis=1)
    return vectors / np.where(size > 0.0, size, np.inf)[:, None]


def _turns(shear: TangentialRows, ahead: float, slab: Slab) -> bool:
    """True if the direction of slip may turn and its end is extrapolated: not in the slab after a stop."""
    return shear.tangents.shape[1] > 1 and ahead > 0.0 and slab.weight == EndPeaks()


def _rested(model: Model, now: ModelState, slab: Slab, rows: ContactRows) -> BoolArray:
    """Rows (m,) of contacts that have come to rest at the start of the slab: they hold up to the limit at rest.

    It is the slab after one that ended where the power of the friction vanished (``marching/friction/slip_end.py``).
    """
    out = np.zeros(len(rows.node), bool)
    if slab.weight != EndPeaks(theta=1.0):
        return out
    shear, forces = now.force_rows(rows).shear, now.traction * (now.sliding & now.closed)[:, None]
    power, usual = (
        -np.sum(forces * shear.slip(slab.span * v), axis=1)
        for v in (model.follow @ now.start.velocity, now.start.velocity)
    )
    for contact in np.unique(rows.contact[now.sliding]).tolist():
        here = rows.contact == contact
        out[here] = np.sum(power[here]) <= RESTED * np.sum(np.abs(usual[here]))
    return out


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
    groups = body_groups(model, (first, now.pressure > 0.0), (last, solution.last.impulse[:m] > 0.0))
    heats = row_heats(((first, old), (last, new)), moved, groups[model.part_of[last.node]])
    return FrictionResult(
        traction=traction,
        sliding=solution.last.active[m:],
        mean=old + new,
        push=first.shear.spread(old) + last.shear.spread(new),
        work=float(np.sum(old * first.shear.moved) + np.sum(new * last.shear.moved)),
        dissipation=float(heats.sum()),
        slip=last.shear.slip(moved) / slab.span,
    )
