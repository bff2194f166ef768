"""The page of measurements shows no figure of code that has changed since."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from record.figures import read
from record.fingerprint import BENCHES, CODE, COMMON, MARCH, ROOT
from run import GROUPS, PAGE, RESULTS, rendered


def test_the_page_shows_only_figures_of_the_code_as_it_is() -> None:
    """``make bench-page`` takes what is out of date off the page, ``make bench`` measures it anew."""
    assert PAGE.read_text(encoding="utf-8") == rendered(*read(RESULTS)), "make bench-page"


def test_every_group_says_what_decides_its_figures() -> None:
    assert set(BENCHES) == set(GROUPS)
    places = [*MARCH, *COMMON, *(p for group in (*BENCHES.values(), *CODE.values()) for p in group)]
    assert [p for p in places if not (ROOT / p).exists()] == []
