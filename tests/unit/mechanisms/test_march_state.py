"""A march continues from the state of one of its steps with the same bits."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.mechanisms import Mechanism, MechanismState, Rigid, march, walk
from softway.mechanisms.contacts.impacts import StopMarch
from softway.mechanisms.step import MechanismStep

FOLDER = Path(__file__).parents[3] / "scenarios"
TOP = Mechanism(bodies={"top": Rigid(mass=1.0, centre=(0.0, 0.0, 0.0), inertia=(1.0, 2.0, 2.5), spin=(0.1, 3.0, 0.1))})
CASES = {
    "bearing_clearance": 12e-3,
    "hammer_on_stop": 0.6,
    "newtons_cradle": 0.3,
    "rocking_block": 1.0,
    "slider_crank": 5e-3,
    "squeezer": 5e-4,
    "tippe_top": 0.02,
    "woodpecker": 0.1,
}


@pytest.fixture(autouse=True)
def short_marches_are_compiled(monkeypatch):
    """Loops over slabs with stops, which marches of so few slabs would not compile."""
    monkeypatch.setattr(walk, "COMPILED", 0)


def numbers(step: MechanismStep) -> list[bytes]:
    """All numbers of a step."""
    states = [(s.centre, s.rotation, s.velocity, s.spin) for s in step.bodies.values()]
    rest = [step.energy_kinetic, step.energy_potential, step.work, step.dissipation, step.energy_error, step.joints]
    more = [*step.motors.values(), step.joint_velocity, step.iterations, step.scalar, step.time]
    arrays = [*(a for state in states for a in state), step.momentum, step.spin, np.array(rest), np.array(more)]
    return [np.ascontiguousarray(a).tobytes() for a in arrays]


@pytest.mark.slow
@pytest.mark.few(4)
@pytest.mark.parametrize("name", sorted(CASES))
def test_the_rest_of_a_march_has_the_same_bits(name):
    checked = sw.check(sw.load(FOLDER / f"{name}.toml"))
    mechanism, until = checked.mechanism, CASES[name]
    step, whole, states = checked.step, [], list[MechanismState]()
    for one in march(mechanism, until=until, step=step):
        whole.append(one)
        states.append(one.march_state())
    for at in (0, 1, len(whole) // 2, len(whole) - 2):
        rest = list(march(mechanism, until=until, step=step, state=states[at]))
        assert len(rest) == len(whole) - at - 1
        for one, other in zip(rest, whole[at + 1 :], strict=True):
            assert numbers(one) == numbers(other)
            assert (one.events, one.closed) == (other.events, other.closed)


def test_states_hold_no_address():
    mechanism = sw.check(sw.load(FOLDER / "hammer_on_stop.toml")).mechanism
    state = next(iter(march(mechanism, until=0.6, step=1e-3))).march_state()
    assert max(int(np.abs(whole).max(initial=0)) for whole in state.flags.values()) < 2**32


@pytest.mark.parametrize("name", ["newtons_cradle", "rocking_block", "slider_crank"])
def test_compiled_slabs_have_the_bits_of_single_ones(monkeypatch, name):
    checked = sw.check(sw.load(FOLDER / f"{name}.toml"))
    span = {"until": CASES[name], "step": checked.step}
    grouped = list(march(checked.mechanism, **span))
    monkeypatch.setattr(StopMarch, "flown", lambda self, table, h, begin, first, total, events: (first, None))
    monkeypatch.setattr(walk, "TOGETHER", 1)
    single = list(march(checked.mechanism, **span))
    assert any(step.events for step in single) == (name != "slider_crank")
    for one, other in zip(grouped, single, strict=True):
        assert numbers(one) == numbers(other)
        assert (one.events, one.closed) == (other.events, other.closed)


def test_groups_of_slabs_with_rests_have_the_states_of_every_slab():
    mechanism = sw.check(sw.load(FOLDER / "newtons_cradle.toml")).mechanism
    fine = {step.time: step for step in march(mechanism, until=0.3, step=1e-3)}
    coarse = list(march(mechanism, until=0.3, step=1e-3, every=7))
    assert len(coarse) == 44
    for step in coarse:
        states = fine[step.time].bodies
        assert all(np.array_equal(step.bodies[name].centre, state.centre) for name, state in states.items())
    assert sum(len(step.events) for step in coarse) == sum(len(step.events) for step in fine.values()) > 0
    assert sum(step.iterations for step in coarse) == sum(step.iterations for step in fine.values())


def test_records_of_groups_have_the_bytes_of_records_of_steps(tmp_path):
    checked = sw.check(sw.load(FOLDER / "newtons_cradle.toml"))
    sw.run(checked, tmp_path / "groups")
    sw.run(checked, tmp_path / "steps", progress=lambda progress: None)
    calls = iter(range(10**9))
    with pytest.raises(sw.Cancelled):
        sw.run(checked, tmp_path / "stopped", cancel=lambda: next(calls) == 40)
    sw.resume(tmp_path / "stopped")
    for name in ("history.csv", "motion.csv", "events.csv"):
        whole = (tmp_path / "groups" / name).read_bytes()
        assert len(whole.splitlines()) > 2
        assert whole == (tmp_path / "steps" / name).read_bytes()
        assert whole == (tmp_path / "stopped" / name).read_bytes()


def test_steps_keep_their_state_when_the_march_has_gone_on():
    steps = list(march(TOP, until=1.0, step=0.1))
    rest = list(march(TOP, until=1.0, step=0.1, state=steps[4].march_state()))
    assert [numbers(step) for step in rest] == [numbers(step) for step in steps[5:]]


def test_states_of_other_marches_are_refused():
    state = next(march(TOP, until=1.0, step=0.1)).march_state()
    two = Mechanism(bodies={name: Rigid(mass=1.0, centre=(0.0, 0.0, 0.0)) for name in "ab"})
    with pytest.raises(InputError, match="another mechanism"):
        march(two, until=1.0, step=0.1, state=state)
    with pytest.raises(InputError, match="slabs of 0.1"):
        march(TOP, until=1.0, step=0.05, state=state)
    last = list(march(TOP, until=1.0, step=0.1))[-1].march_state()
    assert list(march(TOP, until=1.0, step=0.1, state=last)) == []
