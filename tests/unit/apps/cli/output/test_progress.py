"""What somebody who waits is told: nothing at once, then what is being done; nothing at all where nobody watches."""

from io import StringIO
from time import sleep

import pytest
from rich.console import Console

from softway.apps.cli.output import progress


@pytest.mark.parametrize(("patience", "told"), [(0.0, True), (60.0, False)])
def test_long_work_says_what_it_is(monkeypatch, patience, told):
    monkeypatch.setattr(progress, "PATIENCE", patience)
    screen = StringIO()
    with progress.waiting(Console(file=screen, force_terminal=True, width=100), "building meshes"):
        for _ in range(3000 if told else 5):
            if "building meshes" in screen.getvalue():
                break
            sleep(0.01)
    assert ("building meshes, after" in screen.getvalue()) == told


def test_no_progress_is_written_to_a_file(monkeypatch):
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    screen = StringIO()
    with progress.waiting(Console(file=screen), "building meshes"):
        sleep(0.05)
    assert not screen.getvalue()
