"""Commands show, export and audit: the summary of a run, its motion, and its geometry apart from its contact."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.progress import Progress

from softway.apps.cli.output.options import Quiet, Strict
from softway.apps.cli.output.tables import findings, summary
from softway.errors import InputError
from softway.record.audit.among_solids import audited_among_solids, has_rigid_bodies
from softway.record.audit.auditor import Depths
from softway.record.audit.folder import frames_audited, history_audited, unsaid
from softway.record.audit.mechanism import MechanismAudit, audited_mechanism
from softway.record.audit.pile import audited_pile
from softway.record.export.motion import export as write_motion
from softway.record.read.findings import gathered, stored
from softway.record.read.heat_summary import told_of_heat
from softway.record.run import SCENARIO, Run
from softway.record.write.fields import FILE as FIELDS
from softway.scenario.checks.check import check
from softway.scenario.checks.heat import CheckedHeat
from softway.scenario.checks.mechanism import CheckedMechanism
from softway.scenario.checks.pile import CheckedPile
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
    """Write the motion of a mechanism or a pile to a file: places, rotations, velocities, angular velocities.

    Parameters
    ----------
    folder
        Run folder of a mechanism or a pile.
    to
        File to write: .csv, .json, .npz (NumPy) or .gltf (animation), by the end of its name; of a pile not .json.
    """
    run = Run(folder)
    if not (run.of_mechanism or run.of_pile):
        remedy = f"open {folder / FIELDS} in ParaView, or read sw.Run('{folder}').fields in Python"
        raise InputError(str(folder), "has frames, which need no export", remedy)
    written = write_motion(run, to)
    what = f"{len(run.pile['radii'])} balls" if run.of_pile else f"{len(run.outline['bodies'])} bodies"
    Console().print(escape(f"{written}: {what} at {len(run.times)} instants"), soft_wrap=True, highlight=False)


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
    strict: Strict = False,
    quiet: Quiet = False,
) -> int:
    """Look for overlaps and inverted cells in all stored frames of a run, independently of its contact.

    Every body is compared with every other one, with all tools and with itself, whether they are in contact or not, at
    the nodes and between them. A run does the same while it is computed, at most at every tenth slab (time step). The
    error of the energy balance is computed again from the energies in history.csv. Warnings name findings, also those
    of the run, that its summary does not tell. Of rigid bodies all joints, the gaps of their stops, energies and
    momenta are computed again from their motion, beside solids at the stored frames; of a pile the gaps of all balls
    and walls, energies, momentum and angular momentum. Of conductors the balance of heat is told.

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
    if run.of_heat:
        return _heat_audited(run, console)
    if run.of_pile:
        return FINDINGS if _pile_audited(run, console) and strict else 0
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
    open_joints = _rigid_audited(run, console) if has_rigid_bodies(run.path) else 0
    nodes, between = (max((getattr(d, name) for d in found), default=0.0) for name in ("nodes", "between"))
    console.print(f"{len(found)} frames audited; deepest overlap at nodes {nodes:.3g} m, between nodes {between:.3g} m")
    findings(told, Console())
    for sentence in unsaid([*seen, *stored(run.events)], run.summary.get("findings", ())):
        Console(stderr=True).print(f"[bold yellow]warning[/] {escape(sentence)}", soft_wrap=True, highlight=False)
    return FINDINGS if strict and (told or open_joints) else 0


def _mechanism_audited(run: Run, console: Console) -> int:
    """Audit the run of a mechanism and tell what is found; the number of findings."""
    checked = check(stored_scenario(run.path))
    if not isinstance(checked, CheckedMechanism):
        raise InputError(str(run.path / SCENARIO), "is no scenario of a mechanism", "the unchanged run folder")
    return _told(audited_mechanism(run, checked.mechanism), console)


def _rigid_audited(run: Run, console: Console) -> int:
    """Audit the rigid bodies of a run with solids, and tell what is found; the number of findings.

    A scenario with parts that were built in Python is not stored: there the joints are left out.
    """
    try:
        checked = check(stored_scenario(run.path))
        if isinstance(checked, CheckedMechanism | CheckedPile | CheckedHeat):
            raise InputError(str(run.path / SCENARIO), "is a scenario without solids", "the unchanged run folder")
    except InputError as error:
        Console(stderr=True).print(f"joints are left out: {escape(str(error))}", soft_wrap=True, highlight=False)
        return 0
    return _told(audited_among_solids(run, checked.model), console)


def _told(told: MechanismAudit, console: Console) -> int:
    """Tell what an audit of rigid bodies found; the number of findings."""
    say = partial(console.print, markup=False, soft_wrap=True, highlight=False)
    worst, deepest = (max(found.values(), default=0.0) for found in (told.joints, told.overlaps))
    say(f"{told.instants} instants audited; joints hold to {worst:.2g} m, deepest overlap of a stop {deepest:.2g} m")
    parts = ", ".join(f"{name.removeprefix('the ')} to {error:.1e}" for name, error in told.balances.items())
    say(f"history.csv tells what the motion gives: {parts}")
    if told.left_out:
        say(f"not looked at: {', '.join(told.left_out)}")
    return _found(told.findings)


def _pile_audited(run: Run, console: Console) -> int:
    """Audit the run of a pile and tell what is found; the number of findings."""
    checked = check(stored_scenario(run.path))
    if not isinstance(checked, CheckedPile):
        raise InputError(str(run.path / SCENARIO), "is no scenario of a pile", "the unchanged run folder")
    told = audited_pile(run, checked.pile)
    say = partial(console.print, markup=False, soft_wrap=True, highlight=False)
    depths = f"of balls {told.between:.2g} m, with walls {told.walls:.2g} m"
    say(f"{told.instants} instants audited; deepest overlap {depths}")
    parts = ", ".join(f"{name.removeprefix('the ')} to {error:.1e}" for name, error in told.balances.items())
    say(f"history.csv tells what the motion gives: {parts}")
    return _found(told.findings)


def _heat_audited(run: Run, console: Console) -> int:
    """Tell how the balance of heat holds in the history of conductors, which have no geometry to look at."""
    for sentence in told_of_heat(run.numbers):
        console.print(sentence, markup=False, soft_wrap=True, highlight=False)
    return 0


def _found(sentences: Sequence[str]) -> int:
    """Print findings; their number."""
    for sentence in sentences:
        Console().print(f"finding: {sentence}", markup=False, soft_wrap=True, highlight=False)
    return len(sentences)
