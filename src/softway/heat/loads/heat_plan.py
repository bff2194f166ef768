"""Slabs of a march of heat: equal ones between the knots of the loads."""

from dataclasses import dataclass
from math import ceil

from softway.bodies.setup.knots import knots_of_table
from softway.heat.heat_model import HeatModel


def heat_slabs(model: HeatModel, until: float, step: float) -> int:
    """Number of slabs of a march from zero to ``until``, with slabs of at most ``step`` [s]."""
    return len(_plan(model, 0.0, until, step))


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedSlab:
    """Slab of a march: ``first`` is True at the start and after a knot."""

    start: float
    end: float
    span: float
    first: bool


def planned_slabs(model: HeatModel, begin: float, until: float, step: float) -> list[PlannedSlab]:
    """Slabs after ``begin``: those of the march from zero if one of them ends there, else those of one from there."""
    whole = _plan(model, 0.0, until, step)
    rest = [slab for slab in whole if slab.start >= begin]
    return rest if rest and rest[0].start == begin else _plan(model, begin, until, step)


def _plan(model: HeatModel, begin: float, until: float, step: float) -> list[PlannedSlab]:
    """Slabs from ``begin`` on: equal ones between the knots."""
    ends, found = [begin, *(t for t in knots(model) if begin < t < until), until], []
    for low, high in zip(ends[:-1], ends[1:], strict=True):
        count = ceil((high - low) / step * (1.0 - 1e-9))
        at = [low + (high - low) * (k / count) for k in range(count)] + [high]
        span = (high - low) / count
        found += [PlannedSlab(start=at[k], end=at[k + 1], span=span, first=k == 0) for k in range(count)]
    return found


def knots(model: HeatModel) -> tuple[float, ...]:
    """Instants at which a ramp bends [s]."""
    loads = [*(s.load for s in model.surfaces), *(load for load, _ in model.sources), *(load for load, _ in model.held)]
    return tuple(sorted({t for a in (load.ramp for load in loads) for t in knots_of_table(a.times, a.factors)}))
