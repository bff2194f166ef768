"""History of a run as curves: energies, their balance, contact forces and gaps, probes."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.arrays import Array
from softway.record.pile.summary import energy_scale as energy_scale_of_pile
from softway.record.read.heat_summary import dissipated
from softway.record.read.mechanism_summary import energy_scale
from softway.record.read.records import Records
from softway.record.read.summary import contacts_of, ties_of
from softway.record.storage.table import COUNT, Table
from softway.record.view.options import STANDARD, PictureOptions
from softway.record.view.plots.heat_panels import heat_panels, heat_panels_of_solids
from softway.record.view.style import BLACK, BLUE, CYCLE, GREEN, ORANGE, PURPLE, RED, canvas, scaled
from softway.record.write.history_columns import (
    CERTIFICATE,
    COLUMNS,
    EXTRA,
    HEAT,
    LIQUID,
    NODES,
    REMESHING,
    THROUGH,
    of_tie,
)
from softway.record.write.mechanism.columns import NEEDED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


WORDS = {
    "m": "position or displacement",
    "m/s": "velocity",
    "N": "reaction",
    "rad": "rotation",
    "K": "temperature",
    "rad/s": "angular velocity",
}
"""Quantities of probes by unit."""
LONG = 20
"""Letters from which on a quantity does not fit beside an axis."""


WORKS = (("dissipation", ORANGE, "dissipated", "-"), ("work_external", GREEN, "external work", (0, (4, 4))))
"""Columns with colours, labels and line styles; the external work is dashed, since dissipation often covers it."""
NOISE = 1e-9
"""Gaps and coordinates below this size are rounding errors [m]."""


def history(run: Records, look: PictureOptions = STANDARD) -> "Figure":
    """Figure of energies, energy balance error, contact forces, smallest gaps and probes over time."""
    table, title = run.history, run.provenance.get("title", "")
    factor, unit = scaled(table["time"], "s")
    time, panels = factor * table["time"], _panels_of(run, table)
    if run.of_mechanism:
        panels += [partial(_centres, motion=run.motion, letter=letter) for letter in "xyz"[: run.outline["dim"]]]
    rows = -(-len(panels) // 2)
    figure = canvas(*(look.inches or (9.0, 3.1 * rows + 0.2)))
    axes = figure.subplots(rows, 2, sharex=True, squeeze=False).ravel()
    for draw, axis in zip(panels, axes, strict=False):
        draw(axis, time, table)
    for axis in axes[len(panels) :]:
        axis.remove()
    for axis in axes[max(len(panels) - 2, 0) : len(panels)]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel(f"time [{unit}]")
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure


def _panels_of(run: Records, table: Table) -> "list[Callable[[Axes, Array, Table], None]]":
    """Drawing functions of the panels of a run."""
    if run.of_heat:
        probes = [name for name in table if table.units[name] == "K"]
        return [*heat_panels(table), *([partial(_probes, names=probes)] if probes else [])]
    return _of_pile() if run.of_pile else _panels(table)


def _panels(table: Table) -> "list[Callable[[Axes, Array, Table], None]]":
    """Drawing functions of all panels; probes with the same unit share a panel."""
    contacts = contacts_of(table)
    panels: list[Callable[[Axes, Array, Table], None]] = [energies, balance]
    if contacts:
        panels += [partial(forces, contacts=contacts), partial(gaps, contacts=contacts)]
    known = {column.name for column in (*COLUMNS, *CERTIFICATE, *EXTRA, *HEAT)} | {name for name, _ in NEEDED}
    known |= {name for name in table if name.startswith((THROUGH, LIQUID))}
    if HEAT[0].name in table:
        panels += heat_panels_of_solids(table)
    known |= {NODES.name, REMESHING.name}
    if NODES.name in table and np.ptp(table[NODES.name]) > 0.0:
        panels.append(partial(_told, name=NODES.name, title="Nodes of all meshes", word="nodes"))
    ties = ties_of(table)
    if ties:
        panels.append(partial(_broken, ties=ties))
        known |= {column.name for tie in ties for column in of_tie(tie)}
    probes = [n for n in table if n not in known and not n.startswith("contact.")]
    units = dict.fromkeys(table.units[n] for n in probes)
    return panels + [partial(_probes, names=[n for n in probes if table.units[n] == unit]) for unit in units]


def _of_pile() -> "list[Callable[[Axes, Array, Table], None]]":
    """Drawing functions of the panels of a pile."""
    told = (
        ("overlap", "Greatest overlap", "overlap"),
        ("slip_error", "Miss of the law of friction", "velocity"),
        ("closed_contacts", "Closed contacts", "contacts"),
    )
    return [energies, balance, *(partial(_told, name=name, title=title, word=word) for name, title, word in told)]


def _told(axis: "Axes", time: Array, table: Table, name: str, title: str, word: str) -> None:
    """Draw a column of the history."""
    factor, unit = (1.0, "1") if table.units[name] == COUNT else scaled(table[name], table.units[name])
    axis.plot(time, factor * table[name], color=BLUE, lw=1.2)
    axis.set(title=title, ylabel=word if unit == "1" else f"{word} [{unit}]")
    axis.set_ylim(bottom=0.0, top=None if table[name].any() else 1.0)


def energies(axis: "Axes", time: Array, table: Table) -> None:
    """Draw the energies, and dissipation and external work where they are not negligible."""
    word = "strain" if "energy_strain" in table else "potential"
    kinetic, stored = table["energy_kinetic"], table[f"energy_{word}"]
    total = kinetic + stored
    curves: list[tuple[str, Array, str, Any]] = [
        ("kinetic", kinetic, BLUE, "-"),
        (word, stored, RED, "-"),
        (f"kinetic + {word}", total, BLACK, "--"),
    ]
    for name, color, label, style in WORKS:
        if name not in table:
            continue
        work = dissipated(table) if name == "dissipation" else table[name]
        if np.abs(work).max() > 1e-3 * np.abs(total).max():
            curves.append((label, work, color, style))
    factor, unit = scaled(np.concatenate([values for _, values, _, _ in curves]), "J")
    for label, values, color, style in curves:
        axis.plot(time, factor * values, linestyle=style, color=color, label=label)
    axis.set(title="Energy", ylabel=f"energy [{unit}]")
    axis.legend(loc="best")


def balance(axis: "Axes", time: Array, table: Table) -> None:
    """Draw the error of the energy balance relative to the largest energy."""
    if "energy_strain" in table:
        scale = float(np.abs(table["energy_kinetic"] + table["energy_strain"]).max()) or 1.0
    else:
        scale = (energy_scale if "work_external" in table else energy_scale_of_pile)(table) or 1.0
    relative = np.maximum(np.abs(table["energy_error"]) / scale, 1e-17)
    axis.semilogy(time, relative, color=PURPLE, lw=1.2)
    axis.set_ylim(min(1e-17, relative.min()), max(1e-11, 10.0 * relative.max()))
    axis.set(title=f"Energy balance: largest error {relative.max():.1e}", ylabel="relative error")


def forces(axis: "Axes", time: Array, table: Table, contacts: tuple[str, ...]) -> None:
    """Draw the mean normal force of each slab as a step curve."""
    factor, unit = scaled(np.concatenate([table[f"contact.{c}.force_n"] for c in contacts]), "N")
    for contact, color in zip(contacts, _cycle(len(contacts)), strict=True):
        force = factor * table[f"contact.{contact}.force_n"]
        axis.step(time, force, where="pre", color=color, label=contact, lw=1.3)
        axis.fill_between(time, force, step="pre", color=color, alpha=0.15, lw=0)
    axis.set(title="Normal contact force", ylabel=f"force [{unit}]")
    axis.set_ylim(bottom=0.0, top=None if any(table[f"contact.{c}.force_n"].any() for c in contacts) else 1.0)
    axis.legend(loc="best")


def gaps(axis: "Axes", time: Array, table: Table, contacts: tuple[str, ...]) -> None:
    """Draw the smallest gap of each contact."""
    every = np.concatenate([table[f"contact.{c}.min_gap"] for c in contacts])
    known = every[np.isfinite(every)]
    factor, unit = scaled(np.append(known, NOISE), "m")
    if np.abs(known).max(initial=0.0) < NOISE:
        axis.set_ylim(-factor * NOISE, factor * NOISE)
    axis.axhline(0.0, color=BLACK, lw=0.8)
    for contact, color in zip(contacts, _cycle(len(contacts)), strict=True):
        axis.plot(time, factor * table[f"contact.{contact}.min_gap"], color=color, label=contact)
    axis.set(title="Smallest gap", ylabel=f"gap [{unit}]")
    if len(contacts) > 1:
        axis.legend(loc="best")


def _broken(axis: "Axes", time: Array, table: Table, ties: tuple[str, ...]) -> None:
    """Draw the broken fraction of each tie."""
    for tie, color in zip(ties, _cycle(len(ties)), strict=True):
        axis.plot(time, 100.0 * table[f"tie.{tie}.broken"], color=color, label=tie)
    axis.set(title="Broken fraction of the ties", ylabel="broken [%]")
    axis.set_ylim(0.0, 105.0)
    axis.legend(loc="best")


def _probes(axis: "Axes", time: Array, table: Table, names: list[str]) -> None:
    factor, unit = 1.0, table.units[names[0]]
    if not unit.startswith("rad"):
        factor, unit = scaled(np.concatenate([table[n] for n in names]), unit)
    for name, color in zip(names, _cycle(len(names)), strict=True):
        axis.plot(time, factor * table[name], color=color, label=name)
    word = WORDS[table.units[names[0]]]
    axis.set(title=f"Probes: {word}", ylabel=f"{word if len(word) < LONG else 'length'} [{unit}]")
    axis.legend(loc="best")


def _centres(axis: "Axes", time: Array, table: Table, motion: Table, letter: str) -> None:
    """Draw a coordinate of the centres of rigid bodies."""
    names = [name for name in motion if name.endswith(f".{letter}")]
    every = np.concatenate([motion[n] for n in names])
    factor, unit = scaled(np.append(every, NOISE), "m")
    if np.abs(every).max() < NOISE:
        axis.set_ylim(-factor * NOISE, factor * NOISE)
    rows = min(len(time), motion.rows)
    for name, color in zip(names, _cycle(len(names)), strict=True):
        axis.plot(time[:rows], factor * motion[name][:rows], color=color, label=name.rpartition(".")[0])
    axis.set(title=f"Centres: {letter}", ylabel=f"{letter} [{unit}]")
    axis.legend(loc="best")


def _cycle(count: int) -> list[str]:
    return [CYCLE[k % len(CYCLE)] for k in range(count)]
