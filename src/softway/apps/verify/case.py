"""Case of the suite, its outcome, and its data file."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module, resources
from typing import Any

from softway.record.view.plots.curves import Panel


@dataclass(frozen=True, slots=True, kw_only=True)
class Beside:
    """Table of results of other codes: title, column heads, rows of cells (the last one is softway), and a note."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """Outcome of the computation of a case.

    Parameters
    ----------
    values
        Values by the names of the quantities in the file of the case.
    panels
        Curves for the report.
    tables
        Comparisons with other codes, for the report.
    """

    values: Mapping[str, Any]
    panels: tuple[Panel, ...] = ()
    tables: tuple[Beside, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Case with its ``id``, its computing time in ``seconds``, and the ``module`` with ``compute``."""

    id: str
    seconds: float
    module: str

    @property
    def compute(self) -> Callable[[], Outcome]:
        """Function that computes the case."""
        module = import_module(self.module)
        compute: Callable[[], Outcome] = module.compute
        return compute

    @property
    def sheet(self) -> Mapping[str, Any]:
        """Content of the data file."""
        return sheet(self.id)

    @property
    def title(self) -> str:
        """Title, one line."""
        return str(self.sheet["title"])


def sheet(name: str) -> dict[str, Any]:
    """Read the data file of a case.

    Examples
    --------
    >>> sheet("A02")["definition"]["gaps"]
    [0.0, 0.3]
    """
    groups = (resources.files("softway.apps.verify") / "data").iterdir()
    (file,) = (found for group in groups if (found := group / f"{name}.json").is_file())
    return dict(json.loads(file.read_text(encoding="utf-8")))
