"""Static equilibrium of some components with unilateral contact: how a march starts."""

import numpy as np

from softway.errors import NoConvergence, NumericsError
from softway.model import Model
from softway.solve.frozen import freeze
from softway.solve.linear import SuperLU
from softway.solve.normal import Rows, constrain
from softway.typing import Array, BoolArray

REMEDY = "a smaller load or initial displacement, or more supports"


def equilibrium(model: Model, u: Array, unknown: BoolArray, load: Array, limit: int = 60) -> tuple[Array, Array]:
    """Displacement (n, d) and contact forces (m,) with ``f(u) = load + G^T lambda`` on the unknown components.

    Newton's method with the contact rows as inequalities on the gap; the other components keep their value.

    Parameters
    ----------
    u
        (n, d) first guess.
    unknown
        (n, d) components to find; the stiffness among them must be regular.
    load
        (n, d) [N].

    Raises
    ------
    NumericsError
        If it does not settle.
    """
    pressure = np.zeros(len(model.pairs.node))
    if not unknown.any():
        return u, pressure
    keep = np.flatnonzero(unknown.ravel())
    active = np.zeros(len(model.pairs.node), bool)
    u = u.copy()
    for _ in range(limit):
        rows = model.pairs.at(u)
        matrix = rows.matrix(unknown)
        reachable = np.asarray(abs(matrix).sum(axis=1)).ravel() > 1e-12
        force = model.force(u)
        conditions = Rows(target=-model.pairs.gap(u), equal=active & False, unilateral=reachable)
        try:
            frozen = freeze(model.tangent(u)[keep][:, keep], matrix, SuperLU())
            free = -frozen.solve((force - load)[unknown])
            step, pressure, active = constrain(free, frozen, conditions, active)
        except NoConvergence as failure:
            raise NumericsError(f"no static equilibrium at the start: {failure}", 0.0, REMEDY) from None
        u[unknown] += step
        change = float(np.abs(step).max())
        if not np.isfinite(change):
            break
        if change <= 1e-13 * max(float(np.abs(u).max()), float(np.abs(rows.offset).max(initial=0.0))) or (
            model.linear and model.pairs.flat
        ):
            return u, pressure
    raise NumericsError("no static equilibrium at the start", 0.0, REMEDY)
