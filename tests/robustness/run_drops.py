"""Random drops marched and judged: ``python tests/robustness/run_drops.py COUNT``.

With ``--rigid`` scenes with rigid bodies, with ``--assemblies`` several bodies in contact with each other; with
``--adapt`` or ``--remesh`` the meshes of all their solids change.
"""

import argparse
import collections
import json
import signal
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from inputs.assemblies import assembly
from inputs.drops import Drop, drop
from inputs.rigid_drops import rigid_drop
from softway.errors import InputError, NumericsError
from softway.mechanisms.step import MechanismStep
from softway.record.audit.folder import frames_audited
from softway.record.run import Run
from softway.record.write.progress import MechanismProgress, Progress
from softway.scenario.checks.check import Checked, check
from softway.scenario.checks.notes.softening_notes import softening_notes
from softway.scenario.files import loads
from softway.scenario.hints.units_text import Units
from softway.scenario.run import run
from softway.studies.processes import Complaint, answers

ROOT = Path(__file__).parents[2]
SECONDS = 300
"""Processor time of one drop [s]."""
SHAPE = "certificate.shape"


class TooLong(BaseException):
    """The drop took more than its time."""


class Watch:
    """The worst figures of a march: depth over the size of the coordinates, tension over force, energy over energy."""

    def __init__(self) -> None:
        self.worst = {"depth": 0.0, "tension": 0.0, "energy": 0.0}
        self.slabs = self.rejections = self.changes = self.nodes = 0
        self.first = self.share = 0.0

    def __call__(self, progress: Progress | MechanismProgress) -> None:
        """Look at an accepted slab."""
        step = progress.step
        if isinstance(step, MechanismStep):
            self.slabs = progress.slabs
            self.first = max(self.first, step.energy_kinetic + abs(step.energy_potential) + abs(step.dissipation))
            self._worse("energy", abs(step.energy_error) / (self.first + 1e-300))
            self._worse("depth", step.joints)
            return
        found, ledger = step.certificate, step.ledger
        self.slabs, self.rejections = self.slabs + 1, self.rejections + len(step.report.rejections)
        self.changes += bool(step.transfers or step.exchanges)
        self.nodes, self.share = max(self.nodes, step.model.shape[0]), step.slab.end / progress.until
        self.first = max(self.first, ledger.energy_kinetic + ledger.energy_strain + abs(ledger.dissipation))
        reach = max(float(np.abs(u).max()) for u in step.after.displacement.values()) + 1e-300
        force = max([abs(c.force_n) for c in ledger.contacts.values()] + [1e-300])
        self._worse("depth", -found.min_gap / reach)
        self._worse("tension", -found.min_force / force)
        self._worse("energy", abs(ledger.energy_error) / self.first)

    def _worse(self, name: str, value: float) -> None:
        self.worst[name] = max(self.worst[name], value) if np.isfinite(value) or value < 0 else float("inf")


def judged(given: Drop, units: Units, seconds: int = SECONDS) -> dict[str, Any]:
    """How a drop ends: ``done``, ``stops`` with a reason, ``refused``, ``slow`` after ``seconds`` of processor time, or
    ``defect``; and its figures.
    """
    watch, begun = Watch(), process_time()
    signal.signal(signal.SIGVTALRM, _stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    end, why, seen, noted = "done", "", {"findings": "", "given_back": 0.0}, False
    try:
        checked = check(loads(given.text, folder=ROOT, units=units))
        if isinstance(checked, Checked):
            noted = bool(softening_notes(checked.model, checked.contacts))
        with tempfile.TemporaryDirectory() as place:
            done = run(checked, Path(place) / "run", progress=watch)
            why = _unrecorded(done)
            if isinstance(checked, Checked):
                why, seen = why or _unsaid(done), _seen(done)
            end = "defect" if why else "done"
    except NumericsError as error:
        crawls = "crawls: " if "rejections among" in error.what or "stays at h" in error.what else ""
        end, why = "stops", crawls + error.what.rpartition(" s: ")[2]
    except InputError as error:
        end, why = "refused", str(error).splitlines()[0]
    except TooLong:
        end, why = "slow", f"{watch.slabs} slabs, {100 * watch.share:.0f} % of its time, in {seconds} s"
    except Exception as error:
        end, why = "defect", f"{type(error).__name__}: {error}"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    told = {"number": given.number, "end": end, "why": why, "slabs": watch.slabs, "rejections": watch.rejections}
    told |= {"changes": watch.changes, "nodes": watch.nodes, "share": round(watch.share, 3)}
    took = round(process_time() - begun, 2)
    return {**told, "noted": noted, "seconds": took, **watch.worst, **seen, **given.traits}


def asking(given: Drop, lines: Sequence[str]) -> Drop:
    """The drop with these lines in each of its solids."""
    solid = 'kind = "Solid"\n'
    return replace(given, text=given.text.replace(solid, solid + "".join(f"{line}\n" for line in lines)))


def _unrecorded(done: Run) -> str:
    """What in the records is not a number; empty where all is.

    Linear bodies have no shapes of cells: these are numbers in all slabs or in none.
    """
    history = {name: values[1:] for name, values in done.history.items() if "gap" not in name}
    if SHAPE in history and np.isnan(history[SHAPE]).all():
        del history[SHAPE]
    bad = [name for name, values in history.items() if not np.isfinite(values).all()]
    return f"not a number in {', '.join(bad)}" if bad else ""


def _unsaid(done: Run) -> str:
    """A finding of the audit of the stored frames that is no event of the run; empty if there is none."""
    events, history = done.events, done.history
    audited = history["time"][~np.isnan(history["certificate.gap_nodes"])]
    said = set(zip(events["time"], events["kind"], events["contact"], strict=True))
    for depths in frames_audited(done.fields):
        for event in depths.findings:
            if event.time in audited and (event.time, event.kind, event.contact) not in said:
                return f"unsaid: {event.finding} at {event.time:g} s"
    return ""


def _seen(done: Run) -> dict[str, Any]:
    """Kinds of the findings, and the greatest dissipation that a slab gave back, relative to the energy."""
    history = done.history
    kinds = dict.fromkeys(one["kind"] for one in done.summary["findings"])
    energy = float((history["energy_kinetic"] + history["energy_strain"]).max())
    given_back = float(np.maximum(-np.diff(history["dissipation"]), 0.0).max(initial=0.0))
    return {"findings": ", ".join(kinds), "given_back": given_back / (energy + 1e-300)}


def _stop(*_: object) -> None:
    raise TooLong


MADE = {"drop": drop, "rigid": rigid_drop, "assembly": assembly}
"""How a scene of each kind is made."""


def fall(number: int, kind: str = "drop", lines: Sequence[str] = (), seconds: int = SECONDS) -> dict[str, Any]:
    """The scene of a number and a kind, judged, with ``lines`` in each of its solids."""
    return judged(asking(MADE[kind](number), lines), Units.standard(), seconds)


def fall_together(number: int) -> dict[str, Any]:
    """The assembly of a number, judged."""
    return fall(number, "assembly")


def _dead(given: Drop, how: Complaint, seconds: int) -> dict[str, Any]:
    """What is told of a drop whose process died."""
    number = given.number
    told = {"number": number, "end": "defect", "why": how.text, "slabs": 0, "rejections": 0, "seconds": seconds}
    return {**told, **Watch().worst, "findings": "", "given_back": 0.0, **given.traits}


def main() -> None:
    """March so many drops and write what became of them as JSON, one line each; ``--go-on`` keeps the lines there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int, nargs="?", default=500)
    parser.add_argument("--from", dest="first", type=int, default=0)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--go-on", action="store_true")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--rigid", dest="kind", action="store_const", const="rigid", default="drop")
    kind.add_argument("--assemblies", dest="kind", action="store_const", const="assembly")
    parser.add_argument("--seconds", type=int, default=SECONDS, help="processor time of one scene")
    for name in ("adapt", "remesh"):
        parser.add_argument(
            f"--{name}",
            dest="lines",
            action="append_const",
            const=f'{name} = "auto"',
            default=[],
            help="in every solid",
        )
    given = parser.parse_args()
    falls = partial(fall, kind=given.kind, lines=given.lines, seconds=given.seconds)
    kept = given.out.read_text().splitlines() if given.go_on and given.out.is_file() else []
    found = {line["number"]: line for line in map(json.loads, kept)}
    given.out.parent.mkdir(parents=True, exist_ok=True)
    with given.out.open("w") as lines:
        lines.writelines(f"{line}\n" for line in kept)
        for number, told, _ in answers(
            [n for n in range(given.first, given.count) if n not in found], falls, given.jobs
        ):
            found[number] = (
                _dead(MADE[given.kind](number), told, given.seconds) if isinstance(told, Complaint) else told
            )
            lines.write(json.dumps(found[number]) + "\n")
            lines.flush()
            if found[number]["end"] != "done":
                print(number, found[number]["end"], found[number]["why"], flush=True)
    given.out.write_text("".join(json.dumps(found[n]) + "\n" for n in sorted(found)))
    print(dict(collections.Counter(line["end"] for line in found.values())))


if __name__ == "__main__":
    main()
