"""What all tests share: pictures without a screen, reproducible generated cases, processes that can be interrupted,
one registry of units, few values of tests that have many, files without slow tests unread where those are asked for,
and which tests of several processes stay together.
"""

import gc
import signal
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pytest
from hypothesis import settings

from softway.scenario.hints.units_text import Units

mpl.use("Agg")
settings.register_profile("softway", derandomize=True, deadline=None, max_examples=25, database=None)
settings.load_profile("softway")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # begun in the background: processes of tests would inherit it
    signal.signal(signal.SIGINT, signal.default_int_handler)

OWN_UNITS = Units.standard
Units.standard = staticmethod(cache(OWN_UNITS))  # a quarter of a second for each reader of a scenario


@pytest.fixture
def own_units(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every reader makes a registry of units of its own, as outside of the tests."""
    monkeypatch.setattr(Units, "standard", OWN_UNITS)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Files that do not name the mark are not imported where slow tests are asked for: every process collects all."""
    if not str(config.getoption("markexpr")).startswith("slow") or collection_path.suffix != ".py":
        return None
    return True if "mark.slow" not in collection_path.read_text(encoding="utf-8") else None


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """What is collected lives to the end: nobody looks for garbage in it, now or later."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.collect()
        gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Of the values of a test with ``few(n)``, n that are spread evenly stay; the others are for ``minutes``.

    Values that are collected alone, by their names, stay.
    """
    values: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("few"):
            values[item.nodeid.partition("[")[0]].append(item)
    for group in values.values():
        (most,) = group[0].get_closest_marker("few").args
        last = len(group) - 1
        kept = {round(k * last / max(most - 1, 1)) for k in range(most)} if most <= last else range(last + 1)
        for place in set(range(last + 1)).difference(kept):
            group[place].add_marker(pytest.mark.minutes)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Files go to processes as a whole, those of mechanisms to one process and those of piles: their kernels take
    most of the time of compilation, and every process compiles those that it finds on no disk.
    """
    from xdist.scheduler import LoadScopeScheduling

    class Together(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            *_, folder, _ = nodeid.partition("::")[0].split("/")
            return folder if folder in ("mechanisms", "piles") else str(super()._split_scope(nodeid))

    return Together(config, log) if config.getvalue("dist") == "loadscope" else None
