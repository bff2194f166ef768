"""A tolerance in a scenario: slabs grow, and a run that stopped goes on with the same bits."""

from pathlib import Path

import numpy as np
import pytest

import softway as sw
from records import differences

SHIPPED = Path(__file__).parents[4] / "scenarios" / "bouncing_bar.toml"
ASKED = ("bodies.bar.mesh.cells=20", "time.end=2 s", "time.tolerance=0.05", "output.checkpoints={every='0 s', keep=3}")


def bar(*changes: str) -> sw.Scenario:
    """The shipped bar with a tolerance."""
    return sw.load(SHIPPED, (*ASKED, *changes))


def test_the_history_has_the_lengths_and_the_touch_its_instant() -> None:
    run = sw.run(bar())
    h = np.array(run.history["h"])[1:]
    rung = np.log2(h / h[0])
    assert np.abs(rung - np.round(rung)).max() < 1e-9 and rung.max() > 3.5
    assert abs(run.events["time"][0] - 1.0) < 1e-12
    assert len(h) < 0.6 * sw.check(bar()).slabs


@pytest.mark.slow
@pytest.mark.parametrize("after", [7, 14, 40])
def test_a_stopped_run_goes_on_with_the_same_bits(tmp_path: Path, after: int) -> None:
    seen = []

    def stop(progress: sw.Progress) -> None:
        seen.append(progress)
        if len(seen) == after:
            raise KeyboardInterrupt

    sw.run(bar(), tmp_path / "whole")
    with pytest.raises(KeyboardInterrupt):
        sw.run(bar(), tmp_path / "stopped", progress=stop)
    sw.resume(tmp_path / "stopped")
    assert not differences(tmp_path / "whole", tmp_path / "stopped")


def test_the_key_is_read_and_written() -> None:
    scenario = bar()
    assert scenario.time.tolerance == 0.05  # as given
    assert sw.loads(sw.dumps(scenario)).time.tolerance == 0.05  # as given
    assert sw.loads(sw.dumps(sw.load(SHIPPED))).time.tolerance == "auto"
    assert bar("time.tolerance='5 %'").time.tolerance == 0.05  # as given


@pytest.mark.parametrize("value", ["'1 m'", "true"])
def test_a_tolerance_is_a_number(value: str) -> None:
    with pytest.raises(sw.InputError, match=r"time\.tolerance"):
        bar(f"time.tolerance={value}")
