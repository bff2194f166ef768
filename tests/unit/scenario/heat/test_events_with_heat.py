"""Heat that has passed a contact in the events of a run, heat fluxes in its frames, and the place of a wrong one."""

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


def test_summary_tells_the_entropy_of_the_whole_run(tmp_path) -> None:
    """Two insulated bars that exchange heat: sum of C ln(T / T0) of their nodes."""
    run = ran(tmp_path, "heat = { conductance = 0.5 }")
    end = run.fields[-1]
    assert end.time == pytest.approx(4.0)
    capacity, start = np.tile([0.125, 0.25, 0.25, 0.25, 0.125], 2), np.repeat([400.0, 300.0], 5)
    produced = float((capacity * np.log(end["temperature"] / start)).sum())
    assert run.summary["heat"]["entropy_produced"] == pytest.approx(produced, rel=1e-6)


def test_events_of_contacts_without_heat_have_no_such_column(tmp_path) -> None:
    run = ran(tmp_path, "")
    assert "heat" not in run.events and events.HEAT[0][0] == "heat"


def test_frames_have_the_flux_of_the_cells(tmp_path) -> None:
    """Conductivity times the gradient of the temperature, in bars of four cells."""
    last = ran(tmp_path, "heat = { conductance = 0.5 }").fields[-1]
    falls = -np.diff(last["temperature"].reshape(2, 5), axis=1).ravel() / 0.25
    assert falls.max() > 1.0
    np.testing.assert_allclose(last["heat_flux"][:, 0], 0.01 * falls, rtol=1e-12, atol=1e-12)
    assert not last["heat_flux"][:, 1:].any()


def test_a_temperature_below_zero_is_refused_at_its_place() -> None:
    text = BLOCKS.format(heat="").replace("temperature = 400.0", "temperature = -5.0")
    with pytest.raises(sw.InputError, match="in kelvin") as error:
        sw.check(sw.loads(text))
    assert error.value.where == "bodies.hot.thermal.temperature"
