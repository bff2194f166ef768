"""Runs with friction of nodes with inertia: a stopped run ends with the same bits as one that never stopped."""

import numpy as np
import pytest

import softway as sw
from softway.scenario.files import loads

TEXT = """
[bodies.block]
kind = "Solid"
mesh = {{ kind = "Rectangle", size = [0.2, 0.1], cells = [3, 2] }}
material = {{ kind = "NeoHookean", E = 1e6, nu = 0.3 }}
density = 1000
velocity = [1.0, -0.5]

[bodies.floor]
kind = "Tool"
shape = {{ kind = "HalfSpace", point = [0.0, -0.001], normal = [0.02, 1.0] }}

[[contacts]]
between = ["block.bottom", "floor"]
friction = {{ kind = "Stribeck", mu_s = 0.5, mu_k = 0.3, v_s = 0.1 }}
timing = "{rule}"

[[loads]]
kind = "Gravity"
acceleration = [0.0, -9.81]

[time]
end = "7.5 ms"
step = "0.3 ms"

[output]
checkpoints = {{ every = "0 s", keep = 3 }}
"""


@pytest.mark.slow
@pytest.mark.few(2)
@pytest.mark.parametrize("rule", ["Impulse", "Paper"])
@pytest.mark.parametrize("after", [6, 19])
def test_a_stopped_run_is_resumed_with_the_same_bits(rule, after, tmp_path):
    scenario = loads(TEXT.format(rule=rule))
    whole = sw.run(scenario, tmp_path / "whole")

    def stop(progress: sw.Progress) -> None:
        if progress.slabs == after:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(scenario, tmp_path / "stopped", progress=stop)
    resumed = sw.resume(tmp_path / "stopped")
    assert whole.history["dissipation"][-1] > 0.0 and resumed.events.rows == whole.events.rows > 2
    for name in ("energy_kinetic", "energy_strain", "dissipation", "contact.block.bottom-floor.force_t"):
        assert np.array_equal(whole.history[name], resumed.history[name], equal_nan=True)
