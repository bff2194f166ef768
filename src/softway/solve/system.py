"""The equations of one slab: momentum of the nodes with inertia, equilibrium of those without.

    M (q - v0 - J) + h (f_mean + a (f1 - f0) - load) - known impulses = G^T p        nodes with inertia
    h mu2 (f1 - load) = G^T p                                                        nodes without

``f_mean`` is the internal force averaged by the virtual time function or along the chord; ``a`` is the scalar of the
Energy rule (docs/theory/energy.md); ``J`` are the unbalanced jumps of the Paper rule.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.force import AverageField, DiscreteGradient
from softway.bodies.internal import InternalForce
from softway.bodies.past import viscous_force
from softway.contact.candidates import Candidates
from softway.contact.encounters import Pairs
from softway.contact.fig4 import Split
from softway.contact.located import LocatedMean
from softway.contact.path import Path
from softway.model import Model
from softway.solve.along import Along
from softway.solve.balance import Closure, Ends, closed, late
from softway.solve.frozen import Basis, Frozen, basis
from softway.solve.normal import Rows
from softway.solve.return_map import during
from softway.solve.stiffness import Stiffness
from softway.solve.values import Evaluation, Start
from softway.time.weight import EndPeaks, Momentum, TimeWeight, moments, peaks
from softway.typing import Array, BoolArray, IntArray

STEADY = 15
"""Iterations after which nodes are kept on their faces."""
DEPTH = 1e-12
"""Depth at the end of a slab, relative to the coordinates, that is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabSystem:
    """Residual, operator and contact rows of one slab.

    Parameters
    ----------
    model, start, weight, path
        The scene as arrays, the values at t0, the virtual time function and the kinked motion.
    rows
        Conditions on the contact rows of q, where the rows never change.
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
        Rows that turn or change opponent: they are linearised again at every iterate; ``rows`` then lacks the target.
    searched
        The same with the faces chosen afresh at every iterate.
    given
        (n, d) values of q on supported components.
    carrying
        The rows that carry the forces at t0; by default those of the path.
    pressure, traction, live
        (m,) their normal forces, and (m, d) tangential ones where there is friction [N]; the rows (k,) that have
        conditions where they never change, None where all have.
    fallback
        Whether an energy balance that the scalar cannot close is closed along the motion.
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
    searched: Pairs | None = None
    given: Array | float = 0.0
    carrying: Candidates | None = None
    pressure: Array | None = None
    traction: Array | None = None
    live: IntArray | None = None
    fallback: bool = False

    def evaluate(self, q: Array, impulse: Array) -> Evaluation:
        """Residual and its ingredients at q (n, d), where the contact rows carry the impulses (m,)."""
        model, start, h = self.model, self.start, self.path.span
        u1 = self.path.end(q)
        energy, force = model.energy_and_force(u1)
        mean = self._mean_force(q, u1, force)
        lost: Array = np.zeros(len(energy))
        shock = model.shock_force(0.5 * (start.displacement + u1), u1 - start.displacement, h)
        if shock is not None:
            mean, lost = mean + shock, model.totals(shock * (u1 - start.displacement))
        if self.split is not None:
            mean = mean + self.split.difference(self.path, q, self._product_mean(q))
        near = None if self.pairs is None else self.pairs.at(u1)
        none = np.zeros(len(energy))
        closure = Closure(mean=mean, scalar=none, share=none, clipped=False)
        if self.balanced:
            ends = self._ends(u1, force, energy + lost, mean, near, impulse)
            closure = closed(model, ends, self.fallback) if self.weight == EndPeaks() else late(model, ends)
        residual = model.mass @ (q - start.velocity - self.unbalanced) + h * (closure.mean - model.load) - self.impulses
        still = ~model.massive
        residual[still] = h * moments(self.weight)[1] * (force - model.load)[still]
        return Evaluation(
            residual=residual,
            displacement=u1,
            force=force,
            energy=energy,
            mean_force=closure.mean,
            scalar=closure.scalar,
            share=closure.share,
            clipped=closure.clipped,
            near=near,
            lost=lost + closure.lost,
        )

    def _ends(
        self, u1: Array, force: Array, energy: Array, mean: Array, near: Candidates | None, impulse: Array
    ) -> Ends:
        start, m = self.start, len(self.path.rows.node)
        last = self.path.rows if near is None else near
        carried = impulse / (self.path.span * moments(self.weight)[1])
        return Ends(
            u0=start.displacement,
            u1=u1,
            f0=start.force,
            f1=force,
            V0=start.energy,
            V1=energy,
            mean=mean,
            v0=start.velocity,
            rows0=self.first,
            rows1=last,
            force0=np.zeros(m) if self.pressure is None else self.pressure,
            force1=carried[:m],
            shear0=self.traction,
            shear1=None if last.shear is None else last.shear.vectors(carried[m:].reshape(m, -1)),
        )

    def conditions(self, q: Array, end: Evaluation, frozen: Frozen) -> tuple[Along, Rows]:
        """The contact rows along the contact directions, and their conditions, linear at q.

        ``gap(u1) + (h/2) G (z - q) >= 0`` gives the target of the free components of z.
        """
        near = end.near
        if near is None:
            found = frozen.coefficients(self.path.rows, self.model.free)
            return (found if self.live is None else found.part(self.live)), self.rows
        fixed = np.where(self.model.free, 0.0, q)
        with np.errstate(invalid="ignore"):
            target = near.along(q - fixed) - 2.0 * near.gap(end.displacement) / self.path.span
        open_ = near.reachable(self.model.free)
        rows = Rows(
            target=np.where(open_, target, 0.0),
            equal=self.rows.equal,
            unilateral=open_,
            slipping=during(self.rows.slipping, near.shear, fixed, self.path.span),
            rounding=self.rows.rounding,
        )
        return frozen.coefficients(near, self.model.free), rows

    def steadied(self, u1: Array, active: BoolArray, count: int) -> "SlabSystem":
        """The equations after ``count`` iterations: from ``STEADY`` on nodes are kept on the faces where they are.

        A node that goes to and fro between two faces would keep the iteration from settling.
        """
        return self.held(u1, active) if count == STEADY else self

    def held(self, u1: Array, active: BoolArray) -> "SlabSystem":
        """The equations with nodes kept on the faces where they are at the end position ``u1`` (n, d), and with those
        going that slip: ``active`` are the rows that touch, and below them, with friction, those that slip.
        """
        if self.searched is None or self.pairs is not self.searched:
            return self
        slipping = self.rows.slipping
        going = None if slipping is None else slipping.going(active[len(self.rows.equal) :])
        return replace(self, pairs=self.searched.held(u1), rows=replace(self.rows, slipping=going))

    def sound(self, u1: Array) -> bool:
        """Whether kept faces leave no overlap at the end position ``u1`` (n, d)."""
        if self.pairs is self.searched or self.searched is None:
            return True
        return self.searched.overlap(u1) <= DEPTH * float(np.abs(self.model.points + u1).max())

    def completed(self, u1: Array) -> "SlabSystem":
        """The equations with the faces added that nodes overlap at the end position ``u1`` (n, d), or chosen afresh."""
        assert self.searched is not None and self.pairs is not None
        more = self.searched.held(u1, self.pairs)
        grown = more.at(u1).near.sum() > self.pairs.at(u1).near.sum()
        return replace(self, pairs=more if grown else self.searched.held(u1))

    def directions(self, turning: bool = False) -> Basis:
        """The directions in which contact may push in any slab, in axes that may be ``turning`` with the nodes."""
        model = self.model
        return basis(self.path.rows, model.free, model.encounters.fixed and not turning, model.touchable)

    def filled(self) -> Array:
        """Values (n, d) of q on supported components, zero on the others."""
        return np.where(self.model.free, 0.0, self.given)

    @property
    def first(self) -> Candidates:
        """The rows that carry the forces at t0."""
        return self.path.rows if self.carrying is None else self.carrying

    @property
    def share(self) -> float:
        """What of the stiffness counts beside the mass, ``h^2/2 mu2`` [s^2]."""
        return 0.5 * self.path.span**2 * moments(self.weight)[1]

    @property
    def reach(self) -> float:
        """Length of the slab of the default weight that has the same operator [s]."""
        return self.path.span * float(np.sqrt(2.0 * moments(self.weight)[1]))

    @property
    def stiffness(self) -> Stiffness:
        """``M + h^2/2 mu2 K`` on the free components."""
        return Stiffness(model=self.model, share=self.share, again=_first(self.weight) / moments(self.weight)[1])

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
            if not isinstance(part.internal, InternalForce):
                continue
            match part.average:
                case AverageField(points=points):
                    out[part.rows] = part.internal.average_force(u0[part.rows], u1[part.rows], points)
                case DiscreteGradient():
                    out[part.rows] = part.internal.discrete_gradient(u0[part.rows], u1[part.rows])
                case _:
                    pass
        before = self.start.viscous
        viscous = None if before is None or not self.model.massive.any() else viscous_force(self.model.parts, u1)
        if before is not None and viscous is not None:
            out = out + _first(self.weight) * (viscous - before)
        handed = viscous is not None or any(_chord(p.average) for p in self.model.parts)
        return self._handed_on(out, force) if handed else out

    def _handed_on(self, mean: Array, force: Array) -> Array:
        """The mean force with what it has on massless nodes beyond their end values passed to the nodes they follow.

        Massless nodes are in equilibrium at the two ends of the slab, where only contact pushes them; an average
        along the chord would add a push of its own.
        """
        first = _first(self.weight)
        ends = first * self.start.force + (1.0 - first) * force
        excess = (mean - ends) * ~self.model.massive[:, None]
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


def _first(weight: TimeWeight) -> float:
    """The weight of the slab's start: what the mean rate makes there belongs to the slab before."""
    return sum(float(w) for t, w in zip(*peaks(weight), strict=True) if t == 0.0)


def _chord(average: object) -> bool:
    return isinstance(average, AverageField | DiscreteGradient)
