"""What the pages say takes minutes, and a fresh clone: its first picture within five, its demonstration within ten."""

import os
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pages import Command, steps
from reader import PAGES, ROOT, Reader

pytestmark = pytest.mark.minutes


def long(page: Path) -> bool:
    """Whether a page has a command that takes minutes."""
    return any(isinstance(step, Command) and step.long for step in steps(page))


@pytest.mark.parametrize("page", [p for p in PAGES if long(p)], ids=lambda p: p.stem)
def test_what_takes_minutes_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Reader(tmp_path, patient=True).settle().read(page)


@pytest.mark.parametrize("file", sorted(ROOT.glob("scenarios/*.toml")), ids=lambda file: file.stem)
def test_a_scenario_of_the_gallery_runs(file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Reader.give(Command(words=("softway", "run", str(file), "--out", "runs/one"), exit=0, long=True))
    Reader.give(Command(words=("softway", "plot", "runs/one"), exit=0, long=False))


@pytest.fixture
def clone(tmp_path):
    """A fresh clone, whose commands know nothing of this environment or of kernels compiled before."""
    if not (ROOT / ".git").exists() or shutil.which("git") is None:
        pytest.skip("no git checkout to clone")
    subprocess.run(["git", "clone", "-q", str(ROOT), str(tmp_path / "softway")], check=True)
    return tmp_path


def fresh(clone: Path, script: str, seconds: float) -> float:
    """Give the lines of a shell in the clone; the time that they took [s]."""
    known = {name: os.environ[name] for name in ("PATH", "PIP_INDEX_URL", "PIP_CONFIG_FILE") if name in os.environ}
    here = Path(sys.executable).parent
    known["PATH"] = os.pathsep.join(p for p in known["PATH"].split(os.pathsep) if Path(p) != here)
    start = time.monotonic()
    subprocess.run(
        ["bash", "-e", "-c", script], cwd=clone / "softway", env={**known, "HOME": str(clone)}, check=True,
        timeout=2.0 * seconds,
    )  # fmt: skip
    return time.monotonic() - start


def test_the_first_picture_of_a_fresh_clone(clone):
    """The first tutorial, to its picture."""
    page = ROOT / "docs" / "tutorials" / "first_impact.md"
    lines = [shlex.join(step.words) for step in steps(page) if isinstance(step, Command)]
    last = lines.index("softway plot runs/bar")
    assert fresh(clone, "\n".join(lines[: last + 1]), 300.0) < 300.0
    assert (clone / "softway" / "runs" / "bar" / "bodies.png").stat().st_size > 10_000


def test_the_demonstration_of_a_fresh_clone(clone):
    assert fresh(clone, "make demo", 600.0) < 600.0
    assert len(list((clone / "softway" / "demo").glob("*.png"))) >= 2
