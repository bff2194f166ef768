"""Numbers and lines of a Gmsh file in their order, as text or as bytes."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from softway.errors import InputError

LONGEST = 64
"""Greatest length of a number in characters."""
CHUNK = 10_000_000
"""Number of characters whose numbers are separated at once."""
AGAIN = "save the mesh again"


def damaged(problem: str, remedy: str = AGAIN) -> InputError:
    """Error for a file that says something else than it holds."""
    return InputError("path", problem, remedy)


class Cursor:
    r"""Place in the bytes of a file, which moves on with everything that is read.

    Parameters
    ----------
    data
        Bytes of the file.

    Examples
    --------
    >>> cursor = Cursor(b"$Nodes\n1\n")
    >>> cursor.line(), cursor.line(), cursor.ended
    ('$Nodes', '1', True)
    """

    __slots__ = ("at", "data")

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    @property
    def ended(self) -> bool:
        """True at the end of the file."""
        return self.at >= len(self.data)

    def line(self) -> str:
        """Next line, without blanks around it."""
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text, self.at = self.data[self.at : end], end + 1
        return decoded(text).strip()

    def body(self, name: str) -> bytes:
        """Text of a section up to its end."""
        start, mark = self.at, f"$End{name}".encode(errors="surrogateescape")
        found = self.data.find(mark, start)
        while found > 0 and self.data[found - 1 : found] != b"\n":
            found = self.data.find(mark, found + 1)
        if found < 0:
            raise damaged(f"${name:.40} has no $End{name:.40}")
        self.at = found
        if self.line() != f"$End{name}":
            raise damaged(f"${name:.40} has no $End{name:.40}")
        return self.data[start:found]

    def close(self, name: str) -> None:
        """Refuse a section of bytes that does not end here."""
        line = self.line() or self.line()
        if line != f"$End{name}":
            raise damaged(f"${name} holds more or less than it announces")

    def array(self, dtype: DTypeLike, count: int) -> NDArray[Any]:
        """Next numbers of a file of bytes."""
        kind = np.dtype(dtype)
        if not 0 <= count <= (len(self.data) - self.at) // kind.itemsize:
            raise damaged(f"{count} numbers are announced, and the file ends before")
        found = np.frombuffer(self.data, dtype=kind, count=count, offset=self.at)
        self.at += count * kind.itemsize
        return found


class Tokens:
    """Words of a section of a text file in their order, converted where they are taken.

    Parameters
    ----------
    name
        Name of the section for messages.
    body
        Text of the section.

    Examples
    --------
    >>> tokens = Tokens("Nodes", b"1 2 0.5")
    >>> tokens.array(int, 2), tokens.array(float, 1), tokens.rest
    (array([1, 2]), array([0.5]), 0)
    """

    __slots__ = ("at", "name", "words")

    def __init__(self, name: str, body: bytes) -> None:
        self.name, self.at, self.words = name, 0, _words(name, body)

    @property
    def rest(self) -> int:
        """Number of words that are left."""
        return len(self.words) - self.at

    def array(self, dtype: DTypeLike, count: int) -> NDArray[Any]:
        """Next words as numbers."""
        if not 0 <= count <= self.rest:
            raise damaged(f"${self.name} announces {count} numbers where {self.rest} are left")
        words = self.words[self.at : self.at + count]
        self.at += count
        try:
            return words.astype(np.dtype(dtype))
        except (ValueError, OverflowError) as error:
            raise damaged(f"${self.name}: {error}") from None

    def one(self) -> int:
        """Next word as a whole number."""
        return int(self.array(np.int64, 1)[0])

    def close(self) -> None:
        """Refuse a section with more numbers than it announces."""
        if self.rest:
            raise damaged(f"${self.name} holds {self.rest} numbers more than it announces")


def decoded(text: bytes) -> str:
    r"""Text in UTF-8, or else in Latin-1.

    Examples
    --------
    >>> decoded(b"a"), decoded(b"\xe4")
    ('a', 'ä')
    """
    try:
        return text.decode()
    except UnicodeDecodeError:
        return text.decode("latin-1")


def _words(name: str, body: bytes) -> NDArray[np.bytes_]:
    """Words of a text, separated a part at a time."""
    parts, start = [], 0
    while start < len(body):
        end = body.find(b"\n", start + CHUNK)
        end = len(body) if end < 0 else end
        words = body[start:end].split()
        if words and len(max(words, key=len)) > LONGEST:
            raise damaged(f"${name} holds a number of more than {LONGEST} characters")
        parts += [np.array(words, dtype=np.bytes_)] if words else []
        start = end
    return np.concatenate(parts) if parts else np.zeros(0, dtype="S1")
