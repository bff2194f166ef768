"""Start of processes: what is missing is named with a remedy that works, and a failure on one rank is one of all."""

from pathlib import Path

import pytest

import softway as sw
from softway.apps.cli import main
from softway.errors import InputError
from softway.ranks import launch
from softway.ranks.threads import Threads, in_threads


def test_one_rank_needs_no_mpi(file: Path, tmp_path: Path) -> None:
    """The same motion as without ranks, to rounding."""
    assert main(["run", str(file), "--quiet", "--ranks", "1", "--out", str(tmp_path / "one")]) == 0
    assert main(["run", str(file), "--quiet", "--out", str(tmp_path / "plain")]) == 0
    one, plain = (sw.Run(tmp_path / name).history for name in ("one", "plain"))
    assert one["energy_kinetic"] == pytest.approx(plain["energy_kinetic"], rel=1e-9)


def test_without_mpi4py_the_remedy_is_its_installation(
    file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(launch, "find_spec", lambda name: None)
    assert main(["run", str(file), "--ranks", "2"]) == 2
    assert "mpi4py is not installed" in (told := capsys.readouterr().err)
    assert "pip install 'softway[mpi]' mpich" in told


def test_without_mpiexec(file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(launch, "find_spec", lambda name: object())
    monkeypatch.setattr(launch.shutil, "which", lambda name, path=None: None)
    assert main(["run", str(file), "--ranks", "2"]) == 2
    assert "no mpiexec" in capsys.readouterr().err


def test_no_ranks_at_all(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(file), "--ranks", "0"]) == 2
    assert "--ranks: 0" in capsys.readouterr().err


def test_a_scenario_for_one_rank_only(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shock = "bodies.block.shock={kind='BulkViscosity'}"
    assert main(["run", str(file), "--ranks", "1", "--set", shock]) == 2
    assert "bodies.block.shock: runs on one rank only: a bulk viscosity" in capsys.readouterr().err


def test_rigid_bodies_run_on_one_rank(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without solids there are no nodes to share."""
    file = tmp_path / "pendulum.toml"
    file.write_text(
        '[bodies.bob]\nkind = "Rigid"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\ncentre = [0.0, 0.0, 0.0]\n'
        "[joints.hinge]\nkind = 'BallJoint'\nbetween = ['ground', 'bob']\nat = [0.0, 0.0, 1.0]\n"
        "[time]\nend = 0.1\nstep = 0.01\n"
    )
    assert main(["run", str(file), "--ranks", "1"]) == 2
    assert "scenario: runs on one rank only: rigid bodies" in capsys.readouterr().err


def test_an_error_on_one_rank_is_told_on_all() -> None:
    def reads(ranks: Threads) -> str:
        def action() -> None:
            if ranks.rank == 1:
                raise InputError("file", "cannot be read", "another file")

        try:
            launch.agreed(ranks, action)
        except InputError as error:
            return str(error)
        return "no error"

    own = "file: cannot be read\n  try: another file"
    assert in_threads(3, reads) == [f"rank 1: {own}", own, f"rank 1: {own}"]
