"""Run: the reader of a run folder, finished, interrupted or still growing."""

import json
import shutil
import tempfile
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from softway.errors import InputError
from softway.record import events, fields, history, provenance, summary, table
from softway.record.frames import Fields
from softway.record.provenance import Stop
from softway.record.table import Table

if TYPE_CHECKING:
    from softway.record.view import Picture

SCENARIO = "scenario.toml"


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Scratch:
    """A temporary folder that vanishes with the last object that holds it."""

    path: Path


def scratch() -> Scratch:
    """A new temporary folder for a run without a name."""
    made = Scratch(Path(tempfile.mkdtemp(prefix="softway-")))
    weakref.finalize(made, shutil.rmtree, made.path, ignore_errors=True)
    return made


@dataclass(frozen=True, slots=True, eq=False, init=False)
class Run:
    """A run folder; every property reads the files as they are at that moment.

    Parameters
    ----------
    path
        The folder.
    keep
        Whatever must live as long as the folder does (temporary folders).

    Raises
    ------
    InputError
        When ``path`` is no run folder.
    """

    path: Path
    keep: object = field(repr=False)

    def __init__(self, path: str | Path, keep: object = None) -> None:
        object.__setattr__(self, "path", Path(path))
        object.__setattr__(self, "keep", keep)
        if not (self.path / provenance.FILE).is_file():
            raise InputError("", f"no run folder: '{self.path}'", "a folder that 'softway run --out' has written")

    @property
    def history(self) -> Table:
        """A row per accepted slab; the first is the initial situation."""
        return table.read(self.path / history.FILE, history.COLUMNS)

    @property
    def events(self) -> Table:
        """A row per touch or release of a node."""
        return table.read(self.path / events.FILE, events.COLUMNS)

    @property
    def fields(self) -> Fields:
        """The frames: ``len``, ``[k]``, ``times``, ``cells``, ``to_pyvista(k)``."""
        return Fields(self.path / fields.FILE, self.keep)

    @property
    def provenance(self) -> Mapping[str, Any]:
        """Versions, platform, start, stop and its reason."""
        return _notes(self.path / provenance.FILE, "the run folder as it was written")

    @property
    def summary(self) -> Mapping[str, Any]:
        """The run in a few numbers; computed on the spot while the run has not ended."""
        written = self.path / summary.FILE
        if written.is_file():
            return _notes(written, "to delete it: its numbers follow from history.csv")
        return summary.summarise(self.history, self.events)

    @property
    def scenario(self) -> str:
        """Text of the resolved scenario."""
        written = self.path / SCENARIO
        return written.read_text(encoding="utf-8") if written.is_file() else ""

    def plot(
        self, what: Literal["bodies", "history"] = "bodies", *, colour: str | None = None, times: Sequence[float] = ()
    ) -> "Picture":
        """A picture for notebooks and files.

        Parameters
        ----------
        what
            The bodies (of bars: their paths), or the history as curves.
        colour
            Field that colours the bodies, as of ``softway plot --field``.
        times
            Instants of the bodies [s].

        Raises
        ------
        InputError
            There is no such picture, field or instant.
        """
        from softway.record.look import Look
        from softway.record.view import picture

        return picture(self, what, Look(field=colour, times=tuple(times)))

    def _repr_html_(self) -> str:
        """A table and a picture for notebooks; nothing is drawn before there is a frame."""
        from softway.record.notebook import shown

        return shown(self)

    @property
    def stop(self) -> Stop:
        """Why the run stopped, or that it is running."""
        found = self.provenance
        return Stop(found["stop_reason"], found["message"])


def _notes(file: Path, remedy: str) -> dict[str, Any]:
    """What a JSON file of the folder holds."""
    try:
        return dict(json.loads(file.read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError) as error:
        raise InputError(str(file), f"cannot be read: {error}", remedy) from None
