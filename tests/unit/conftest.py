"""What tests of bad input share: a command line that is refused, and leaves nothing behind."""

from collections.abc import Callable
from pathlib import Path

import pytest

from softway.apps.cli import main


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Callable[..., None]:
    """Run and check a scenario with changes, "&" between several: exit code 2, parts of the text, and no folder."""

    def told(scenario: Path, change: str, *parts: str) -> None:
        out = scenario.parent / "out"
        settings = [part for one in change.split(" & ") for part in ("--set", one)]
        texts = []
        for command in (["run", str(scenario), "--out", str(out)], ["check", str(scenario)]):
            assert main([*command, *settings]) == 2
            texts.append("".join(capsys.readouterr()))
        assert not out.exists()
        assert "Traceback" not in "".join(texts)
        assert texts[0] == texts[1]
        for part in parts:
            assert part in texts[0]

    return told
