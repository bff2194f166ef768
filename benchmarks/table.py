"""The figures as a page of Markdown."""

from collections.abc import Iterable
from itertools import groupby

from figures import Figure

HEAD = """# Measured

`make bench` measures this page and `benchmarks/results/latest.json`; `make bench-check` takes the short measurements
again and names every ratio that got worse by more than a fifth. A ratio compares two things measured in one run; with
`>=` more is better. Where a target is given, it is for the ratio, or for the value if there is no ratio.

"""


def page(figures: Iterable[Figure], notes: dict[str, str]) -> str:
    """The page: a table for each group, under the note on what is measured."""
    text = HEAD
    for group, members in groupby(figures, key=lambda f: f.name.split("/")[0]):
        text += f"## {group.capitalize()}\n\n"
        text += f"{notes[group]}\n\n" if group in notes else ""
        rows = list(members)
        text += machine(rows) if group == "machine" else table(rows)
        text += "\n"
    return text.rstrip("\n") + "\n"


def machine(figures: Iterable[Figure]) -> str:
    """The description of the machine as a list."""
    return "".join(f"* {_last(f.name)}: {f.value}\n" for f in figures)


def table(figures: Iterable[Figure]) -> str:
    """A table of figures of one group."""
    rows = ["| what | value | unit | against | ratio | target | met |", "|-|-|-|-|-|-|-|"]
    for f in figures:
        met = {None: "", True: "yes", False: "**no**"}[f.passed]
        cells = (_last(f.name), _number(f.value), f.unit, _number(f.baseline), _number(f.ratio), f.target or "", met)
        rows.append("| " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def _last(name: str) -> str:
    return name.split("/", 1)[1]


def _number(value: float | str | None) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else f"{value:.3g}"
