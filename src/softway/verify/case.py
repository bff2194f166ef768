"""A case of the suite, what it computes, and the file that states it."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module, resources
from typing import Any

from softway.record.view_curves import Panel


@dataclass(frozen=True, slots=True, kw_only=True)
class Beside:
    """Figures of others beside ours: a title, heads of columns, rows of cells (the last one ours), and what to know."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What a case computed.

    Parameters
    ----------
    values
        By the names of the quantities in the file of the case.
    panels
        Curves for the report.
    tables
        Figures of others beside ours, for the report.
    """

    values: Mapping[str, Any]
    panels: tuple[Panel, ...] = ()
    tables: tuple[Beside, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A case: its ``id``, the ``seconds`` it takes, and the ``module`` with ``compute``, by default that of the id."""

    id: str
    seconds: float
    module: str = ""

    @property
    def compute(self) -> Callable[[], Outcome]:
        """The function that computes it."""
        module = import_module(self.module or f"softway.verify.cases.{self.id.lower()}")
        compute: Callable[[], Outcome] = module.compute
        return compute

    @property
    def sheet(self) -> Mapping[str, Any]:
        """Its file."""
        return sheet(self.id)

    @property
    def title(self) -> str:
        """One line."""
        return str(self.sheet["title"])


def sheet(name: str) -> dict[str, Any]:
    """The file that states a case.

    Examples
    --------
    >>> sheet("A02")["definition"]["gaps"]
    [0.0, 0.3]
    """
    file = resources.files("softway.verify") / "data" / f"{name}.json"
    return dict(json.loads(file.read_text(encoding="utf-8")))
