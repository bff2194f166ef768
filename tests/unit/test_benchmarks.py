"""The figures of the benchmarks: their file, their comparison, their page."""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from figures import KEYS, STORED, Figure, read, regressions, speedup, unmatched, written
from groups.asked import Asked
from groups.methods import spread
from groups.peers import Time, against, sampled, whole
from groups.peers import figures as shown
from machine import described
from run import GROUPS, NOTES, group_of, peers_of
from table import page

FAST = speedup("drop/3k", 2.0, 20.0, "s", ">= 10")
SLOPE = Figure(name="scaling/cost", value=1.2, ratio=1.2, target="<= 1.35")
PLAIN = Figure(name="slab/bar", value=3.5, unit="ms")
CPU = Figure(name="machine/processor", value="a processor")
ALL = (CPU, FAST, SLOPE, PLAIN)


def named(*figures: Figure) -> dict[str, Figure]:
    return {f.name: f for f in figures}


def with_ratio(figure: Figure, ratio: float, unit: str = "") -> Figure:
    return Figure(name=figure.name, value=figure.value, unit=unit, ratio=ratio, target=figure.target)


def test_a_file_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "new" / "latest.json"
    written(path, ALL)
    assert read(path) == named(*ALL)
    rows = json.loads(path.read_text())
    assert all(tuple(row) == KEYS for row in rows)
    assert [row["pass"] for row in rows] == [None, True, True, None]


def test_without_a_file_nothing_is_stored(tmp_path: Path) -> None:
    assert read(tmp_path / "latest.json") == {}


@pytest.mark.parametrize(
    ("target", "value", "ratio", "passed"),
    [
        (">= 10", 1.0, 10.0, True),
        (">= 10", 20.0, 9.9, False),
        ("<= 1.35", 2.0, 1.3, True),
        ("<= 1e-6", 1e-7, None, True),
        ("<= 1e-6", 1e-5, None, False),
        ("higher", 1.0, 1.0, None),
        (None, 1.0, 1.0, None),
    ],
)
def test_a_target_is_for_the_ratio_or_else_for_the_value(
    target: str | None, value: float, ratio: float | None, passed: bool | None
) -> None:
    assert Figure(name="a/b", value=value, ratio=ratio, target=target).passed is passed


@pytest.mark.parametrize(("figure", "ratio"), [(FAST, 7.9), (SLOPE, 1.45)])
def test_a_ratio_worse_by_more_than_a_fifth_is_told(figure: Figure, ratio: float) -> None:
    worse = regressions(named(with_ratio(figure, ratio), PLAIN), named(*ALL))
    assert list(worse) == [figure.name]
    assert f"{ratio:.3g}" in worse[figure.name]


@pytest.mark.parametrize(("figure", "ratio"), [(FAST, 8.1), (FAST, 30.0), (SLOPE, 1.43), (SLOPE, 0.5)])
def test_a_ratio_within_a_fifth_or_better_passes(figure: Figure, ratio: float) -> None:
    assert not regressions(named(with_ratio(figure, ratio)), named(*ALL))


def test_a_baseline_of_an_earlier_run_is_not_compared() -> None:
    assert not regressions(named(with_ratio(FAST, 1.0, f"s, {STORED}")), named(*ALL))


def test_the_time_of_the_processor_is_compared_where_it_is_known() -> None:
    wall = speedup("drop/3k/ours, 1 thread", 2.0, 20.0, "s")
    cpu = speedup("drop/3k/ours, processor", 2.0, 20.0, "s")
    slow = with_ratio(wall, 5.0)
    assert list(regressions(named(slow), named(wall, cpu))) == [wall.name]
    assert not regressions(named(slow, cpu), named(wall, cpu))
    assert list(regressions(named(slow, with_ratio(cpu, 7.0)), named(wall, cpu))) == [cpu.name]


def test_names_that_only_one_file_has_are_told() -> None:
    other = speedup("drop/30k", 1.0, 2.0, "s")
    assert unmatched(named(other, SLOPE), named(*ALL)) == (["drop/30k"], ["drop/3k"])
    assert not regressions(named(other), named(*ALL))


def test_the_page_has_a_row_for_each_figure_and_a_list_of_the_machine() -> None:
    text = page(ALL, {"drop": "A cube is thrown."})
    assert "* processor: a processor\n" in text
    assert "A cube is thrown.\n\n| what |" in text
    assert "| 3k | 2 | s | 20 | 10 | >= 10 | yes |\n" in text
    assert "| bar | 3.5 | ms |  |  |  |  |\n" in text
    assert text.count("|-|-|-|-|-|-|-|") == 3


def test_a_missed_target_stands_out() -> None:
    assert "| **no** |" in page([with_ratio(FAST, 5.0)], {})


def test_every_group_says_what_it_measures() -> None:
    assert all(NOTES[name] for name in GROUPS)
    assert group_of("scaling/cost of a slab") == "drop"


def test_the_machine_is_described_by_texts() -> None:
    figures = named(*described())
    assert {"machine/processor", "machine/cores", "machine/memory", "machine/numpy"} <= set(figures)
    assert all(isinstance(f.value, str) and f.passed is None for f in figures.values())


def test_peers_are_named_with_interpreters(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOFTWAY_PEERS", "NGSolve=python3 GetFEM=a")
    assert peers_of(["GetFEM=b"]) == {"NGSolve": "python3", "GetFEM": "b"}


def test_the_stored_time_of_a_peer_that_is_missing_is_marked(capsys: pytest.CaptureFixture[str]) -> None:
    stored = named(
        Figure(name="drop/3k/NGSolve", value=12.0, unit="s, 2 threads"),
        Figure(name="drop/3k/NGSolve, processor", value=18.0, unit="s, 1 thread"),
    )
    times = whole(Asked(stored=stored), "NGSolve", "drop/3k", 9)
    assert times == [Time(peer="NGSolve", seconds=12.0, cpu=18.0, unit=f"s, 2 threads, {STORED}", stored=True)]
    assert "NGSolve" in capsys.readouterr().out
    figure = against(times, "drop/3k/ours", 1.0, "s", ">= 10")
    assert figure.ratio == 12.0
    assert not figure.comparable
    assert against(times, "drop/3k/ours", 1.0, "s", ">= 10", "cpu").ratio == 18.0


def test_a_peer_never_measured_gives_no_ratio() -> None:
    assert sampled(Asked(), "GetFEM", "drop/30k", 20, (60, 40)) == []
    assert against([], "drop/30k/ours", 1.0, "s", ">= 10").ratio is None


def test_the_fastest_peer_counts() -> None:
    times = [
        Time(peer="NGSolve", seconds=12.0, cpu=12.0, unit="s, 1 thread"),
        Time(peer="GetFEM", seconds=13.0, cpu=13.0, unit="s, 1 thread"),
        Time(peer="GetFEM", seconds=9.0, cpu=None, unit="s, 2 threads"),
    ]
    figure = against(times, "drop/3k/ours", 1.0, "s", ">= 10")
    assert (figure.ratio, figure.passed) == (9.0, False)
    assert "GetFEM" in figure.unit
    assert against(times, "drop/3k/ours", 1.0, "s", ">= 10", "cpu").ratio == 12.0
    told = [(f.name, f.value, f.unit) for f in shown(times, "drop/3k")]
    assert ("drop/3k/GetFEM", 9.0, "s, 2 threads") in told
    assert ("drop/3k/GetFEM, processor", 13.0, "s, 1 thread") in told


def test_the_factor_is_spread_over_a_run() -> None:
    assert spread({"seconds": [11.0, 1.0, 1.0]}) == pytest.approx(1.1)
