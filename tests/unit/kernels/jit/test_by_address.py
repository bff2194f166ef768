"""Tables by address, and kernels that are interpreted for small arguments."""

import sys
from typing import NamedTuple

import numpy as np
import pytest

from softway.arrays import Array, BoolArray, IntArray
from softway.kernels.assembly.merged_pattern import merged_pattern
from softway.kernels.assembly.node_pairs import expanded, node_pairs
from softway.kernels.jit.by_address import (
    BLOCKS,
    FLAGS,
    NUMBERS,
    ROWS,
    WHOLE,
    WHOLES,
    packed,
    passed_by_address,
    table,
)
from softway.kernels.jit.compilation import called, interpreted, kernel, uncounted_kernel


class Parts(NamedTuple):
    """One entry of each kind."""

    count: int
    places: IntArray
    flags: BoolArray
    numbers: Array
    rows: Array
    blocks: Array


parts_at = table("Parts", count=WHOLE, places=WHOLES, flags=FLAGS, numbers=NUMBERS, rows=ROWS, blocks=BLOCKS)


@called
def _sum(parts):
    total = 1.0 * parts.count * len(parts.flags)
    for k in range(len(parts.numbers)):
        if parts.flags[k]:
            total += parts.numbers[k] * parts.places[k]
    return total + parts.rows[1, 2] + parts.blocks[0, 1, 0]


@uncounted_kernel
def taken(place, out):
    """Sum of entries; the table is changed, too."""
    parts = parts_at(place)
    out[0] = _sum(parts)
    parts.rows[0, 0] = 7.0


def given() -> Parts:
    """Entries."""
    rows, blocks = np.arange(6.0).reshape(2, 3), 100.0 * np.arange(8.0).reshape(2, 2, 2)
    flags = np.array([True, False, True])
    return Parts(
        count=2, places=np.array([3, 4, 5]), flags=flags, numbers=np.array([0.5, 9.0, 0.25]), rows=rows, blocks=blocks
    )


def test_entries_of_a_table() -> None:
    parts, out = given(), np.zeros(1)
    numbers = packed(parts)
    taken(numbers.ctypes.data, out)
    assert out[0] == pytest.approx(6.0 + 1.5 + 1.25 + 5.0 + 200.0)
    assert parts.rows[0, 0] == pytest.approx(7.0)


def test_arrays_of_a_table_are_contiguous() -> None:
    with pytest.raises(ValueError, match="contiguous"):
        packed(given()._replace(rows=np.zeros((4, 4))[:, ::2]))


def test_kernels_of_patterns_give_the_same_where_they_are_not_compiled() -> None:
    """Patterns of triangles, and the union of two matrices without some rows and columns."""
    rng = np.random.default_rng(3)
    cells = np.array([rng.choice(12, 3, replace=False) for _ in range(20)]).ravel()
    first = np.arange(0, 61, 3)
    pairs = [interpreted(node_pairs, small)(cells, first, 12) for small in (False, True)]
    same(*pairs)
    rows, columns = pairs[0][:2]
    same(*(interpreted(expanded, small)(rows, columns, 2) for small in (False, True)))
    number = np.where(np.arange(12) % 5 == 2, -1, np.cumsum(np.arange(12) % 5 != 2) - 1)
    two = np.repeat(np.arange(13), 1), np.arange(12)  # a diagonal
    pattern = rows, columns, rng.normal(size=len(columns)), *two, number
    same(*(interpreted(merged_pattern, small)(*pattern) for small in (False, True)))


def same(one, other) -> None:
    """Arrays have the same kinds and values."""
    for a, b in zip(one, other, strict=True):
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)


@passed_by_address
class Inner(NamedTuple):
    """A tuple that is an entry of another one."""

    numbers: Array
    ends: IntArray


@passed_by_address
class Outer(NamedTuple):
    """Arrays, a number, and a tuple."""

    rows: Array
    inner: Inner
    width: int
    other: Array


@called
def _last(inner):
    return inner.numbers[inner.ends[1]]


@kernel
def _entries(outer):
    """Entries of both tuples; arrays are changed, made and given back."""
    outer.rows[1] = outer.inner.numbers
    kept = outer.other.copy()
    kept += outer.other
    outer.other[:] = kept
    return outer.rows[0, 1] + outer.width * _last(outer.inner)


def test_entries_of_a_named_tuple_and_of_one_in_it() -> None:
    inner = Inner(numbers=np.array([3.0, 5.0, 8.0]), ends=np.array([0, 2]))
    outer = Outer(rows=np.arange(6.0).reshape(2, 3), inner=inner, width=4, other=np.array([1.0]))
    arrays = [outer.rows, outer.other, *inner]
    before = [sys.getrefcount(array) for array in arrays]
    for turn in range(3):
        assert _entries(outer) == pytest.approx(1.0 + 4.0 * 8.0)
        assert outer.other[0] == pytest.approx(2.0 ** (turn + 1))
    assert outer.rows[1] == pytest.approx(inner.numbers)
    assert [sys.getrefcount(array) for array in arrays] == before


def test_a_named_tuple_with_other_arrays_is_another_kind() -> None:
    """Rows that are not contiguous are read by their strides."""
    inner = Inner(numbers=np.array([3.0, 5.0, 8.0]), ends=np.array([0, 2]))
    rows = np.arange(12.0).reshape(2, 6)[:, ::2]
    outer = Outer(rows=rows, inner=inner, width=1, other=np.zeros(1))
    assert _entries(outer) == pytest.approx(2.0 + 8.0)
    assert rows[1] == pytest.approx(inner.numbers)
    assert len(_entries.signatures) == 2
