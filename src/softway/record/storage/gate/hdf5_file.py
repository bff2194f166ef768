"""HDF5 files of a run folder, read without trust in what they announce, with nothing that leads to another file."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.record.storage.gate.own_files import plain_file

RATIO = 1100
"""Greatest factor by which the filters of softway shrink data; deflate does not reach 1033."""
SLACK = 4096
"""Length of data that need not be stored yet [bytes]."""
CHUNK = 1 << 26
"""Greatest length of a chunk [bytes], which is unpacked as a whole."""
OBJECTS = 10_000
"""Greatest number of groups and arrays."""
FILTERS = {h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE}
BROKEN = (KeyError, TypeError, ValueError, RuntimeError, OSError, AttributeError, OverflowError, RecursionError)
"""Exceptions of h5py and NumPy at a file that is not what it should be."""


@contextmanager
def reading(path: Path, remedy: str) -> Iterator[h5py.File]:
    """Open a file for reading, even while a run still writes to it.

    Raises
    ------
    InputError
        If the file is missing, damaged, or leads to other files or to code.
    """
    try:
        opened = h5py.File(plain_file(path), "r", locking=False)
    except OSError as error:
        problem = "is missing" if not path.exists() else f"cannot be read: {error}"
        raise InputError(str(path), problem, remedy) from None
    with opened as file:
        try:
            require_plain(file)
            yield file
        except BROKEN as error:
            raise InputError(str(path), f"is damaged: {type(error).__name__}: {error}", remedy) from None


def require_plain(file: h5py.File) -> None:
    """Refuse links, arrays that are stored elsewhere, other filters, and arrays longer than what is stored.

    Raises
    ------
    ValueError
        With the name in the file.
    """
    rest: list[tuple[str, h5py.Group]] = [("", file)]
    seen = 0
    while rest:
        place, group = rest.pop()
        for name in group:
            seen += 1
            where = f"{place}/{name}"
            if seen > OBJECTS:
                raise ValueError(f"more than {OBJECTS} objects")
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                raise ValueError(f"{where} is a link")
            item = group[name]
            if isinstance(item, h5py.Group):
                rest.append((where, item))
            elif isinstance(item, h5py.Dataset):
                _require_array(item, where)
            else:
                raise ValueError(f"{where} is no array")


def _require_array(data: h5py.Dataset, where: str) -> None:
    if data.is_virtual or data.external:
        raise ValueError(f"{where} is stored in other files")
    plan = data.id.get_create_plist()
    if any(plan.get_filter(k)[0] not in FILTERS for k in range(plan.get_nfilters())):
        raise ValueError(f"{where} needs a filter that softway does not use")
    if data.dtype.kind not in "biufS" and h5py.check_string_dtype(data.dtype) is None:
        raise ValueError(f"{where} holds {data.dtype}, no numbers")
    chunk = data.dtype.itemsize
    for length in data.chunks or ():
        chunk *= length
    if chunk > CHUNK:
        raise ValueError(f"{where} has chunks of {chunk} bytes")
    if data.nbytes > RATIO * data.id.get_storage_size() + SLACK:
        raise ValueError(f"{where} announces {data.shape} numbers, more than it holds")


def write_rows(rows: h5py.Dataset, start: int, data: Array) -> None:
    """Write data from a row on, as the end of an array.

    The calls of HDF5 itself: selections of h5py take three times as long as writing the rows of a small frame.
    """
    values = np.ascontiguousarray(data)
    rows.id.set_extent((start + len(values), *rows.shape[1:]))
    if values.size:
        place = rows.id.get_space()
        place.select_hyperslab((start,) + (0,) * (values.ndim - 1), values.shape)
        rows.id.write(h5py.h5s.create_simple(values.shape), place, values)


def kept_number(group: h5py.Group, name: str) -> h5py.h5a.AttrID:
    """Attribute of a group that is kept open, and written in place by ``write``."""
    return h5py.h5a.open(group.id, name.encode())
