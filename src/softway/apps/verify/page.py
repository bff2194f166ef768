"""Report of the suite as one self-contained HTML page."""

import platform
from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from importlib.metadata import PackageNotFoundError, version

from softway.apps.verify.case import Beside
from softway.apps.verify.report import Row, causes, rows, verdict
from softway.apps.verify.result import Result
from softway.record.view.plots.curves import Curve, Panel, drawing

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .3rem; }
table { border-collapse: collapse; margin: .6rem 0; font-size: .88rem; }
th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid #e4e4e4; }
th:first-child, td:first-child, .left { text-align: left; }
tr.ours td { font-weight: 600; } .pass { color: #00704f; } .fail { color: #b43c00; font-weight: 600; }
p.small, ul { font-size: .88rem; color: #555; } img { max-width: 100%; display: block; margin: .5rem 0; }
nav a { margin-right: .6rem; white-space: nowrap; } .wide { overflow-x: auto; }
td:not(:first-child) { white-space: nowrap; }
@media (max-width: 40rem) {
  body { margin: 1rem auto; } h1 { font-size: 1.35rem; } table { font-size: .8rem; }
  th, td { padding: .2rem .3rem; } td:first-child { min-width: 8rem; } nav { line-height: 2; }
}
@media print {
  body { max-width: none; margin: 0; font-size: 10pt; } h2, p { break-after: avoid; } tr, img { break-inside: avoid; }
  nav { display: none; } .wide { overflow-x: visible; } img { max-height: 20cm; }
}
"""
HEADS = ("quantity", "reference", "softway", "error", "tolerance", "")


def page(results: Sequence[Result]) -> str:
    """HTML page with the verdict, the causes of failures, and each case with its quantities and curves.

    Examples
    --------
    >>> from softway.apps.verify import chosen, examined
    >>> text = page([examined(chosen(["A01"])[0])])
    >>> text.startswith("<!DOCTYPE html>"), "http" in text.replace("http://www.w3.org", "")
    (True, False)
    """
    links = " ".join(f'<a class="{_word(r.passed)}" href="#{r.case.id}">{r.case.id}</a>' for r in results)
    body = [
        "<h1>Verification of softway</h1>",
        f"<p>{verdict(results)}.</p>",
        f'<p class="small">{escape(_circumstances(results))}</p>',
        _list(causes(results)),
        f"<nav>{links}</nav>",
        _picture((_overview(results),), "Error relative to the tolerance for every quantity"),
        *(_section(result) for result in results),
    ]
    meta = '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    head = f"{meta}<title>Verification of softway</title><style>{STYLE}</style>"
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head><body>\n' + "\n".join(body) + "\n</body></html>\n"


def _section(result: Result) -> str:
    """Section of a case: title, table, pictures."""
    complaint = f'<p class="fail">Not computed: {escape(result.complaint)}</p>' if result.complaint else ""
    parts = [
        f'<h2 id="{result.case.id}">{result.case.id} {escape(result.case.title)}</h2>',
        f'<p class="small">{escape(_source(result))}{result.wall:.1f} s.</p>',
        complaint,
        _table(HEADS, [_cells(row) for row in rows([result])]),
        _picture(result.panels, f"Curves of {result.case.id}"),
        *(_beside(beside) for beside in result.tables),
    ]
    return "\n".join(part for part in parts if part)


def _source(result: Result) -> str:
    source = str(result.case.sheet["reference"].get("source", "")).rstrip(".")
    return f"Reference: {source}. " if source else ""


def _cells(row: Row) -> tuple[str, ...]:
    word = _word(row.passed)
    numbers = (row.quantity, row.reference, row.ours, row.error, row.tolerance)
    return (*(escape(text) for text in numbers), f'<span class="{word}">{word}</span>')


def _word(passed: bool) -> str:
    return "pass" if passed else "fail"


def _table(heads: Iterable[str], body: Sequence[Sequence[str]], ours: int = -1) -> str:
    """HTML table of cells that are HTML already."""
    lines = ["<tr>" + "".join(f"<th>{head}</th>" for head in heads) + "</tr>"]
    for k, cells in enumerate(body):
        mark = ' class="ours"' if k == ours else ""
        lines.append(f"<tr{mark}>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    return '<div class="wide"><table>' + "\n".join(lines) + "</table></div>"


def _beside(beside: Beside) -> str:
    """Table of results of other codes, with softway in the last line."""
    body = [[escape(cell) for cell in row] for row in beside.rows]
    grid = _table([escape(head) for head in beside.heads], body, len(body) - 1)
    return f'<p><b>{escape(beside.title)}</b></p>{grid}<p class="small">{escape(beside.note)}</p>'


def _list(sentences: Sequence[str]) -> str:
    return "<ul>" + "".join(f"<li>{escape(s)}</li>" for s in sentences) + "</ul>" if sentences else ""


def _picture(panels: Sequence[Panel], told: str) -> str:
    """Drawing as a separate image, so that its internal names do not clash with others."""
    if not panels:
        return ""
    data = b64encode(drawing(panels).encode()).decode()
    return f'<img alt="{escape(told)}" src="data:image/svg+xml;base64,{data}">'


def _overview(results: Sequence[Result]) -> Panel:
    """Plot of error / tolerance of all quantities, in the order of the table."""
    ratios = [max(q.error / q.tolerance, 1e-8) for r in results for q in r.quantities if q.value is not None]
    places = list(range(1, len(ratios) + 1))
    curves = (
        Curve(x=places, y=ratios, kind="dots"),
        Curve(x=[0, len(ratios) + 1], y=[1.0, 1.0], kind="exact", label="allowed"),
    )
    return Panel(title="Every quantity", x="line of the table", y="error / tolerance", curves=curves, log="y")


def _circumstances(results: Sequence[Result]) -> str:
    """Versions, machine and computing time."""
    packages = ", ".join(f"{name} {_version(name)}" for name in ("softway", "numpy", "scipy", "numba"))
    wall = sum(result.wall for result in results)
    return f"{packages}, Python {platform.python_version()}, {platform.machine()}; {wall:.0f} s of computation."


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "?"
