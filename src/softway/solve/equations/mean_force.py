"""Mean internal force of a slab: averages by the virtual time function, along the chord, or with exact instants."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.material_states import end_force
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient
from softway.contact.slab_motion.exact_instants import ExactInstantMean
from softway.contact.slab_motion.trajectory import Trajectory
from softway.contact.slab_motion.trapezoid_triangle import TrapezoidTriangle
from softway.model.model import Model
from softway.model.time_weight import EndPeaks, Momentum, TimeWeight, peaks
from softway.solve.equations.slab_values import SlabStart


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabEnd:
    """Displacement (n, d), energy (parts,) and force (n, d) at the end of a slab, and the part of the force due to the
    mean rate of the slab.
    """

    displacement: Array
    energy: Array
    force: Array
    viscous: Array | None


def end_of_slab(model: Model, u1: Array) -> SlabEnd:
    """Values at the end of a slab at the displacement ``u1`` (n, d); without inertia no part acts on its own."""
    energy, force, viscous = end_force(model.parts, u1)
    return SlabEnd(displacement=u1, energy=energy, force=force, viscous=viscous if model.inert else None)


def passed_on(model: Model, force: Array) -> Array:
    """Force (n, d) [N] of which the part on massless nodes acts on the nodes that they follow."""
    still = force * ~model.massive[:, None]
    return np.asarray(force - still + model.passing @ model.space.filled(still))


class MeanForce(Protocol):
    """Average of the internal force over a slab."""

    def mean(self, model: Model, start: SlabStart, path: Trajectory, q: Array, end: SlabEnd) -> Array:
        """Mean internal force (n, d) at q (n, d) [N]."""
        ...


@dataclass(frozen=True, slots=True)
class WeightedMean:
    """Mean by the virtual time function, or along the chord for bodies with such a slab force."""

    weight: TimeWeight

    def mean(self, model: Model, start: SlabStart, path: Trajectory, q: Array, end: SlabEnd) -> Array:
        """Mean internal force (n, d) [N]."""
        u0, u1, force, chords = (
            start.displacement,
            end.displacement,
            end.force,
            [_chord(p.average) for p in model.parts],
        )
        out = np.empty_like(force) if all(chords) else self._weighted(model, start, path, q, force)
        for part in model.parts:
            average = part.internal.slab_average(part.average, u0[part.nodes], u1[part.nodes])
            if average is not None:
                out[part.nodes] = average
        damped = start.viscous is not None and end.viscous is not None
        if start.viscous is not None and end.viscous is not None:
            out = out + first_weight(self.weight) * (end.viscous - start.viscous)
        return self._balanced(model, start, out, force) if damped or any(chords) else out

    def sampled(self, path: Trajectory, q: Array) -> Array:
        """Displacement (n, d) averaged over the points of the virtual time function."""
        return sum((wi * path.at(float(t), q) for t, wi in zip(*peaks(self.weight), strict=True)), np.zeros_like(q))

    def _weighted(self, model: Model, start: SlabStart, path: Trajectory, q: Array, force: Array) -> Array:
        tau, w = peaks(self.weight)
        shift: Array | float = 0.0
        if isinstance(self.weight, Momentum) and (path.events.kinked.any() or path.jumps):
            shift = path.mean(q) - self.sampled(path, q)
        out = np.zeros_like(force)
        for t, wi in zip(tau, w, strict=True):
            if t == 0.0:
                out += wi * start.force_of_solids
            elif t == 1.0:
                out += wi * force
            else:
                out += wi * model.force(path.at(t, q) + shift)
        return out

    def _balanced(self, model: Model, start: SlabStart, mean: Array, force: Array) -> Array:
        """Mean force whose excess over the end values on massless nodes acts on the nodes that they follow.

        Massless nodes are in equilibrium at the two ends of the slab, where only contact acts on them.  An average
        along the chord would add a force of its own.
        """
        first = first_weight(self.weight)
        ends = first * start.force_of_solids + (1.0 - first) * force
        return ends + passed_on(model, mean - ends)


@dataclass(frozen=True, slots=True, eq=False)
class SplitMean:
    """Weighted mean with the trapezoid and the triangle of Fig. 4 in place of the product elements at a touch."""

    weighted: WeightedMean
    split: TrapezoidTriangle

    def mean(self, model: Model, start: SlabStart, path: Trajectory, q: Array, end: SlabEnd) -> Array:
        """Mean internal force (n, d) [N]."""
        by_weight = isinstance(self.weighted.weight, Momentum)
        product = path.mean(q) if by_weight else self.weighted.sampled(path, q)
        return self.weighted.mean(model, start, path, q, end) + self.split.difference(path, q, product)


@dataclass(frozen=True, slots=True, eq=False)
class ExactMean:
    """Exact mean of a linear force, with the instants of touch and release inside the slab."""

    instants: ExactInstantMean

    def mean(self, model: Model, start: SlabStart, path: Trajectory, q: Array, end: SlabEnd) -> Array:
        """Mean internal force (n, d) [N]."""
        return model.force(self.instants.mean(start.displacement, end.displacement))


def first_weight(weight: TimeWeight) -> float:
    """Weight of the virtual time function at the start of a slab.

    Examples
    --------
    >>> from softway.model.time_weight import EndPeaks
    >>> first_weight(EndPeaks())
    0.5
    """
    if isinstance(weight, EndPeaks):
        return 1.0 - weight.theta
    return sum(float(w) for t, w in zip(*peaks(weight), strict=True) if t == 0.0)


def _chord(average: object) -> bool:
    """True for forces that are averaged along the chord of the slab."""
    return isinstance(average, AverageField | DiscreteGradient)
