"""Runs in threads of one process end with the bits of runs in a row, whatever the others do."""

import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import matplotlib as mpl
import pytest

import softway as sw
from records import differences
from softway.kernels.jit.threads import use
from softway.record.view.pictures import pictures
from softway.scenario.checks.check import check
from softway.scenario.files import loads

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("own_units")]

ROOT = Path(__file__).parents[4]
SKID = (ROOT / "tests" / "robustness" / "inputs" / "marched" / "skid.toml").read_text(encoding="utf-8")
BAR = (ROOT / "scenarios" / "paper_bar.toml").read_text(encoding="utf-8").replace('end = "4 s"', 'end = "0.6 s"')
BALL = """
[bodies.ball]
kind = "Solid"
mesh = { kind = "Ball", radius = "0.5 m", cells = 4 }
material = { kind = "NeoHookean", E = "1 Pa", nu = 0.3 }
density = "1 kg/m^3"
velocity = ["0.1 m/s", "0 m/s", "-0.2 m/s"]
place = { bottom = "10 mm" }

[bodies.plane]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0, 0, 0], normal = [0, 0, 1] }

[[contacts]]
name = "plane"
between = ["ball", "plane"]
FRICTION

[time]
end = "0.4 s"
step = "0.05 s"

[solver]
kind = "FixedPoint"
operator = { kind = "OPERATOR" }
"""
FIT = """
[bodies.inner]
kind = "Solid"
mesh = { kind = "Ring", inner = "20 mm", outer = "30.05 mm", cells = [2, 24] }
material = { kind = "NeoHookean", E = "210 MPa", nu = 0.3 }
density = "1100 kg/m^3"

[bodies.outer]
kind = "Solid"
mesh = { kind = "Ring", inner = "30 mm", outer = "40 mm", cells = [2, 28] }
material = { kind = "NeoHookean", E = "210 MPa", nu = 0.3 }
density = "1100 kg/m^3"

[[contacts]]
name = "fit"
between = ["inner.outer", "outer.inner"]
start = "fit"

[time]
end = "25 us"
step = "5 us"
"""
RUBBED = 'friction = { kind = "Coulomb", mu = 0.2 }'


def ball(operator: str, friction: str = "") -> str:
    return BALL.replace("OPERATOR", operator).replace("FRICTION", friction)


SCENARIOS = {
    "bar": BAR,
    "paper": BAR.replace('"Energy" #', '"Paper" #'),
    "plastic": SKID.replace('end = "1.5 s"', 'end = "0.5 s"').replace('every = "0 s"', 'every = "30 s"'),
    "ball": ball("Factored", RUBBED),
    "free": ball("MatrixFree"),
    "grid": ball("Multigrid"),
    "fit": FIT,
}


@pytest.fixture(scope="module")
def serial(tmp_path_factory) -> Path:
    """The runs, one after the other."""
    folder = tmp_path_factory.mktemp("serial")
    for name, text in SCENARIOS.items():
        sw.run(loads(text), folder / name)
    return folder


@pytest.fixture
def hasty():
    """Threads that take turns a thousand times as often as they would."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(5e-6)
    yield
    sys.setswitchinterval(before)


@pytest.mark.parametrize("kernels", [1, pytest.param(2, marks=pytest.mark.minutes)])
def test_runs_in_four_threads(serial, tmp_path, hasty, kernels):
    """With a picture of each, on one thread and on two for the kernels of each; the style of pictures is put back."""
    style = dict(mpl.rcParams)

    def computed(name: str) -> list[str]:
        with use(kernels):
            run = sw.run(loads(SCENARIOS[name]), tmp_path / name)
        for file in pictures(run):
            assert file.read_bytes().startswith(b"\x89PNG")
            file.unlink()
        return differences(run.path, serial / name)

    with ThreadPoolExecutor(4) as pool:
        assert dict(zip(SCENARIOS, pool.map(computed, SCENARIOS), strict=True)) == {n: [] for n in SCENARIOS}
    assert dict(mpl.rcParams) == style


def test_the_same_in_every_thread(serial, tmp_path, hasty):
    """One scenario several times at once: nothing that a kind of run keeps is shared."""
    names = [name for name in ("grid", "ball") for _ in range(4)]

    def computed(k: int) -> list[str]:
        return differences(sw.run(loads(SCENARIOS[names[k]]), tmp_path / str(k)).path, serial / names[k])

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(computed, range(len(names)))) == [[]] * len(names)


def test_runs_cancelled_by_another_thread_are_resumed_with_the_same_bits(serial, tmp_path):
    begun, off = threading.Barrier(4), threading.Event()
    names = ("bar", "plastic", "ball")

    def computed(name: str) -> str:
        def met(progress: sw.Progress) -> None:
            if progress.slabs == 2:
                begun.wait(60)

        with pytest.raises(sw.Cancelled):
            sw.run(loads(SCENARIOS[name]), tmp_path / name, progress=met, cancel=off.is_set)
        return sw.Run(tmp_path / name).stop.reason

    with ThreadPoolExecutor(3) as pool:
        coming = pool.map(computed, names)
        begun.wait(60)
        off.set()
        assert list(coming) == ["cancelled"] * 3
        list(pool.map(sw.resume, [tmp_path / name for name in names]))
    assert {name: differences(tmp_path / name, serial / name) for name in names} == {name: [] for name in names}


def test_two_threads_do_not_write_to_one_folder(tmp_path):
    inside, done = threading.Event(), threading.Event()

    def rest(progress: sw.Progress) -> None:
        inside.set()
        done.wait(60)

    with ThreadPoolExecutor(1) as pool:
        coming = pool.submit(sw.run, loads(BAR), tmp_path / "run", progress=rest)
        inside.wait(60)
        with pytest.raises(sw.InputError, match="still writing"):
            sw.resume(tmp_path / "run")
        done.set()
        assert coming.result().stop.reason == "done"


def test_marches_take_turns_in_one_thread():
    """Generators that are asked for a step each in turn; each step has the bits that it has alone."""
    scenes = []
    for name in ("bar", "plastic", "ball"):
        scenario = loads(SCENARIOS[name])
        scene = sw.Scene(bodies=scenario.bodies, contacts=scenario.contacts)
        scenes.append((scene, scenario.time.end, scenario.time.step))

    def steps(k: int):
        scene, end, step = scenes[k]
        return sw.march(scene, until=end, step=step)

    alone = [[bits(step) for step in steps(k)] for k in range(len(scenes))]
    going, found = [steps(k) for k in range(len(scenes))], [[] for _ in scenes]
    while any(len(f) < len(a) for f, a in zip(found, alone, strict=True)):
        for march, seen in zip(going, found, strict=True):
            seen += [bits(step) for step in [next(march, None)] if step is not None]
    assert found == alone


def bits(step: sw.Step) -> list[bytes]:
    return [u.tobytes() for u in (*step.after.displacement.values(), *step.after.velocity.values())]


@pytest.mark.parametrize("name", ["plastic", "ball", "fit"])
def test_one_model_is_marched_by_several_threads_at_once(name, hasty):
    """A built model is only read: marches of it in three threads, and two that take turns, have the same bits."""
    checked = check(loads(SCENARIOS[name]))

    def steps(_: int = 0):
        time, solver = checked.scenario.time, checked.scenario.solver
        return sw.march(checked.model, until=time.end, step=checked.step, weight=time.weight, method=solver)

    alone = [bits(step) for step in steps()]
    with ThreadPoolExecutor(3) as pool:
        assert list(pool.map(lambda k: [bits(step) for step in steps(k)], range(3))) == [alone] * 3
    turns = [(bits(one), bits(other)) for one, other in zip(steps(), steps(), strict=True)]
    assert turns == [(step, step) for step in alone]
