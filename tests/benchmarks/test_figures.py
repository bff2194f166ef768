"""The figures of the benchmarks: their file, their comparison, their page."""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import run
from groups.asked import Asked
from groups.force import apart, means
from groups.methods import spread
from groups.peers import Time, against, sampled, whole
from groups.peers import figures as shown
from processes.apart import Failed, alone
from record.figures import KEYS, STORED, Figure, read, regressions, speedup, unmatched, written
from record.fingerprint import Origin, fingerprint, origin, prints
from record.machine import described
from record.table import page
from run import GROUPS, NOTES, changed, group_of, peers_of, rendered

FAST = speedup("drop/3k", 2.0, 20.0, "s", ">= 10")
SLOPE = Figure(name="scaling/cost", value=1.2, ratio=1.2, target="<= 1.35")
PLAIN = Figure(name="slab/bar", value=3.5, unit="ms")
CPU = Figure(name="machine/processor", value="a processor")
ALL = (CPU, FAST, SLOPE, PLAIN)
ORIGIN = Origin(date="2026-01-31", commit="abc", code="c", bench="b", seconds=12.0)


def named(*figures: Figure) -> dict[str, Figure]:
    return {f.name: f for f in figures}


def with_ratio(figure: Figure, ratio: float, unit: str = "") -> Figure:
    return Figure(name=figure.name, value=figure.value, unit=unit, ratio=ratio, target=figure.target)


def test_a_file_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "new" / "latest.json"
    written(path, ALL, {"drop": ORIGIN})
    assert read(path) == (named(*ALL), {"drop": ORIGIN})
    rows = json.loads(path.read_text())["figures"]
    assert all(tuple(row) == KEYS for row in rows)
    assert [row["pass"] for row in rows] == [None, True, True, None]


def test_without_a_file_nothing_is_stored(tmp_path: Path) -> None:
    assert read(tmp_path / "latest.json") == ({}, {})


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
    text = page(ALL, {"drop": "A cube is thrown."}, {}, {})
    assert "* processor: a processor\n" in text
    assert "A cube is thrown.\n\n| what |" in text
    assert "| 3k | 2 | s | 20 | 10 | >= 10 | yes |\n" in text
    assert "| bar | 3.5 | ms |  |  |  |  |\n" in text
    assert text.count("|-|-|-|-|-|-|-|") == 3


def test_a_missed_target_stands_out() -> None:
    assert "| **no** |" in page([with_ratio(FAST, 5.0)], {}, {}, {})


def test_a_group_has_its_date_and_commit_and_no_table_when_its_code_has_changed() -> None:
    text = page([FAST], {}, {"drop": ORIGIN}, {})
    assert "Measured on 2026-01-31 at commit `abc`, in 12 s." in text
    text = page([FAST], {}, {"drop": ORIGIN}, {"drop": "the measured code has changed since"})
    assert "Measured on 2026-01-31" in text
    assert "Not shown: the measured code has changed since" in text
    assert "| 3k |" not in text


def test_words_and_layout_do_not_change_a_fingerprint(tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    file.write_text('"""One."""\n\n\ndef f(x):\n    """Two."""\n    return g(x, "a")\n')
    first = fingerprint(["a.py"], tmp_path)
    file.write_text('def f(x):  # three\n    return g(\n        x,\n        \'a\',\n    )\n"""Four."""\n')
    assert fingerprint(["a.py"], tmp_path) == first
    assert fingerprint(["."], tmp_path) == first
    file.write_text("def f(x):\n    return g(x, 'b')\n")
    assert fingerprint(["a.py"], tmp_path) != first


def test_figures_of_other_code_are_told_and_not_shown() -> None:
    now = origin("drop", 1.0)
    code, bench = prints("drop")
    assert changed({"drop": now}, ["drop", "scaling"]) == {}
    old = Origin(date="", commit="", code="other", bench=bench)
    assert "measured code" in changed({"drop": old}, ["drop"])["drop"]
    assert changed({"drop": old}, ["drop"], bench_only=True) == {}
    other = Origin(date="", commit="", code=code, bench="other")
    assert "what measures" in changed({"drop": other}, ["scaling"], bench_only=True)["scaling"]
    assert list(changed({}, ["drop"])) == ["drop"]
    assert "| 3k |" in rendered(named(CPU, FAST), {"drop": now})
    assert "| 3k |" not in rendered(named(CPU, FAST), {"drop": old})


def test_a_comparison_with_what_another_benchmark_measured_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(run, "GROUPS", {"drop": lambda asked: iter([FAST])})
    asked = Asked(stored=named(FAST))
    assert run.checked(asked, ["drop"], {}) == 1
    assert "drop: not compared" in capsys.readouterr().out
    assert run.checked(asked, ["drop"], {"drop": origin("drop", 1.0)}) == 0


def test_a_failure_of_our_own_and_a_number_that_is_none_fail_a_group(monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(asked: Asked) -> object:
        yield FAST
        raise Failed("cube: no memory")

    groups = {
        "drop": failing,
        "slab": lambda asked: iter([Figure(name="slab/bar", value=float("nan"))]),
        "large": lambda asked: iter(()),
        "start": lambda asked: iter([PLAIN]),
    }
    monkeypatch.setattr(run, "GROUPS", groups)
    figures, failed = run.collected(Asked(), groups)
    assert figures == named(PLAIN)
    assert failed == {"drop": "cube: no memory", "slab": "slab/bar is not finite", "large": "no figures"}
    with pytest.raises(Failed, match="inertia"):
        alone("inertia", cells=-1, keep="nowhere")


def test_a_force_is_told_by_the_momentum_it_gives() -> None:
    steady = {"time": [1e-3, 2e-3, 3e-3], "momentum": [-5.0, -4.0, -4.0]}
    assert means(steady["time"], steady["momentum"], 5e-4, 3e-3) == pytest.approx([0.0, 0.0, 1e3, 1e3, 0.0, 0.0])
    late = {"time": [1.5e-3, 2e-3, 3e-3], "momentum": [-5.0, -4.0, -4.0]}
    assert apart(steady, steady) == 0.0
    assert apart(late, steady) == pytest.approx(100.0)
    assert apart(late, steady, 1e-3) == pytest.approx(0.0, abs=1e-9)


def test_what_a_peer_prints_becomes_figures(tmp_path: Path) -> None:
    told = {"version": "1", "wall": 2.5, "cpu": 2.5, "seconds": [0.1, 0.3] * 6, "touching": [False, True] * 6}
    script = tmp_path / "peer"
    script.write_text(f"#!/bin/sh\necho '{json.dumps(told)}'\n")
    script.chmod(0o755)
    asked = Asked(peers={"NGSolve": str(script)})
    assert [t.seconds for t in whole(asked, "NGSolve expert", "drop/3k", 9)] == [2.5, 2.5]
    (time, _) = sampled(asked, "NGSolve expert", "drop/30k", 20, (10, 20))
    assert time.seconds == pytest.approx(0.1 + 10 * 0.1 + 20 * 0.3)
    assert "12 steps" in time.unit


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
