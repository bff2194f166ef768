"""Where the records of a run go."""

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from softway.errors import InputError
from softway.record import provenance
from softway.record.lock import held
from softway.record.run import Scratch, scratch


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Place:
    """Where the records go.

    Parameters
    ----------
    out
        Folder to be made; ``None`` for a temporary one that lives as long as its :class:`Run`.
    overwrite
        Whether a run folder of that name may be replaced.
    """

    out: Path | None = None
    overwrite: bool = False

    def check(self) -> None:
        """Refuse a folder that holds something else, before anything is computed."""
        if self.out is None:
            return
        if not self.out.exists():
            self._reachable(self.out)
            return
        if not self.out.is_dir():
            raise InputError("out", f"'{self.out}' is a file", "the name of a folder")
        ours = (self.out / provenance.FILE).is_file()
        if any(self.out.iterdir()) and not (ours and self.overwrite):
            known = "already holds a run" if ours else "is not empty"
            raise InputError("out", f"'{self.out}' {known}", "another folder" + (", or --overwrite" if ours else ""))

    @staticmethod
    def _reachable(out: Path) -> None:
        """Refuse a folder that cannot be made."""
        above = next(parent for parent in out.absolute().parents if parent.exists())
        if not above.is_dir():
            raise InputError("out", f"'{above}' is a file", "the name of a folder that is one, or not there yet")
        if not os.access(above, os.W_OK | os.X_OK):
            raise InputError("out", f"'{above}' must not be written", "a folder of your own: --out FOLDER")

    def make(self, fill: Callable[[Path], None]) -> Scratch:
        """Make the folder with what ``fill`` puts into it: it is there with all of that or not at all."""
        if self.out is None:
            made = scratch()
            fill(made.path)
            return made
        self.check()
        fresh, old = (self.out.with_name(f".{self.out.name}.{word}") for word in ("partial", "old"))
        for left in (fresh, old):
            shutil.rmtree(left, ignore_errors=True)
        try:
            fresh.mkdir(parents=True)
            fill(fresh)
            if self.out.exists():
                with held(self.out):
                    self.out.replace(old)
            fresh.replace(self.out)
        except BaseException:
            shutil.rmtree(fresh, ignore_errors=True)
            raise
        shutil.rmtree(old, ignore_errors=True)
        return Scratch(self.out)
