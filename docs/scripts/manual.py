"""The page of the verification manual from the table of the suite.

``python docs/scripts/manual.py TABLE.json PAGE.md`` writes it.  The table is what ``softway verify --json TABLE.json``
writes; ``make manual`` does both.
"""

import json
import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from softway.apps.verify import Case, Result, compared, listed
from softway.apps.verify.report import causes, rows, verdict

HEAD = """# Verification manual

Cases whose solution is known, computed by `softway verify` (softway {version}) and compared with it. `make manual`
computes them anew and writes this page; `softway verify A02` computes one of them on your machine, `softway verify
--quick` those of a few seconds, and both write a page with curves. Each case is a file of `softway/verify/data`, which
states it in full, and a module of `softway/verify/cases`. Of quantities that are many numbers the one with the greatest
error is shown.

**{verdict}.**
"""
HEADS = "| quantity | reference | softway | error | tolerance | pass |\n|---|--:|--:|--:|--:|---|"


def results(table: Sequence[Mapping[str, Any]]) -> tuple[Result, ...]:
    """What the suite found, from its table; cases that are not in it are left out."""
    values: dict[str, dict[str, Any]] = {}
    for line in table:
        values.setdefault(line["case"], {})[line["quantity"]] = line["value"]
    return tuple(
        Result(case=case, quantities=compared(case.sheet, values[case.id])) for case in listed() if case.id in values
    )


def page(found: Sequence[Result]) -> str:
    """The manual."""
    parts = [HEAD.format(version=version("softway"), verdict=verdict(found))]
    if missed := causes(found):
        told = "\n".join(f"* {cell(sentence)}" for sentence in missed)
        parts.append(f"Outside their tolerance, and why:\n\n{told}\n")
    parts += [section(result) for result in found]
    return "\n".join(parts)


def section(result: Result) -> str:
    """A case: its reference and its table."""
    lines = [HEADS]
    for r in rows([result]):
        passed = "yes" if r.passed else "**no**"
        lines.append(f"| {cell(r.quantity)} | {r.reference} | {r.ours} | {r.error} | {r.tolerance} | {passed} |")
    grid = "\n".join(lines)
    return f"## {result.case.id} {result.case.title}\n\n{_told(result.case)}{grid}\n{_others(result.case)}"


def _told(case: Case) -> str:
    source = str(case.sheet["reference"].get("source", "")).rstrip(".")
    return f"Reference: {cell(source)}.\n\n" if source else ""


def _others(case: Case) -> str:
    """Figures of other schemes or packages, where the file of the case has them."""
    reference = case.sheet["reference"]
    if "others" not in reference:
        return ""
    heads = reference["heads"]
    grid = [heads, ["---"] * len(heads), *reference["others"]]
    lines = "\n".join("| " + " | ".join(row) + " |" for row in grid)
    return f"\n{reference['caption']}:\n\n{lines}\n\n{reference['note']}\n"


def cell(text: str) -> str:
    """Text that Markdown leaves as it is."""
    for sign in "\\|*_$<":
        text = text.replace(sign, f"\\{sign}")
    return text


def main(arguments: list[str]) -> int:
    """Write the page."""
    if len(arguments) != 2:
        sys.exit(__doc__)
    table, target = (Path(a) for a in arguments)
    target.write_text(page(results(json.loads(table.read_text(encoding="utf-8")))), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
