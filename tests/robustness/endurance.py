"""A bar between two walls for 10^5 slabs with every recorder on: ``python tests/robustness/endurance.py``.

The memory of the process after a tenth of the slabs is compared with that at the end.
"""

import argparse
import json
import tempfile
from pathlib import Path

from softway.record.write.progress import Progress
from softway.scenario.files import loads
from softway.scenario.run import run

BAR = """
[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = 1, cells = 2 }
material = { kind = "LinearElastic", E = 1 }
density = 1
velocity = 0.3
[bodies.left]
kind = "Tool"
shape = { kind = "HalfSpace", point = -0.2, normal = 1 }
[bodies.right]
kind = "Tool"
shape = { kind = "HalfSpace", point = 1.2, normal = -1 }
[[contacts]]
between = ["bar.left", "left"]
[[contacts]]
between = ["bar.right", "right"]
[time]
end = END
step = 0.05
[[output.probes]]
name = "front"
of = "bar"
tag = "right"
"""


def resident() -> int:
    """Bytes of memory that the process holds."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096


def endured(slabs: int) -> dict[str, float]:
    """Memory [MB] after a tenth of the slabs and at the end, the bounces and the error of energy."""
    taken: list[int] = []
    marks = {slabs // 10, slabs}
    errors: list[float] = [0.0]
    count = 0

    def watch(progress: Progress) -> None:
        nonlocal count
        count += 1
        errors[0] = max(errors[0], abs(progress.step.ledger.energy_error))
        if count in marks:
            taken.append(resident())

    with tempfile.TemporaryDirectory() as place:
        done = run(loads(BAR.replace("END", str(0.05 * slabs))), Path(place) / "run", progress=watch)
        touches = int(sum(kind == "touch" for kind in done.events["kind"]))
    early, late = (value / 1e6 for value in taken)
    return {"slabs": slabs, "touches": touches, "early": early, "late": late, "energy": errors[0] / 0.045}


def main() -> None:
    """Print the figures, and write them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("slabs", type=int, nargs="?", default=100_000)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    found = endured(given.slabs)
    print(json.dumps(found))
    if given.out:
        given.out.parent.mkdir(parents=True, exist_ok=True)
        given.out.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
