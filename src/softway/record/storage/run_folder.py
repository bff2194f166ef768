"""Folder for the records of a run."""

import os
import shutil
import tempfile
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from softway.errors import InputError
from softway.record.storage import provenance
from softway.record.storage.lock import locked


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class ScratchFolder:
    """Temporary folder that is deleted together with the last object that holds it."""

    path: Path


def scratch() -> ScratchFolder:
    """Create a temporary folder for a run without a named folder."""
    made = ScratchFolder(Path(tempfile.mkdtemp(prefix="softway-")))
    weakref.finalize(made, shutil.rmtree, made.path, ignore_errors=True)
    return made


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RunFolder:
    """Folder for the records of a new run.

    Parameters
    ----------
    out
        Folder to create; ``None`` for a temporary one that lives as long as its :class:`Run`.
    overwrite
        True if an existing run folder of that name may be replaced.
    """

    out: Path | None = None
    overwrite: bool = False

    def check(self) -> None:
        """Refuse a folder that cannot be created or holds other files, before anything is computed."""
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
        """Refuse a folder that cannot be created."""
        above = next(parent for parent in out.absolute().parents if parent.exists())
        if not above.is_dir():
            raise InputError("out", f"'{above}' is a file", "a path that leads through folders only")
        if not os.access(above, os.W_OK | os.X_OK):
            raise InputError("out", f"no permission to write to '{above}'", "a folder of your own: --out FOLDER")

    def make(self, fill: Callable[[Path], None]) -> ScratchFolder:
        """Create the folder atomically with the files that ``fill`` writes into it."""
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
                with locked(self.out):
                    self.out.replace(old)
            fresh.replace(self.out)
        except BaseException:
            shutil.rmtree(fresh, ignore_errors=True)
            raise
        shutil.rmtree(old, ignore_errors=True)
        return ScratchFolder(self.out)
