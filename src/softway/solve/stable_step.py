"""Stability limit of a slab (time step), from the greatest frequency of the free system and the time weight."""

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

    Massless components are condensed statically.
    """
    d = model.shape[1]
    free = model.free.ravel()
    heavy = np.flatnonzero(free & np.repeat(model.massive, d))
    light = np.flatnonzero(free & ~np.repeat(model.massive, d))
    mass = sp.csc_array(sp.kron(model.mass, sp.eye_array(d), format="csc")[heavy][:, heavy])
    stiffness = model.tangent(u)
    inner, cross = stiffness[heavy][:, heavy], stiffness[heavy][:, light]
    soft = suited(len(light)).factor(sp.csc_array(stiffness[light][:, light])) if len(light) else None
    if len(heavy) <= DENSE:
        k = inner.toarray() - (cross @ soft.solve(cross.T.toarray()) if soft is not None else 0.0)
        return float(np.sqrt(max(eigh(k, mass.toarray(), eigvals_only=True)[-1], 0.0)))

    def condensed(x: Array) -> Array:
        y: Array = inner @ x
        return y - cross @ soft.solve(cross.T @ x) if soft is not None else y

    inverse, where = mass_solver(model), model.free & model.massive[:, None]

    def accelerated(x: Array) -> Array:
        force = np.zeros(model.shape)
        force[where] = x
        return inverse.acceleration(force)[where]

    operator = LinearOperator(mass.shape, matvec=condensed, dtype=float)
    weak = LinearOperator(mass.shape, matvec=accelerated, dtype=float)
    start = np.random.default_rng(0).standard_normal(len(heavy))
    value = eigsh(operator, k=1, M=mass, Minv=weak, which="LA", v0=start, tol=1e-5, return_eigenvectors=False)
    return float(np.sqrt(max(value[0], 0.0)))


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


def require_stable(model: Model, u: Array, scheme: TimeWeight | Explicit, span: float) -> None:
    """Refuse a slab beyond the stability limit of its time weight or of central differences.

    Raises
    ------
    InputError
        With the limit.
    """
    if not isinstance(scheme, Explicit) and limit(scheme) == 0.0:
        raise InputError("time.weight", f"{scheme} is unstable for every step", "a mean instant of at least 1/2")
    greatest = stable_step(model, u, scheme)
    if span > greatest * (1.0 + 1e-9):
        raise InputError(
            "time.step",
            f"{span:.6g} s is beyond the stability limit {greatest:.6g} s of {type(scheme).__name__}",
            f"a step of at most {greatest:.4g} s, or {_other(scheme)}, which is stable for every step",
        )


def _other(scheme: TimeWeight | Explicit) -> str:
    return "the solver FixedPoint" if isinstance(scheme, Explicit) else "the weight EndPeaks"
