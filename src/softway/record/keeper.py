"""The keeper of a run's checkpoints: when the next one is due, and what it holds."""

import time as clock
from collections.abc import Mapping
from pathlib import Path

from softway.march.standing import Standing
from softway.record.checkpoint import RARE, Checkpoint, Checkpoints, save
from softway.record.recorder import Recorder


class Keeper:
    """Takes every recorded step and writes a checkpoint when it is time.

    Parameters
    ----------
    folder
        Of the run.
    plan
        How often, and how many are kept.
    recorders
        The records by name, whose lengths belong to a checkpoint.
    before
        Time on the clock that earlier parts of the run took [s].
    """

    __slots__ = ("_latest", "_saved", "before", "begun", "due", "folder", "plan", "recorders")

    def __init__(self, folder: Path, plan: Checkpoints, recorders: Mapping[str, Recorder], before: float) -> None:
        self.folder, self.plan, self.recorders, self.before = folder, plan, recorders, before
        self.begun = clock.perf_counter()
        self.due = self.begun + plan.every
        self._latest: tuple[Standing, dict[str, int]] | None = None
        self._saved = -1

    @property
    def wall(self) -> float:
        """Time on the clock that the run has taken [s]."""
        return self.before + clock.perf_counter() - self.begun

    def took(self, standing: Standing) -> None:
        """Note where the march stands now that its last step is recorded.

        Raises
        ------
        OSError
            If a checkpoint cannot be written.
        """
        self._latest = standing, {name: recorder.mark for name, recorder in self.recorders.items()}
        if clock.perf_counter() >= self.due:
            self.write()

    def write(self) -> None:
        """Write a checkpoint of the last step that was recorded whole, unless there is one.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        if self._latest is None or not self.plan.keep:
            return
        standing, marks = self._latest
        if standing.slabs == self._saved:
            return
        start = clock.perf_counter()
        for recorder in self.recorders.values():
            recorder.sync()
        save(self.folder, Checkpoint(standing=standing, marks=marks, wall=self.wall), self.plan.keep)
        self._saved, now = standing.slabs, clock.perf_counter()
        self.due = now + max(self.plan.every, RARE * (now - start)) if self.plan.every else now
