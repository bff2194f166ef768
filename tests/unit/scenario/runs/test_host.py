"""What a host program has: progress, cancellation, a log that is silent until it is listened to."""

import logging
import subprocess
import sys
import threading
from dataclasses import dataclass

import numpy as np
import pytest

import softway as sw
from records import differences
from softway.record.storage.checkpoint import listed
from softway.record.write.progress import Meter
from softway.scenario.files import loads

BAR = """
[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = "1 m", cells = 3 }
material = { kind = "LinearElastic", E = "1 Pa" }
density = "1 kg/m^3"
velocity = "1 m/s"

[bodies.wall]
kind = "Tool"
shape = { kind = "HalfSpace", point = "1.25 m", normal = -1 }

[[contacts]]
between = ["bar.right", "wall"]

[time]
end = "2 s"
step = "0.1 s"

[output]
checkpoints = { every = "1 h" }
"""
SLABS = 20
SCENARIO = loads(BAR)
SCENE = sw.Scene(bodies=SCENARIO.bodies, contacts=SCENARIO.contacts)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The run of a bar that nobody stops."""
    folder = tmp_path_factory.mktemp("bar") / "run"
    sw.run(SCENARIO, folder)
    return folder


def after(asks: int):
    """A ``cancel`` that says no so many times."""
    left = iter(range(asks))
    return lambda: next(left, None) is None


def test_progress_says_how_far_a_run_is(whole, tmp_path):
    seen: list[sw.Progress] = []
    sw.run(SCENARIO, tmp_path / "run", progress=seen.append)
    assert [p.slabs for p in seen] == [*range(1, SLABS + 1)] and {p.until for p in seen} == {2.0}
    assert [p.fraction for p in seen] == pytest.approx([k / SLABS for k in range(1, SLABS + 1)])
    assert [p.time for p in seen] == [p.step.after.time for p in seen]
    walls = [p.wall for p in seen]
    assert walls == sorted(walls) and seen[-1].left == 0.0 and seen[4].left == pytest.approx(3.0 * seen[4].wall)


def test_a_resumed_run_continues_the_count_and_measures_its_own_pace(tmp_path):
    with pytest.raises(sw.Cancelled):
        sw.run(SCENARIO, tmp_path / "run", cancel=after(30))
    done, seen = sw.Run(tmp_path / "run").summary["slabs"], []
    sw.resume(tmp_path / "run", scenario=SCENARIO, progress=seen.append)
    first = seen[0]
    assert first.slabs == done + 1 and seen[-1].slabs == SLABS and seen[-1].fraction == 1.0
    assert first.pace == pytest.approx(0.1 / first.wall)


def test_the_pace_is_that_of_the_last_half_minute(monkeypatch):
    now, seen = [0.0], []
    monkeypatch.setattr("softway.record.write.progress.clock.perf_counter", lambda: now[0])
    meter = Meter(seen.append, until=100.0, start=0.0)

    @dataclass
    class Interval:
        end: float

    @dataclass
    class Slab:
        slab: Interval

    for second in range(1, 61):
        now[0] = float(second)
        meter.took(Slab(Interval(float(min(second, 30)) + 0.1 * max(second - 30, 0))))
    assert seen[29].pace == pytest.approx(1.0) and seen[29].left == pytest.approx(70.0)
    assert seen[-1].pace == pytest.approx(0.1, rel=0.05) and seen[-1].left == pytest.approx(670.0, rel=0.05)


@pytest.mark.parametrize("slabs", [1, 11])
def test_what_progress_raises_comes_out_and_the_run_can_be_resumed(whole, tmp_path, slabs):
    broken = KeyError("widget")

    def watch(progress: sw.Progress) -> None:
        if progress.slabs == slabs:
            raise broken

    with pytest.raises(KeyError) as caught:
        sw.run(SCENARIO, tmp_path / "run", progress=watch)
    stop = sw.Run(tmp_path / "run").stop
    assert caught.value is broken and stop.reason == "failed" and stop.message == "KeyError: 'widget'"
    sw.resume(tmp_path / "run", scenario=SCENARIO)
    assert differences(tmp_path / "run", whole) == []


@pytest.mark.parametrize("asks", [0, 3, 31, 32, 33])
def test_a_cancelled_run_is_resumed_with_the_same_bits(whole, tmp_path, asks):
    """Called off at some iteration of some slab, twice."""
    with pytest.raises(sw.Cancelled, match=r"cancelled in the slab at t = "):
        sw.run(SCENARIO, tmp_path / "run", cancel=after(asks))
    if asks == 0:
        assert not (tmp_path / "run").exists()  # the start is an equilibrium of the contact nodes
        return
    run = sw.Run(tmp_path / "run")
    assert run.stop.reason == "cancelled" and run.history.rows == 1 + run.summary["slabs"] < SLABS
    assert len(listed(run.path)) == (run.history.rows > 1)
    with pytest.raises(sw.Cancelled):
        sw.resume(run.path, scenario=SCENARIO, cancel=after(10))
    assert [e["stopped"] for e in sw.resume(run.path, scenario=SCENARIO).provenance["resumed"]] == ["cancelled"] * 2
    assert differences(run.path, whole) == []


def test_cancel_is_called_at_every_iteration():
    asked = []
    steps = list(sw.march(SCENE, until=2.0, step=0.1, cancel=lambda: bool(asked.append(0))))
    assert len(asked) >= sum(s.report.iterations for s in steps) > len(steps)


def test_a_cancelled_march_continues_from_its_last_step():
    model, going = sw.build(SCENE), []
    plain = list(sw.march(model, until=2.0, step=0.1))
    with pytest.raises(sw.Cancelled):
        going.extend(sw.march(model, until=2.0, step=0.1, cancel=after(30)))
    assert 0 < len(going) < SLABS
    going += sw.march(model, until=2.0, step=0.1, state=going[-1].march_state)
    assert [s.after.displacement["bar"].tobytes() for s in going] == [
        s.after.displacement["bar"].tobytes() for s in plain
    ]


@dataclass(frozen=True, kw_only=True)
class Counted(sw.NeoHookean):
    """A law that notes how often it is asked for its stress, and calls the run off at one of these times."""

    calls: list[int]
    off: threading.Event
    at: float

    def stress(self, E):
        self.calls.append(len(E))
        if len(self.calls) >= self.at:
            self.off.set()
        return super().stress(E)


def counted(at: float) -> tuple[Counted, int]:
    """The law, and how many slabs a march with it has accepted when it is called off, of two."""
    law = Counted(E=1.0, nu=0.3, calls=[], off=threading.Event(), at=at)
    block = sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), material=law, density=1.0,
                     velocity=sw.bodies.Affine(gradient=((0.6, 0.3), (-0.5, -0.4))))  # fmt: skip
    slabs = 0
    try:
        for _ in sw.march(sw.Scene(bodies={"block": block}), until=1.0, step=0.5, cancel=law.off.is_set):
            slabs += 1
    except sw.Cancelled:
        pass
    return law, slabs


def test_a_slow_slab_is_left_after_the_iterate_that_is_being_computed():
    """Whenever it is called off, the law is asked a few times more; all of the slab would be many times."""
    law, slabs = counted(np.inf)
    whole = len(law.calls)
    assert slabs == 2
    found = [counted(at) for at in range(1, whole - 2)]
    assert whole > 20 and {s for _, s in found} == {0, 1}
    assert max(len(law.calls) - at for at, (law, _) in enumerate(found, 1)) <= 2


def test_a_static_start_can_be_cancelled():
    """A body under gravity on the ground: the first equilibrium takes steps."""
    law = sw.NeoHookean(E=100.0, nu=0.3)
    block = sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), material=law, density=1.0,
                     supports=(sw.Fixed(on="bottom"),))  # fmt: skip
    scene = sw.Scene(
        bodies={"block": block}, loads=(sw.Gravity(acceleration=(0.0, -9.81)),), start=sw.model.StaticStart()
    )
    model = sw.build(scene)
    with pytest.raises(sw.Cancelled, match="t = 0 s"):
        next(sw.march(model, until=1.0, cancel=after(2)))


def test_the_log_is_silent_until_it_is_configured(caplog):
    """INFO has the operator and rejected slabs, DEBUG every iterate; the host says where it goes."""
    code = (
        "import logging, softway as sw, sys; sys.stderr.write(str(logging.getLogger('softway').level)); "
        "logging.getLogger('softway.marching').warning('nobody hears this')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("", "0") and not logging.getLogger().isEnabledFor(logging.INFO)
    with caplog.at_level(logging.DEBUG, "softway"):
        run = sw.run(SCENARIO)
    names = {r.name for r in caplog.records}
    assert {"softway.marching.slabs", "softway.solve.methods.iteration", "softway.record.conduct"} <= names
    assert all(n.startswith("softway.") for n in names)
    told = [r.getMessage() for r in caplog.records if r.levelno == logging.INFO]
    assert any(m.startswith("operator ") for m in told) and any("done after 20 slabs" in m for m in told)
    iterates = [r for r in caplog.records if r.getMessage().startswith("iterate ")]
    assert len(iterates) == sum(run.history["iterations"])
