"""What can be asked of pictures: a field, instants, a size; films; world lines with their kinks."""

import numpy as np
import pytest
from PIL import Image

from softway.apps.cli import main
from softway.errors import InputError
from softway.record.conduct import record_run
from softway.record.read.world_lines import kinks, world_lines
from softway.record.storage.run_folder import RunFolder
from softway.record.view import film as films
from softway.record.view.bodies.bodies import bodies
from softway.record.view.bodies.colour_field import colour_of
from softway.record.view.options import PictureOptions


@pytest.fixture
def flat(square, tmp_path):
    return record_run(square.steps(), square.opening(), RunFolder(out=tmp_path / "square"), title="Made up")


@pytest.fixture
def thin(bar, tmp_path):
    return record_run(bar.steps(), bar.opening(), RunFolder(out=tmp_path / "bar"), title="Made up")


def test_pictures_of_a_field_at_instants_of_a_size(flat, tmp_path):
    """Three panels in a file of the pixels that were asked for."""
    file = tmp_path / "three.png"
    words = ["--field", "velocity.y", "--times", "0.1 s, 500 ms,1", "--size", "900x400", "--dpi", "100"]
    assert main(["plot", str(flat.path), "--out", str(file), *words]) == 0
    with Image.open(file) as picture:
        assert picture.size == (900, 400)
    figure = bodies(flat, PictureOptions(field="velocity.y", times=(0.1, 0.5, 1.0)))
    panels = [axis.get_title() for axis in figure.axes[:3]]
    assert panels == ["100 ms", "500 ms", "1 s"]
    assert figure.axes[3].get_ylabel() == "velocity y [m/s]"


def test_every_field_can_be_asked_for(flat):
    frame, cells = flat.fields[5], flat.fields.cells
    for name in ("displacement", "velocity.x", "contact_force", "stress.xy", "von_mises"):
        assert colour_of(flat, name).at_nodes(cells, frame).shape == (len(cells.reference),)
    np.testing.assert_allclose(colour_of(flat, "stress.xy").at_nodes(cells, frame), 2.0, rtol=1e-14)
    assert colour_of(flat, None).name == "von_mises"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--field", "heat"], "no field 'heat'"),
        (["--field", "stress"], "stress.xx, stress.yy"),
        (["--field", "velocity.xy"], "velocity.x, velocity.y"),
        (["--at", "3 s"], "outside of the run"),
        (["--at", "3 kg"], "a time"),
        (["--size", "big"], "such as 1280x720"),
        (["--dpi", "1"], "--dpi"),
        (["--dpi", "0"], "--dpi"),
        (["--film", "/dev/null/a.gif"], "cannot write"),
        (["--film", "new/a.gif", "--field", "heat"], "no field"),
        (["--film", "a.avi"], "film.mp4"),
        (["--film", "a.gif", "--times", "1 s"], "two"),
    ],
)
def test_what_cannot_be_drawn_is_named(flat, capsys, words, told, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert main(["plot", str(flat.path), *words]) == 2
    text = "".join(capsys.readouterr())
    assert told in " ".join(text.split()) and "Traceback" not in text
    assert not list(tmp_path.glob("*.*")) and not (tmp_path / "new").exists() and not list(flat.path.glob("*.png"))


def test_a_film_moves(flat, tmp_path, caplog):
    """Eleven pictures of the size that was asked for; the falling square stands elsewhere in each."""
    file = films.film(flat, tmp_path / "fall.gif", PictureOptions(size=(320, 240), dpi=60))
    with Image.open(file) as film:
        assert film.size == (320, 240) and film.n_frames == 11
        pictures = []
        for k in (0, 5):
            film.seek(k)
            pictures.append(np.asarray(film.convert("L"), float))
    assert np.abs(pictures[0] - pictures[1]).max() > 100.0 and not caplog.records


def test_a_film_of_a_bar_between_two_instants(thin, tmp_path):
    file = films.film(thin, tmp_path / "bar.gif", PictureOptions(size=(320, 240), dpi=40, times=(0.25, 0.55)))
    with Image.open(file) as film:
        assert film.n_frames == 3


def test_without_ffmpeg_a_film_is_a_gif(flat, tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(films, "_ffmpeg", lambda: None)
    monkeypatch.setenv("PATH", str(tmp_path))
    file = films.film(flat, tmp_path / "fall.mp4", PictureOptions(size=(320, 240), dpi=60, times=(0.0, 0.25)))
    assert file.name == "fall.gif" and file.exists() and "pip install" in caplog.text
    assert [f.name for f in tmp_path.glob("*fall*")] == ["fall.gif"]


@pytest.mark.parametrize("more", [(), ("--film", "bar.gif")])
def test_bars_have_no_field(thin, more, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["plot", str(thin.path), "--field", "velocity", *more]) == 2
    assert "omit" in "".join(capsys.readouterr()) and not list(tmp_path.glob("*.*"))


def test_world_lines_bend_at_events(thin):
    """Node 0 touches at 0.4 s and lets go at 0.6 s where the events say, between the frames."""
    bent = kinks(thin)
    assert list(bent) == [0]
    np.testing.assert_allclose(bent[0][:, 0], [0.4, 0.6])
    line, other = world_lines(thin, np.array([0, 1]), 0)
    assert len(line) == len(other) + 2 and (np.diff(line[:, 0]) >= 0.0).all()
    with pytest.raises(InputError, match="outside"):
        bodies(thin, PictureOptions(times=(7.0,)))
