"""Small HTML tables for notebooks."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape

CELL = "text-align:left; padding:1px 12px 1px 0; vertical-align:top"


def table(title: str, rows: Mapping[str, object]) -> str:
    """HTML table of names and values; line breaks in a text value are kept.

    Examples
    --------
    >>> table("a < b", {"x": 1})[:29]
    '<div><strong>a &lt; b</strong'
    """
    lines = "".join(
        f'<tr><th style="{CELL}; font-weight:normal; opacity:.65">{escape(name)}</th>'
        f'<td style="{CELL}">{_text(value)}</td></tr>'
        for name, value in rows.items()
    )
    return f"<div><strong>{escape(title)}</strong><table>{lines}</table></div>"


def grid(title: str, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """HTML table with a row of headings.

    Examples
    --------
    >>> grid("two", ["x", "y"], [(1, 2.5)]).count("<td")
    2
    """
    head = "".join(f'<th style="{CELL}; opacity:.65">{escape(name)}</th>' for name in heads)
    lines = "".join(f"<tr>{''.join(f'<td style={CELL!r}>{_text(value)}</td>' for value in row)}</tr>" for row in rows)
    return f"<div><strong>{escape(title)}</strong><table><tr>{head}</tr>{lines}</table></div>"


def _text(value: object) -> str:
    """HTML text of a value; floats have four digits."""
    return escape(f"{value:.4g}" if isinstance(value, float) else str(value)).replace("\n", "<br>")
