"""The figures as a page of Markdown; those of changed code are left out."""

from collections.abc import Iterable, Mapping
from itertools import groupby
from pathlib import Path

from record.figures import Figure
from record.fingerprint import Origin

HEAD = (Path(__file__).parent / "compared.md").read_text(encoding="utf-8")
"""What is compared, and what is not."""


def page(
    figures: Iterable[Figure], notes: Mapping[str, str], origins: Mapping[str, Origin], changed: Mapping[str, str]
) -> str:
    """The page: for each group a table under the note on what is measured, and where its figures come from.

    A group in ``changed`` has the reason in place of its figures.
    """
    text = HEAD + "\n"
    for group, members in groupby(figures, key=lambda f: f.name.split("/")[0]):
        text += f"## {group.capitalize()}\n\n"
        text += f"{notes[group]}\n\n" if group in notes else ""
        text += f"{told(origins[group])}\n\n" if group in origins else ""
        if group in changed:
            text += f"**Not shown: {changed[group]}. `make bench` measures them anew.**\n\n"
        else:
            rows = list(members)
            text += (machine(rows) if group == "machine" else table(rows)) + "\n"
    return text.rstrip("\n") + "\n"


def told(origin: Origin) -> str:
    """Where the figures of a group come from, as a sentence."""
    return f"Measured on {origin.date} at commit `{origin.commit}`, in {origin.seconds:.0f} s."


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
