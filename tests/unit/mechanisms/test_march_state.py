"""A march continues from the state of one of its steps with the same bits."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.mechanisms import Mechanism, MechanismState, Rigid, march
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


def numbers(step: MechanismStep) -> list[bytes]:
    """All numbers of a step."""
    states = [(s.centre, s.rotation, s.velocity, s.spin) for s in step.bodies.values()]
    rest = [step.energy_kinetic, step.energy_potential, step.work, step.dissipation, step.energy_error, step.joints]
    more = [*step.motors.values(), step.joint_velocity, step.iterations, step.scalar, step.time]
    arrays = [*(a for state in states for a in state), step.momentum, step.spin, np.array(rest), np.array(more)]
    return [np.ascontiguousarray(a).tobytes() for a in arrays]


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


def test_a_march_that_has_gone_on_has_no_state_of_before():
    steps = march(TOP, until=1.0, step=0.1)
    first, second = next(steps), next(steps)
    assert second.march_state().slabs == 1
    with pytest.raises(InputError, match="has gone on"):
        first.march_state()


def test_states_of_other_marches_are_refused():
    state = next(march(TOP, until=1.0, step=0.1)).march_state()
    two = Mechanism(bodies={name: Rigid(mass=1.0, centre=(0.0, 0.0, 0.0)) for name in "ab"})
    with pytest.raises(InputError, match="another mechanism"):
        march(two, until=1.0, step=0.1, state=state)
    with pytest.raises(InputError, match="slabs of 0.1"):
        march(TOP, until=1.0, step=0.05, state=state)
    last = list(march(TOP, until=1.0, step=0.1))[-1].march_state()
    assert list(march(TOP, until=1.0, step=0.1, state=last)) == []
