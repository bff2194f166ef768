"""The history of a run as curves: energies, their balance, contact forces and gaps."""

from typing import TYPE_CHECKING

import numpy as np

from softway.record.run import Run
from softway.record.summary import contacts_of
from softway.record.table import Table
from softway.record.view_style import BLACK, BLUE, CYCLE, GREEN, ORANGE, PURPLE, RED, canvas, scaled
from softway.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def history(run: Run) -> "Figure":
    """Energies, error of the energy balance, contact force and least gap over time."""
    table, title = run.history, run.provenance.get("title", "")
    contacts = contacts_of(table)
    figure = canvas(9.0, 6.4 if contacts else 3.4)
    axes = figure.subplots(2 if contacts else 1, 2, sharex=True, squeeze=False)
    factor, unit = scaled(table["time"], "s")
    time = factor * table["time"]
    _energies(axes[0, 0], time, table)
    _balance(axes[0, 1], time, table)
    if contacts:
        _forces(axes[1, 0], time, table, contacts)
        _gaps(axes[1, 1], time, table, contacts)
    for axis in axes[-1]:
        axis.set_xlabel(f"time [{unit}]")
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure


def _energies(axis: "Axes", time: Array, table: Table) -> None:
    kinetic, strain = table["energy_kinetic"], table["energy_strain"]
    total = kinetic + strain
    factor, unit = scaled(total, "J")
    curves = [("kinetic", kinetic, BLUE, "-"), ("strain", strain, RED, "-"), ("kinetic + strain", total, BLACK, "--")]
    for name, color, label in (("work_external", GREEN, "work of loads"), ("dissipation", ORANGE, "dissipated")):
        if np.abs(table[name]).max() > 1e-3 * np.abs(total).max():
            curves.append((label, table[name], color, "-"))
    for label, values, color, style in curves:
        axis.plot(time, factor * values, style, color=color, label=label)
    axis.set(title="Energy", ylabel=f"energy [{unit}]")
    axis.legend(loc="best")


def _balance(axis: "Axes", time: Array, table: Table) -> None:
    scale = float((table["energy_kinetic"] + table["energy_strain"]).max()) or 1.0
    relative = np.maximum(np.abs(table["energy_error"]) / scale, 1e-17)
    axis.semilogy(time, relative, color=PURPLE, lw=1.2)
    axis.set_ylim(min(1e-17, relative.min()), max(1e-11, 10.0 * relative.max()))
    axis.set(title=f"Energy balance: worst error {relative.max():.1e}", ylabel="|error| / greatest energy")


def _forces(axis: "Axes", time: Array, table: Table, contacts: tuple[str, ...]) -> None:
    """Mean force of each slab, as a staircase."""
    factor, unit = scaled(np.concatenate([table[f"contact.{c}.force_n"] for c in contacts]), "N")
    for contact, color in zip(contacts, _cycle(len(contacts)), strict=True):
        force = factor * table[f"contact.{contact}.force_n"]
        axis.step(time, force, where="pre", color=color, label=contact, lw=1.3)
        axis.fill_between(time, force, step="pre", color=color, alpha=0.15, lw=0)
    axis.set(title="Normal contact force", ylabel=f"force [{unit}]")
    axis.legend(loc="best")


def _gaps(axis: "Axes", time: Array, table: Table, contacts: tuple[str, ...]) -> None:
    factor, unit = scaled(np.concatenate([table[f"contact.{c}.min_gap"] for c in contacts]), "m")
    for contact, color in zip(contacts, _cycle(len(contacts)), strict=True):
        axis.plot(time, factor * table[f"contact.{contact}.min_gap"], color=color, label=contact)
    axis.axhline(0.0, color=BLACK, lw=0.8)
    axis.set(title="Least gap", ylabel=f"gap [{unit}]")


def _cycle(count: int) -> list[str]:
    return [CYCLE[k % len(CYCLE)] for k in range(count)]
