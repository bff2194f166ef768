"""Run folders with links, pipes and devices in them: nothing outside is written to, and no reader waits for ever."""

import os
from pathlib import Path

import pytest

import softway as sw
from softway.apps.cli import main


@pytest.fixture
def stopped(tmp_path) -> Path:
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=1.0)
    made = sw.Scenario(bodies={"bar": bar}, time=sw.Time(end=0.2, step=0.1))

    def stop(progress: sw.Progress) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(made, tmp_path / "run", progress=stop)
    return tmp_path / "run"


@pytest.mark.parametrize("name", ["history.csv", "fields.vtkhdf", "summary.json"])
def test_a_pipe_is_no_record(stopped, capsys, name):
    """A reader would wait for ever for what nobody writes; the summary is computed again."""
    (stopped / name).unlink()
    os.mkfifo(stopped / name)
    assert main(["show", str(stopped)]) == 0
    assert main(["plot", str(stopped)]) == (0 if name == "summary.json" else 2)
    assert name == "summary.json" or name in capsys.readouterr().err


def test_a_device_is_no_checkpoint(stopped, caplog):
    (stopped / "checkpoints" / "slab-000000009").symlink_to("/dev/zero")
    with pytest.raises(sw.InputError, match="is a link"):
        sw.resume(stopped)
