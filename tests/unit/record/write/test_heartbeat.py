"""Progress lines inside one attempt at a slab: the clock decides what is shown and nothing else."""

import math
from itertools import count
from types import SimpleNamespace

import softway as sw
from softway.marching.results.trying import Trying
from softway.record.write import progress
from softway.record.write.progress import BEAT, Heartbeat

SCENE = """
[bodies.block]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1.0, 1.0], cells = [2, 4] }
material = { kind = "NeoHookean", E = 1e3, nu = 0.3 }
density = 1.0
velocity = [0.0, -1.0]
place = { bottom = 0.05 }

[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0], normal = [0, 1] }

[[contacts]]
between = ["block", "floor"]

[time]
end = 0.1
step = 0.01
"""


def test_a_run_tells_what_it_tries_and_ends_with_the_same_bits(tmp_path, monkeypatch) -> None:
    """A slow machine, whose clock advances by half of the interval at every look, against a fast one.

    It looks at the start of each attempt, at each iterate, and at each step of the contact problems.
    """
    file = tmp_path / "fall.toml"
    file.write_text(SCENE, encoding="utf-8")
    lines: list[str] = []
    fast = sw.run(sw.load(file), tell=lines.append)
    assert lines == []
    ticks = count(1)
    monkeypatch.setattr(progress, "clock", SimpleNamespace(perf_counter=lambda: 0.5 * BEAT * next(ticks)))
    slow = sw.run(sw.load(file), tell=lines.append)
    iterations = slow.history["iterations"]
    assert len(lines) >= sum(math.ceil(k / 2) - 1 for k in iterations[iterations > 0].astype(int).tolist()) > 5
    assert any(line.endswith(", 3 active rows") and ": iteration 3, relative change " in line for line in lines)
    assert any("3 active rows, contact of 12 rows, 3 active, exchange 0" in line for line in lines)
    assert (slow.history["energy_strain"] == fast.history["energy_strain"]).all()


def test_a_new_attempt_starts_the_clock_again() -> None:
    times, lines = iter([0.0, 4.0, 6.0, 10.0]), []
    beat = Heartbeat(lines.append, lambda: next(times))
    for iteration in (0, 1, 0, 1):
        beat(Trying(slab=1, time=0.0, span=1.0, iteration=iteration, change=0.5, active=0))
    assert lines == []


def test_long_work_is_told_before_it_begins() -> None:
    """A factor that will take a minute by its count of operations; a short one is not."""
    times, lines = iter([0.0, 0.1, 0.2]), []
    beat = Heartbeat(lines.append, lambda: next(times))
    beat(Trying(slab=0, iteration=0))
    beat(Trying(slab=0, iteration=0, doing="factoring 9 unknowns", seconds=1e-6))
    beat(Trying(slab=0, iteration=0, doing="factoring 900000 unknowns", seconds=60.0))
    assert lines == ["after 0 s: equilibrium at the start: factoring 900000 unknowns"]
