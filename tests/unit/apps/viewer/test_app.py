"""The page of a run without a browser: what it shows, and how it is served."""

import shutil
import socket
import sys

import numpy as np
import pytest

from softway.apps.cli import main
from softway.apps.viewer.shown import events_of, pictures_of

pytest.importorskip("trame")
pytest.importorskip("pyvista")

from softway.apps.viewer.app import page


@pytest.fixture
def made(square):
    return page(square)


def test_a_frame_moves_the_skin(square, made):
    """In frame k the skin is where the fields say; its colours are the field."""
    for k in (0, 3):
        made.frame(k)
        frame = square.fields[k]
        np.testing.assert_allclose(
            made.solids.skin.bounds[2:4],
            np.array([0.0, 1.0]) * np.ptp(frame.points[:, 1]) + frame.points[:, 1].min(),
            atol=0.06,
        )
        assert made.server.state.now == pytest.approx(0.4 * k)
    made.server.state.enlarged = False
    made.frame(5)
    points = square.fields[5].points
    np.testing.assert_allclose(
        made.solids.skin.bounds[:4], [*np.sort(points[:, 0])[[0, -1]], *np.sort(points[:, 1])[[0, -1]]]
    )


def test_every_field_can_be_chosen(square, made):
    for name in (field["value"] for field in made.server.state.fields):
        made.server.state.colour = name
        made.colours(name)
        assert made.server.state.colour == name and len(made.server.state.marks) == 5
    made.server.state.colour = "contact_pressure"
    made.colours("contact_pressure")
    made.frame(3)
    force = square.fields[3]["contact_pressure"].max()
    assert force > 0.0 and made.solids.skin.point_data["field"].max() == pytest.approx(force)


def test_a_time_picks_the_nearest_frame(made):
    made.pick(1.15)
    assert made.server.state.frame == 3
    made.step(-5)
    assert made.server.state.frame == 0


def test_curves_and_events(square, bar):
    """Time runs along the axes of every curve from the start to the end; the list is that of events.csv."""
    for run in (square, bar):
        found = pictures_of(run)
        assert len(found["curves"]) == 4 and found["world"]["begin"] == 0.0
        for curve in found["curves"]:
            assert 0.0 < curve["low"] < 0.3 < 0.9 < curve["high"] <= 1.0 and curve["end"] == pytest.approx(4.0)
    listed = events_of(bar)
    assert [e["kind"] for e in listed] == list(bar.events["kind"]) and listed[0]["kind"] == "touch"


def test_a_bar_is_a_ribbon(bar):
    made = page(bar)
    made.frame(0)
    assert made.solids.skin.n_cells == 10 and np.ptp(made.solids.skin.points[:, 0]) == pytest.approx(1.0)


def test_without_the_extra_the_error_tells_the_command(square, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "trame.app", None)
    monkeypatch.delitem(sys.modules, "softway.apps.viewer.app", raising=False)
    assert main(["view", str(square.path)]) == 2
    assert "pip install 'softway[view]'" in " ".join("".join(capsys.readouterr()).split())


@pytest.mark.parametrize(("words", "told"), [(["--port", "70000"], "--port"), (["--port", "x"], "x")])
def test_what_cannot_be_served_is_named(square, capsys, words, told):
    assert main(["view", str(square.path), "--no-browser", *words]) == 2
    assert told in "".join(capsys.readouterr())


def test_a_port_that_is_taken_is_named(square, capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert main(["view", str(square.path), "--no-browser", "--port", str(port)]) == 2
    assert f"{port}: Address already in use" in " ".join("".join(capsys.readouterr()).split())


@pytest.mark.parametrize("left", [0, 1000])
def test_missing_or_cut_frames_are_named(square, tmp_path, capsys, left):
    shutil.copytree(square.path, tmp_path / "run")
    file = tmp_path / "run" / "fields.vtkhdf"
    data = file.read_bytes()[:left]
    file.write_bytes(data) if left else file.unlink()
    for verb in (["view", "--no-browser"], ["plot"]):
        assert main([verb[0], str(tmp_path / "run"), *verb[1:]]) == 2
        told = "".join(capsys.readouterr())
        assert "fields.vtkhdf" in told and "Traceback" not in told


def test_no_run_folder(tmp_path, capsys):
    assert main(["view", str(tmp_path)]) == 2
    assert "no run folder" in " ".join("".join(capsys.readouterr()).split())
