"""Archives of plain arrays, as NumPy's ``savez`` writes them, read without trust in what they announce.

The arrays are not packed, so that what an archive unfolds to is no larger than the archive.
"""

import io
import zipfile
from math import prod

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

KINDS = "biuf"
"""Kinds of numbers that an array may hold: no objects, which could run code, and no texts."""
LONGEST = 10_000
"""Greatest length of the header of an array [bytes]."""


def packed_arrays(arrays: dict[str, NDArray[np.generic]]) -> bytes:
    """Archive of some arrays.

    Examples
    --------
    >>> unpacked_arrays(packed_arrays({"a": np.arange(3)}))
    {'a': array([0, 1, 2])}
    """
    body = io.BytesIO()
    np.savez(body, allow_pickle=False, **arrays)
    return body.getvalue()


def unpacked_arrays(content: bytes) -> dict[str, NDArray[np.generic]]:
    """Arrays of an archive; the memory that they take is bounded by the length of the archive.

    Raises
    ------
    ValueError
        If the archive is no plain one: packed, damaged, or with other lengths than it announces.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            if any(e.compress_type != zipfile.ZIP_STORED for e in entries):
                raise ValueError("an array is packed")
            if sum(e.file_size for e in entries) > len(content):
                raise ValueError("the arrays are announced to be longer than the archive")
            return {e.filename.removesuffix(".npy"): _array(archive.read(e), e.filename) for e in entries}
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, OSError) as error:
        raise ValueError(f"no archive of arrays: {error}") from None


def _array(data: bytes, name: str) -> NDArray[np.generic]:
    """Array of one file of the archive, after a check of its header."""
    source = io.BytesIO(data)
    try:
        read = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}[npy.read_magic(source)]
        shape, _, kind = read(source, max_header_size=LONGEST)
    except (KeyError, ValueError, SyntaxError, TypeError, RecursionError, MemoryError) as error:
        raise ValueError(f"{name} is no array: {error}") from None
    if kind.kind not in KINDS:
        raise ValueError(f"{name} holds {kind}, no plain numbers")
    if prod(shape) * kind.itemsize != len(data) - source.tell():
        raise ValueError(f"{name} announces {shape} numbers, but holds {len(data) - source.tell()} bytes")
    source.seek(0)
    try:
        found: NDArray[np.generic] = npy.read_array(source, allow_pickle=False)
    except OverflowError as error:
        raise ValueError(f"{name} announces {shape} numbers: {error}") from None
    return found
