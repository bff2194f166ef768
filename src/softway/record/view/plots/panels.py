"""Single panels of the history as SVG drawings for a web page, with the position of their axes."""

import io
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from softway.record.read.records import Records
from softway.record.read.summary import contacts_of
from softway.record.view.plots.history import balance, energies, forces, gaps
from softway.record.view.plots.spacetime import spacetime
from softway.record.view.style import canvas, scaled, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (5.2, 2.35)
"""Size of a panel [inches]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawing:
    """SVG drawing whose time axis runs from ``begin`` to ``end`` [s].

    The time axis covers the fractions ``low`` to ``high`` of the width or, if ``upright``, of the height from below.
    """

    svg: str
    low: float
    high: float
    begin: float
    end: float
    upright: bool = False


def curves(run: Records) -> tuple[Drawing, ...]:
    """Drawings of energies, contact forces, smallest gaps and energy balance error over time."""
    table = run.history
    if table.rows < 2:
        return ()
    factor, unit = scaled(table["time"], "s")
    contacts, time = contacts_of(table), factor * table["time"]
    panels: list[Callable[[Axes], None]] = [lambda axis: energies(axis, time, table)]
    if contacts:
        panels += [lambda axis: forces(axis, time, table, contacts), lambda axis: gaps(axis, time, table, contacts)]
    panels.append(lambda axis: balance(axis, time, table))
    return tuple(_panel(draw, unit, (float(table["time"][0]), float(table["time"][-1]))) for draw in panels)


def world(run: Records) -> Drawing | None:
    """Drawing of the space-time mesh of bodies on a line or in the plane; None for other bodies."""
    if run.fields.cells.dimension > 2 or run.history.rows < 2:
        return None
    with styled():
        figure = spacetime(run)
        svg = _svg(figure)
    times, box = run.history["time"], figure.axes[0].get_position()
    return Drawing(svg=svg, low=box.y0, high=box.y1, begin=float(times[0]), end=float(times[-1]), upright=True)


def _panel(draw: "Callable[[Axes], None]", unit: str, span: tuple[float, float]) -> Drawing:
    with styled(**{"font.size": 9}):
        figure = canvas(*SIZE)
        axis = figure.subplots()
        draw(axis)
        axis.set_xlabel(f"time [{unit}]")
        axis.margins(x=0.0)
        svg = _svg(figure)
    box = axis.get_position()
    return Drawing(svg=svg, low=box.x0, high=box.x1, begin=span[0], end=span[1])


def _svg(figure: "Figure") -> str:
    """Draw the figure as SVG; its layout is known afterwards."""
    out = io.StringIO()
    figure.savefig(out, format="svg", facecolor="white")
    return out.getvalue()
