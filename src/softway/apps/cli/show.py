"""Commands show, export and audit: the summary of a run, its motion, and its geometry apart from its contact."""

from functools import partial
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter
from rich.console import Console
from rich.markup import escape
from rich.progress import Progress

from softway.apps.cli.output.tables import findings, summary
from softway.errors import InputError
from softway.record.audit.auditor import Depths
from softway.record.audit.folder import frames_audited, history_audited, unsaid
from softway.record.audit.mechanism import audited_mechanism
from softway.record.export.motion import export as write_motion
from softway.record.read.findings import gathered, stored
from softway.record.run import SCENARIO, Run
from softway.record.write.fields import FILE as FIELDS
from softway.scenario.checks.check import check
from softway.scenario.checks.mechanism import CheckedMechanism
from softway.scenario.run import stored as stored_scenario

FINDINGS = 4
"""Exit code of a run with findings under --strict."""


def show(folder: Path, /) -> None:
    """Show the summary of a run, also of one that is still running or was interrupted.

    Parameters
    ----------
    folder
        Run folder.
    """
    summary(Run(folder), Console())


def export(folder: Path, /, *, to: Path) -> None:
    """Write the motion of the bodies of a mechanism to a file: places, rotations, velocities, angular velocities.

    Parameters
    ----------
    folder
        Run folder of a mechanism.
    to
        File to write: .csv, .json, .npz (NumPy) or .gltf (animation), by the end of its name.
    """
    run = Run(folder)
    if not run.of_mechanism:
        remedy = f"open {folder / FIELDS} in ParaView, or read sw.Run('{folder}').fields in Python"
        raise InputError(str(folder), "is the run of solids: their frames need no export", remedy)
    written = write_motion(run, to)
    bodies, rows = len(run.outline["bodies"]), run.motion.rows
    Console().print(escape(f"{written}: {bodies} bodies at {rows} instants"), soft_wrap=True, highlight=False)


def audited(done: Run, *, strict: bool, quiet: bool) -> int:
    """Exit code of a completed run; the findings of a ``quiet`` one are printed to the error output."""
    found = done.summary["findings"]
    if found:
        errors = Console(stderr=True)
        count = f"{len(found)} finding{'s' if len(found) > 1 else ''}"
        errors.print(f"[bold yellow]warning[/] done, with {count} of the audit", highlight=False)
        if quiet:
            findings(found, errors)
    return FINDINGS if strict and found else 0


def audit(
    folder: Path,
    /,
    *,
    strict: Annotated[bool, Parameter(negative=())] = False,
    quiet: Annotated[bool, Parameter(name=["--quiet", "-q"], negative=())] = False,
) -> int:
    """Look for overlaps and inverted cells in all stored frames of a run, independently of its contact.

    Every body is compared with every other one, with all tools and with itself, whether they are in contact or not, at
    the nodes and between them. A run does the same while it is computed, at most at every tenth slab (time step). The
    error of the energy balance is computed again from the energies in history.csv. Warnings name findings, also those
    of the run, that its summary does not tell. Of a mechanism all joints, the gaps of its stops, the energies, momentum
    and angular momentum are computed again from the motion of its bodies.

    Parameters
    ----------
    folder
        Run folder.
    strict
        Exit with code 4 if there is a finding.
    quiet
        Print the findings only.
    """
    run, console = Run(folder), Console(quiet=quiet)
    if run.of_mechanism:
        return FINDINGS if _mechanism_audited(run, console) and strict else 0
    fields = run.fields
    for name in fields.cells.lost:
        Console(stderr=True).print(f"'{name}' is not stored as data: it is left out", highlight=False)
    found: list[Depths] = []
    with Progress(console=console, transient=True) as display:
        task = display.add_task("frames", total=max(len(fields) - 1, 0))
        for depths in frames_audited(fields):
            found.append(depths)
            display.advance(task)
    seen = [*(event for depths in found for event in depths.findings), *history_audited(run.history)]
    told: list[dict[str, Any]] = gathered(seen)
    nodes, between = (max((getattr(d, name) for d in found), default=0.0) for name in ("nodes", "between"))
    console.print(f"{len(found)} frames audited; deepest overlap at nodes {nodes:.3g} m, between nodes {between:.3g} m")
    findings(told, Console())
    for sentence in unsaid([*seen, *stored(run.events)], run.summary.get("findings", ())):
        Console(stderr=True).print(f"[bold yellow]warning[/] {escape(sentence)}", soft_wrap=True, highlight=False)
    return FINDINGS if strict and told else 0


def _mechanism_audited(run: Run, console: Console) -> int:
    """Audit the run of a mechanism and tell what is found; the number of findings."""
    checked = check(stored_scenario(run.path))
    if not isinstance(checked, CheckedMechanism):
        raise InputError(str(run.path / SCENARIO), "is no scenario of a mechanism", "the unchanged run folder")
    told = audited_mechanism(run, checked.mechanism)
    say = partial(console.print, markup=False, soft_wrap=True, highlight=False)
    worst, deepest = (max(found.values(), default=0.0) for found in (told.joints, told.overlaps))
    say(f"{told.instants} instants audited; joints hold to {worst:.2g} m, deepest overlap of a stop {deepest:.2g} m")
    parts = ", ".join(f"{name.removeprefix('the ')} to {error:.1e}" for name, error in told.balances.items())
    say(f"history.csv tells what the motion gives: {parts}")
    if told.left_out:
        say(f"not looked at: {', '.join(told.left_out)}")
    for sentence in told.findings:
        Console().print(f"finding: {sentence}", markup=False, soft_wrap=True, highlight=False)
    return len(told.findings)
