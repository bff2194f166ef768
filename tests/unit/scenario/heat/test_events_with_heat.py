"""Heat that has passed a contact, in the events of a run."""

import numpy as np
import pytest

import softway as sw
from softway.record.write import events

BLOCKS = """
[bodies.hot]
mesh = {{ kind = "Interval", length = 1.0, cells = 4 }}
material = {{ kind = "LinearElastic", E = 1.0 }}
density = 1.0
velocity = {{ kind = "Uniform", value = 0.1 }}
thermal = {{ temperature = 400.0, law = {{ conductivity = 0.01, capacity = 1.0 }} }}

[bodies.cold]
mesh = {{ kind = "Interval", length = 1.0, cells = 4, origin = 1.052 }}
material = {{ kind = "LinearElastic", E = 1.0 }}
density = 1.0
thermal = {{ temperature = 300.0, law = {{ conductivity = 0.01, capacity = 1.0 }} }}

[[contacts]]
name = "meet"
between = ["hot.right", "cold.left"]
{heat}

[time]
end = 4.0
step = 0.1
"""


def ran(tmp_path, heat: str) -> sw.Run:
    return sw.run(sw.loads(BLOCKS.format(heat=heat)), tmp_path / "run")


def test_events_tell_the_heat_that_has_passed(tmp_path) -> None:
    run = ran(tmp_path, "heat = { conductance = 0.5 }")
    told, history = run.events, run.history
    assert list(told["kind"]) == ["touch", "release"]
    ends = np.searchsorted(history["time"], told["time"])
    np.testing.assert_allclose(told["heat"], history["heat.through.meet"][ends], rtol=1e-15)
    assert 0.0 < told["heat"][0] < told["heat"][1] == pytest.approx(history["heat.through.meet"][-1], rel=1e-9)


def test_events_of_contacts_without_heat_have_no_such_column(tmp_path) -> None:
    run = ran(tmp_path, "")
    assert "heat" not in run.events and events.HEAT[0][0] == "heat"
