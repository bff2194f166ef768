"""Resumed runs of mechanisms: the finished folder holds the bits of an uninterrupted run."""

import json
from pathlib import Path
from shutil import copytree

import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.record.storage.checkpoint import listed

FOLDER = Path(__file__).parents[4] / "scenarios"
TABLES = ("history.csv", "motion.csv", "events.csv", "mechanism.json", "scenario.toml")
ENDS = {
    "bearing_clearance": ("time.end=20 ms",),
    "hammer_on_stop": ("time.end=0.7 s",),
    "newtons_cradle": ("time.end=0.4 s",),
    "slider_crank": ("time.end=10 ms", "output.fields_every=0.3 ms"),
    "woodpecker": ("time.end=0.2 s",),
}


def scenario(name: str, *more: str) -> sw.Scenario:
    return sw.load(FOLDER / f"{name}.toml", (*ENDS[name], *more))


def interrupted(name: str, folder: Path, at: float, *more: str) -> sw.Run:
    """Run that is interrupted when a part ``at`` of it is done."""

    def stop(progress):
        if progress.fraction >= at:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(scenario(name, *more), folder, progress=stop)
    return sw.Run(folder)


def require_same(run: sw.Run, whole: sw.Run) -> None:
    for file in TABLES:
        assert (run.path / file).read_bytes() == (whole.path / file).read_bytes(), file
    one, other = ({k: v for k, v in r.summary.items() if k != "wall_time"} for r in (run, whole))
    assert one == other and run.status == "done" and not listed(run.path)


@pytest.mark.few(3)
@pytest.mark.parametrize("name", sorted(ENDS))
def test_an_interrupted_run_ends_with_the_same_bits(name, tmp_path):
    whole = sw.run(scenario(name), tmp_path / "whole")
    run = interrupted(name, tmp_path / "run", 0.6)
    assert len(listed(run.path)) == 1
    seen = []
    done = sw.resume(run.path, progress=lambda progress: seen.append(progress.slabs))
    require_same(done, whole)
    told = done.provenance["resumed"][0]
    assert told["stopped"] == "interrupted" and 0 < told["slabs"] < seen[0] and seen[-1] == whole.summary["slabs"]
    assert sw.resume(run.path).status == "done"  # a complete run is left as it is


@pytest.mark.slow
def test_a_killed_run_goes_on_from_its_last_checkpoint(tmp_path):
    """The lines after the checkpoint, the last of them torn, are computed again."""
    whole = sw.run(scenario("woodpecker"), tmp_path / "whole")
    every = 'output.checkpoints={every="0 s", keep=3}'
    run = interrupted("woodpecker", tmp_path / "run", 0.5, every)
    assert len(listed(run.path)) == 3
    for file in listed(run.path)[:2]:
        file.unlink()
    with (run.path / "motion.csv").open("a") as file:
        file.write("0.1,0.3")
    record = json.loads((run.path / "provenance.json").read_text())
    (run.path / "provenance.json").write_text(json.dumps({**record, "stop_reason": "running"}))
    done = sw.resume(run.path)
    for file in TABLES[:4]:
        assert (done.path / file).read_bytes() == (whole.path / file).read_bytes(), file


def test_without_a_checkpoint_it_starts_again(tmp_path):
    whole = sw.run(scenario("hammer_on_stop"), tmp_path / "whole")
    run = interrupted("hammer_on_stop", tmp_path / "run", 0.3)
    for file in listed(run.path):
        file.write_bytes(b"softway checkpoint 3 damaged\n")
    require_same(sw.resume(run.path), whole)


def test_a_checkpoint_of_solids_is_not_used(tmp_path):
    solids = tmp_path / "solids"

    def stop(progress):
        if progress.slabs == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.load(FOLDER / "paper_bar.toml"), solids, progress=stop)
    run = interrupted("hammer_on_stop", tmp_path / "run", 0.3)
    foreign = listed(solids)[0].read_bytes()
    for file in listed(run.path):
        file.write_bytes(foreign)
    assert sw.resume(run.path).provenance["resumed"][0]["slabs"] == 0


def test_a_cancelled_run_is_resumed_by_the_command(tmp_path, capsys):
    whole = sw.run(scenario("newtons_cradle"), tmp_path / "whole")
    asked = iter([False] * 150 + [True])
    with pytest.raises(sw.Cancelled):
        sw.run(scenario("newtons_cradle"), tmp_path / "run", cancel=lambda: next(asked))
    assert main(["resume", str(tmp_path / "run")]) == 0
    assert "resumed after slab" in capsys.readouterr().out
    require_same(sw.Run(tmp_path / "run"), whole)
    assert main(["resume", str(tmp_path / "run")]) == 0 and "already done" in capsys.readouterr().out


def test_a_changed_scenario_is_refused(tmp_path):
    run = interrupted("hammer_on_stop", tmp_path / "run", 0.3)
    copytree(run.path, tmp_path / "copy")
    file = tmp_path / "copy" / "scenario.toml"
    file.write_text(file.read_text().replace("restitution = 0.5", "restitution = 0.4"))
    with pytest.raises(sw.InputError, match="differs"):
        sw.resume(tmp_path / "copy")


@pytest.mark.slow
def test_a_sweep_resumes_mechanisms(tmp_path):
    values = {"stops.anvil.restitution": [0.5]}
    file, changes = FOLDER / "hammer_on_stop.toml", ENDS["hammer_on_stop"]
    done = sw.sweep(file, values, out=tmp_path / "sweep", changes=changes, jobs=1)
    folder = done.rows[0].folder
    whole = (folder / "motion.csv").read_bytes()
    for stale in folder.iterdir():
        stale.unlink()
    folder.rmdir()
    interrupted("hammer_on_stop", folder, 0.4, "stops.anvil.restitution=0.5")
    again = sw.sweep(file, values, out=tmp_path / "sweep", changes=changes, jobs=1)
    assert not again.failed and (folder / "motion.csv").read_bytes() == whole
    assert sw.Run(folder).provenance["resumed"]


def test_a_checkpoint_of_a_mechanism_is_not_used_for_solids(tmp_path):
    run = interrupted("hammer_on_stop", tmp_path / "run", 0.3)

    def stop(progress):
        if progress.slabs == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sw.run(sw.load(FOLDER / "paper_bar.toml", ("time.end=0.5 s",)), tmp_path / "solids", progress=stop)
    for file in listed(tmp_path / "solids"):
        file.write_bytes(listed(run.path)[0].read_bytes())
    assert sw.resume(tmp_path / "solids").provenance["resumed"][0]["slabs"] == 0
