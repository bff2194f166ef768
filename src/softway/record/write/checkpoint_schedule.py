"""Schedule of the checkpoints of a run: when the next one is due, and its content."""

import time as clock
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from softway.heat.march import HeatState
from softway.marching.state.march_state import MarchState
from softway.mechanisms.arrays import MechanismState
from softway.piles.state import PileState
from softway.record.storage.checkpoint import RARE, Checkpoint, Checkpoints, save
from softway.record.storage.uninterrupted import uninterrupted

State = MarchState | MechanismState | PileState | HeatState
"""State of a march after a step."""


class Marked(Protocol):
    """Record with a length, as :class:`~softway.record.write.recorder.Recorder`."""

    @property
    def mark(self) -> int:
        """Length of the record."""
        ...

    def sync(self) -> None:
        """Flush the record to the disk."""
        ...


class CheckpointWriter:
    """Writer of checkpoints: it takes every recorded step and writes a checkpoint when one is due.

    Parameters
    ----------
    folder
        Folder of the run.
    plan
        Time between checkpoints, and number of checkpoints to keep.
    recorders
        Records by name; a checkpoint stores their lengths.
    before
        Wall-clock time of the earlier parts of the run [s].
    """

    __slots__ = ("_latest", "_saved", "before", "begun", "due", "folder", "plan", "recorders")

    def __init__(self, folder: Path, plan: Checkpoints, recorders: Mapping[str, Marked], before: float) -> None:
        self.folder, self.plan, self.recorders, self.before = folder, plan, recorders, before
        self.begun = clock.perf_counter()
        self.due = self.begun + plan.every
        self._latest: tuple[State | Callable[[], State], dict[str, int]] | None = None
        self._saved = -1

    @property
    def wall(self) -> float:
        """Wall-clock time of the run so far [s]."""
        return self.before + clock.perf_counter() - self.begun

    def took(self, march_state: State | Callable[[], State]) -> None:
        """Take the state of the march after its last step was recorded, or a function that makes it, and write a
        checkpoint if one is due.

        Raises
        ------
        OSError
            If a checkpoint cannot be written.
        """
        self._latest = march_state, {name: recorder.mark for name, recorder in self.recorders.items()}
        if clock.perf_counter() >= self.due:
            self.write()

    def write(self) -> None:
        """Write a checkpoint of the last step that was recorded completely, unless it has one already.

        Raises
        ------
        OSError
            If the checkpoint cannot be written.
        """
        if self._latest is None or not self.plan.keep:
            return
        reached, marks = self._latest
        march_state = reached() if callable(reached) else reached
        if march_state.slabs == self._saved:
            return
        start = clock.perf_counter()
        for recorder in self.recorders.values():
            recorder.sync()
        point = Checkpoint(march_state=march_state, marks=marks, wall=self.wall)
        uninterrupted(lambda: save(self.folder, point, self.plan.keep))
        self._saved, now = march_state.slabs, clock.perf_counter()
        self.due = now + max(self.plan.every, RARE * (now - start)) if self.plan.every else now
