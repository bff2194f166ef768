"""Runs killed at random instants (SIGKILL), resumed until they are done, and compared bit by bit with one never killed.

    python tests/robustness/kills.py [--kills 50] [--seed 1] [--out FILE]

Every run and every run that goes on is a process of its own, killed after a random time between its start and the time
that a whole run takes.  The table tells where the kills fell.  The exit code is 1 where bits differ.
"""

import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from records import differences
from softway.record.run import Run
from softway.record.storage.checkpoint import listed

ROOT = Path(__file__).parents[2]
SCENARIOS = {
    "scenarios/paper_bar.toml": ("output.checkpoints.every=0.2 s",),
    "tests/robustness/inputs/marched/skid.toml": (),
    "scenarios/block_on_sphere.toml": ("output.checkpoints.every=0.5 s", "time.end=2 ms"),
}
"""Scenarios with what is set."""


@dataclass
class Tally:
    """What was seen in one scenario."""

    seconds: float = 0.0
    kills: int = 0
    before: int = 0
    torn: int = 0
    halves: int = 0
    runs: int = 0
    slabs: list[int] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)

    def killed(self, folder: Path) -> None:
        """Look at what a kill left."""
        self.kills += 1
        if not (folder / "history.csv").is_file():
            self.before += 1
            return
        journal = folder / ".fields.vtkhdf.undo"
        self.torn += journal.is_file() and journal.stat().st_size > 0
        self.halves += any((folder / "checkpoints").glob(".*")) if (folder / "checkpoints").is_dir() else 0
        self.slabs.append(max(Run(folder).history.rows - 1, 0))


def softway(*arguments: str | Path) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, "-m", "softway", *map(str, arguments), "--quiet"], stderr=subprocess.PIPE)


def tried(name: str, changes: tuple[str, ...], kills: int, chance: random.Random, place: Path) -> Tally:
    """Kill a scenario so often."""
    found, file = Tally(), ROOT / name
    setting = [word for change in changes for word in ("--set", change)]
    start = time.perf_counter()
    if softway("run", file, *setting, "--out", place / "whole").wait():
        raise SystemExit(f"{name} does not run")
    found.seconds = time.perf_counter() - start
    while found.kills < kills:
        folder = place / f"run-{found.runs}"
        finished(folder, ["run", file, *setting, "--out", folder], found, kills, chance)
        found.runs += 1
        found.wrong += [f"run {found.runs}: {what}" for what in differences(folder, place / "whole")]
    return found


def finished(folder: Path, first: list[str | Path], found: Tally, kills: int, chance: random.Random) -> None:
    """Carry one run to its end through kills, as long as there are any left."""
    while True:
        process = softway(*(["resume", folder] if folder.is_dir() else first))
        try:
            wait = chance.uniform(0.0, found.seconds) if found.kills < kills else None
            _, errors = process.communicate(timeout=wait)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.communicate()
            found.killed(folder)
            continue
        if process.returncode:
            raise SystemExit(f"{folder} does not go on: {errors.decode()}")
        assert not listed(folder), "checkpoints are left"
        return


def table(tallies: dict[str, Tally]) -> str:
    """The tallies in Markdown."""
    head = (
        "| scenario | wall time [s] | kills | before the first record | amid a frame | amid a checkpoint |"
        " slabs at the kills | runs | runs with other bits |\n|---|---|---|---|---|---|---|---|---|\n"
    )
    return head + "".join(
        f"| `{name}` | {t.seconds:.1f} | {t.kills} | {t.before} | {t.torn} | {t.halves} |"
        f" {min(t.slabs, default=0)} to {max(t.slabs, default=0)} | {t.runs} | {len(t.wrong)} |\n"
        for name, t in tallies.items()
    )


def main() -> int:
    reader = argparse.ArgumentParser(description=__doc__)
    reader.add_argument("--kills", type=int, default=50)
    reader.add_argument("--seed", type=int, default=1)
    reader.add_argument("--out", type=Path)
    given = reader.parse_args()
    chance, tallies = random.Random(given.seed), {}
    for k, (name, changes) in enumerate(SCENARIOS.items()):
        share = given.kills * (k + 1) // len(SCENARIOS) - given.kills * k // len(SCENARIOS)
        with tempfile.TemporaryDirectory(prefix="softway-kills-") as place:
            tallies[name] = tried(name, changes, share, chance, Path(place))
        print(name, tallies[name], flush=True)
    text = table(tallies)
    print(text)
    if given.out:
        given.out.write_text(text, encoding="utf-8")
    wrong = [f"{name}, {what}" for name, t in tallies.items() for what in t.wrong]
    print("\n".join(wrong) or "all bits are the same")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
