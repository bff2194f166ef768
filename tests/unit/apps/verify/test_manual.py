"""The page of the manual follows from the table of the suite."""

import json
import runpy
from pathlib import Path

from softway.apps.verify import chosen, examined
from softway.apps.verify.report import in_json

DOCS = Path(__file__).parents[4] / "docs"
SCRIPT = DOCS / "scripts" / "manual.py"


def test_the_page(tmp_path: Path) -> None:
    lines = json.loads(in_json([examined(chosen(["A01"])[0])]))
    lines[2]["value"] = 3.0
    table, target = tmp_path / "table.json", tmp_path / "page.md"
    table.write_text(json.dumps(lines))
    assert runpy.run_path(str(SCRIPT))["main"]([str(table), str(target)]) == 0
    text = target.read_text()
    assert "**2 of 3 quantities of 1 cases are within their tolerance.**" in text
    assert "| stability limit of const weighting | 3.46410 | 3.00000 | 4.6e-01 | 3.5e-06 | **no** |" in text
    assert "* A01, stability limit of const weighting: the cause is not known" in text


def test_figures_of_other_programs_are_in_it() -> None:
    script = runpy.run_path(str(SCRIPT))
    assert "| Akantu 5.0.7, explicit tetrahedra, 252 steps | 1.7 |" in script["_others"](chosen(["peers"])[0])


def test_every_line_of_the_suite_is_in_the_manual() -> None:
    """The page under version control was written after the last case was added; `make manual` renews it."""
    page = (DOCS / "verification" / "manual.md").read_text(encoding="utf-8")
    headings = [line.split()[1] for line in page.splitlines() if line.startswith("## ")]
    known = [case.id for case in chosen()]
    assert headings == [name for name in known if name in headings]
    assert {name for name in known if name[0] in "AB" or not name[0].isupper()} <= set(headings)
