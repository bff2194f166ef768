"""Records of conductors: ``history.csv``, ``events.csv`` and ``fields.vtkhdf``."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from softway.heat.fronts.places import with_latent
from softway.heat.heat_model import HeatModel
from softway.heat.march import HeatStep, heat_at_start
from softway.heat.operators import heat_flux, heat_values
from softway.record.storage.line_files import LineFiles, open_files
from softway.record.storage.table import Cells
from softway.record.write import events, fields, history
from softway.record.write.checkpoint_schedule import Marked
from softway.record.write.grid.grid_layout import layout
from softway.record.write.grid.grid_series import GridFrame, GridSeries, continue_series, create_series
from softway.record.write.heat.columns import HeatColumn, columns
from softway.record.write.heat.probes import HeatReading
from softway.record.write.recorder import frame_due

UNITS = {"temperature": "K", "liquid": "", "heat_flux": "W/m^2"}
"""Units of the fields of conductors; the liquid share is there if a body melts."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatOpening:
    """What the records of conductors need to know.

    Parameters
    ----------
    model
        Conductors.
    readings
        Resolved probes.
    until, fields_every
        End of the march, and time between two frames [s].
    """

    model: HeatModel
    readings: tuple[HeatReading, ...]
    until: float
    fields_every: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatRecords:
    """Recorder that takes the steps of a march in order; its files are valid after each of them."""

    opening: HeatOpening
    tables: LineFiles
    series: GridSeries

    @property
    def files(self) -> Mapping[str, Marked]:
        """Open files by name."""
        return {**self.tables.files, fields.FILE: self.series}

    def take(self, step: HeatStep, slabs: int) -> None:
        """Write a step after a number of slabs."""
        self.tables.take(step, slabs)
        given = self.opening
        if slabs and frame_due(given.fields_every, given.until, step.time - step.span, step.time):
            self.series.write(_frame(given.model, step))

    def close(self) -> None:
        """Close the files."""
        with ExitStack() as closing:
            closing.callback(self.series.close)
            closing.callback(self.tables.close)


def open_heat(opening: HeatOpening, folder: Path, marks: Mapping[str, int]) -> HeatRecords:
    """Create the files of conductors; those with ``marks`` are truncated to these lengths, and continued."""
    told = columns(opening.model, opening.readings)
    heads = {history.FILE: [(c.name, c.unit) for c in told], events.FILE: (*events.COLUMNS, *events.EXTRA)}

    def rows(step: HeatStep, slabs: int) -> Iterator[Cells]:
        yield _row(told, step)

    with ExitStack() as failing:
        tables = open_files(folder, heads, {history.FILE: rows}, marks)
        failing.callback(tables.close)
        path = folder / fields.FILE
        if fields.FILE in marks:
            series = continue_series(path, marks[fields.FILE])
        else:
            grid = layout({part.name: part.mesh for part in opening.model.parts}, {})
            first = _frame(opening.model, heat_at_start(opening.model))
            series = create_series(path, grid, first, UNITS, {"tools": {}, "rigid": {}})
        failing.pop_all()
    return HeatRecords(opening=opening, tables=tables, series=series)


def _row(told: tuple[HeatColumn, ...], step: HeatStep) -> Cells:
    return [column.value(step) for column in told]


def _frame(model: HeatModel, step: HeatStep) -> GridFrame:
    """Temperatures, heat fluxes, and where bodies melt the liquid share of the cells."""
    points = np.zeros((model.n_nodes, 3))
    for part in model.parts:
        points[part.nodes, : part.mesh.dim] = part.mesh.points
    now = with_latent(model, step.state.fronts, heat_values(model, step.state.unknowns, slopes=False))
    cells = {"heat_flux": heat_flux(model, now)}
    if step.liquid:
        cells["liquid"] = now.melted
    return GridFrame(time=step.time, points=points, at_points={"temperature": now.temperature}, in_cells=cells)
