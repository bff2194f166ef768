"""Balance of the heats of the nodes over a part of a slab, and the heat that each load brings."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.elements.following_heat import Entries
from softway.heat.heat_model import HeatModel
from softway.heat.operators import HeatValues, heat_flow, heat_values, surface_heat, unknowns_of

ROUNDING = 2.0 * float(np.finfo(float).eps)
"""Rounding of the sum of the heats of the nodes, relative to the terms that they are summed from."""


def logarithmic_mean(one: Array, other: Array) -> Array:
    """Logarithmic mean of positive numbers, ``(b - a)/(ln b - ln a)``, not a number where one is not positive.

    A change of temperature divided by it is the change of the logarithm: the entropy of a constant capacity.

    Examples
    --------
    >>> logarithmic_mean(np.array([300.0, 1.0]), np.array([300.0, np.e])).round(12).tolist()
    [300.0, 1.718281828459]
    """
    middle = 0.5 * (one + other)
    with np.errstate(all="ignore"):
        x = 0.5 * (other - one) / middle
        square = x * x
        series = 1.0 + square * (1 / 3 + square * (1 / 5 + square * (1 / 7 + square / 9)))
        ratio = np.where(np.abs(x) < 1e-2, series, np.arctanh(x) / np.where(x == 0.0, 1.0, x))
        return np.asarray(np.where((one > 0.0) & (other > 0.0), middle / ratio, np.nan))


def arithmetic_mean(one: Array, other: Array) -> Array:
    """Arithmetic mean of numbers."""
    return 0.5 * (one + other)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatOfStrain:
    """Heat that the strain of a body takes from its nodes in a part of a slab.

    Parameters
    ----------
    mean
        (n,) temperatures at which it is taken [K].
    taken, slope
        (n,) heat [J], and its derivative along the temperature of the end [J/K].
    freezing
        (n,) derivative of the heat along the liquid share of the end [J].
    work
        (n,) work of the stresses that depend on the temperature [J].
    unknown
        (n,) heat of the stress in a flow that its law did not know, of either sign [J]; zero for none.
    """

    mean: Array
    taken: Array
    slope: Array
    freezing: Array
    work: Array
    unknown: Array | float = 0.0


def at_rest(before: HeatValues, after: HeatValues) -> HeatOfStrain:
    """Heat of strain of a body that does not move: none."""
    none = np.zeros_like(before.temperature)
    mean = logarithmic_mean(before.temperature, after.temperature)
    return HeatOfStrain(mean=mean, taken=none, slope=none, freezing=none, work=none)


class StrainHeat(Protocol):
    """Heat that the motion of a body exchanges with its nodes, at constant rates."""

    @property
    def power(self) -> Array:
        """Heat (n,) of dissipation per time [W]."""
        ...

    def over(self, span: float, before: HeatValues, after: HeatValues) -> HeatOfStrain:
        """Heat that the strain takes in a time ``span`` [s]."""
        ...

    def later(self, span: float) -> "StrainHeat":
        """The rest, after a time ``span`` [s]."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Stage:
    """Part of a slab: it begins at ``start`` and takes ``span`` [s]; the heat flows at the mean of the temperatures of
    its start and its end, with the weight ``theta`` of the end.  A body that deforms has the heat of its ``strain``.

    Examples
    --------
    >>> Stage(start=1.0, span=0.5, theta=0.5).end
    1.5
    """

    start: float
    span: float
    theta: float
    strain: StrainHeat | None = None

    @property
    def end(self) -> float:
        """Time of the end [s]."""
        return self.start + self.span


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Balance:
    """Balance of the heats at tried temperatures of the end.

    Parameters
    ----------
    after
        Temperatures and contents of the end.
    values
        (n,) heat gained by the nodes, less what flowed in and what loads brought [J].
    moved
        Sum of the magnitudes of the heats that take part [J].
    matrix
        (n, n) derivative of the values along the unknowns; None if left out.
    mean
        (n,) temperatures at which the heat flows [K].
    flow
        (n,) heat that flows out of the nodes by conduction and through contacts [W].
    strain
        Heat that the strain takes; None in a body that does not move.
    """

    after: HeatValues
    values: Array
    moved: float
    matrix: sp.csr_array | None
    mean: Array
    flow: Array
    strain: HeatOfStrain | None = None


def prescribed(model: HeatModel, unknowns: Array, time: float) -> Array:
    """Unknowns (n,) with those of the prescribed temperatures of a time [s]."""
    out = unknowns.copy()
    for load, nodes in model.held:
        out[nodes] = unknowns_of(model, np.full(model.n_nodes, load.at(time)))[nodes]
    return out


def put_at_once(model: HeatModel, before: HeatValues, time: float) -> tuple[HeatValues, Array, float]:
    """State with the prescribed temperatures of a time [s], the heat (k,) [J] of the jump to each of them, and the
    entropy that these heats bring [J/K].
    """
    brought, carried, after = np.zeros(len(model.held)), 0.0, before
    target = prescribed(model, before.unknowns, time)
    for k, (_, nodes) in enumerate(model.held):
        unknowns = after.unknowns.copy()
        unknowns[nodes] = target[nodes]
        if not model.space.every(unknowns == after.unknowns):
            changed = heat_values(model, unknowns)
            gained = changed.content - after.content
            brought[k] = model.space.total(gained)
            carried += model.space.total(gained / changed.temperature)
            after = changed
    return after, brought, carried


def balance(model: HeatModel, before: HeatValues, stage: Stage, unknowns: Array, *, slopes: bool) -> Balance:
    """Balance of the heats at unknowns (n,) of the end of a stage, with its derivatives if ``slopes`` are wanted."""
    h, theta = stage.span, stage.theta
    after = heat_values(model, unknowns, slopes)
    mean = (1.0 - theta) * before.temperature + theta * after.temperature
    liquid = (1.0 - theta) * before.liquid + theta * after.liquid
    flow, matrix, by_liquid = heat_flow(model, mean, liquid, slopes)
    gained = after.content - before.content
    moved, through = np.abs(gained) + h * np.abs(flow), 0.0
    for exchange in model.exchanges:
        heat = exchange.heat(mean)
        flow, through = flow + exchange.jump.T @ heat, through + h * float(np.abs(heat).sum())
        if matrix is not None:
            matrix = matrix + exchange.matrix()
    values = gained + h * flow
    for surface, factor in zip(model.surfaces, factors(model, stage), strict=True):
        heat, slope = surface_heat(surface, mean, factor)
        values, moved = values - h * (surface.points.T @ heat), moved + h * (surface.points.T @ np.abs(heat))
        if matrix is not None and slope.any():
            matrix = matrix - surface.points.T @ sp.diags_array(slope) @ surface.points
    for power in powers(model, stage):
        values, moved = values - h * power, moved + h * np.abs(power)
    total = None if matrix is None else _matrix(after, matrix, by_liquid, theta * h)
    strain = None if stage.strain is None else stage.strain.over(h, before, after)
    if stage.strain is not None and strain is not None:
        given = h * stage.strain.power
        values, moved = values + strain.taken - given, moved + np.abs(strain.taken) + np.abs(given)
        if total is not None and not model.linear:
            total = sp.csr_array(total + _of_strain(model, strain, after))
    return Balance(
        after=after, values=values, moved=model.space.total(moved) + through, matrix=total, mean=mean, flow=flow,
        strain=strain,
    )  # fmt: skip


def _matrix(after: HeatValues, conduction: sp.csr_array, by_liquid: Entries, span: float) -> sp.csr_array:
    """Derivative (n, n) of the balance: capacity and latent heat, and ``span`` [s] times that of the heat flow."""
    n, E = len(after.unknowns), len(after.liquid)
    flow = conduction.copy()
    flow.data *= span * after.stretch[flow.indices]
    flow.setdiag(flow.diagonal() + after.capacity)
    if after.latent_slope:
        flow = flow + _assembled(after.latent_slope, (n, n))
    if by_liquid and after.liquid_slope:
        flow = flow + span * (_assembled(by_liquid, (n, E)) @ _assembled(after.liquid_slope, (E, n)))
    return sp.csr_array(flow)


def _of_strain(model: HeatModel, strain: HeatOfStrain, after: HeatValues) -> sp.csr_array:
    """Derivative (n, n) of the heat that the strain takes."""
    n = model.n_nodes
    diagonal = strain.slope * after.stretch + strain.freezing * after.share_slope
    heat = strain.freezing / np.where(model.latent > 0.0, model.latent, np.inf)
    cut = tuple((rows, columns, heat[rows] * values) for rows, columns, values in after.latent_slope)
    return _assembled(((np.arange(n), np.arange(n), diagonal), *cut), (n, n))


def _assembled(entries: Entries, shape: tuple[int, int]) -> sp.csr_array:
    """Matrix of some entries."""
    rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
    return sp.csr_array((values, (rows, columns)), shape=shape)


def heats(model: HeatModel, before: HeatValues, stage: Stage, found: Balance) -> Array:
    """Heat that came in by each load on a surface, each source and each prescribed temperature, in this order [J]."""
    each = [
        surface.points.T @ surface_heat(surface, found.mean, factor)[0] * stage.span
        for surface, factor in zip(model.surfaces, factors(model, stage), strict=True)
    ]
    each += [power * stage.span for power in powers(model, stage)]
    each += [np.where(np.isin(np.arange(model.n_nodes), nodes), found.values, 0.0) for _, nodes in model.held]
    return model.space.sums(np.stack(each, axis=1)) if each else np.zeros(0)


def passed(model: HeatModel, stage: Stage, found: Balance) -> Array:
    """Heat (k,) that passed each contact from its first to its second surface [J]."""
    return np.array([stage.span * exchange.heat(found.mean).sum() for exchange in model.exchanges])


def entropy_brought(model: HeatModel, stage: Stage, found: Balance) -> float:
    """Entropy that loads brought [J/K]: their heats over the temperatures at which they came in."""
    brought = np.where(model.free_nodes(), 0.0, found.values / found.mean)
    for surface, factor in zip(model.surfaces, factors(model, stage), strict=True):
        heat, _ = surface_heat(surface, found.mean, factor)
        brought = brought + stage.span * (surface.points.T @ (heat / (surface.points @ found.mean)))
    for power in powers(model, stage):
        brought = brought + stage.span * power / found.mean
    return model.space.total(brought)


def entropy_of_reservoirs(model: HeatModel, stage: Stage, found: Balance) -> float:
    """Entropy that the opponents of contacts gained which have no nodes, but a temperature [J/K]."""
    total = 0.0
    for exchange in model.exchanges:
        heat, ambient = exchange.heat(found.mean), np.broadcast_to(exchange.ambient, exchange.conductances.shape)
        total += stage.span * float((heat[ambient > 0.0] / ambient[ambient > 0.0]).sum())
    return total


def rounding(model: HeatModel, before: HeatValues, stage: Stage) -> float:
    """Rounding of the sum of the heats of the nodes [J]."""
    each = 2.0 * np.abs(before.content)
    if stage.strain is not None or model.fronts is not None:  # temperatures are rounded, whatever is counted from
        each = each + 2.0 * (before.capacity / before.stretch) * before.temperature
    if model.conduction is not None:
        each = each + 2.0 * stage.span * model.conduction.diagonal() * np.abs(before.temperature)
    total = model.space.total(each)
    temperature = model.everywhere(before.temperature)
    for cells in model.cells if model.conduction is None else ():
        at = np.abs(temperature[cells.nodes]).max(axis=1)
        k, _ = cells.law.along_axes(at, cells.gradients.shape[-1])
        size = np.einsum("eq,eqar->er", cells.volume, cells.gradients**2)
        total += stage.span * float((size * k).sum(axis=1) @ at)
    for exchange in model.exchanges:
        total += 2.0 * stage.span * float(exchange.conductances.sum()) * model.space.greatest(before.temperature)
    return ROUNDING * total


def factors(model: HeatModel, stage: Stage) -> list[float]:
    """Mean factors of the loads on surfaces in a stage."""
    return [surface.load.ramp.mean(stage.start, stage.end) for surface in model.surfaces]


def powers(model: HeatModel, stage: Stage) -> list[Array]:
    """Mean powers (n,) of the sources in a stage [W]."""
    return [load.value * load.ramp.mean(stage.start, stage.end) * at for load, at in model.sources]
