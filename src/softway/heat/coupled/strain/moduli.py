"""Potentials of the strain of a node, and the heat that it takes (docs/theory/heat/coupling.md).

    psi = sum_X phi_X(theta) X(u),   phi_H = -m (theta - theta_r),   phi_G = m

with the entropy H of thermal expansion, the elastic energy G at the moduli of the law, and the factor m of the moduli.
"""

from dataclasses import dataclass, replace

import numpy as np

from softway.arrays import Array, IntArray
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
    reference
        (k,) temperatures without thermal stress [K].
    curves
        Numbers of nodes with a factor that depends on the temperature, and the factor; it is one on all others.

    Examples
    --------
    >>> from softway.laws.heat.stiffness_table import StiffnessTable
    >>> curve = StiffnessTable(temperatures=(300.0, 500.0), values=(1.0, 0.8)).curve()
    >>> moduli = Moduli(reference=np.array([300.0, 300.0]), curves=((np.array([1]), curve),))
    >>> moduli.factor(np.array([400.0, 400.0])).round(12).tolist()
    [1.0, 0.9]
    >>> moduli.potentials(np.array([400.0, 400.0])).round(12).tolist()
    [[-100.0, -90.0], [1.0, 0.9]]
    """

    reference: Array
    curves: tuple[tuple[IntArray, StiffnessCurve], ...] = ()

    def factor(self, temperature: Array) -> Array:
        """Factor (k,) of the moduli at temperatures (k,) [K]."""
        out = np.ones(len(self.reference))
        for nodes, curve in self.curves:
            out[nodes] = curve.at(temperature[nodes])
        return out

    def potentials(self, temperature: Array) -> Array:
        """Potentials (2, k) of expansion [K] and of elastic energy [1] at temperatures (k,) [K]."""
        m, over = self.factor(temperature), temperature - self.reference
        return np.stack([-m * over, m])

    def slopes(self, temperature: Array) -> Array:
        """Derivatives (2, k) of the potentials along the temperature."""
        m, over, slope = self.factor(temperature), temperature - self.reference, np.zeros(len(self.reference))
        for nodes, curve in self.curves:
            slope[nodes] = curve.slope(temperature[nodes])
        return np.stack([-slope * over - m, slope])

    def between(self, before: Array, after: Array, mean: Array) -> Array:
        """Potentials (2, k) in a slab between temperatures with a mean (k,): the mean of the tangents at both ends."""
        if not self.curves:
            return self.potentials(mean)
        ends = (self.potentials(t) + (mean - t) * self.slopes(t) for t in (before, after))
        return 0.5 * np.sum(list(ends), axis=0)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ElasticHeat:
    """:class:`~softway.heat.heat_balance.StrainHeat` of potentials.

    Parameters
    ----------
    moduli
        Potentials of k nodes.
    amounts, rates
        (2, k) entropies [J/K] and elastic energies [J] at the start, and their rates [W/K, W].
    power
        (k,) heat of dissipation per time [W].
    inert
        True if the body has inertia.
    """

    moduli: Moduli
    amounts: Array
    rates: Array
    power: Array
    inert: bool

    def later(self, span: float) -> "ElasticHeat":
        """The rest, after a time ``span`` [s]."""
        return replace(self, amounts=self.amounts + span * self.rates)

    def over(self, span: float, before: HeatValues, after: HeatValues) -> HeatOfStrain:
        """Heat that the strain takes in a time ``span`` [s]."""
        theta0, theta1, change = before.temperature, after.temperature, span * self.rates
        mean = logarithmic_mean(theta0, theta1) if self.inert else arithmetic_mean(theta0, theta1)
        if not self.moduli.curves:
            entropy = change[0]
            work = self.moduli.potentials(mean)[0] * entropy
            return HeatOfStrain(mean=mean, taken=entropy * mean, slope=0.5 * entropy, work=work)
        middle = self.amounts + 0.5 * change
        slope0, slope1 = self.moduli.slopes(theta0), self.moduli.slopes(theta1)
        value0, value1 = self.moduli.potentials(theta0), self.moduli.potentials(theta1)
        if self.inert:
            capacity = 0.5 * (before.capacity / before.stretch + after.capacity / after.stretch)
            mean = mean + self._shift(mean, (theta0, theta1), middle, capacity)
        slope = 0.5 * (slope0 + slope1)
        stored = middle * ((value1 - theta1 * slope1) - (value0 - theta0 * slope0))
        between = 0.5 * ((value0 + (mean - theta0) * slope0) + (value1 + (mean - theta1) * slope1))
        return HeatOfStrain(
            mean=mean,
            taken=(stored - mean * slope * change).sum(axis=0),
            slope=-0.5 * (slope1 * change).sum(axis=0),
            work=(between * change).sum(axis=0),
        )

    def _shift(self, mean: Array, ends: tuple[Array, Array], middle: Array, capacity: Array) -> Array:
        """What the curvature of the potentials adds to the logarithmic ``mean``: ``dU / dS`` at constant strain."""
        (theta0, theta1), centre = ends, arithmetic_mean(*ends)
        change = theta1 - theta0
        moves = np.abs(change) > STEADY * centre
        step = np.where(moves, change, 1.0)
        values, slopes = (np.stack([f(t) for t in ends]) for f in (self.moduli.potentials, self.moduli.slopes))
        bent = (slopes[1] - slopes[0]) / step
        missing = (values[1] - values[0]) / step - 0.5 * (slopes[0] + slopes[1])
        energy = (middle * (missing - (centre - mean) * bent)).sum(axis=0)
        entropy = capacity / mean - (middle * bent).sum(axis=0)
        return np.where(moves, energy / entropy, 0.0)
