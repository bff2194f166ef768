"""Checkpoints: the state of a march and the lengths of its records, each checkpoint in one file written atomically.

A file consists of a line with the checksum of the rest, and a NumPy archive of plain arrays.  One of the arrays is a
text that describes how to assemble the others.
"""

import hashlib
import json
import logging
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields
from math import isfinite
from pathlib import Path

import numpy as np

from softway.errors import InputError
from softway.heat.march import HeatState
from softway.marching.state.march_state import MarchState
from softway.mechanisms.arrays import MechanismState
from softway.piles.state import PileState
from softway.record.storage.atomic_file import replaced
from softway.record.storage.gate.archive import packed_arrays, unpacked_arrays
from softway.record.storage.gate.own_files import plain_file
from softway.record.storage.gate.stored_types import require_fields
from softway.record.storage.serialisation import packed, unpacked
from softway.units import Second

LOG = logging.getLogger(__name__)
FOLDER = "checkpoints"
FAMILY = "softway checkpoint"
FORMAT = f"{FAMILY} 3"
RARE = 100.0
"""Minimum time between checkpoints, as a multiple of the time that the last one took to write."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Checkpoints:
    """Schedule of the checkpoints from which a run can be resumed after it was killed or interrupted.

    Writing takes less than one percent of the run time: large checkpoints are written less often.

    Parameters
    ----------
    every
        Wall-clock time between two checkpoints [s]; 0 writes one after every time step at any cost.  A run that is
        interrupted or fails also writes one at its end.
    keep
        Number of most recent checkpoints to keep; 0 for no checkpoints.

    Examples
    --------
    >>> Checkpoints().keep
    2
    """

    every: Second = 30.0
    keep: int = 2

    def __post_init__(self) -> None:
        if not (isfinite(self.every) and self.every >= 0.0):
            raise InputError("every", f"{self.every:g} s is negative or not finite", 'a time such as "30 s", or 0')
        if self.keep < 0:
            raise InputError("keep", f"{self.keep} is negative", "0 for no checkpoints, or 2")


NO_CHECKPOINTS = Checkpoints(keep=0)
"""Schedule of temporary folders."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Checkpoint:
    """State of a run: the state of the march, the length of each record, and the wall-clock time so far [s]."""

    march_state: MarchState | MechanismState | PileState | HeatState
    marks: Mapping[str, int]
    wall: float

    @property
    def time(self) -> float:
        """Time that the march has reached [s]."""
        reached = self.march_state
        return reached.time if isinstance(reached, MechanismState | PileState | HeatState) else reached.state.time


class Damaged(Exception):
    """Error for a checkpoint that cannot be read; the message gives the reason."""


def save(folder: Path, checkpoint: Checkpoint, keep: int) -> Path:
    """Write a checkpoint of a run folder and remove all but the last ``keep``.

    Raises
    ------
    OSError
        If the checkpoint cannot be written; the earlier ones stay.
    """
    place = folder / FOLDER
    place.mkdir(exist_ok=True)
    text, arrays = packed(checkpoint.march_state)
    about = json.dumps({"march_state": text, "marks": dict(checkpoint.marks), "wall": checkpoint.wall})
    content = packed_arrays({"about": np.frombuffer(about.encode(), np.uint8), **arrays})
    head = f"{FORMAT} {hashlib.sha256(content).hexdigest()}\n".encode()
    file = place / f"slab-{checkpoint.march_state.slabs:09d}"
    replaced(file, head + content, sync=True)
    for old in listed(folder)[keep:]:
        old.unlink(missing_ok=True)
    return file


def listed(folder: Path) -> list[Path]:
    """Checkpoint files of a run folder, the last one first."""
    return sorted((folder / FOLDER).glob("slab-*"), reverse=True)


def last(
    folder: Path, require: Callable[[MarchState | MechanismState | PileState | HeatState], object] = lambda state: None
) -> Checkpoint | None:
    """Last usable checkpoint of a run folder; a warning names each other one.

    Parameters
    ----------
    folder
        Folder of the run.
    require
        Function that raises an :class:`InputError` if a state does not belong to the model of the run.
    """
    for file in listed(folder):
        try:
            found = read(file)
            require(found.march_state)
            return found
        except (Damaged, InputError) as error:
            why = str(error) if isinstance(error, Damaged) else f"is damaged: {error}"
            LOG.warning("checkpoint '%s' %s; the previous checkpoint or the start of the run is used", file, why)
    return None


def read(file: Path) -> Checkpoint:
    """Read the checkpoint in a file.

    Raises
    ------
    Damaged
        If the file cannot be read, is of another version, its checksum is wrong, or its content is no state of a march.
    """
    try:
        head, _, content = plain_file(file).read_bytes().partition(b"\n")
    except OSError as error:
        raise Damaged(f"cannot be read: {error.strerror}") from None
    kind = head.rpartition(b" ")[0]
    if kind != FORMAT.encode() and kind.startswith(FAMILY.encode()):
        raise Damaged(f"is of another version of softway ({kind.decode(errors='replace')!r}, here {FORMAT!r})")
    if head != f"{FORMAT} {hashlib.sha256(content).hexdigest()}".encode():
        raise Damaged("is damaged: its checksum is wrong")
    try:
        arrays = unpacked_arrays(content)
        about = json.loads(arrays.pop("about").tobytes())
        found = Checkpoint(march_state=unpacked(about["march_state"], arrays), marks=about["marks"], wall=about["wall"])
        require_fields(Checkpoint, {f.name: getattr(found, f.name) for f in fields(Checkpoint)}, {})
        if min(found.marks.values(), default=0) < 0:
            raise ValueError("a mark is negative")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise Damaged(f"is damaged: {error}") from None
    return found


def forget(folder: Path) -> None:
    """Remove the checkpoints of a finished run."""
    place = folder / FOLDER
    if place.is_symlink() or not place.is_dir():
        return
    for file in (*listed(folder), *place.glob(".slab-*")):
        file.unlink(missing_ok=True)
    with suppress(OSError):  # files of others stay
        place.rmdir()
