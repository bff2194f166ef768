"""File with an undo journal: an incomplete change is undone after the process was killed or the disk was full.

Before existing bytes are overwritten, they are copied into a journal next to the file.  A complete change empties the
journal.  An incomplete change is undone by :func:`undone`, which writes the old bytes back.
"""

import io
import os
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

HEAD, ENTRY = struct.Struct("<8sQ"), struct.Struct("<QQI")
MAGIC = b"softundo"


class JournaledFile:
    """Unbuffered binary file for reading and writing, with the methods that HDF5 needs.

    HDF5 cannot recover from an error of its file during an operation.  After an error the methods therefore report
    success and write nothing, and :meth:`commit` or :meth:`close` raises the error.

    Parameters
    ----------
    path
        Path of the file.
    new
        True creates an empty file; False opens the existing one.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "notes"
    >>> file = JournaledFile(path, new=True)
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
        """Start a change; if the journal cannot be written, nothing is written any more."""
        self.kept = os.fstat(self.file.fileno()).st_size
        try:
            _put(self.guard, HEAD.pack(MAGIC, self.kept))
        except OSError:
            self.broken = True
            raise

    def commit(self) -> None:
        """Complete a change and make it permanent.

        Raises
        ------
        OSError, KeyboardInterrupt
            If it was raised during the change; the change is undone when the file is closed.
        """
        self._complain()
        self.guard.seek(0)
        self.guard.truncate(0)
        self.kept, self.changes = 0, self.changes + 1

    def give_up(self) -> None:
        """Mark the change to be undone when the file is closed; later writes are ignored."""
        self.broken = True

    def write(self, data: bytes) -> int:
        """Write at the current position."""
        return self._tried(lambda: self._write(bytes(data)), len(data))

    def truncate(self, size: int) -> int:
        """Truncate or extend the file to a size."""
        return self._tried(lambda: self._truncate(size), size)

    def read(self, size: int = -1) -> bytes:
        """Read from the current position."""
        return self.file.read(size) or b""

    def readinto(self, buffer: memoryview) -> int:
        """Read from the current position into a buffer."""
        return self.file.readinto(buffer) or 0

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Move the current position."""
        return self.file.seek(offset, whence)

    def tell(self) -> int:
        """Return the current position."""
        return self.file.tell()

    def flush(self) -> None:
        """Do nothing: the file is not buffered."""

    def sync(self) -> None:
        """Flush the file to the disk."""
        os.fsync(self.file.fileno())

    def close(self) -> None:
        """Close the file and undo a change that was given up or failed.

        Raises
        ------
        OSError, KeyboardInterrupt
            If it was raised during a change that has not been committed.
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
        """Copy the bytes between two positions into the journal."""
        end = min(end, self.kept)
        if start >= end:
            return
        here = self.file.tell()
        self.file.seek(start)
        old = self.file.read(end - start)
        self.file.seek(here)
        _put(self.guard, ENTRY.pack(start, len(old), zlib.crc32(old)) + old)


def journal(path: Path) -> Path:
    """Path of the journal of a file."""
    return path.with_name(f".{path.name}.undo")


def undone(path: Path) -> None:
    """Undo an incomplete change of a file with the help of its journal."""
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
    """Size of the file before the change, and the overwritten bytes; an incomplete entry had no effect on the file."""
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
    """Write all bytes; on a nearly full disk one call may write only a part."""
    while data:
        data = data[file.write(data) or 0 :]
