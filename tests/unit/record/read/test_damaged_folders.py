"""A run folder that lost something, or holds half a file: named, never a traceback."""

import shutil

import pytest

import softway as sw
from softway.apps.cli import main


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=sw.LinearElastic(E=1.0), density=1.0)
    made = sw.Scenario(bodies={"bar": bar}, time=sw.Time(end=0.2, step=0.1))
    return sw.run(made, tmp_path_factory.mktemp("damaged") / "run").path


@pytest.mark.few(6)
@pytest.mark.parametrize("name", ["provenance.json", "summary.json", "history.csv", "events.csv"])
@pytest.mark.parametrize("left", [0, 25, None])
def test_a_damaged_file_is_named(whole, tmp_path, capsys, name, left):
    """Cut to some bytes, or gone."""
    folder = tmp_path / "run"
    shutil.copytree(whole, folder)
    file = folder / name
    file.unlink() if left is None else file.write_bytes(file.read_bytes()[:left])
    for verb in ("show", "plot"):
        code = main([verb, str(folder)])
        told = capsys.readouterr()
        if code:
            assert code == 2 and "Traceback" not in told.err
            assert name in told.err or "no run folder" in told.err
    assert code == 2 or name == "summary.json"


def test_files_with_unreadable_numbers_are_named(whole, tmp_path, capsys):
    folder = tmp_path / "run"
    shutil.copytree(whole, folder)
    file = folder / "history.csv"
    file.write_text(file.read_text().replace("0.1", "O.1"))
    assert main(["plot", str(folder)]) == 2
    assert "history.csv: cannot be read" in " ".join(capsys.readouterr().err.split())


def test_a_name_that_is_not_there_is_answered_with_those_that_are(whole):
    run = sw.Run(whole)
    with pytest.raises(KeyError, match="no column 'energy'.*energy_kinetic"):
        run.history["energy"]
    with pytest.raises(KeyError, match="no field 'pressure'.*von_mises"):
        run.fields[0]["pressure"]
