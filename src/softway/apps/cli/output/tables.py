"""Tables on the terminal: the scales of a scenario, the summary of a run, the ranking of a race."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table as Grid

from softway.errors import Note
from softway.marching.start.ladder import rungs
from softway.record.pile.summary import told_of_pile
from softway.record.read.findings import sentences
from softway.record.read.heat_summary import told_of_heat
from softway.record.read.mechanism_summary import told
from softway.record.read.summary import UNITS as NUMBERS
from softway.record.run import Run
from softway.record.storage.provenance import CANCELLED, INTERRUPTED
from softway.record.storage.table import RATIO

UNITS = {
    **{name: unit for name, unit in NUMBERS.items() if unit != RATIO},
    "wave_speed": "m/s",
    "length": "m",
    "transit": "s",
    "edge": "m",
    "finest_edge": "m",
    "stable_step": "s",
    "gap": "m",
    "approach": "m/s",
    "duration": "s",
    "wall": "s",
    "cpu": "s",
    "first_slab_cpu": "s",
    "slab_cpu": "s",
    "penetration": "m",
    "least_force": "N",
    "distance": "m",
    "mass": "kg",
    "speed": "m/s",
    "spin": "rad/s",
    "radius_least": "m",
    "radius_greatest": "m",
    "overlap_worst": "m",
    "slip_error_worst": "m/s",
    "energy_kinetic_end": "J",
    "temperature_least": "K",
    "temperature_greatest": "K",
    "heat_content_end": "J",
    "heat_in": "J",
    "heat_out": "J",
    "heat_error_worst": "J",
    "heat_brought": "J",
    "heat_received": "J",
    "heat_reversible": "J",
    "heat_friction": "J",
    "cold_work": "J",
    "liquid": "m^3",
    "temperature": "K",
    "entropy_produced": "J/K",
    "entropy_least": "J/K",
}
WORDS = {
    "stable_step": "stable step (Momentum)",
    "duration": "expected duration",
    "approach": "approach speed",
    "transit": "wave transit time",
    "edge": "smallest edge",
    "finest_edge": "smallest edge, adapted",
    "dofs": "free components",
    "wall": "wall time",
    "cpu": "CPU time",
    "first_slab_cpu": "CPU time, first slab",
    "slab_cpu": "CPU time of a slab (median)",
    "energy_drift": "energy error (relative)",
    "distance": "distance at the end",
    "peak_force": "peak force (mean of a slab)",
}
RACE = (
    "slabs",
    "iterations_mean",
    "iterations_max",
    "factorisations",
    "rejected",
    "wall",
    "cpu",
    "first_slab_cpu",
    "slab_cpu",
    "energy_drift",
    "penetration",
    "least_force",
    "distance",
)
"""Numbers shown for each method of a race."""
COLUMNS = 6
"""Greatest number of bodies or contacts side by side."""


def scales(checked: Any, console: Console, most: int | None = None) -> None:
    """Print the scales of a scenario, its number of slabs, at most ``most``, and the notes on it."""
    title = checked.scenario.title
    if title:
        console.print(title, style="bold", markup=False)
    _columns(_merged("body", checked.bodies), console)
    _columns(_merged("contact", getattr(checked, "contacts", {})), console)
    end = checked.scenario.time.end
    some = f"{most} of " if most is not None and most < checked.slabs else ""
    longer = _growth(checked) if most is None else ""
    console.print(f"{some}{checked.slabs} slabs of {checked.step:.6g} s until {end:.6g} s{longer}\n", markup=False)
    _notes(checked.notes, console)


def _growth(checked: Any) -> str:
    """How far slabs grow under a tolerance; empty where all have the length that is told."""
    bound = getattr(checked, "tolerance", None)
    if bound is None:
        return ""
    longest = 2 ** rungs(checked.march_state.settings)
    return f"; smooth ones grow up to {longest} times (tolerance {bound:g})"


def summary(run: Run, console: Console) -> None:
    """Print the numbers of a run, the notes on its scenario, and the reason why it stopped."""
    found, stop, title = run.summary, run.stop, run.provenance.get("title", "")
    if title:
        console.print(title, style="bold", markup=False)
    plain = {k: v for k, v in found.items() if isinstance(v, int | float) and not isinstance(v, bool)}
    _columns({"run": plain}, console)
    _columns({f"contact {n}": c for n, c in found["contacts"].items()}, console)
    _columns({f"stop {n}": c for n, c in found.get("stops", {}).items()}, console)
    if found.get("heat"):
        _columns({"heat of solids": found["heat"]}, console)
    if found.get("mesh"):
        _columns({"meshes that change": found["mesh"]}, console)
    if found.get("certificate"):
        _columns({"certificate (worst slab)": found["certificate"]}, console)
    _notes((Note(**note) for note in found.get("notes", ())), console)
    findings(found.get("findings", ()), console)
    for sentence in sentences_of(run, found):
        console.print(sentence, markup=False, soft_wrap=True, highlight=False)
    console.print(f"{run.status}{': ' if stop.message else ''}{stop.message}", markup=False, soft_wrap=True)
    if stop in (INTERRUPTED, CANCELLED):
        console.print(f"resume with: softway resume {run.path}", markup=False, soft_wrap=True, highlight=False)
    console.print(f"records: {run.path}", markup=False, soft_wrap=True, highlight=False)


def sentences_of(run: Run, found: Mapping[str, Any]) -> tuple[str, ...]:
    """Sentences on the run of a mechanism, a pile or conductors with its summary; none of solids."""
    if run.of_heat:
        return told_of_heat(found)
    if run.of_pile:
        return told_of_pile(found)
    return told(found) if run.of_mechanism else ()


def findings(found: Sequence[Mapping[str, Any]], console: Console) -> None:
    """Print the findings of an audit, one line each."""
    for sentence in sentences(found):
        console.print(f"finding: {sentence}", markup=False, soft_wrap=True, highlight=False)


def _notes(notes: Iterable[Note], console: Console) -> None:
    for note in notes:
        console.print("[bold yellow]note[/]", escape(str(note)), soft_wrap=True, highlight=False)


def ranking(found: Mapping[str, Any], console: Console) -> None:
    """Print the results of a race, one column per method, and the reasons of failures."""
    methods = found["methods"]
    _columns({name: {key: _short(method[key]) for key in RACE} for name, method in methods.items()}, console)
    for name, method in methods.items():
        failed = f"; failed: {method['reason']}" if method["reason"] else ""
        console.print(f"{name}: {method['method']}{failed}", markup=False, soft_wrap=True, highlight=False)
    if found["reference"]:
        console.print(f"distance at the end: greatest distance of a node from '{found['reference']}'", highlight=False)


def _short(value: float | int | None) -> str | int | None:
    """Value with three significant digits."""
    return f"{value:.3g}" if isinstance(value, float) else value


def _numbers(item: Any) -> dict[str, Any]:
    numbers = {f.name: getattr(item, f.name) for f in fields(item)} if is_dataclass(item) else dict(item)
    return {name: value for name, value in numbers.items() if value is not None}


def _merged(what: str, items: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Numbers by heading; neighbours that read the same, such as copies of a body, have one column."""
    runs: list[tuple[str, str, dict[str, Any]]] = []
    for name, item in items.items():
        numbers = {key: _cell(value) for key, value in _numbers(item).items()}
        first = name
        if runs and runs[-1][2] == numbers:
            first = runs.pop()[0]
        runs.append((first, name, numbers))
    return {f"{what} {a}" if a == b else f"{what} {a} to {b}": numbers for a, b, numbers in runs}


def _columns(items: dict[str, dict[str, Any]], console: Console) -> None:
    """Print one column per item and one line per number."""
    names = list(items)
    for start in range(0, len(names), COLUMNS):
        chosen = names[start : start + COLUMNS]
        grid = Grid(box=None, pad_edge=False, header_style="bold")
        grid.add_column("")
        for name in chosen:
            grid.add_column(name, justify="right", overflow="fold")
        grid.add_column("")
        for key in dict.fromkeys(k for name in chosen for k in items[name]):
            cells = [_cell(items[name].get(key)) for name in chosen]
            unit = UNITS.get(key) or UNITS.get(key.partition(".")[0], "")
            grid.add_row(WORDS.get(key, key.replace("_", " ").replace(".", " of ")), *cells, unit)
        console.print(grid)
        console.print()


def _cell(value: Any) -> str:
    return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)
