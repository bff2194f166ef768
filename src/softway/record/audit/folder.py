"""Audit of a stored run, and its comparison with what the run says of itself."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from softway.march.results.step import Event
from softway.record.audit.auditor import Depths, auditor
from softway.record.audit.energy_watch import EnergyWatch, given_back, missed
from softway.record.read.findings import gathered
from softway.record.read.frames import Fields
from softway.record.storage.table import Table

DEEPER = 1e-9
"""Relative difference of depths that were computed from the same frame."""


def frames_audited(fields: Fields) -> Iterator[Depths]:
    """Depths and findings of each stored frame after the first."""
    cells = fields.cells
    judge = auditor(cells, cells.tools)
    for k in range(1, len(fields)):
        frame = fields[k]
        yield judge.look(frame.time, frame.points[:, : cells.dimension])


def history_audited(history: Table) -> list[Event]:
    """Findings on the energies of a history; the error of the balance is computed again from the other columns."""
    names = ("time", "h", "energy_kinetic", "energy_strain", "work_external", "dissipation")
    lines = list(zip(*(history[name].tolist() for name in names), strict=True))
    if not lines:
        return []
    (_, _, *first), *others = lines
    start = first[0] + first[1]
    watch, found = EnergyWatch(start), []
    for time, span, kinetic, strain, work, lost in others:
        gained = watch.took(time, kinetic, strain, work, lost, kinetic + strain - start - work + lost)
        found += [*given_back(watch, gained, time, span), *missed(watch)]
    return found


def unsaid(found: Iterable[Event], claimed: Iterable[Mapping[str, Any]]) -> list[str]:
    """Sentences on findings that the entries ``findings`` of a summary do not tell, or tell with less depth.

    Examples
    --------
    >>> from softway.record.read.findings import finding
    >>> seen = [finding(0.1, "overlap", ("a", "b"), "node 3 of 'a' is 0.01 m inside 'b'", depth=0.01)]
    >>> unsaid(seen, gathered(seen)), unsaid(seen, [{"kind": "overlap", "between": "a-b", "depth": 0.002}])
    ([], ["summary.json tells 0.002 m of 0.01 m: overlap of 'a-b'"])
    >>> unsaid(seen, [])
    ["summary.json does not tell: overlap of 'a-b'"]
    """
    told, out = {(str(one.get("kind")), str(one.get("between"))): one for one in claimed}, []
    for entry in gathered(found):
        known = told.get((entry["kind"], entry["between"]))
        name = f"{entry['kind']} of '{entry['between']}'"
        if known is None:
            out.append(f"summary.json does not tell: {name}")
        elif entry["depth"] > (1.0 + DEEPER) * float(known.get("depth", 0.0)):
            out.append(f"summary.json tells {float(known.get('depth', 0.0)):.3g} m of {entry['depth']:.3g} m: {name}")
    return out
