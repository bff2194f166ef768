"""Stability limit of a slab (time step), from the greatest frequency of the free system and the time weight."""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh

from softway.arrays import Array
from softway.errors import InputError
from softway.model.model import Model
from softway.model.time_weight import TimeWeight, limit
from softway.solve.linear.mass_solver import mass_solver
from softway.solve.methods.central_difference import Explicit
from softway.solve.operators.factored import suited

DENSE = 600


def greatest_frequency(model: Model, u: Array) -> float:
    """Greatest angular frequency of the components with inertia at the displacement u (n, d) [rad/s].

    Massless components are condensed statically.  Without components with inertia it is zero.
    """
    all_mass = model.dofs.matrix(sp.csc_array(sp.kron(model.mass, sp.eye_array(model.shape[1]), format="csc")))
    inert = all_mass.diagonal() > 0.0
    heavy, light = np.flatnonzero(inert), np.flatnonzero(~inert)
    if not len(heavy):
        return 0.0
    mass = sp.csc_array(all_mass[heavy][:, heavy])
    stiffness = model.dofs.matrix(model.tangent(u))
    inner, cross = stiffness[heavy][:, heavy], stiffness[heavy][:, light]
    soft = suited(len(light)).factor(sp.csc_array(stiffness[light][:, light])) if len(light) else None
    if len(heavy) <= DENSE:
        k = inner.toarray() - (cross @ soft.solve(cross.T.toarray()) if soft is not None else 0.0)
        return float(np.sqrt(max(eigh(k, mass.toarray(), eigvals_only=True)[-1], 0.0)))

    def condensed(x: Array) -> Array:
        y: Array = inner @ x
        return y - cross @ soft.solve(cross.T @ x) if soft is not None else y

    inverse = _inverse_mass(model, mass)

    operator = LinearOperator(mass.shape, matvec=condensed, dtype=float)
    weak = LinearOperator(mass.shape, matvec=inverse, dtype=float)
    start = np.random.default_rng(0).standard_normal(len(heavy))
    value = eigsh(operator, k=1, M=mass, Minv=weak, which="LA", v0=start, tol=1e-5, return_eigenvectors=False)
    return float(np.sqrt(max(value[0], 0.0)))


def _inverse_mass(model: Model, mass: sp.csc_array) -> Callable[[Array], Array]:
    """Accelerations from forces, both on the unknowns with inertia, for their mass matrix."""
    if model.dofs.components is None:
        return suited(mass.shape[0]).factor(mass).solve
    inverse, heavy = mass_solver(model), model.dofs.only(model.massive)
    return lambda x: heavy.unknowns(inverse.acceleration(heavy.nodes(x)))


def stable_step(model: Model, u: Array, scheme: TimeWeight | Explicit) -> float:
    """Greatest stable slab length of a weight or of central differences [s]; infinite for peaks at the two ends."""
    bound = 2.0 if isinstance(scheme, Explicit) else limit(scheme)
    if np.isinf(bound):
        return np.inf
    if isinstance(scheme, Explicit):
        damping = max((p.shock.viscosity.linear for p in model.parts if p.shock is not None), default=0.0)
        bound *= np.sqrt(1.0 + damping**2) - damping
    omega = greatest_frequency(model, u)
    return bound / omega if omega > 0.0 else np.inf


def require_stable_weight(scheme: TimeWeight | Explicit) -> None:
    """Refuse a time weight that is unstable for every slab length.

    Raises
    ------
    InputError
        With the weight.
    """
    if not isinstance(scheme, Explicit) and limit(scheme) == 0.0:
        raise InputError("time.weight", f"{scheme} is unstable for every step", "a mean instant of at least 1/2")


def require_stable(model: Model, u: Array, scheme: TimeWeight | Explicit, span: float) -> None:
    """Refuse a slab beyond the stability limit of its time weight or of central differences.

    Raises
    ------
    InputError
        With the limit.
    """
    require_stable_weight(scheme)
    greatest = stable_step(model, u, scheme)
    if span > greatest * (1.0 + 1e-9):
        raise InputError(
            "time.step",
            f"{span:.6g} s is beyond the stability limit {greatest:.6g} s of {type(scheme).__name__}",
            f"a step of at most {_below(greatest):.4g} s, or {_other(scheme)}, which is stable for every step",
        )


def _below(value: float) -> float:
    """Value rounded down to four digits.

    Examples
    --------
    >>> _below(0.70716)
    0.7071
    """
    digits = 3 - int(np.floor(np.log10(value)))
    return round(float(np.floor(value * 10.0**digits)) / 10.0**digits, digits)


def _other(scheme: TimeWeight | Explicit) -> str:
    return "the solver FixedPoint" if isinstance(scheme, Explicit) else "the weight EndPeaks"
