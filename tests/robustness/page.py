"""The page of robustness, docs/verification/robustness.md, from the results beside it."""

import collections
import json
import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import Any

PLACE = Path(__file__).parents[2] / "docs" / "verification" / "robustness"
ENDS = ("done", "stops", "slow", "refused", "defect")
HEAD = """# Robustness

`make fuzz`, `make drops` and `make endurance` make this page. What each does is said in `tests/robustness`.
"""

KNOWN = """## What is known to stop or to take long

- Impacts that a law does not bear: StVenantKirchhoff from half the speed at which a plane impact takes its matter to
  where it is unstable ([softening](../theory/bodies/softening.md)); `check` notes them. Cells collapse to a hundredth
  of their volume and less. With NeoHookean in its place 421, 429, 458 and 468 are done in 2 to 4 s.
- Other matter crushed at v/c > 0.13, most of it with friction: nodes of a surface lose their equilibrium. Then
  [dashpots](../theory/contact/energy.md#nodes-without-equilibrium) act until they find another one, in many short
  slabs: 31, 234, 291, 300, 308, 351 and 402 go on, but take more than five minutes.
- Newton's method chosen by hand with crushed cells: where it does not converge, the fixed point takes over, and each
  slab pays for both.
- Impulse and Paper between the corners of two bodies: a node sees one wall of a corner in one slab and the other in
  the next.
- Paper gives energy where neighbours move against the node that it stops, as in the second example of the paper
  ([contact](../theory/contact/contact.md#energy-loss-at-first-contact)): 161 and 239. The audit tells it.
- Balls of Kelvin matter damped beyond what their slabs resolve: right, but 25 iterations a slab and no factor kept.
"""


def page(place: Path = PLACE) -> str:
    """The text of the page; a part whose results are missing is left out."""
    parts = [HEAD]
    if (place / "fuzz.json").is_file():
        parts.append(fuzz(json.loads((place / "fuzz.json").read_text())))
    for name, section in (("drops", drops), ("rigid_drops", rigid_drops), ("assemblies", assemblies)):
        if (place / f"{name}.jsonl").is_file():
            lines = (place / f"{name}.jsonl").read_text().splitlines()
            parts.append(section([json.loads(line) for line in lines]))
        if name == "drops" and (place / "adapted_drops.jsonl").is_file():
            given, found = (place / f"{kind}.jsonl" for kind in ("drops", "adapted_drops"))
            parts.append(
                adapted_drops(*([json.loads(line) for line in p.read_text().splitlines()] for p in (given, found)))
            )
    if (place / "endurance.json").is_file():
        parts.append(endurance(json.loads((place / "endurance.json").read_text())))
    return "\n".join([*parts, KNOWN])


def table(head: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    r"""A table in Markdown.

    Examples
    --------
    >>> table(["a", "b"], [[1, 2]])
    '| a | b |\n|---|---|\n| 1 | 2 |\n'
    """
    lines = [head, ["---"] * len(head), *rows]
    text = ["| " + " | ".join(str(cell) for cell in line) + " |" for line in lines]
    return "\n".join(text).replace("| --- | --- ", "|---|---").replace("| --- ", "|---").replace("--- |", "---|") + "\n"


def fuzz(found: dict[str, Any]) -> str:
    """Damaged inputs and what became of them."""
    kinds = ("ok", "refused", "failed", "slow", "defect")
    rows = [[name, *(counts.get(k, 0) for k in kinds)] for name, counts in sorted(found["families"].items())]
    text = f"""## Damaged and mutated inputs

{found["inputs"]} inputs, each in a process with a limit of memory and of time; {found["defects"]} defects.

- **Damaged** (`bytes`, `structure`, `mesh`, `command`): scenarios, mesh files (msh, inp, stl, ply, obj, vtu) and
  command lines with bytes, numbers, keys and parts changed. A defect is a traceback, a hang, a dead process, a refusal
  without place or remedy, or a file left behind.
- **Scenarios** mutated by meaning: small scenes of every dimension, rule and solver get valid parts in new
  combinations, drawn from the same type hints as the reader (other laws, meshes, tools, motions, rules, solvers), parts
  of each other, bodies, contacts and supports twice or crossed, other names, units and lengths of lists. `check` may
  refuse them with place and remedy; what it accepts has every value of the file in the scenario, and runs for three
  time steps (slabs).
  Further defects are: `check` accepts and `run` refuses, a value of the file that the scenario does not have, a
  warning of Python, a history that is not finite.
- **Meshes** mutated by meaning: Gmsh files of the versions 2.2, 4.0 and 4.1, as text and as bytes (labels with gaps,
  nodes that are not there, cells twice, further parts, several groups of one entity, names twice, huge or on nothing,
  sections of other programs, wrong counts) and surfaces as STL, OBJ, PLY and VTU. A file that is read gives all its
  cells, their volume or area, and all its groups, or the list of `check` names what is missing.
- **Decks** mutated by meaning: parts, includes, repeated headers, wrong labels, odd cards. Every card that was added is
  in the mesh or in the list of `check`.

The slowest took {found["slowest"]} s; *slow* is a `run` that its limit of time ended.

"""
    return text + table(["inputs", "accepted", "refused (exit 2)", "failed (exit 3)", "slow", "defects"], rows)


def drops(found: list[dict[str, Any]]) -> str:
    """Random drops and how they ended."""
    ends = collections.Counter(d["end"] for d in found)
    text = f"""## Random drops

{len(found)} drops of random bodies (bars, rectangles, discs, rings, thin and open rings that fold, boxes, balls,
cylinders, the bracket; all cells; ten laws) on random obstacles (half space, ball, block, roller, torus, STL, another
body), two or three deformable bodies in a third of them, friction in half, at v/c up to 0.3, tilted, with and without
gravity, by the three contact rules and two solvers; `tests/robustness/inputs/drops.py` makes the scenario of each
number. Every accepted slab is looked at: depth over the size of the displacements, tension over force, error of the
energy balance over energy, and the energy that friction and matter give back in a slab. The
[audit](../theory/contact/audit.md) looks at the stored frames; each of its findings has to be an event of the run. The
rules Impulse and Paper give no promise on energy. *Slow* is more than five minutes of processor time.

"""
    rows = []
    for rule in ("Energy", "Impulse", "Paper"):
        mine = [d for d in found if d["rule"] == rule]
        rows.append([rule, *_ends(mine), *_worst(mine, "given_back")])
    out = text + table(["rule", "drops", *ENDS, "depth", "tension", "energy", "given back"], rows) + _findings(found)
    stopped = [d for d in found if d["end"] not in ("done", "refused")]
    if stopped:
        out += f"\nThe {len(stopped)} that did not finish:\n\n"
        noted = sum(d.get("noted", False) for d in stopped)
        keys = ("number", "space", "body", "cells", "law", "obstacle", "rule", "solver", "friction", "speed")
        lines = [[*(d[k] for k in keys), d["end"], d["why"].replace("|", "/")] for d in stopped]
        out += table(["drop", *keys[1:], "end", "reason"], lines)
        out += f"\n{noted} of them are impacts that their law does not bear, as `check` notes before they are marched: "
        out += "[softening](../theory/bodies/softening.md).\n"
    return out + f"\nIn all: {', '.join(f'{ends[e]} {e}' for e in ENDS if ends[e])}.\n"


def adapted_drops(given: list[dict[str, Any]], found: list[dict[str, Any]]) -> str:
    """Random drops on meshes that adapt, how they ended, and what the same drops do without."""
    without = {d["number"]: d for d in given}
    seconds = [d["seconds"] for d in found]
    text = f"""## Random drops on meshes that adapt

The first {len(found)} of these drops with `adapt = "auto"` in every solid (`--adapt --seconds 900`). *Slow* is more
than 900 s of processor time; half of the drops took less than {statistics.median(seconds):.0f} s, and nine in ten less
than {statistics.quantiles(seconds, n=10)[-1]:.0f} s.
Meshes of cells that are not cut stay; small ones are fine from the start where a contact is near.

"""
    rows = []
    for name, mine in (
        ("changed", [d for d in found if d["changes"]]),
        ("as at the start", [d for d in found if not d["changes"]]),
    ):
        rows.append([name, *_ends(mine), *_worst(mine)])
    head = ["meshes", "drops", *ENDS, "depth", "tension", "energy"]
    text += table(head, rows) + _findings(found) + _unfinished(found)
    new = [d["number"] for d in found if _more(d, without[d["number"]])]
    told = f"Drops with a finding that they do not have on the given meshes: {', '.join(map(str, new))}." if new else ""
    return text + f"\n{told or 'No drop has a kind of finding that it does not have on the given mesh.'}\n"


def _more(found: dict[str, Any], given: dict[str, Any]) -> bool:
    """True if a drop has a kind of finding that another one does not have."""
    kinds = [{kind for kind in d.get("findings", "").split(", ") if kind} for d in (found, given)]
    return not kinds[0] <= kinds[1]


def rigid_drops(found: list[dict[str, Any]]) -> str:
    """Random scenes with rigid bodies and how they ended."""
    text = f"""## Random scenes with rigid bodies

{len(found)} scenes in the plane, by `tests/robustness/inputs/rigid_drops.py`: rigid discs and squares that fall on a
solid, alone, with a second body on a rod or a hinge, or below a stop; hinged and guided hammers with springs; hubs that
carry a solid, free, hinged or driven by a motor; and chains of bars, without solids, that fall on stops with friction.
Masses over three decades, five laws, friction, two solvers. Depth is that of drops; of chains the error of the joints.

"""
    rows = []
    for family in ("falls", "hangs", "carries", "chain"):
        mine = [d for d in found if d["family"] == family]
        rows.append([family, *_ends(mine), *_worst(mine)])
    return text + table(["family", "scenes", *ENDS, "depth", "tension", "energy"], rows) + _unfinished(found)


def assemblies(found: list[dict[str, Any]]) -> str:
    """Random assemblies and how they ended."""
    text = f"""## Random assemblies

{len(found)} assemblies of three to eight bodies, by `tests/robustness/inputs/assemblies.py`: discs, boxes, thin closed
rings, strips and glued boxes in the plane, balls, boxes and plates in space, a quarter of them of two materials, that
fall into a box. Everything may touch everything and itself, most with friction, some pairs with a contact of their own.

"""
    rows = []
    for space in ("2D", "3D"):
        for glued in (False, True):
            mine = [d for d in found if d["space"] == space and ("glued" in d["pieces"]) == glued]
            tries = sum(d.get("slabs", 0) for d in mine), sum(d.get("rejections", 0) for d in mine)
            rows.append([f"{space}, with ties" if glued else space, *_ends(mine), *tries, *_worst(mine)])
    head = ["space", "assemblies", *ENDS, "slabs", "rejections", "depth", "tension", "energy"]
    return text + table(head, rows) + _findings(found) + _unfinished(found)


def _ends(mine: list[dict[str, Any]]) -> list[int]:
    """Number of scenes, and of those with each end."""
    counts = collections.Counter(d["end"] for d in mine)
    return [len(mine), *(counts[e] for e in ENDS)]


def _worst(mine: list[dict[str, Any]], *more: str) -> list[str]:
    """Greatest depth, tension and error of energy, and of ``more`` figures."""
    return [f"{max((d.get(k, 0.0) for d in mine), default=0.0):.1e}" for k in ("depth", "tension", "energy", *more)]


def _unfinished(found: list[dict[str, Any]]) -> str:
    """A line on each scene that did not finish."""
    return "".join(f"\n{d['number']} {d['end']}: {d['why']}\n" for d in found if d["end"] != "done")


def _findings(found: list[dict[str, Any]]) -> str:
    """Sentence on the findings of the audit; empty without any."""
    kinds = collections.Counter(kind for d in found for kind in d.get("findings", "").split(", ") if kind)
    told = ", ".join(f"{kind} in {count}" for kind, count in sorted(kinds.items()))
    some = sum(bool(d.get("findings")) for d in found)
    return f"\nThe audit found something in {some} of them: {told}.\n" if kinds else ""


def endurance(found: dict[str, float]) -> str:
    """A long run and its memory."""
    early, late = (f"{found[key]:.1f} MB" for key in ("early", "late"))
    return f"""## Endurance

A bar of two elements between two walls, {found["slabs"]:.0f} slabs with {found["touches"]:.0f} touches, history, events
and fields recorded: the process holds {early} after a tenth of the slabs and {late} at the end; the error of energy is
at most {found["energy"]:.1e} of the energy.
"""


def main() -> None:
    """Write the page."""
    PLACE.with_suffix(".md").write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
