"""Balance of the heats of the nodes over a part of a slab, and the heat that each load brings."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.heat.heat_model import HeatModel
from softway.heat.operators import Entries, Thermal, heat_flow, surface_heat, thermal, unknowns_of

ROUNDING = 2.0 * float(np.finfo(float).eps)
"""Rounding of the sum of the heats of the nodes, relative to the terms that they are summed from."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """Part of a slab: it begins at ``start`` and takes ``span`` [s]; the heat flows at the mean of the temperatures of
    its start and its end, with the weight ``theta`` of the end.

    Examples
    --------
    >>> Stage(start=1.0, span=0.5, theta=0.5).end
    1.5
    """

    start: float
    span: float
    theta: float

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
    """

    after: Thermal
    values: Array
    moved: float
    matrix: sp.csr_array | None
    mean: Array


def prescribed(model: HeatModel, unknowns: Array, time: float) -> Array:
    """Unknowns (n,) with those of the prescribed temperatures of a time [s]."""
    out = unknowns.copy()
    for load, nodes in model.held:
        out[nodes] = unknowns_of(model, np.full(model.n_nodes, load.at(time)))[nodes]
    return out


def put_at_once(model: HeatModel, before: Thermal, time: float) -> tuple[Thermal, Array, float]:
    """State with the prescribed temperatures of a time [s], the heat (k,) [J] of the jump to each of them, and the
    entropy that these heats bring [J/K].
    """
    brought, carried, after = np.zeros(len(model.held)), 0.0, before
    target = prescribed(model, before.unknowns, time)
    for k, (_, nodes) in enumerate(model.held):
        if (after.unknowns[nodes] != target[nodes]).any():
            unknowns = after.unknowns.copy()
            unknowns[nodes] = target[nodes]
            changed = thermal(model, unknowns)
            gained = changed.content - after.content
            brought[k] = gained.sum()
            carried += float((gained / changed.temperature).sum())
            after = changed
    return after, brought, carried


def balance(model: HeatModel, before: Thermal, stage: Stage, unknowns: Array, *, slopes: bool) -> Balance:
    """Balance of the heats at unknowns (n,) of the end of a stage, with its derivatives if ``slopes`` are wanted."""
    h, theta = stage.span, stage.theta
    after = thermal(model, unknowns, slopes)
    mean = (1.0 - theta) * before.temperature + theta * after.temperature
    liquid = (1.0 - theta) * before.liquid + theta * after.liquid
    flow, matrix, by_liquid = heat_flow(model, mean, liquid, slopes)
    gained = after.content - before.content
    values, moved = gained + h * flow, np.abs(gained).sum() + h * np.abs(flow).sum()
    for surface, factor in zip(model.surfaces, _factors(model, stage), strict=True):
        heat, slope = surface_heat(surface, mean, factor)
        values, moved = values - h * (surface.points.T @ heat), moved + h * np.abs(heat).sum()
        if matrix is not None and slope.any():
            matrix = matrix - surface.points.T @ sp.diags_array(slope) @ surface.points
    for exchange in model.exchanges:
        heat = exchange.heat(mean)
        values, moved = values + h * (exchange.jump.T @ heat), moved + h * np.abs(heat).sum()
        if matrix is not None:
            matrix = matrix + exchange.matrix()
    for power in _powers(model, stage):
        values, moved = values - h * power, moved + h * np.abs(power).sum()
    total = None if matrix is None else _matrix(after, matrix, by_liquid, theta * h)
    return Balance(after=after, values=values, moved=float(moved), matrix=total, mean=mean)


def _matrix(after: Thermal, conduction: sp.csr_array, by_liquid: Entries, span: float) -> sp.csr_array:
    """Derivative (n, n) of the balance: capacity and latent heat, and ``span`` [s] times that of the heat flow."""
    n, E = len(after.unknowns), len(after.liquid)
    diagonal = np.arange(n)
    capacity = _assembled(((diagonal, diagonal, after.capacity), *after.latent_slope), (n, n))
    flow = conduction.copy()
    flow.data *= span * after.stretch[flow.indices]
    if by_liquid and after.liquid_slope:
        flow = flow + span * (_assembled(by_liquid, (n, E)) @ _assembled(after.liquid_slope, (E, n)))
    return sp.csr_array(capacity + flow)


def _assembled(entries: Entries, shape: tuple[int, int]) -> sp.csr_array:
    """Matrix of some entries."""
    rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
    return sp.csr_array((values, (rows, columns)), shape=shape)


def heats(model: HeatModel, before: Thermal, stage: Stage, found: Balance) -> Array:
    """Heat that came in by each load on a surface, each source and each prescribed temperature, in this order [J]."""
    surfaces = [
        surface_heat(surface, found.mean, factor)[0].sum() * stage.span
        for surface, factor in zip(model.surfaces, _factors(model, stage), strict=True)
    ]
    sources = [power.sum() * stage.span for power in _powers(model, stage)]
    return np.array([*surfaces, *sources, *(found.values[nodes].sum() for _, nodes in model.held)])


def passed(model: HeatModel, stage: Stage, found: Balance) -> Array:
    """Heat (k,) that passed each contact from its first to its second surface [J]."""
    return np.array([stage.span * exchange.heat(found.mean).sum() for exchange in model.exchanges])


def entropy_brought(model: HeatModel, stage: Stage, found: Balance) -> float:
    """Entropy that loads brought [J/K]: their heats over the temperatures at which they came in."""
    total = 0.0
    for surface, factor in zip(model.surfaces, _factors(model, stage), strict=True):
        heat, _ = surface_heat(surface, found.mean, factor)
        total += stage.span * float((heat / (surface.points @ found.mean)).sum())
    for power in _powers(model, stage):
        total += stage.span * float((power / found.mean).sum())
    held = ~model.free_nodes()
    return total + float((found.values[held] / found.mean[held]).sum())


def rounding(model: HeatModel, before: Thermal, stage: Stage) -> float:
    """Rounding of the sum of the heats of the nodes [J]."""
    total = 2.0 * float(np.abs(before.content).sum())
    for cells in model.cells:
        at = np.abs(before.temperature[cells.nodes]).max(axis=1)
        k, _ = cells.law.along_axes(at, cells.gradients.shape[-1])
        size = np.einsum("eq,eqar->er", cells.volume, cells.gradients**2)
        total += stage.span * float((size * k).sum(axis=1) @ at)
    for exchange in model.exchanges:
        total += 2.0 * stage.span * float(exchange.conductances.sum()) * float(np.abs(before.temperature).max())
    return ROUNDING * total


def _factors(model: HeatModel, stage: Stage) -> list[float]:
    """mean factors of the loads on surfaces."""
    return [surface.load.ramp.mean(stage.start, stage.end) for surface in model.surfaces]


def _powers(model: HeatModel, stage: Stage) -> list[Array]:
    """Mean powers (n,) of the sources [W]."""
    return [load.value * load.ramp.mean(stage.start, stage.end) * at for load, at in model.sources]
