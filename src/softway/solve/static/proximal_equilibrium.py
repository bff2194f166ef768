"""Static equilibrium by proximal steps, where Newton's method finds none."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray
from softway.bodies.dof_map import DofMap
from softway.contact.contact_rows import ContactRows
from softway.errors import NoConvergence, NumericsError
from softway.model.cohesive_ties import CohesiveTies
from softway.model.model import Model
from softway.solve.constraints.normal_active_set import rounded
from softway.solve.effort import Effort
from softway.solve.linear.backends.superlu import SuperLU
from softway.solve.static.static_equilibrium import (
    KEEP_AFTER,
    REMEDY,
    NoInitialSlip,
    StaticState,
    loaded,
    newton_step,
    static_state,
)

STEPS = 600
"""Greatest number of steps."""
LEAST, MOST = 2.0**-16, 2.0**16
"""Least and greatest lift of the diagonal, relative to the sums of absolute entries of the first stiffness."""
BEGIN = 0.02
"""Greatest length of a step, relative to the extent of the scene."""
SHORTER = 0.5
"""Ratio of the greatest lengths of steps after one that turned back."""
EXACT = 1e-13
"""Step, relative to the extent of the scene, that ends the search."""


def proximal_equilibrium(
    model: Model, u: Array, dofs: DofMap, load: Array, time: float = 0.0, glue: tuple[CohesiveTies, ...] = ()
) -> StaticState:
    """Solve ``f(u) = load + G^T lambda`` without friction, by steps of Newton's method whose stiffness has a lifted
    diagonal, about the last iterate.

    The lift bounds the length of a step, and makes the stiffness positive definite, so that steps lead downhill.  The
    bound falls where a step turns back, as where a plastic tangent is nearly singular, and rises again otherwise.  The
    last step has no lift: the equilibrium is that of the forces, and stable.

    Parameters
    ----------
    u
        (n, d) initial guess [m].
    dofs
        Map of the unknowns.
    load
        (n, d) [N].
    glue
        Ties that break, which hold with the damage that they have.

    Raises
    ------
    NumericsError
        If the steps do not end.

    References
    ----------
    Rockafellar (1976), Monotone operators and the proximal point algorithm, SIAM J. Control Optim. 14, 877-898.
    """
    pairs, most = model.contacts.rest(u, time), BEGIN * model.extent(u)
    least = max(EXACT * model.extent(u), rounded(model.space.greatest(model.points)))
    lift, last, sums, before, longest = 0.0, None, None, np.zeros(dofs.size), most
    for count in range(STEPS):
        pairs = pairs.with_kept_facets(u) if count == KEEP_AFTER and pairs.fixed_rows is None else pairs
        rows, (stiffness, pull) = pairs.at(u), loaded(model, u, dofs, load, glue)
        sums = np.asarray(abs(stiffness).sum(axis=0)).ravel() if sums is None else sums
        free = _Step(model=model, rows=rows, u=u, dofs=dofs, load=pull, stiffness=stiffness, last=last)
        lift = 0.25 * lift if lift > LEAST else 0.0
        found = free.lifted(lift * sums)
        while found is None or model.space.greatest(found[0]) > max(longest, least):
            lift = max(2.0 * lift, LEAST)
            if lift > MOST:
                raise NumericsError("no static equilibrium by proximal steps", time, REMEDY)
            found = free.lifted(lift * sums)
        step, force, active = found
        u, last = u + dofs.nodes(step), (force, active)
        if model.space.greatest(step) <= least and lift == 0.0:
            return static_state(u, rows, force, active)
        longest = SHORTER * longest if model.space.dot(step, before) < 0.0 else min(longest / SHORTER, most)
        before = step
    raise NumericsError(f"no static equilibrium by {STEPS} proximal steps", time, REMEDY)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Step:
    """Step of Newton's method to come, from a displacement u (n, d), forces and active rows."""

    model: Model
    rows: ContactRows
    u: Array
    dofs: DofMap
    load: Array
    stiffness: sp.csc_array
    last: tuple[Array, BoolArray] | None

    def lifted(self, lift: Array) -> tuple[Array, Array, BoolArray] | None:
        """Step with a lift (k,) of the diagonal, forces and active rows; None if there is none, or the stiffness with
        the lift is not positive definite.
        """
        stiffness = self.stiffness + sp.csc_array(sp.diags_array(lift)) if lift.any() else self.stiffness
        given = (self.model, self.rows, self.u, self.dofs, self.load, stiffness)
        try:
            if SuperLU().factor(stiffness).indefinite:
                return None
            found = newton_step(*given, self.last, NoInitialSlip(), Effort())
        except NoConvergence:
            return None
        return found if np.isfinite(self.model.space.greatest(found[0])) else None
