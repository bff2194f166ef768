"""Picture of a race: CPU time and iterations of each method as bars, iterations and energy error over time."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from softway.errors import InputError
from softway.record.view.style import BLACK, CYCLE, canvas, library, scaled, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROUNDING = 1e-17
"""Smallest relative energy error that is drawn."""


def picture(found: Mapping[str, Any], file: Path) -> Path:
    """Draw the record of a race into a file; the file extension gives the format.

    Parameters
    ----------
    found
        Record from :func:`softway.studies.race.report.record`, or read from its JSON file.
    file
        Picture to write.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    with styled():
        figure = drawn(found)
        try:
            figure.savefig(file, dpi=160, facecolor="white")
        except (OSError, ValueError) as error:
            raise InputError("out", f"cannot write '{file}': {error}", "a file such as picture.png") from None
    return file


def drawn(found: Mapping[str, Any]) -> "Figure":
    """Figure of four panels, with one colour for each method."""
    methods = found["methods"]
    colours = {name: CYCLE[k % len(CYCLE)] for k, name in enumerate(methods)}
    figure = canvas(10.0, 6.6)
    (first, second), (third, fourth) = figure.subplots(2, 2)
    _times(first, methods, colours)
    _counts(second, methods, colours)
    _iterations(third, methods, colours)
    _energies(fourth, methods, colours)
    if found.get("title"):
        figure.suptitle(found["title"], x=0.01, ha="left", fontsize=12, fontweight="bold")
    return figure


def _times(axis: "Axes", methods: Mapping[str, Any], colours: Mapping[str, str]) -> None:
    """Draw the CPU time of all slabs; failed methods are hatched."""
    values = [m["cpu"] for m in methods.values()]
    factor, unit = scaled(np.array(values or [0.0]), "s")
    _bars(axis, methods, colours, [factor * v for v in values])
    axis.set(title="CPU time of all slabs", xlabel=f"time [{unit}]")


def _counts(axis: "Axes", methods: Mapping[str, Any], colours: Mapping[str, str]) -> None:
    """Draw the mean number of iterations per slab, with a mark at the maximum."""
    _bars(axis, methods, colours, [m["iterations_mean"] or 0.0 for m in methods.values()])
    axis.plot([m["iterations_max"] for m in methods.values()], range(len(methods)), "|", color=BLACK, ms=12, mew=1.5)
    axis.set(title="Iterations per slab: mean and maximum", xlabel="iterations")


def _bars(axis: "Axes", methods: Mapping[str, Any], colours: Mapping[str, str], values: list[float]) -> None:
    for k, ((name, method), value) in enumerate(zip(methods.items(), values, strict=True)):
        failed = bool(method["reason"])
        axis.barh(k, value, color=colours[name], alpha=0.4 if failed else 0.9, hatch="///" if failed else None)
        axis.annotate(
            f" failed after {method['slabs']} slabs" if failed else f" {value:.3g}", (value, k), va="center", fontsize=9
        )
    axis.set_yticks(range(len(methods)), list(methods))
    axis.invert_yaxis()
    axis.grid(visible=False, axis="y")
    axis.margins(x=0.25)


def _iterations(axis: "Axes", methods: Mapping[str, Any], colours: Mapping[str, str]) -> None:
    times = [lap["time"] for m in methods.values() for lap in m["laps"]]
    factor, unit = scaled(np.array(times or [0.0]), "s")
    for name, method in methods.items():
        laps = method["laps"]
        time = [factor * lap["time"] for lap in laps]
        axis.plot(time, [lap["iterations"] for lap in laps], color=colours[name], label=name, lw=1.2)
    axis.set(title="Iterations of each slab", xlabel=f"time [{unit}]", ylabel="iterations")
    axis.set_ylim(bottom=0)
    axis.yaxis.set_major_locator(library().ticker.MaxNLocator(integer=True))


def _energies(axis: "Axes", methods: Mapping[str, Any], colours: Mapping[str, str]) -> None:
    times = [lap["time"] for m in methods.values() for lap in m["laps"]]
    factor, unit = scaled(np.array(times or [0.0]), "s")
    for name, method in methods.items():
        laps = method["laps"]
        greatest = max([method["initial_energy"], *(lap["energy"] for lap in laps)]) or 1.0
        error = [max(abs(lap["error"]) / greatest, ROUNDING) for lap in laps]
        axis.semilogy([factor * lap["time"] for lap in laps], error, color=colours[name], label=name, lw=1.2)
    axis.set(title="Error of the energy balance", xlabel=f"time [{unit}]", ylabel="|error| / largest energy")
    if methods:
        axis.legend(loc="best")
