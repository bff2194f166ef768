"""Page of a mechanism: one file that holds all it shows."""

import re
from base64 import b64decode
from html.parser import HTMLParser
from pathlib import Path

import pytest

import softway as sw
from softway.apps.cli.commands import main
from softway.apps.cli.results import view as command
from softway.record.view.page import page

FOLDER = Path(__file__).parents[4] / "scenarios"


class Parts(HTMLParser):
    """Tags of a page, and the addresses that it names."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[str] = []
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append(tag)
        self.addresses += [value or "" for key, value in attrs if key in ("src", "href")]
        if tag not in ("img", "input", "meta"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> sw.Run:
    scenario = sw.load(FOLDER / "hammer_on_stop.toml", ("time.end=0.6 s", "output.fields_every=30 ms"))
    return sw.run(scenario, tmp_path_factory.mktemp("runs") / "run")


def test_the_page_is_whole_and_names_no_other_file(run):
    seen = []
    text = page(run, ("It came to rest < once.",), lambda done, of: seen.append((done, of)))
    parts = Parts()
    parts.feed(text)
    rows = run.motion.rows
    assert not parts.open and parts.seen.count("img") == rows + 1 and seen[-1] == (rows, rows)
    assert all(address.startswith("data:image/png;base64,") for address in parts.addresses)
    assert b64decode(parts.addresses[0].partition(",")[2]).startswith(b"\x89PNG")
    assert "came to rest &lt; once." in text and "Hinged hammer on an anvil" in text
    times = re.search(r'id="times">\[(.*?)\]', text)
    assert times is not None and [float(t) for t in times[1].split(",")] == run.motion["time"].tolist()
    assert parts.seen.count("tr") == run.events.rows + 1


@pytest.mark.slow
def test_pictures_of_a_long_run_are_chosen(tmp_path, monkeypatch):
    monkeypatch.setattr("softway.record.view.page.FRAMES", 9)
    run = sw.run(sw.load(FOLDER / "slider_crank.toml", ("time.end=1 ms",)), tmp_path / "run")
    assert run.motion.rows == 11
    assert page(run, ()).count("<img") == 9 + 1


@pytest.mark.slow
def test_the_command_writes_and_opens_it(run, monkeypatch, capsys):
    opened = []
    monkeypatch.setattr(command.webbrowser, "open", opened.append)
    assert main(["view", str(run.path)]) == 0
    file = run.path / "view.html"
    assert opened == [file.resolve().as_uri()] and opened[0] in capsys.readouterr().out
    assert "was touched" in file.read_text(encoding="utf-8")
    assert main(["view", str(run.path), "--no-browser"]) == 0 and len(opened) == 1
    assert main(["view", str(run.path), "--live"]) == 2 and "omit them" in capsys.readouterr().err
