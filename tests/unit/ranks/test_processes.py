"""Ranks as processes of MPI: the same records as one rank, bit by bit; needs mpi4py and mpiexec (make test-mpi)."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np
import pytest

import softway as sw
from softway.ranks.launch import launcher

pytestmark = pytest.mark.minutes


def command(arguments: Sequence[str], expected: int = 0, given: Mapping[str, str] | None = None) -> str:
    """What the command told on the terminal."""
    pytest.importorskip("mpi4py.MPI", exc_type=(ImportError, RuntimeError))
    try:
        launcher()
    except sw.InputError as error:
        pytest.skip(str(error))
    around = {**os.environ, "OMP_NUM_THREADS": "1", **(given or {})}
    words = [sys.executable, "-m", "softway", *arguments]
    done = subprocess.run(words, capture_output=True, text=True, timeout=300, env=around)
    assert done.returncode == expected, done.stderr
    return done.stdout + done.stderr


def records(folder: Path) -> dict[str, bytes]:
    """Tables of a run, and the values of its fields."""
    tables = {name: (folder / name).read_bytes() for name in ("history.csv", "events.csv")}
    with h5py.File(folder / "fields.vtkhdf") as stored:
        found: dict[str, bytes] = {}

        def keep(name: str, at: object) -> None:
            if isinstance(at, h5py.Dataset):
                found[name] = np.asarray(at[()]).tobytes()

        stored.visititems(keep)
    return {**tables, **found}


Kept = Callable[[str, Callable[[Path], object]], Path]


def alone(kept: Kept, scenario: Path) -> Path:
    """Run of a scenario on one rank."""
    return kept(
        scenario.stem, lambda out: command(["run", str(scenario), "--quiet", "--ranks", "1", "--out", str(out)])
    )


@pytest.mark.parametrize(("name", "count"), [("file", 2), ("hot", 2), ("rough", 2), ("rough", 4)])
def test_records_have_the_same_bits_on_one_rank_and_on_several(
    name: str, count: int, request: pytest.FixtureRequest, kept: Kept, tmp_path: Path
) -> None:
    """Also with friction, plasticity and two bodies, and with heat."""
    scenario, several = request.getfixturevalue(name), tmp_path / "several"
    command(["run", str(scenario), "--quiet", "--ranks", str(count), "--out", str(several)])
    assert records(alone(kept, scenario)) == records(several)
    assert sw.Run(several).events


def test_multigrid_of_petsc_has_the_same_motion_on_two_ranks(file: Path, tmp_path: Path) -> None:
    """Multigrid depends on the partition: the energies agree to 1e-11, the events are the same."""
    pytest.importorskip("petsc4py", exc_type=(ImportError, RuntimeError))
    chosen = "solver={kind='FixedPoint', operator={kind='Multigrid'}}"
    for count in ("1", "2"):
        command(["run", str(file), "--quiet", "--ranks", count, "--set", chosen, "--out", str(tmp_path / count)])
    one, two = (sw.Run(tmp_path / count) for count in ("1", "2"))
    for name in ("energy_kinetic", "energy_strain"):
        assert np.asarray(two.history[name]) == pytest.approx(np.asarray(one.history[name]), abs=1e-11)
    assert len(two.events) == len(one.events) > 0


def test_a_missing_petsc_is_told_and_the_run_goes_on(file: Path, tmp_path: Path) -> None:
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "sitecustomize.py").write_text(
        "import importlib.util as util\n"
        "real = util.find_spec\n"
        "util.find_spec = lambda name, *given: None if name == 'petsc4py' else real(name, *given)\n"
    )
    path = {"PYTHONPATH": os.pathsep.join([str(hidden), os.environ.get("PYTHONPATH", "")])}
    chosen = "solver={kind='FixedPoint', operator={kind='Multigrid'}}"
    told = command(["run", str(file), "--ranks", "2", "--set", chosen, "--out", str(tmp_path / "run")], given=path)
    assert " ".join(told.split()).count("petsc4py is not installed") == 1


def test_a_folder_that_exists_ends_all_ranks(file: Path, tmp_path: Path) -> None:
    command(["run", str(file), "--quiet", "--ranks", "2", "--out", str(tmp_path / "run")])
    told = command(["run", str(file), "--ranks", "2", "--out", str(tmp_path / "run")], expected=2)
    assert told.count("already holds a run") == 1


def test_a_scenario_on_one_rank_only_is_refused_once(file: Path, tmp_path: Path) -> None:
    shock = "bodies.block.shock={kind='BulkViscosity'}"
    told = command(["run", str(file), "--ranks", "2", "--set", shock], expected=2)
    assert told.count("runs on one rank only: a bulk viscosity") == 1


def test_more_ranks_than_cells_are_refused_once(file: Path) -> None:
    told = command(["run", str(file), "--ranks", "3", "--set", "bodies.block.mesh.cells=[1, 2]"], expected=2)
    assert told.count("error ranks: 3 for 2 cells") == 1


@pytest.mark.parametrize(("name", "count"), [("hot", None), ("rough", 3)])
def test_a_run_that_lost_a_rank_goes_on_with_the_same_bits(
    name: str, count: int | None, request: pytest.FixtureRequest, kept: Kept, tmp_path: Path
) -> None:
    """A run on two processes, of which one fails, continues on one or on three."""
    scenario, lost = request.getfixturevalue(name), tmp_path / "lost"
    whole = alone(kept, scenario)
    failing(tmp_path, scenario, lost, slab=9)
    assert sw.Run(lost).provenance["ranks"] == 2
    command(["resume", str(lost), "--quiet", *([] if count is None else ["--ranks", str(count)])])
    assert records(whole) == records(lost)
    assert sw.Run(lost).provenance["resumed"][0]["slabs"] >= 8


def test_a_run_without_ranks_does_not_go_on_over_ranks(rough: Path, tmp_path: Path) -> None:
    out = tmp_path / "run"
    command(["run", str(rough), "--quiet", "--out", str(out)])
    record = json.loads((out / "provenance.json").read_text())
    (out / "provenance.json").write_text(json.dumps({**record, "stop_reason": "interrupted"}))
    told = command(["resume", str(out), "--ranks", "2"], expected=2)
    assert told.count("error --ranks: 2, for a run without ranks") == 1


def failing(place: Path, scenario: Path, out: Path, slab: int) -> str:
    """What a run on two processes tells of which the second fails in a slab, with exit code 3."""
    module = place / "broken.py"
    module.write_text(
        "import os, sys\n"
        "from softway.cluster import march\n"
        "real = march.slabs\n"
        "def slabs(*given):\n"
        "    for k, step in enumerate(real(*given)):\n"
        f"        if k == {slab} and os.environ.get('PMI_RANK', os.environ.get('OMPI_COMM_WORLD_RANK')) == '1':\n"
        "            raise OSError('the disk of this node is gone')\n"
        "        yield step\n"
        "march.slabs = slabs\n"
        "from softway.__main__ import main\n"
        "sys.exit(main())\n"
    )
    pytest.importorskip("mpi4py.MPI", exc_type=(ImportError, RuntimeError))
    arguments = [launcher(), "-n", "2", sys.executable, str(module), "run", str(scenario), "--out", str(out)]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=120)
    assert done.returncode == 3
    return done.stderr


def test_a_rank_that_fails_alone_is_named(file: Path, tmp_path: Path) -> None:
    """The records of rank 0 are readable up to the slab in which another rank fails."""
    told = failing(tmp_path, file, tmp_path / "run", slab=2)
    assert "error rank 1 of 2 ends the run: the disk of this node is gone" in told
    assert len(sw.Run(tmp_path / "run").history) >= 2
