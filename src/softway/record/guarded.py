"""A file whose last changes can be taken back, after a process was killed or a disk was full in the middle of them.

Before bytes that were there are written over, they are put into a journal beside the file.  A change that comes to its
end empties the journal; one that does not is undone by :func:`undone`, which writes the old bytes back.
"""

import io
import os
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

HEAD, ENTRY = struct.Struct("<8sQ"), struct.Struct("<QQI")
MAGIC = b"softundo"


class Guarded:
    """A binary file for reading and writing, as HDF5 asks for one; not buffered.

    HDF5 does not survive a failure of its file in the middle of its work: it is told that all went well, nothing is
    written any more, and :meth:`commit` or :meth:`close` raises what happened.

    Parameters
    ----------
    path
        The file.
    new
        Whether it begins empty.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "notes"
    >>> file = Guarded(path, new=True)
    >>> file.begin(), file.write(b"old"), file.commit(), file.begin(), file.seek(0), file.write(b"newer")
    (None, 3, None, None, 0, 5)
    >>> file.give_up(), file.close(), path.read_bytes(), file.changes
    (None, None, b'old', 1)
    """

    __slots__ = ("broken", "changes", "failure", "file", "guard", "kept", "path")

    def __init__(self, path: Path, new: bool) -> None:
        self.path, self.changes, self.kept, self.broken = path, 0, 0, False
        self.failure: BaseException | None = None
        self.file = io.FileIO(path, "w+" if new else "r+")
        self.guard = io.FileIO(journal(path), "w")

    def begin(self) -> None:
        """Start a change; without room for that nothing is written any more."""
        self.kept = os.fstat(self.file.fileno()).st_size
        try:
            _put(self.guard, HEAD.pack(MAGIC, self.kept))
        except OSError:
            self.broken = True
            raise

    def commit(self) -> None:
        """End a change: it stays.

        Raises
        ------
        OSError, KeyboardInterrupt
            What happened in the middle of it; it is taken back when the file is closed.
        """
        self._complain()
        self.guard.seek(0)
        self.guard.truncate(0)
        self.kept, self.changes = 0, self.changes + 1

    def give_up(self) -> None:
        """Take the change back when the file is closed; whatever is still written is lost."""
        self.broken = True

    def write(self, data: bytes) -> int:
        """Write at the present place."""
        return self._tried(lambda: self._write(bytes(data)), len(data))

    def truncate(self, size: int) -> int:
        """Cut or extend the file to a size."""
        return self._tried(lambda: self._truncate(size), size)

    def read(self, size: int = -1) -> bytes:
        """Read from the present place on."""
        return self.file.read(size) or b""

    def readinto(self, buffer: memoryview) -> int:
        """Read at the present place."""
        return self.file.readinto(buffer) or 0

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Go to a place."""
        return self.file.seek(offset, whence)

    def tell(self) -> int:
        """The present place."""
        return self.file.tell()

    def flush(self) -> None:
        """Nothing is left to flush."""

    def sync(self) -> None:
        """Bring the file to the disk."""
        os.fsync(self.file.fileno())

    def close(self) -> None:
        """Close the file, without a change that was given up or failed.

        Raises
        ------
        OSError, KeyboardInterrupt
            What happened in a change that nobody has committed.
        """
        self.file.close()
        self.guard.close()
        if self.broken:
            undone(self.path)
        journal(self.path).unlink(missing_ok=True)
        self._complain()

    def _complain(self) -> None:
        failure, self.failure = self.failure, None
        if failure is not None:
            raise failure

    def _tried(self, action: Callable[[], None], done: int) -> int:
        if not self.broken:
            try:
                action()
            except BaseException as error:
                self.broken, self.failure = True, error
        return done

    def _write(self, data: bytes) -> None:
        at = self.file.tell()
        self._keep(at, at + len(data))
        _put(self.file, data)

    def _truncate(self, size: int) -> None:
        self._keep(size, self.kept)
        self.file.truncate(size)

    def _keep(self, start: int, end: int) -> None:
        """Put what there is between two places into the journal."""
        end = min(end, self.kept)
        if start >= end:
            return
        here = self.file.tell()
        self.file.seek(start)
        old = self.file.read(end - start)
        self.file.seek(here)
        _put(self.guard, ENTRY.pack(start, len(old), zlib.crc32(old)) + old)


def journal(path: Path) -> Path:
    """The journal of a file."""
    return path.with_name(f".{path.name}.undo")


def undone(path: Path) -> None:
    """Take back the change that was going on when the file was left."""
    kept = journal(path)
    if not (kept.is_file() and path.is_file()):
        return
    size, entries = _read(kept.read_bytes())
    if size is not None:
        with path.open("r+b") as file:
            for start, old in reversed(entries):
                file.seek(start)
                file.write(old)
            file.truncate(size)
    kept.unlink()


def _read(data: bytes) -> tuple[int | None, list[tuple[int, bytes]]]:
    """Size of the file before the change, and what was written over; an entry that was cut short had no effect yet."""
    if len(data) < HEAD.size:
        return None, []
    size, place, entries = HEAD.unpack_from(data)[1], HEAD.size, []
    while place + ENTRY.size <= len(data):
        start, length, check = ENTRY.unpack_from(data, place)
        old = data[place + ENTRY.size : place + ENTRY.size + length]
        if len(old) < length or zlib.crc32(old) != check:
            break
        entries.append((start, old))
        place += ENTRY.size + length
    return size, entries


def _put(file: io.FileIO, data: bytes) -> None:
    """Write all of it: a nearly full disk takes a part first."""
    while data:
        data = data[file.write(data) or 0 :]
