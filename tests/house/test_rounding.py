"""Tests hold on every processor: none asks for the last bit of a computed number, none for the speed of the machine."""

import ast
import doctest
import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest

from processors import LEFT
from sources import Documented, Source, read_sources

EXACT = 2**20
"""Greatest denominator of a dyadic number that arithmetic is expected to make exactly."""
GIVEN = "# as given"
"""Mark of a line in which a number is read back that nothing was computed with."""
CLOCKS = {"perf_counter", "monotonic", "process_time", "thread_time", "time"}
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d*)?(?:e[-+]?\d+)?(?![\w.])")
RAW = re.compile(r"\.tolist\(\)|\bfloat\(")
"""What an example shows with all digits."""
ROUNDED = re.compile(r"\bround\(|:[^\s'\"}]*\d[gefd%]")


@pytest.fixture(scope="module")
def tests(root: Path) -> tuple[Source, ...]:
    return read_sources(root / "tests")


def inexact(text: str) -> bool:
    """Whether a number is no sum of few powers of two."""
    denominator = Fraction(text).denominator
    return denominator > EXACT or denominator & (denominator - 1) != 0


def compared(source: Source) -> Iterator[str]:
    """Inexact numbers that an assertion compares for equality."""
    lines = source.text.splitlines()
    for asked in (n for n in ast.walk(source.tree) if isinstance(n, ast.Assert)):
        for node in (n for n in ast.walk(asked.test) if isinstance(n, ast.Compare)):
            if not any(isinstance(o, ast.Eq | ast.NotEq) for o in node.ops) or GIVEN in lines[node.lineno - 1]:
                continue
            for side in (node.left, *node.comparators):
                found = side.operand if isinstance(side, ast.UnaryOp) else side
                if isinstance(found, ast.Constant) and isinstance(found.value, float) and inexact(repr(found.value)):
                    yield f"{source.name}, line {node.lineno}: == {found.value!r}: pytest.approx, or {GIVEN!r}"


def clocked(source: Source) -> Iterator[str]:
    """Assertions that look at a clock."""
    for asked in (n for n in ast.walk(source.tree) if isinstance(n, ast.Assert)):
        for node in (n for n in ast.walk(asked.test) if isinstance(n, ast.Call)):
            of = node.func
            if isinstance(of, ast.Attribute) and of.attr in CLOCKS and ast.unparse(of.value) in ("time", "clock"):
                yield f"{source.name}, line {asked.lineno}: the speed of the machine"


def shown(source: Source) -> Iterator[str]:
    """Examples in docstrings that show all digits of a computed number."""
    for node in (n for n in ast.walk(source.tree) if isinstance(n, Documented | ast.Module)):
        for example in doctest.DocTestParser().get_examples(ast.get_docstring(node, clean=False) or ""):
            raw = RAW.search(example.source) and not ROUNDED.search(example.source)
            if raw and any(inexact(text) for text in NUMBER.findall(example.want)):
                yield f"{source.name}: {example.source.strip()}"


def test_no_assertion_asks_for_a_last_bit(tests: tuple[Source, ...]) -> None:
    assert not (wrong := [line for source in tests for line in compared(source)]), "\n".join(wrong)


def test_no_assertion_asks_for_speed(tests: tuple[Source, ...]) -> None:
    assert not (wrong := [line for source in tests for line in clocked(source)]), "\n".join(wrong)


def test_no_example_shows_a_last_bit(sources: tuple[Source, ...]) -> None:
    assert not (wrong := [line for source in sources for line in shown(source)]), "\n".join(wrong)


def test_the_rules_find_what_they_forbid(tmp_path: Path) -> None:
    path = tmp_path / "test_a.py"
    path.write_text(
        '''"""A.\n\n>>> [0.1].tolist()\n[0.1]\n>>> [0.5].tolist()\n[0.5]\n"""\n'''
        "assert x == 0.1\nassert x == -0.3 and y == 0.5\nassert x == 0.1  # as given\nassert time.monotonic() < 1\n"
    )
    (found,) = read_sources(tmp_path)
    assert len(list(compared(found))) == 2 and len(list(clocked(found))) == 1 and len(list(shown(found))) == 1


def test_what_is_not_tried_on_other_processors_is_there_and_in_order(root: Path) -> None:
    assert all((root / "tests" / place).exists() for place in LEFT)
    assert list(LEFT) == sorted(LEFT)
