"""The equations of one slab: momentum of the nodes with inertia, equilibrium of those without.

    M (q - v0 - J) + h (f_mean + a (f1 - f0) - load) - known impulses = G^T p        nodes with inertia
    h mu2 (f1 - load) = G^T p                                                        nodes without

``f_mean`` is the internal force averaged by the virtual time function or along the chord; ``a`` is the scalar of the
Energy rule (docs/theory/energy.md); ``J`` are the unbalanced jumps of the Paper rule.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.bodies.force import AverageField, DiscreteGradient
from softway.contact.fig4 import Split
from softway.contact.located import LocatedMean
from softway.contact.pairs import Pairs
from softway.contact.path import Path
from softway.model import Model
from softway.solve.normal import Rows
from softway.time.weight import Momentum, TimeWeight, moments, peaks
from softway.typing import Array

ROUNDING = 2e-15


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Start:
    """What is known at t0: displacement, velocity, internal force (n, d) and stored energy (parts,)."""

    displacement: Array
    velocity: Array
    force: Array
    energy: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Evaluation:
    """The equations at one q: residual, end values, mean force (n, d), and the scalar a of each part."""

    residual: Array
    displacement: Array
    force: Array
    energy: Array
    mean_force: Array
    scalar: Array
    clipped: bool


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabSystem:
    """Residual, operator and contact rows of one slab.

    Parameters
    ----------
    model, start, weight, path
        The scene as arrays, the values at t0, the virtual time function and the kinked motion.
    rows
        Conditions on the normal components of q.
    unbalanced
        (n, d) velocity jumps that the momentum equation does not see.
    impulses
        (n, d) known contact impulses [N s].
    balanced
        Whether the scalar a closes the energy balance.
    located
        Exact slab averages of the located Energy rule, in place of the time weight.
    split
        Trapezoid and triangle in place of the product elements beside a touch (Fig. 4).
    pairs
        Curved obstacles, whose rows are linearised again at every iterate; ``rows`` then lacks the target.
    """

    model: Model
    start: Start
    weight: TimeWeight
    path: Path
    rows: Rows
    unbalanced: Array | float = 0.0
    impulses: Array | float = 0.0
    balanced: bool = False
    located: LocatedMean | None = None
    split: Split | None = None
    pairs: Pairs | None = None

    def evaluate(self, q: Array) -> Evaluation:
        """Residual and its ingredients at q (n, d)."""
        model, start, h = self.model, self.start, self.path.span
        u1 = self.path.end(q)
        energy, force = model.energy_and_force(u1)
        mean = self._mean_force(q, u1, force)
        if self.split is not None:
            mean = mean + self.split.difference(self.path, q, self._product_mean(q))
        scalar, clipped = self._scalar(u1, force, energy, mean) if self.balanced else (np.zeros(len(energy)), False)
        mean = mean + self._nodal(scalar) * (force - start.force)
        inertia = model.mass @ (q - start.velocity - self.unbalanced)
        residual = inertia + h * (mean - model.load) - self.impulses
        still = ~model.massive
        residual[still] = h * moments(self.weight)[1] * (force - model.load)[still]
        return Evaluation(
            residual=residual,
            displacement=u1,
            force=force,
            energy=energy,
            mean_force=mean,
            scalar=scalar,
            clipped=clipped,
        )

    def conditions(self, q: Array, u1: Array) -> tuple[sp.csr_array, Rows]:
        """The contact rows (m, f) on the free components and their conditions, linear at the end position ``u1`` of q.

        ``gap(u1) + (h/2) n . (z - q) >= 0`` gives the target of z.
        """
        if self.pairs is None:
            return self.path.rows.matrix(self.model.free), self.rows
        near = self.pairs.at(u1)
        target = near.along(q) - 2.0 * self.pairs.gap(u1) / self.path.span
        return near.matrix(self.model.free), replace(self.rows, target=target)

    def operator(self, u: Array) -> sp.csc_array:
        """M + h^2/2 mu2 K(u) on the free components, symmetric positive definite near equilibrium."""
        model = self.model
        d = model.shape[1]
        keep = np.flatnonzero(model.free.ravel())
        inertia = sp.kron(model.mass, sp.eye_array(d), format="csc")
        stiffness = 0.5 * self.path.span**2 * moments(self.weight)[1] * model.tangent(u)
        return sp.csc_array((inertia + stiffness)[keep][:, keep])

    def _mean_force(self, q: Array, u1: Array, force: Array) -> Array:
        if self.located is not None:
            return self.model.force(self.located.mean(self.start.displacement, u1))
        u0 = self.start.displacement
        out = (
            self._weighted(q, u1, force)
            if any(not _chord(p.average) for p in self.model.parts)
            else np.empty_like(force)
        )
        for part in self.model.parts:
            match part.average:
                case AverageField(points=points):
                    out[part.rows] = part.internal.average_force(u0[part.rows], u1[part.rows], points)
                case DiscreteGradient():
                    out[part.rows] = part.internal.discrete_gradient(u0[part.rows], u1[part.rows])
                case _:
                    pass
        return self._handed_on(out, force) if any(_chord(p.average) for p in self.model.parts) else out

    def _handed_on(self, mean: Array, force: Array) -> Array:
        """The mean force with what it has on massless nodes beyond their end values passed to the nodes they follow.

        Massless nodes are in equilibrium at the two ends of the slab, where only contact pushes them; an average
        along the chord would add a push of its own.
        """
        excess = (mean - 0.5 * (self.start.force + force)) * ~self.model.massive[:, None]
        return np.asarray(mean - excess + self.model.follow.T @ excess)

    def _weighted(self, q: Array, u1: Array, force: Array) -> Array:
        tau, w = peaks(self.weight)
        shift: Array | float = 0.0
        if isinstance(self.weight, Momentum) and (self.path.way.kinked.any() or self.path.jumps):
            shift = self.path.mean(q) - self._sampled_mean(q)
        out = np.zeros_like(force)
        for t, wi in zip(tau, w, strict=True):
            if t == 0.0:
                out += wi * self.start.force
            elif t == 1.0:
                out += wi * force
            else:
                out += wi * self.model.force(self.path.at(t, q) + shift)
        return out

    def _sampled_mean(self, q: Array) -> Array:
        """Displacement (n, d) averaged over the peaks."""
        return sum(
            (wi * self.path.at(float(t), q) for t, wi in zip(*peaks(self.weight), strict=True)), np.zeros_like(q)
        )

    def _product_mean(self, q: Array) -> Array:
        """Mean displacement (n, d) that a linear force of the product form feels."""
        return self.path.mean(q) if isinstance(self.weight, Momentum) else self._sampled_mean(q)

    def _scalar(self, u1: Array, force: Array, energy: Array, mean: Array) -> tuple[Array, bool]:
        """a = [V1 - V0 - mean . du - W] / [(f1 - f0) . du] over each part; du of the nodes with inertia."""
        model, start = self.model, self.start
        du = u1 - start.displacement
        moving = du * model.massive[:, None]
        work = model.totals(mean * moving)
        still = model.totals(model.load * (du - moving))
        num = energy - start.energy - work - still
        den = model.totals((force - start.force) * moving)
        level = np.abs(energy) + np.abs(start.energy) + model.kinetic(start.velocity)
        level += model.totals(np.abs(mean * moving)) + model.totals(np.abs(model.load * du))
        real = np.abs(num) > ROUNDING * level + model.floor
        with np.errstate(divide="ignore", invalid="ignore"):
            a = np.where(real & (den != 0.0), num / den, 0.0)
        return np.clip(a, -0.5, 0.5), bool((np.abs(a) > 0.5).any())

    def _nodal(self, values: Array) -> Array:
        out = np.empty((self.model.shape[0], 1))
        for part, value in zip(self.model.parts, values, strict=True):
            out[part.rows] = value
        return out


def _chord(average: object) -> bool:
    return isinstance(average, AverageField | DiscreteGradient)
