"""Potentials of the strain of a node, and the heat that it takes (docs/theory/heat/coupling.md).

    psi = sum_X phi_X(theta, s) X(u),   phi_H = -m e(theta, s),   phi_G = m

with the free strain e of temperature and liquid share, the energy H that a free strain of one takes, the elastic energy
G at the moduli of the law, and the factor m of the moduli.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, IntArray
from softway.heat.coupled.strain.free_strain import FreeStrain
from softway.heat.heat_balance import HeatOfStrain, arithmetic_mean, logarithmic_mean
from softway.heat.operators import HeatValues
from softway.laws.heat.stiffness_table import StiffnessCurve

STEADY = 1e-6
"""Change of a temperature, relative to it, below which the curvature of the moduli has no effect on the mean."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Moduli:
    """Factor m of the moduli, and the potentials, at k nodes.

    Parameters
    ----------
    free
        Free strain of the nodes.
    curves
        Numbers of nodes with a factor that depends on the temperature, and the factor; it is one on all others.

    Examples
    --------
    >>> from softway.laws.heat.stiffness_table import StiffnessTable
    >>> curve = StiffnessTable(temperatures=(300.0, 500.0), values=(1.0, 0.8)).curve()
    >>> none, steel = np.zeros(2), FreeStrain(reference=np.full(2, 300.0), liquid=np.zeros(2),
    ...                                       coefficient=np.full(2, 1e-5), melting=np.zeros(2))
    >>> moduli = Moduli(free=steel, curves=((np.array([1]), curve),))
    >>> moduli.factor(np.array([400.0, 400.0])).round(12).tolist()
    [1.0, 0.9]
    >>> moduli.potentials(np.array([400.0, 400.0]), none).round(12).tolist()
    [[-0.001, -0.0009], [1.0, 0.9]]
    """

    free: FreeStrain
    curves: tuple[tuple[IntArray, StiffnessCurve], ...] = ()

    def factor(self, temperature: Array) -> Array:
        """Factor (k,) of the moduli at temperatures (k,) [K]."""
        out = np.ones(len(self.free.reference))
        for nodes, curve in self.curves:
            out[nodes] = curve.at(temperature[nodes])
        return out

    def slope(self, temperature: Array) -> Array:
        """Derivative (k,) of the factor along the temperature [1/K]."""
        out = np.zeros(len(self.free.reference))
        for nodes, curve in self.curves:
            out[nodes] = curve.slope(temperature[nodes])
        return out

    def potentials(self, temperature: Array, share: Array) -> Array:
        """Potentials (2, k) of free strain and of elastic energy at temperatures (k,) [K] and liquid shares (k,)."""
        if not self.curves:
            out: Array = np.ones((2, len(temperature)))
            out[0] = -self.free.of(temperature, share)
            return out
        m = self.factor(temperature)
        return np.stack([-m * self.free.of(temperature, share), m])

    def slopes(self, temperature: Array, share: Array) -> Array:
        """Derivatives (2, k) of the potentials along the temperature [1/K]."""
        if not self.curves:
            out: Array = np.zeros((2, len(temperature)))
            out[0] = -self.free.coefficient
            return out
        m, slope = self.factor(temperature), self.slope(temperature)
        return np.stack([-slope * self.free.of(temperature, share) - m * self.free.coefficient, slope])

    def between(self, before: HeatValues, after: HeatValues, mean: Array) -> Array:
        """Potentials (2, k) in a slab with a mean temperature (k,): the mean of the tangents at both ends."""
        if not self.curves:
            return self.potentials(mean, 0.5 * (before.share + after.share))
        ends = ((v.temperature, v.share) for v in (before, after))
        found = (self.potentials(t, s) + (mean - t) * self.slopes(t, s) for t, s in ends)
        return 0.5 * np.sum(list(found), axis=0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ElasticHeat:
    """:class:`~softway.heat.heat_balance.StrainHeat` of potentials.

    Parameters
    ----------
    moduli
        Potentials of k nodes.
    amounts, rates
        (2, k) energies of a free strain of one and elastic energies at the start [J], and their rates [W].
    power
        (k,) heat of dissipation per time [W].
    inert
        True if the body has inertia.
    flow
        (3, k) rates of the energies of inelastic strain, of the potentials and of one [W]; None without.
    """

    moduli: Moduli
    amounts: Array
    rates: Array
    power: Array
    inert: bool
    flow: Array | None = None

    def later(self, span: float) -> "ElasticHeat":
        """The rest, after a time ``span`` [s]."""
        return replace(self, amounts=self.amounts + span * self.rates)

    def over(self, span: float, before: HeatValues, after: HeatValues) -> HeatOfStrain:
        """Heat that the strain takes in a time ``span`` [s]."""
        found = self._reversible(span, before, after)
        return found if self.flow is None else self._flowing(found, span * self.flow, before, after)

    def _flowing(self, found: HeatOfStrain, flow: Array, before: HeatValues, after: HeatValues) -> HeatOfStrain:
        """Heat of strain with the work of the stress that the law of a flow did not know, which is heat as well."""
        work = (self.moduli.between(before, after, found.mean) * flow[:2]).sum(axis=0) + flow[2]
        slope = self.moduli.slopes(after.temperature, after.share)
        melts = self.moduli.free.melting * self.moduli.factor(after.temperature)
        return replace(
            found,
            taken=found.taken - work,
            slope=found.slope - 0.5 * (slope * flow[:2]).sum(axis=0),
            freezing=found.freezing + 0.5 * melts * flow[0],
            work=found.work + work,
            unknown=work,
        )

    def _reversible(self, span: float, before: HeatValues, after: HeatValues) -> HeatOfStrain:
        """Heat that elastic strain takes in a time ``span`` [s]."""
        theta0, theta1, change = before.temperature, after.temperature, span * self.rates
        mean = logarithmic_mean(theta0, theta1) if self.inert else arithmetic_mean(theta0, theta1)
        if not self.moduli.curves:
            return self.at(span, before, after, mean)
        middle, free = self.amounts + 0.5 * change, self.moduli.free
        slope0, slope1 = (self.moduli.slopes(v.temperature, v.share) for v in (before, after))
        value0, value1 = (self.moduli.potentials(v.temperature, v.share) for v in (before, after))
        if self.inert:
            mean = mean + self._shift(mean, before, after, middle)
        slope = 0.5 * (slope0 + slope1)
        stored = middle * ((value1 - theta1 * slope1) - (value0 - theta0 * slope0))
        between = 0.5 * ((value0 + (mean - theta0) * slope0) + (value1 + (mean - theta1) * slope1))
        return HeatOfStrain(
            mean=mean,
            taken=(stored - mean * slope * change).sum(axis=0),
            slope=-0.5 * (slope1 * change).sum(axis=0),
            freezing=-free.melting * middle[0] * (self.moduli.factor(theta1) - theta1 * self.moduli.slope(theta1)),
            work=(between * change).sum(axis=0),
        )

    def at(self, span: float, before: HeatValues, after: HeatValues, mean: Array) -> HeatOfStrain:
        """:meth:`over` of moduli that do not depend on the temperature, at its ``mean`` (k,) [K]."""
        change, free = span * self.rates, self.moduli.free
        entropy, melts = free.coefficient * change[0], free.melting * (self.amounts[0] + 0.5 * change[0])
        return HeatOfStrain(
            mean=mean,
            taken=entropy * mean - melts * (after.share - before.share),
            slope=0.5 * entropy,
            freezing=-melts,
            work=self.moduli.between(before, after, mean)[0] * change[0],
        )

    def _shift(self, mean: Array, before: HeatValues, after: HeatValues, middle: Array) -> Array:
        """What the curvature of the potentials adds to the logarithmic ``mean``: ``dU / dS`` at constant strain."""
        ends, share = (before.temperature, after.temperature), 0.5 * (before.share + after.share)
        capacity = 0.5 * (before.capacity / before.stretch + after.capacity / after.stretch)
        centre, change = arithmetic_mean(*ends), ends[1] - ends[0]
        moves = np.abs(change) > STEADY * centre
        step = np.where(moves, change, 1.0)
        both = (self.moduli.potentials, self.moduli.slopes)
        values, slopes = (np.stack([f(t, share) for t in ends]) for f in both)
        bent = (slopes[1] - slopes[0]) / step
        missing = (values[1] - values[0]) / step - 0.5 * (slopes[0] + slopes[1])
        energy = (middle * (missing - (centre - mean) * bent)).sum(axis=0)
        entropy = capacity / mean - (middle * bent).sum(axis=0)
        return np.where(moves, energy / entropy, 0.0)
