"""Inputs that would take all memory or all time, run code, or read what is no file: each is refused with a reason."""

import os
from pathlib import Path

import pytest

from softway.apps.cli import main
from softway.errors import InputError
from softway.meshes.files.mesh_files import read_facets, read_mesh
from softway.scenario.files import NESTED, load, loads
from softway.scenario.text.templates import templates

BAR = templates()["bar"]


def told(folder: Path, capsys: pytest.CaptureFixture[str], *changes: str, text: str = BAR) -> str:
    """What the command line says of a scenario that it refuses."""
    (folder / "bar.toml").write_text(text)
    before = sorted(folder.iterdir())
    changed = [part for change in changes for part in ("--set", change)]
    assert main(["run", str(folder / "bar.toml"), "--out", str(folder / "out"), *changed]) == 2
    assert sorted(folder.iterdir()) == before
    said = capsys.readouterr().err
    assert "Traceback" not in said
    return said


@pytest.mark.parametrize(
    ("change", "where", "problem"),
    [
        ("bodies.bar.mesh.cells=1000000000000", "bodies.bar.mesh.cells", "1e+12 cells"),
        ("bodies.bar.mesh={kind='Box', size=[1,1,1], cells=[100000,100000,100000]}", "bodies.bar.mesh.cells", "1e+15"),
        ("bodies.bar.mesh={kind='Ball', radius=1, cells=100000}", "bodies.bar.mesh.cells", "1e+15"),
        ("bodies.bar.mesh={kind='GradedDisc', radius=1, focus=0.1, cells=1000000}", "bodies.bar.mesh.cells", "1e+12"),
        ("time.step=1e-40", "time.end", "slabs"),
        ("time.step=1e-300", "time.step", "1e-300 s"),
        ("bodies.bar.density=" + "9" * 400, "bodies.bar.density", "not finite"),
        ("bodies.bar.density=1e-317", "bodies.bar.density", "beyond the range of numbers"),
        ("bodies.bar.density=1e307", "bodies.bar.density", "beyond the range of numbers"),
        ("bodies.bar.material.kind=[1]", "bodies.bar.material.kind", "unknown"),
        ("bodies.bar.material={kind={a=1}}", "bodies.bar.material.kind", "unknown"),
        ("bodies.bar.material.kind=os:system", "bodies.bar.material.kind", "would run Python"),
        ("bodies.bar.material.kind=../x:Law", "bodies.bar.material.kind", "is not of the form"),
        (
            "bodies.bar.material.kind=softway.scenario.text.user_modules:Modules",
            "bodies.bar.material.kind",
            "is no StoredEnergy",
        ),
        ("bodies.bar.material.kind=softway.apps.cli.commands:main", "bodies.bar.material.kind", "no dataclass"),
        ("bodies.wall.shape={kind='SignedDistance', dim=1, function='os:system'}", "function", "would run Python"),
        ("bodies.bar.mesh={kind='MeshFile', path='/dev/zero'}", "bodies.bar.mesh.path", "no such file"),
        ("bodies.wall.shape={kind='Surface', file='/dev/stdin'}", "bodies.wall.shape.file", "no such file"),
    ],
)
def test_what_is_too_much_or_forbidden(tmp_path, capsys, change, where, problem):
    said = told(tmp_path, capsys, change)
    assert where in said
    assert problem in said
    assert "try:" in said


@pytest.mark.few(3)
@pytest.mark.parametrize("change", ["time.step=auto", "time.weight=Momentum", "solver.kind=Explicit"])
@pytest.mark.parametrize("step", ["auto", "50 ms"])
def test_a_body_that_is_held_everywhere_ends_or_is_refused(tmp_path, capsys, change, step):
    """It has no frequency that bounds a step."""
    (tmp_path / "bar.toml").write_text(BAR)
    held = ["bodies.bar.supports=[{on='all'}]", "bodies.bar.velocity=0", f"time.step={step}", change]
    given = [part for text in held for part in ("--set", text)]
    assert main(["run", str(tmp_path / "bar.toml"), "--out", str(tmp_path / "out"), "-q", *given]) in (0, 2)
    said = capsys.readouterr().err
    assert "inf" not in said and ("try:" in said or (tmp_path / "out").is_dir())


@pytest.mark.parametrize("verb", ["check", "run", "show", "resume", "plot", "view", "sweep"])
def test_names_of_any_length_are_refused(tmp_path, capsys, verb):
    """No file system has a name of this length."""
    for name in ("x" * 300, "x" * 300 + ".toml", "x/" * 3000):
        more = ["--over", "time.end=1 s"] if verb == "sweep" else []
        assert main([verb, str(tmp_path / name), *more]) == 2
        assert "try:" in capsys.readouterr().err
    (tmp_path / "bar.toml").write_text(BAR)
    for verb_, more in (("run", []), ("sweep", ["--over", "time.end=1 s"])):
        assert main([verb_, str(tmp_path / "bar.toml"), "--out", str(tmp_path / ("x" * 300)), *more]) == 2
        assert "try:" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["a = " + "[" * 5000 + "]" * 5000, "x" + ".x" * 5000 + " = 1", "a = " + "9" * 5000])
def test_texts_that_are_nested_or_long_without_end(tmp_path, capsys, text):
    assert "bar.toml" in told(tmp_path, capsys, text=text)


def test_depths_that_a_scenario_may_have():
    with pytest.raises(InputError, match=f"more than {NESTED} levels"):
        loads("x" + ".x" * NESTED + " = 1")
    with pytest.raises(InputError, match="unknown key"):
        loads("x" + ".x" * (NESTED - 2) + " = 1")


def test_a_scenario_that_is_no_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    for name in (tmp_path / "pipe.toml", tmp_path, Path("/dev/zero")):
        with pytest.raises(InputError, match="cannot be read: a folder or a device"):
            load(name)
    with pytest.raises(InputError, match="cannot be read: embedded null"):
        load("a\0b")


def test_mesh_files_that_are_no_files(tmp_path):
    os.mkfifo(tmp_path / "pipe.msh")
    (tmp_path / "link.msh").symlink_to("/proc/self/status")
    with pytest.raises(InputError, match="no such file"):
        read_mesh(tmp_path / "pipe.msh")
    with pytest.raises(InputError, match="has 0 bytes"):
        read_mesh(tmp_path / "link.msh")


def test_a_head_without_end(tmp_path):
    (tmp_path / "a.ply").write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(InputError, match="no end_header"):
        read_facets(tmp_path / "a.ply")


def test_a_deck_that_includes_itself(tmp_path):
    (tmp_path / "a.inp").write_text("*INCLUDE, INPUT=a.inp\n" * 50)
    with pytest.raises(InputError, match="includes itself"):
        read_mesh(tmp_path / "a.inp")


def test_a_facet_count_that_no_file_holds(tmp_path):
    (tmp_path / "a.stl").write_bytes(b"\0" * 80 + (2**32 - 1).to_bytes(4, "little") + b"\0" * 50)
    with pytest.raises(InputError, match="a.stl"):
        read_facets(tmp_path / "a.stl")
