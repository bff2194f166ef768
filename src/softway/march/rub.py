"""What friction does in one slab of the Energy rule: forces and work."""

from dataclasses import dataclass

import numpy as np

from softway.contact.candidates import Candidates
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.driver import Solution
from softway.solve.return_map import Slipping
from softway.time.slab import Slab
from softway.time.weight import moments
from softway.typing import Array, BoolArray

AHEAD = 0.5
"""Part of the change of the mean speed from slab to slab that is still to come at the end of the slab."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rub:
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
        Energy that friction takes [J].
    """

    traction: Array
    sliding: BoolArray
    mean: Array
    push: Array
    work: float
    dissipation: float


def slipping(model: Model, now: Situation, slab: Slab, rows: Candidates, held: bool) -> Slipping | None:
    """The conditions on the slip in a slab that begins with these rows; None where there is no friction."""
    if model.rubbing is None or rows.shear is None or now.sliding is None:
        return None
    h, shear = slab.span, rows.shear
    return Slipping(
        rubbing=model.rubbing.at(now.start.displacement + 0.5 * h * now.start.velocity),
        shift=np.zeros(shear.tangents.shape[:2]),
        pace=0.5,
        unit=1.0 / (h * moments(slab.weight)[1]),
        ahead=AHEAD if model.massive.any() else 0.0,
        before=np.where(rows.near, np.linalg.norm(shear.slip(h * now.start.velocity), axis=1) / h, 0.0),
        sliding=now.sliding,
        held=held,
    )


def first_impulses(now: Situation, slab: Slab, rows: Candidates) -> tuple[Array, BoolArray]:
    """Multipliers of the rows, and which are active, to begin a slab with: the forces at its start."""
    unit = slab.span * moments(slab.weight)[1]
    pressed = now.pressure * unit
    if rows.shear is None or now.traction is None or now.sliding is None:
        return pressed, pressed != 0.0
    active = np.concatenate([pressed != 0.0, now.sliding])
    return np.concatenate([pressed, unit * rows.shear.flat(now.traction).ravel()]), active


def rub(now: Situation, slab: Slab, solution: Solution, rows: tuple[Candidates, Candidates], a: Array) -> Rub | None:
    """Friction over a slab with its contact rows at both ends and the scalars a (m,); None where there is none."""
    first, last = rows
    if first.shear is None or last.shear is None or now.traction is None:
        return None
    m = len(first.node)
    moved = solution.end.displacement - now.start.displacement
    flat = solution.last.impulse[m:].reshape(m, -1) / (slab.span * moments(slab.weight)[1])
    traction = last.shear.vectors(flat)
    old, new = (0.5 - a)[:, None] * now.traction, (0.5 + a)[:, None] * traction
    return Rub(
        traction=traction,
        sliding=solution.last.active[m:],
        mean=old + new,
        push=first.shear.spread(old) + last.shear.spread(new),
        work=float(np.sum(old * first.shear.moved) + np.sum(new * last.shear.moved)),
        dissipation=-float(np.sum(old * first.shear.slip(moved)) + np.sum(new * last.shear.slip(moved))),
    )
