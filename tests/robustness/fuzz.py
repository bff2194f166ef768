"""Damaged and mutated inputs given to the command line: ``python tests/robustness/fuzz.py`` reports what it does.

``--of scenarios`` takes the scenarios mutated by meaning, ``--of meshes`` mesh files, ``--of decks`` input decks, and
``--of damaged`` inputs with bytes, numbers and keys changed; without it all of them are judged.

Each input has its own folder, a limit of time, and a process with a limit of memory.  A defect is a traceback, an exit
code without its message, a hang, a process that dies, a file left behind, or a part that is lost in silence.
"""

import argparse
import collections
import json
import multiprocessing as mp
import resource
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from time import perf_counter
from typing import Any

from inputs.command import FAILED, REFUSED, answer, written
from inputs.decks import judged_deck
from inputs.mesh_files import judged_mesh
from inputs.mutations import Damaged, damaged
from inputs.scenarios.judge import judged_scenario

MEMORY = 6 << 30
"""Bytes that a process may take."""
SECONDS = 20
"""Time for one input [s]."""
ENDS = ("ok", "refused", "failed", "slow")
"""Verdicts that are no defects."""


def judged(given: Damaged, seconds: int = SECONDS) -> str:
    """What the command line does with an input: ``ok``, ``refused``, ``failed``, or a defect in words."""
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        written(place, given.files)
        told = answer(place, given.command, seconds)
    if told.defect.startswith("hang") and given.command[:1] in (("run",), ("race",)):
        return "slow"
    return told.defect or _verdict(told.code, told.told, told.left, given)


def judged_damaged(number: int) -> str:
    """Verdict on the damaged input of a number."""
    return judged(damaged(number))


KINDS: Mapping[str, tuple[int, Callable[[int], str]]] = {
    "damaged": (10_000, judged_damaged),
    "scenarios": (3_000, judged_scenario),
    "meshes": (1_000, judged_mesh),
    "decks": (1_000, judged_deck),
}
"""Numbers of inputs, and their judgement."""


def _verdict(code: int | None, told: str, left: frozenset[str], given: Damaged) -> str:
    if left and code != 0 and given.command[:1] not in (("run",), ("race",)):
        return f"files left: {sorted(left)}"
    if "Traceback" in told:
        return "traceback printed"
    if code in (REFUSED, FAILED) and "error" not in told:
        return f"exit {code} without a message"
    if code in (REFUSED, FAILED) and given.family != "command" and "try:" not in told and "line" not in told:
        return f"no remedy: {told[:90]!r}"
    return {0: "ok", 1: "ok", REFUSED: "refused", FAILED: "failed"}.get(code or 0, f"exit {code}")


def _work(first: int, count: int, kind: str, results: Any) -> None:
    """Judge some inputs, telling each before and after; in a process of its own."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    from softway.scenario.hints.units_text import Units

    known = Units.standard()
    Units.standard = classmethod(lambda cls: known)  # type: ignore[method-assign]
    for number in range(first, first + count):
        results.send((number, None, 0.0))
        begun = perf_counter()
        verdict = KINDS[kind][1](number)
        results.send((number, verdict, perf_counter() - begun))
        if verdict == "slow":  # what was interrupted may have left a half-compiled kernel
            break
    results.send(None)


def verdicts(first: int, count: int, kind: str = "damaged") -> dict[int, tuple[str, float]]:
    """Verdict and time of each input; a process that dies or hangs is replaced."""
    found: dict[int, tuple[str, float]] = {}
    context, end = mp.get_context("spawn"), first + count
    while first < end:
        here, there = context.Pipe(duplex=False)
        worker = context.Process(target=_work, args=(first, end - first, kind, there))
        worker.start()
        there.close()
        number, told = first, True
        while told:
            try:
                told = here.recv() if here.poll(SECONDS + 60) else None
            except EOFError:
                found[number] = (f"died: exit {worker.exitcode}", 0.0)
                break
            if told is None:
                break
            number = told[0]
            if told[1] is not None:
                found[number] = (told[1], told[2])
        if told is None and number not in found:
            found[number] = ("hang that no signal ends", SECONDS)
        worker.terminate()
        worker.join()
        first = number + 1
    return found


def _family(number: int, kind: str) -> str:
    return damaged(number).family if kind == "damaged" else kind


def main() -> None:
    """Judge so many inputs and write the counts as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int, nargs="?")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--of", choices=list(KINDS))
    given = parser.parse_args()
    counts: dict[str, collections.Counter[str]] = collections.defaultdict(collections.Counter)
    inputs, defects, slowest = 0, 0, 0.0
    for kind in [given.of] if given.of else KINDS:
        found = verdicts(given.first, given.count or KINDS[kind][0], kind)
        for number, (verdict, _) in found.items():
            counts[_family(number, kind)][verdict if verdict in ENDS else "defect"] += 1
            if verdict not in ENDS:
                print(number, _family(number, kind), verdict, flush=True)
                defects += 1
        inputs += len(found)
        slowest = max(slowest, *(time for _, time in found.values()))
    table = {"inputs": inputs, "families": counts, "defects": defects, "slowest": round(slowest, 2)}
    print(json.dumps(table))
    if given.out:
        given.out.parent.mkdir(parents=True, exist_ok=True)
        given.out.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
