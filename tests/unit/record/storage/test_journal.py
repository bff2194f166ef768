"""A change of a file comes to its end or is taken back, wherever it was stopped."""

from pathlib import Path

import h5py
import numpy as np
import pytest

from softway.record.storage.journal import JournaledFile, journal, undone


def written(path: Path, values: list[float]) -> JournaledFile:
    """An HDF5 file with a growing series, closed after so many changes."""
    guarded = JournaledFile(path, new=True)
    guarded.begin()
    file = h5py.File(guarded, "w")
    series = file.create_dataset("x", (0,), float, maxshape=(None,), chunks=(4,))
    for value in values:
        series.resize(len(series) + 1, axis=0)
        series[-1] = value
        file.flush()
        guarded.commit()
        guarded.begin()
    file.close()
    guarded.close()
    return guarded


class Stopped(Exception):
    """Stands for a process that was killed: nothing more reaches the disk."""


class Failing(JournaledFile):
    """Stops in one of its writes after a part of it."""

    __slots__ = ("left",)

    def _write(self, data: bytes) -> None:
        self.left -= 1
        super()._write(data if self.left else data[: len(data) // 2])
        if not self.left:
            raise Stopped


def left(guarded: JournaledFile) -> None:
    """Close what the end of a process closes, and nothing else."""
    guarded.file.close()
    guarded.guard.close()


def test_a_file_is_restored_after_a_kill_in_any_write(tmp_path):
    """A change of an HDF5 file is cut in each of its writes in turn: what was there before comes back whole."""
    written(tmp_path / "whole", [1.0, 2.0, 3.0])
    before, torn = (tmp_path / "whole").read_bytes(), 0
    for stop in range(1, 100):
        path = tmp_path / f"cut-{stop}"
        path.write_bytes(before)
        guarded = Failing(path, new=False)
        guarded.left = stop
        guarded.begin()
        with h5py.File(guarded, "r+") as file:
            file["x"].resize(9, axis=0)
            file["x"][3:] = np.arange(6.0)
            file.attrs["more"] = 1
        left(guarded)
        if not guarded.broken:
            break
        with pytest.raises(Stopped):
            guarded.commit()
        torn += path.read_bytes()[: len(before)] != before
        undone(path)  # as the next process does
        assert path.read_bytes() == before, stop
    assert torn >= 3 and stop > 5


def test_a_journal_cut_short_had_its_effect_up_to_there(tmp_path):
    """An entry is there as a whole before what it guards is written over."""
    path = tmp_path / "file"
    path.write_bytes(b"0123456789")
    guarded = JournaledFile(path, new=False)
    guarded.begin()
    states, lengths = [path.read_bytes()], [len(journal(path).read_bytes())]
    for place, text in ((2, b"ab"), (9, b"xyz"), (2, b"c")):
        guarded.seek(place)
        guarded.write(text)
        states.append(path.read_bytes())
        lengths.append(len(journal(path).read_bytes()))
    kept = journal(path).read_bytes()
    left(guarded)
    assert states[-1] == b"01cb45678xyz"
    for length in range(len(kept) + 1):
        entries = sum(length >= n for n in lengths) - 1
        for state in {max(entries, 0), max(entries - 1, 0)}:
            path.write_bytes(states[state])
            journal(path).write_bytes(kept[:length])
            undone(path)
            assert path.read_bytes() == states[0] and not journal(path).exists()


def test_a_shorter_file_gets_its_end_back(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"0123456789")
    guarded = JournaledFile(path, new=False)
    guarded.begin()
    guarded.truncate(4)
    guarded.give_up()
    guarded.close()
    assert path.read_bytes() == b"0123456789" and not journal(path).exists()


def test_what_is_committed_stays(tmp_path):
    guarded = written(tmp_path / "file", [1.0, 2.0])
    assert guarded.changes == 2
    undone(tmp_path / "file")
    with h5py.File(tmp_path / "file") as file:
        assert file["x"][:].tolist() == [1.0, 2.0]
