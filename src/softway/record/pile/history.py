"""Columns of the history of a pile."""

from collections.abc import Callable
from dataclasses import dataclass

from softway.piles.march import PileStep
from softway.record.storage import table


@dataclass(frozen=True, slots=True, eq=False)
class PileColumn:
    """Column of the history of a pile: name, unit, and value after a step and a number of slabs (time steps)."""

    name: str
    unit: str
    value: Callable[[PileStep, int], float]


COLUMNS = (
    PileColumn("time", "s", lambda step, _: step.time),
    PileColumn("slabs", table.COUNT, lambda _, slabs: slabs),
    PileColumn("sweeps", table.COUNT, lambda step, _: step.sweeps),
    PileColumn("energy_kinetic", "J", lambda step, _: step.energy_kinetic),
    PileColumn("energy_potential", "J", lambda step, _: step.energy_potential),
    PileColumn("dissipation", "J", lambda step, _: step.dissipation),
    PileColumn("energy_error", "J", lambda step, _: step.energy_error),
    PileColumn("momentum_x", "kg m/s", lambda step, _: float(step.momentum[0])),
    PileColumn("momentum_y", "kg m/s", lambda step, _: float(step.momentum[1])),
    PileColumn("momentum_z", "kg m/s", lambda step, _: float(step.momentum[2])),
    PileColumn("spin_x", "kg m^2/s", lambda step, _: float(step.spin[0])),
    PileColumn("spin_y", "kg m^2/s", lambda step, _: float(step.spin[1])),
    PileColumn("spin_z", "kg m^2/s", lambda step, _: float(step.spin[2])),
    PileColumn("overlap", "m", lambda step, _: step.overlap),
    PileColumn("slip_error", "m/s", lambda step, _: step.slip_error),
    PileColumn("unfinished", table.COUNT, lambda step, _: step.unfinished),
    PileColumn("touches", table.COUNT, lambda step, _: step.touches),
    PileColumn("closed_contacts", table.COUNT, lambda step, _: step.closed),
)
"""Columns of every history; sweeps, overlap, slip error, unfinished slabs and touches are those since the last line."""
NEEDED = tuple((column.name, column.unit) for column in COLUMNS)
"""Names and units of the columns."""
