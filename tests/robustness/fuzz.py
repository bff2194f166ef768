"""Damaged inputs given to the command line: ``python tests/robustness/fuzz.py COUNT`` reports what it does with them.

With ``--decks`` the inputs are decks mutated by meaning, of which nothing may be lost in silence.

Each input has its own folder, a limit of time, and a process with a limit of memory.  A defect is a traceback, an exit
code without its message, a hang, a process that dies, or a file left behind.
"""

import argparse
import collections
import contextlib
import io
import json
import multiprocessing as mp
import os
import resource
import signal
import tempfile
import traceback
import warnings
from pathlib import Path
from time import perf_counter
from typing import Any

from inputs.decks import judged_deck
from inputs.mutations import Damaged, damaged

MEMORY = 6 << 30
"""Bytes that a process may take."""
SECONDS = 20
"""Time for one input [s]."""
REFUSED, FAILED, INTERRUPTED = 2, 3, 130


class TooLong(BaseException):
    """The input took more than its time."""


def judged(given: Damaged, seconds: int = SECONDS) -> str:
    """What the command line does with an input: ``ok``, ``refused``, ``failed``, or a defect in words."""
    from softway.apps.cli import main

    with tempfile.TemporaryDirectory() as place:
        for name, data in given.files.items():
            Path(place, name).write_bytes(data)
        before, home = set(os.listdir(place)), Path.cwd()
        out, errors = io.StringIO(), io.StringIO()
        os.chdir(place)
        signal.signal(signal.SIGALRM, _stop)
        signal.alarm(seconds)
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                code = main(list(given.command))
        except TooLong:
            return f"hang: more than {seconds} s" if given.command[:1] not in (("run",), ("race",)) else "ok"
        except SystemExit as stop:
            return f"left by SystemExit {stop.code}"
        except Exception as error:
            where = traceback.extract_tb(error.__traceback__)[-1]
            return f"traceback: {type(error).__name__}: {str(error)[:80]} at {Path(where.filename).name}:{where.lineno}"
        finally:
            signal.alarm(0)
            os.chdir(home)
        left = set(os.listdir(place)) - before
    return _verdict(code, errors.getvalue(), left, given)


def _verdict(code: int, told: str, left: set[str], given: Damaged) -> str:
    if left and code != 0 and given.command[:1] not in (("run",), ("race",)):
        return f"files left: {sorted(left)}"
    if "Traceback" in told:
        return "traceback printed"
    if code in (REFUSED, FAILED) and "error" not in told:
        return f"exit {code} without a message"
    if code in (REFUSED, FAILED) and given.family != "command" and "try:" not in told and "line" not in told:
        return f"no remedy: {told[:90]!r}"
    return {0: "ok", 1: "ok", REFUSED: "refused", FAILED: "failed"}.get(code, f"exit {code}")


def _stop(*_: object) -> None:
    raise TooLong


def _work(first: int, count: int, decks: bool, results: Any) -> None:
    """Judge some inputs, telling each before and after; in a process of its own."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    from softway.scenario.hints.units_text import Units

    known = Units.standard()
    Units.standard = classmethod(lambda cls: known)  # type: ignore[method-assign]
    for number in range(first, first + count):
        results.send((number, None, 0.0))
        begun = perf_counter()
        verdict = judged_deck(number) if decks else judged(damaged(number))
        results.send((number, verdict, perf_counter() - begun))
    results.send(None)


def verdicts(first: int, count: int, *, decks: bool = False) -> dict[int, tuple[str, float]]:
    """Verdict and time of each input; a process that dies or hangs is replaced."""
    found: dict[int, tuple[str, float]] = {}
    context, end = mp.get_context("spawn"), first + count
    while first < end:
        here, there = context.Pipe(duplex=False)
        worker = context.Process(target=_work, args=(first, end - first, decks, there))
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


def _family(number: int, decks: bool) -> str:
    return "deck" if decks else damaged(number).family


def main() -> None:
    """Judge so many inputs and write the counts as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int, nargs="?", default=10_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--decks", action="store_true")
    given = parser.parse_args()
    found = verdicts(given.first, given.count, decks=given.decks)
    defects = {n: v for n, (v, _) in found.items() if v not in ("ok", "refused", "failed")}
    counts: dict[str, collections.Counter[str]] = collections.defaultdict(collections.Counter)
    for number, (verdict, _) in found.items():
        counts[_family(number, given.decks)][verdict if verdict in ("ok", "refused", "failed") else "defect"] += 1
    for number, verdict in defects.items():
        print(number, _family(number, given.decks), verdict)
    slowest = max(time for _, time in found.values())
    table = {"inputs": len(found), "families": counts, "defects": len(defects), "slowest": round(slowest, 2)}
    print(json.dumps(table))
    if given.out:
        given.out.parent.mkdir(parents=True, exist_ok=True)
        given.out.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
