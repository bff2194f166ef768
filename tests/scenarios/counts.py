"""Slabs, iterations and rejections of the scenarios: what they cost, but for the time of an iteration.

    python tests/scenarios/counts.py [NAME ...]

counts all of them again, or those with these names, and writes ``counts.json``.
"""

import argparse
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from softway.marching.march import march
from softway.marching.results.step import Step
from softway.scenario.checks.check import check
from softway.scenario.scenario import Scenario
from variants import VARIANTS, small, whole

FILE = Path(__file__).with_name("counts.json")
CHEAP = (
    "ball_impact",
    "beam_swing",
    "block_on_sphere",
    "bracket_drop",
    "paper_bar",
    "paper_bar_fixed",
    "ring_test",
    "stamp_on_pad",
)
"""Scenarios that take less than five seconds as they are shipped."""
WITHIN = 0.05
"""Greatest difference, relative to the stored number, that a test allows."""
KINDS = {"small": (small, tuple(sorted(VARIANTS))), "whole": (whole, CHEAP)}
"""Small variants and shipped scenarios: how to get one by its name, and the names."""


@dataclass(frozen=True, slots=True)
class Count:
    """What a march costs: iterations and rejections of its slabs, and its calls between iterations in all attempts.

    A march asks between iterations if it is cancelled, also in attempts that are rejected.
    """

    slabs: list[tuple[int, int]] = field(default_factory=list)
    calls: list[None] = field(default_factory=list)

    def cancel(self) -> bool:
        """Count a call; never cancel."""
        self.calls.append(None)
        return False

    def take(self, step: Step) -> None:
        """Count a slab."""
        self.slabs.append((step.report.iterations, len(step.report.rejections)))

    def numbers(self) -> dict[str, int]:
        """Number of slabs, of iterations in accepted slabs, of calls and of rejections."""
        iterations, rejections = (sum(column) for column in zip(*self.slabs, strict=True))
        return {
            "slabs": len(self.slabs),
            "iterations": iterations,
            "calls": len(self.calls),
            "rejections": rejections,
        }


def counted(scenario: Scenario) -> dict[str, int]:
    """:meth:`Count.numbers` of a scenario."""
    checked, count = check(scenario), Count()
    given = checked.scenario
    time = given.time
    for step in march(
        checked.model,
        until=time.end,
        step=time.step,
        weight=time.weight,
        method=given.solver,
        control=time.control,
        tolerance=time.tolerance,
        cancel=count.cancel,
    ):
        count.take(step)
    return count.numbers()


def stored() -> Mapping[str, Mapping[str, Mapping[str, int]]]:
    """Stored numbers by kind and name."""
    found: Mapping[str, Mapping[str, Mapping[str, int]]] = json.loads(FILE.read_text(encoding="utf-8"))
    return found


def main() -> None:
    """Count again and store the numbers."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="scenarios that are counted; all by default")
    wanted, before = parser.parse_args().names, stored()
    known = {name for _, names in KINDS.values() for name in names}
    if not set(wanted) <= known:
        parser.error(f"no scenario {min(set(wanted) - known)!r}; known: {', '.join(sorted(known))}")
    found = {
        kind: {n: counted(get(n)) if n in wanted or not wanted else before[kind][n] for n in names}
        for kind, (get, names) in KINDS.items()
    }
    FILE.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
