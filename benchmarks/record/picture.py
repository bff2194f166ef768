"""Picture of time against error, from the figures of the group ``adapted``."""

from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

from record.figures import Figure

LABELS = {"uniform": "uniform mesh", "adapted": "adapted mesh"}


def drawn(figures: Iterable[Figure], path: Path) -> None:
    """Draw processor time over error, a panel for each problem, into a file; nothing without figures.

    A run that counts as exact is a broken line at its time.
    """
    known: dict[str, dict[str, dict[str, Figure]]] = defaultdict(lambda: defaultdict(dict))
    for figure in figures:
        if figure.name.startswith("adapted/") and ", cells of " in figure.name:
            problem, cells, kind = figure.name.split("/", 1)[1].rsplit(", ", 2)
            known[problem][cells][kind] = figure
    if not known:
        return
    picture, axes = plt.subplots(1, len(known), figsize=(3.4 * len(known), 3.2), layout="constrained", squeeze=False)
    for panel, (problem, cells) in zip(axes[0], known.items(), strict=True):
        for number, (label, marker) in enumerate(zip(LABELS.values(), "os", strict=True)):
            pairs = [_pair(found, uniform=number == 0) for found in cells.values()]
            shown = [(error, time) for error, time in pairs if error > 0.0]
            (line,) = panel.loglog(*zip(*shown, strict=True), marker=marker, label=label)
            for time in (time for error, time in pairs if error == 0.0):  # the run that counts as exact
                panel.axhline(time, color=line.get_color(), linestyle="--")
        panel.set(title=problem, xlabel="error [%]", ylabel="processor time [s]")
        panel.grid(visible=True, which="both", alpha=0.3)
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
    axes[0][0].legend()
    picture.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(picture)


def _pair(found: dict[str, Figure], uniform: bool) -> tuple[float, float]:
    """Error [%] and time [s] of a run."""
    error, time = found["error"], found["time"]
    values = (error.baseline, time.baseline) if uniform else (error.value, time.value)
    return float(values[0] or 0.0), float(values[1] or 0.0)
