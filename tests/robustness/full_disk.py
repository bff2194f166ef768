"""A disk that is full in the middle of a run, at several amounts of room; more room, and the run goes on.

    unshare --user --map-root-user --mount python tests/robustness/full_disk.py SCENARIO REFERENCE PLACE KIB ...

makes a file system in memory at PLACE for each number of KiB in turn, runs the scenario there until it is full, makes
it larger, resumes, and compares with the REFERENCE run.  It prints the exit code of the run, its slabs until then, and
what differs in the end.
"""

import subprocess
import sys
from pathlib import Path

from records import differences
from softway.apps import cli
from softway.record.run import Run


def filled(scenario: Path, reference: Path, place: Path, size: int) -> tuple[int, int, int, list[str]]:
    """Exit codes of the run and of the resumed one, slabs of the first, and differences from the reference."""
    _mount(place, f"size={size}k")
    try:
        folder = place / "run"
        code = cli.main(["run", str(scenario), "--out", str(folder), "--quiet"])
        slabs = Run(folder).history.rows - 1 if folder.is_dir() else 0
        frames = len(Run(folder).fields) if folder.is_dir() else 0
        assert frames > 0 or not slabs, "no frame can be read"
        _mount(place, "remount,size=64m")
        verb = ["resume", str(folder)] if folder.is_dir() else ["run", str(scenario), "--out", str(folder)]
        again = cli.main([*verb, "--quiet"])
        return code, again, slabs, differences(folder, reference)
    finally:
        subprocess.run(["umount", place], check=True)


def _mount(place: Path, options: str) -> None:
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", place], check=True)


if __name__ == "__main__":
    given, known, where, *sizes = sys.argv[1:]
    for kib in map(int, sizes):
        print(kib, *filled(Path(given), Path(known), Path(where), kib), flush=True)
