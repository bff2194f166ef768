"""Folder for the records of a run."""

import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from softway.errors import InputError
from softway.record.storage import provenance
from softway.record.storage.lock import locked

LONGEST = 240
"""Greatest length of the name of a new folder [bytes]; while it is made, its name is longer."""


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
        try:
            self._free(self.out)
        except OSError as error:
            problem = f"'{self.out}' cannot be a folder: {error.strerror}"
            raise InputError("out", problem, "a shorter name, in a folder of your own: --out FOLDER") from None

    def _free(self, out: Path) -> None:
        if not out.exists():
            self._reachable(out)
            if len(os.fsencode(out.name)) > LONGEST:
                raise InputError("out", f"'{out.name}' is longer than {LONGEST} bytes", "a shorter name")
            return
        if not out.is_dir():
            raise InputError("out", f"'{out}' is a file", "the name of a folder")
        if out.samefile("."):
            raise InputError("out", f"'{out}' is the present folder", "the name of a new folder, such as run")
        ours = (out / provenance.FILE).is_file()
        if any(out.iterdir()) and not (ours and self.overwrite):
            known = "already holds a run" if ours else "is not empty"
            raise InputError("out", f"'{out}' {known}", "another folder" + (", or --overwrite" if ours else ""))

    @staticmethod
    def _reachable(out: Path) -> None:
        """Refuse a folder that cannot be created."""
        above = next(parent for parent in out.absolute().parents if parent.exists())
        if not above.is_dir():
            raise InputError("out", f"'{above}' is a file", "a path that leads through folders only")
        if not os.access(above, os.W_OK | os.X_OK):
            raise InputError("out", f"no permission to write to '{above}'", "a folder of your own: --out FOLDER")

    @contextmanager
    def made(self, fill: Callable[[Path], None]) -> Iterator[ScratchFolder]:
        """Create the folder atomically with the files that ``fill`` writes into it; it is locked for this run.

        Of several runs that are started into one folder at the same time, one gets it.

        Raises
        ------
        InputError
            If another run is writing to the folder, or has filled it meanwhile.
        OSError
            If the folder cannot be created or filled; nothing is left.
        """
        if self.out is None:
            temporary = scratch()
            with locked(temporary.path):
                fill(temporary.path)
                yield temporary
            return
        target = self.out.resolve()
        fresh, old = (target.with_name(f".{target.name}.{word}") for word in ("partial", "old"))
        with self._claimed(fresh):
            try:
                for left in (*fresh.iterdir(), *([old] if old.exists() else [])):
                    _remove(left)
                fill(fresh)
                if target.exists():
                    with locked(target, self.out):
                        target.replace(old)
                fresh.replace(target)
            except BaseException:
                shutil.rmtree(fresh, ignore_errors=True)
                raise
            shutil.rmtree(old, ignore_errors=True)
            yield ScratchFolder(self.out)

    @contextmanager
    def _claimed(self, fresh: Path) -> Iterator[None]:
        """Create and lock the folder that is filled before it gets its name; leftovers of a killed process are reused.

        A folder that another run has renamed in between is not ours.
        """
        while True:
            self.check()
            with suppress(FileExistsError):  # removed by another run while it is looked at
                fresh.mkdir(parents=True, exist_ok=True)
            with locked(fresh, self.out) as ours:
                if ours:
                    try:
                        self.check()
                    except InputError:
                        shutil.rmtree(fresh, ignore_errors=True)
                        raise
                    yield
                    return


def _remove(left: Path) -> None:
    if left.is_dir() and not left.is_symlink():
        shutil.rmtree(left)
    else:
        left.unlink()
