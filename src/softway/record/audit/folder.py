"""Audit of a stored run, and its comparison with what the run says of itself."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from softway.marching.results.finding import ENERGY, finding
from softway.marching.results.step import Event
from softway.record.audit.auditor import Depths, auditor
from softway.record.audit.watch import AGREED
from softway.record.read.findings import gathered
from softway.record.read.frames import Fields
from softway.record.storage.table import Table
from softway.record.write.history_columns import REMESHING

DEEPER = 1e-9
"""Relative difference of depths that were computed from the same frame."""


def frames_audited(fields: Fields) -> Iterator[Depths]:
    """Depths and findings of each stored frame after the first, on its own cells."""
    last = judge = None
    for frame, cells in fields.with_cells(range(1, len(fields))):
        if judge is None or cells is not last:
            last, judge = cells, auditor(cells, cells.obstacles(0.0))
        yield judge.look(frame.time, frame.points[:, : cells.dimension], cells.obstacles(frame.time))


def history_audited(history: Table) -> list[Event]:
    """Finding on a history whose column ``energy_error`` is not what the other energies leave, with those that changes
    of the mesh took.

    Examples
    --------
    >>> columns = {"time": [0, 1], "energy_kinetic": [2, 1], "energy_strain": [0, 1], "work_external": [0, 0]}
    >>> wrong = {**columns, "dissipation": [0, 0.5], "energy_error": [0, 0]}
    >>> [found.finding for found in history_audited(Table({n: np.array(v) for n, v in wrong.items()}))]
    ['the energies of history.csv leave 0.5 J, its column energy_error has 0 J']
    """
    names = ("energy_kinetic", "energy_strain", "work_external", "dissipation")
    kinetic, strain, work, lost = (history[name] for name in names)
    lost = lost + history[REMESHING.name] if REMESHING.name in history else lost
    left = kinetic + strain - (kinetic + strain)[:1] - work + lost
    scale = np.abs(kinetic) + np.abs(strain) + np.abs(work) + np.abs(lost) + (kinetic + strain)[:1]
    wrong = np.flatnonzero(~(np.abs(left - history["energy_error"]) <= AGREED * scale))
    if not len(wrong):
        return []
    k = wrong[0]
    text = f"the energies of history.csv leave {left[k]:.3g} J, its column energy_error has"
    return [finding(float(history["time"][k]), ENERGY, ("all",), f"{text} {float(history['energy_error'][k]):.3g} J")]


def unsaid(found: Iterable[Event], claimed: Iterable[Mapping[str, Any]]) -> list[str]:
    """Sentences on findings that the entries ``findings`` of a summary do not tell, or tell with less depth.

    Examples
    --------
    >>> from softway.marching.results.finding import finding
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
