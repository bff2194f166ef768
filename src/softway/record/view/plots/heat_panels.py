"""Panels of the history of conductors: heats, their balance, volumes of liquid."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from softway.arrays import Array
from softway.record.storage.table import Table
from softway.record.view.style import BLACK, BLUE, CYCLE, GREEN, ORANGE, PURPLE, RED, scaled
from softway.record.write.history_columns import LIQUID

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEATS = (("heat_in", RED, "came in"), ("heat_out", BLUE, "went out"))
"""Columns with colours and labels."""
OF_SOLIDS = (
    ("heat.received", RED, "from the motion"),
    ("heat.reversible", ORANGE, "of it, reversible"),
    ("heat.friction", GREEN, "of friction"),
    ("heat.brought", BLUE, "by loads and tools"),
    ("heat.cold_work", BLACK, "dissipated without heating"),
)
"""The same of solids with heat."""


def heat_panels(table: Table) -> "list[Callable[[Axes, Array, Table], None]]":
    """Drawing functions of the panels."""
    return [_heats, _balance, *([_liquids] if _melting(table) else [])]


def heat_panels_of_solids(table: Table) -> "list[Callable[[Axes, Array, Table], None]]":
    """Drawing functions of the panels of solids that move."""
    return [_heat_of_solids, *([_liquids] if _melting(table) else [])]


def _heat_of_solids(axis: "Axes", time: Array, table: Table) -> None:
    """Draw the heats of solids that move, from zero at the start."""
    curves = [(label, table[name] - table[name][0], color) for name, color, label in OF_SOLIDS if name in table]
    factor, unit = scaled(np.concatenate([values for _, values, _ in curves]), "J")
    for label, values, color in curves:
        axis.plot(time, factor * values, color=color, label=label)
    axis.set(title="Heat of the solids", ylabel=f"heat [{unit}]")
    axis.legend(loc="best")


def _heats(axis: "Axes", time: Array, table: Table) -> None:
    """Draw the heats that came in and went out, and the change of the content."""
    change = table["heat_content"] - table["heat_content"][0]
    curves = [*((label, table[name], color) for name, color, label in HEATS), ("change of the content", change, BLACK)]
    factor, unit = scaled(np.concatenate([values for _, values, _ in curves]), "J")
    for label, values, color in curves:
        axis.plot(time, factor * values, color=color, label=label)
    axis.set(title="Heat", ylabel=f"heat [{unit}]")
    axis.legend(loc="best")


def _balance(axis: "Axes", time: Array, table: Table) -> None:
    """Draw the error of the balance of heat."""
    relative = np.maximum(np.abs(table["heat_error_relative"]), 1e-17)
    axis.semilogy(time, relative, color=PURPLE, lw=1.2)
    axis.set_ylim(1e-17, max(1e-11, 10.0 * relative.max()))
    axis.set(title=f"Balance of heat: largest error {relative.max():.1e}", ylabel="relative error")


def _liquids(axis: "Axes", time: Array, table: Table) -> None:
    """Draw the liquid volume of each body that melts, relative to the largest one in the run."""
    for k, name in enumerate(_melting(table)):
        most = float(table[name].max()) or 1.0
        axis.plot(time, 100.0 * table[name] / most, color=CYCLE[k % len(CYCLE)], label=name.removeprefix(LIQUID))
    axis.set(title="Liquid volume", ylabel="of its largest [%]")
    axis.set_ylim(0.0, 105.0)
    axis.legend(loc="best")


def _melting(table: Table) -> list[str]:
    return [name for name in table if name.startswith(LIQUID)]
