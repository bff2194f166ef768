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

STEPS = 300
"""Greatest number of steps."""
WINDOW = 30
"""Number of steps with one lift over which their lengths are compared: those that would not end within ``STEPS`` are
given up."""
LEAST, MOST = 2.0**-16, 2.0**16
"""Least and greatest lift of the diagonal, relative to the sums of absolute entries of the first stiffness."""
BEGIN = 0.02
"""Greatest length of a step, relative to the extent of the scene."""
SHORTER = 0.5
"""Ratio of the greatest lengths of steps after one that turned back."""
DEPTHS = 2.0
"""Length of a step that is allowed in any case, in depths of the rows that overlap."""
EXACT = 1e-13
"""Step, relative to the extent of the scene, that ends the search."""
QUIET = 3
"""Number of such steps with a lift: contacts hold what the stiffness alone does not."""


def proximal_equilibrium(
    model: Model, u: Array, dofs: DofMap, load: Array, time: float = 0.0, glue: tuple[CohesiveTies, ...] = ()
) -> StaticState:
    """Solve ``f(u) = load + G^T lambda`` without friction, by steps of Newton's method whose stiffness has a lifted
    diagonal, about the last iterate.

    The lift bounds the length of a step, and makes the stiffness positive definite, so that steps lead downhill.  The
    bound falls where a step turns back, as where a plastic tangent is nearly singular, and rises again otherwise.  A
    step may always part surfaces that overlap, and none turns a cell inside out.  The last steps are rounding: the
    equilibrium is that of the forces, and stable with its contacts.

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
    at = _At.of(model, u, dofs, load, glue)
    sums = np.asarray(abs(at.stiffness).sum(axis=0)).ravel()
    lift, last, before, longest, quiet, steps = 0.0, None, np.zeros(dofs.size), most, 0, list[tuple[float, float]]()
    for count in range(STEPS):
        pairs = pairs.with_kept_facets(at.u) if count == KEEP_AFTER and pairs.fixed_rows is None else pairs
        free = _Step(model=model, rows=pairs.at(at.u), at=at, dofs=dofs, last=last)
        lift = 0.25 * lift if lift > LEAST else 0.0
        allowed = max(longest, least, DEPTHS * free.depth)
        while (found := free.lifted(lift * sums, allowed)) is None:
            lift = max(2.0 * lift, LEAST)
            if lift > MOST:
                raise NumericsError("no static equilibrium by proximal steps", time, REMEDY)
        (step, force, active), at = found
        last = force, active
        steps.append((model.space.greatest(step), lift))
        quiet = quiet + 1 if steps[-1][0] <= least else 0
        if quiet >= (QUIET if lift > 0.0 else 1):
            return static_state(at.u, free.rows, force, active)
        if not quiet and _endless(steps, least):
            raise NumericsError(f"no static equilibrium by {count + 1} proximal steps", time, REMEDY)
        longest = SHORTER * longest if model.space.dot(step, before) < 0.0 else min(longest / SHORTER, most)
        before = step
    raise NumericsError(f"no static equilibrium by {STEPS} proximal steps", time, REMEDY)


def _endless(steps: list[tuple[float, float]], least: float) -> bool:
    """True if steps that go on to shrink as they did last do not reach the ``least`` length [m] within ``STEPS``.

    ``steps`` are lengths [m] and lifts; where the lift has changed the rate will change as well.

    Examples
    --------
    >>> _endless([(0.5**n, 0.0) for n in range(60)], 1e-25), _endless([(0.97**n, 0.0) for n in range(60)], 1e-25)
    (False, True)
    """
    last = steps[-WINDOW:]
    if len(steps) < 2 * WINDOW or len({lift for _, lift in last}) > 1:
        return False
    rate = np.log(last[-1][0] / last[0][0]) / (WINDOW - 1)
    return bool(np.log(last[-1][0] / least) > (STEPS - len(steps)) * abs(rate))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _At:
    """Stiffness (k, k) on the unknowns at a displacement u (n, d), and load (n, d) without what ``glue`` holds there,
    of the ``given`` load (n, d).
    """

    u: Array
    stiffness: sp.csc_array
    load: Array
    given: Array
    glue: tuple[CohesiveTies, ...]

    @classmethod
    def of(cls, model: Model, u: Array, dofs: DofMap, given: Array, glue: tuple[CohesiveTies, ...]) -> "_At":
        """These at a displacement."""
        stiffness, load = loaded(model, u, dofs, given, glue)
        return cls(u=u, stiffness=stiffness, load=load, given=given, glue=glue)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Step:
    """Step of Newton's method to come, from forces and active rows."""

    model: Model
    rows: ContactRows
    at: _At
    dofs: DofMap
    last: tuple[Array, BoolArray] | None

    @property
    def depth(self) -> float:
        """Greatest depth by which surfaces overlap where unknowns can part them [m]."""
        gap = self.rows.gap(self.at.u)[self.rows.reachable(self.dofs)]
        return float(np.maximum(-gap, 0.0).max(initial=0.0))

    def lifted(self, lift: Array, longest: float) -> tuple[tuple[Array, Array, BoolArray], _At] | None:
        """Step with a lift (k,) of the diagonal, forces and active rows, and where it leads.

        None if there is none, if the stiffness with the lift is not positive definite, and if the step is longer than
        ``longest`` [m] or turns a cell inside out.
        """
        at = self.at
        stiffness = at.stiffness + sp.csc_array(sp.diags_array(lift)) if lift.any() else at.stiffness
        given = (self.model, self.rows, at.u, self.dofs, at.load, stiffness)
        try:
            if SuperLU().factor(stiffness).indefinite:
                return None
            found = newton_step(*given, self.last, NoInitialSlip(), Effort())
        except NoConvergence:
            return None
        if not self.model.space.greatest(found[0]) <= longest:
            return None
        there = _At.of(self.model, at.u + self.dofs.nodes(found[0]), self.dofs, at.given, at.glue)
        return (found, there) if np.isfinite(there.stiffness.data).all() else None
