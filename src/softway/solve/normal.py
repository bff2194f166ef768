"""Normal contact on the frozen operator: a dual active set on the compliance of the contact rows.

Given the free solution ``y`` of A y = b, find multipliers P such that ``z = y + A^-1 G^T P`` satisfies

    G z = c  on closed rows,     G z >= c,  P >= 0,  P (G z - c) = 0  on unilateral rows.

The closed degrees of freedom are thereby eliminated through their Schur complement, and the factor of A serves
every contact status.
"""

from dataclasses import dataclass

import numpy as np

from softway.errors import NoConvergence
from softway.kernels.dense import shared
from softway.solve.frozen import Frozen
from softway.typing import Array, BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Rows:
    """Conditions of one slab on the contact rows: ``target`` (m,), and which are ``equal`` or ``unilateral`` (m,)."""

    target: Array
    equal: BoolArray
    unilateral: BoolArray


def constrain(
    free: Array, frozen: Frozen, rows: Rows, guess: BoolArray, slack: Array | None = None
) -> tuple[Array, Array, BoolArray]:
    """Solution (f,), multipliers (m,) and active rows (m,) of the contact problem for the free solution.

    ``slack`` (m,) is ``G y - c``; where the rows have turned since their compliance was frozen it is given, and the
    solution is the step of an iteration.

    Primal-dual sweeps from the ``guess``; after 30 of them single exchanges of least index (Murty), which end for
    every symmetric positive definite compliance.
    """
    active = rows.equal | (guess & rows.unilateral)
    slack = frozen.rows @ free - rows.target if slack is None else slack
    floor = 1e-14 * max(np.abs(slack).max(initial=0.0), np.abs(rows.target).max(initial=0.0), 1e-300)
    for sweep in range(30 + 4 * len(active)):
        index = np.flatnonzero(active)
        compliance = frozen.compliance(index)
        columns = compliance.columns
        force = shared(compliance.delassus, -slack[index])
        gap = slack + frozen.rows @ (columns @ force)
        multiplier = np.zeros(len(active))
        multiplier[index] = force
        wrong = rows.unilateral & ((active & (multiplier < 0.0)) | (~active & (gap < -floor)))
        if not wrong.any():
            break
        change = np.flatnonzero(wrong)[:1] if sweep >= 30 else np.flatnonzero(wrong)
        active = active.copy()
        active[change] = ~active[change]
    else:
        raise NoConvergence(f"the {len(active)} contact rows have no solution")
    return free + columns @ force, multiplier, active
