"""Sphinx: the directive ``scenario-keys``, a table of every key that a scenario may have."""

import re
from typing import Any

from docutils import nodes
from fields import default_of
from sphinx.util.docutils import SphinxDirective

from softway.scenario.class_index import keys
from softway.scenario.hints.docstrings import described
from softway.scenario.hints.type_hints import Hint, hints

HEAD = ("key", "of", "default, unit", "meaning")


class ScenarioKeys(SphinxDirective):
    """The table, made of the docstrings when the page is."""

    def run(self) -> list[nodes.Node]:
        """Its nodes; the page is made anew each time, since its source does not say when a docstring changes."""
        self.env.note_reread()
        lines = [_row(HEAD), _row(("---",) * len(HEAD))]
        for key, owners in sorted(keys().items(), key=lambda item: item[0].lower()):
            lines += [_row((f"`{key}`", *_cells(cls, key))) for cls in owners]
        return self.parse_text_to_nodes("\n".join(lines))


def setup(app: Any) -> dict[str, bool]:
    """Add the directive."""
    app.add_directive("scenario-keys", ScenarioKeys)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _cells(cls: type, key: str) -> tuple[str, ...]:
    """Class, default with unit, and meaning of a key."""
    text = re.sub(r":\w+:`~?([^`]*\.)?(\w+)`", r"`\2`", described(cls).fields.get(key, ""))
    default, unit = default_of(cls, key), Hint.of(hints(cls)[key], None).unit
    standard = " ".join([f"`{default}`"] * bool(default) + [f"[{unit}]"] * bool(unit))
    return f"{{py:obj}}`{cls.__name__} <{cls.__module__}.{cls.__qualname__}>`", standard, text


def _row(cells: tuple[str, ...]) -> str:
    return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"
