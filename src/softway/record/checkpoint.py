"""Checkpoints: where a march stands and how long its records are, each in one file that is there as a whole or not.

A file is a line with the checksum of the rest, and a NumPy archive of plain arrays, one of them the text that puts
them together.
"""

import hashlib
import io
import json
import logging
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np

from softway.errors import InputError
from softway.march.standing import Standing
from softway.record.pack import packed, unpacked
from softway.record.whole import replaced
from softway.units import Second

LOG = logging.getLogger(__name__)
FOLDER = "checkpoints"
FORMAT = "softway checkpoint 1"
RARE = 100.0
"""Time between checkpoints, at least so many times what the last one took to write."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Checkpoints:
    """How often a run notes where it stands, so that it can be resumed after it was killed.

    Writing takes less than a hundredth of the time: it is done less often where a checkpoint is large.

    Parameters
    ----------
    every
        Time on the clock between two checkpoints [s], 0 for one after every slab whatever it costs; a run that is
        interrupted or fails writes one at its end.
    keep
        How many of the last ones are kept; 0 for none.

    Examples
    --------
    >>> Checkpoints().keep
    2
    """

    every: Second = 30.0
    keep: int = 2

    def __post_init__(self) -> None:
        if not (isfinite(self.every) and self.every >= 0.0):
            raise InputError("every", f"{self.every:g} s", 'a time on the clock such as "30 s"')
        if self.keep < 0:
            raise InputError("keep", f"{self.keep} is negative", "0 for no checkpoints, or 2")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Checkpoint:
    """Where a run stands: the march, the length of each record, and the time on the clock until then [s]."""

    standing: Standing
    marks: Mapping[str, int]
    wall: float


class Damaged(Exception):
    """A checkpoint cannot be read; the message says why."""


def save(folder: Path, checkpoint: Checkpoint, keep: int) -> Path:
    """Write a checkpoint of a run folder and remove all but the last ``keep``.

    Raises
    ------
    OSError
        If it cannot be written; the earlier ones stay.
    """
    place = folder / FOLDER
    place.mkdir(exist_ok=True)
    text, arrays = packed(checkpoint.standing)
    about = json.dumps({"standing": text, "marks": dict(checkpoint.marks), "wall": checkpoint.wall})
    body = io.BytesIO()
    np.savez(body, allow_pickle=False, about=np.frombuffer(about.encode(), np.uint8), **arrays)
    content = body.getvalue()
    head = f"{FORMAT} {hashlib.sha256(content).hexdigest()}\n".encode()
    file = place / f"slab-{checkpoint.standing.slabs:09d}"
    replaced(file, head + content, sync=True)
    for old in listed(folder)[keep:]:
        old.unlink(missing_ok=True)
    return file


def listed(folder: Path) -> list[Path]:
    """The checkpoints of a run folder, the last one first."""
    return sorted((folder / FOLDER).glob("slab-*"), reverse=True)


def last(folder: Path) -> Checkpoint | None:
    """The last checkpoint of a run folder that can be read; those that cannot are named in a warning."""
    for file in listed(folder):
        try:
            return read(file)
        except Damaged as error:
            LOG.warning("checkpoint '%s' %s; what was before it is used", file, error)
    return None


def read(file: Path) -> Checkpoint:
    """The checkpoint in a file.

    Raises
    ------
    Damaged
        If it is not what was written.
    """
    try:
        head, _, content = file.read_bytes().partition(b"\n")
    except OSError as error:
        raise Damaged(f"cannot be read: {error.strerror}") from None
    if head != f"{FORMAT} {hashlib.sha256(content).hexdigest()}".encode():
        raise Damaged("is damaged: its checksum is wrong")
    with np.load(io.BytesIO(content), allow_pickle=False) as stored:
        arrays = {name: stored[name] for name in stored.files}
    about = json.loads(arrays.pop("about").tobytes())
    return Checkpoint(standing=unpacked(about["standing"], arrays), marks=about["marks"], wall=about["wall"])


def forget(folder: Path) -> None:
    """Remove the checkpoints of a run that is over."""
    for file in listed(folder):
        file.unlink(missing_ok=True)
    if (folder / FOLDER).is_dir():
        for rest in (folder / FOLDER).iterdir():
            rest.unlink()
        (folder / FOLDER).rmdir()
