"""Columns of the history of conductors."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from softway.heat.heat_model import HeatModel
from softway.heat.march import HeatStep
from softway.record.storage import table
from softway.record.write.heat.probes import HeatReading
from softway.record.write.history_columns import LIQUID


@dataclass(frozen=True, slots=True, eq=False)
class HeatColumn:
    """Column of the history of conductors: name, unit, and value after a step."""

    name: str
    unit: str
    value: Callable[[HeatStep], float]


COLUMNS = (
    HeatColumn("time", "s", lambda step: step.time),
    HeatColumn("h", "s", lambda step: step.span),
    HeatColumn("iterations", table.COUNT, lambda step: step.iterations),
    HeatColumn("entropy_produced", "J/K", lambda step: step.entropy_produced),
    HeatColumn("heat_content", "J", lambda step: step.ledger.heat_content),
    HeatColumn("heat_in", "J", lambda step: step.ledger.heat_in),
    HeatColumn("heat_out", "J", lambda step: step.ledger.heat_out),
    HeatColumn("heat_error", "J", lambda step: step.ledger.error),
    HeatColumn("heat_error_relative", table.RATIO, lambda step: step.ledger.relative_error),
)
"""Columns of every history of conductors."""
NEEDED = tuple((column.name, column.unit) for column in COLUMNS)
"""Names and units of the columns."""
LOAD, CONTACT = "heat.", "passed."
"""Starts of the names of the columns of the heats of loads, and of the heats through contacts."""


def columns(model: HeatModel, readings: Sequence[HeatReading]) -> tuple[HeatColumn, ...]:
    """Columns of a run: those of every history, the liquid volumes of the bodies that melt, the heats that the loads
    have brought, by their numbers in the scenario from 0, those that passed the contacts to their second surfaces, and
    the probes.
    """
    melting = [part.name for part in model.parts if part.law.latent is not None]
    liquid = [HeatColumn(f"{LIQUID}{name}", "m^3", partial(_liquid, name)) for name in melting]
    loads = [HeatColumn(f"{LOAD}{k}", "J", partial(_heat, place)) for k, place in enumerate(model.ledger_places())]
    contacts = [HeatColumn(f"{CONTACT}{k}", "J", partial(_passed, k)) for k in range(len(model.exchanges))]
    probes = [HeatColumn(reading.name, reading.unit, reading.value) for reading in readings]
    return (*COLUMNS, *liquid, *loads, *contacts, *probes)


def _liquid(name: str, step: HeatStep) -> float:
    return step.liquid_volume[name]


def _passed(place: int, step: HeatStep) -> float:
    return step.ledger.by_contact[place]


def _heat(place: int, step: HeatStep) -> float:
    return step.ledger.by_load[place]
