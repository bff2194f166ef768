"""Audit of a march: its slabs with the findings at the stored frames and at the end."""

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from softway.bodies.prescribed_motion import PlacedShape
from softway.bodies.solid import Tool
from softway.marching.results.finding import ENERGY, MOMENTUM, SPIN, finding
from softway.marching.results.step import Event, Step
from softway.marching.slab.step_group import StepGroup
from softway.model.scene import State
from softway.record.audit.auditor import Auditor, Depths, auditor
from softway.record.audit.energy_watch import ENERGIES, RECEIVED, EnergyWatch, given_back, missed, received
from softway.record.storage.table import Table
from softway.record.write.grid.grid_layout import Layout, layout
from softway.record.write.mechanism.rigid_table import placed_bodies
from softway.record.write.recorder import RunStart

APART = 10
"""Least number of slabs between two audits: with it they take a few percent of the time of a run."""
AGREED = 1e-9
"""Difference of energies and momenta to those computed again from the fields, relative to them."""

UNPUSHED = 1e-6
"""Force that no contact explains, relative to the forces on the nodes of a body, above which it is a finding."""

UNTURNED = 1e-2
"""Likewise the moment of forces, relative to the moments on the nodes of a body: slabs keep spin to second order."""

TURNED = 0.1
"""Excess of the resultant over the sum of the row forces that turning normals of mean gaps may explain."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Geometry:
    """Solids on the meshes of a ``start``, as ``cells``, with their geometric audit."""

    start: RunStart
    cells: Layout
    auditor: Auditor

    def depths(self, state: State, obstacles: Mapping[str, PlacedShape]) -> Depths:
        """Depths and findings in a state."""
        d = self.cells.dimension
        x = self.cells.reference[:, :d] + self.cells.nodal(state.displacement)[:, :d]
        return self.auditor.look(state.time, x, obstacles)


class Watcher:
    """Audit of the slabs of one march, which it takes in order.

    Parameters
    ----------
    obstacles
        Tools and rigid bodies at their places in a state.
    opening
        Start of the run: when frames are stored, and the balances of a state.
    """

    __slots__ = ("_audited", "_energy", "_geometry", "_slabs", "obstacles", "opening")

    def __init__(self, obstacles: Callable[[State], Mapping[str, PlacedShape]], opening: RunStart) -> None:
        self.obstacles, self.opening = obstacles, opening
        self._geometry = self._geometry_of(opening)
        self._slabs = self._audited = 0
        start = opening.ledger
        self._energy = EnergyWatch(start.energy_kinetic + start.energy_strain, opening.rounding)

    def past(self, history: Table) -> None:
        """Take up the history of the part of the run that was computed before it is resumed."""
        columns = ("time", *ENERGIES, *(name for name in history if name == RECEIVED))
        lines = zip(*(history[name].tolist() for name in columns), strict=True)
        before = float(history["time"][0])
        for time, *energies in itertools.islice(lines, 1, None):
            given = energies[len(ENERGIES) :]
            self._energy.took(time, *energies[: len(ENERGIES)], received=sum(given))
            if self._counted(before, time):
                self._energy.looked()
            before = time

    def watched(self, steps: Iterator[Step | StepGroup]) -> Iterator[Step | StepGroup]:
        """Steps with the findings among their events, and the gaps that were seen in their certificates.

        Groups have no frames, at which geometry and balances are audited.
        """
        for one in steps:
            if isinstance(one, StepGroup):
                yield from self._group(one)
            else:
                yield self._step(one)

    def _step(self, step: Step) -> Step:
        energies = (getattr(step.ledger, name) for name in ENERGIES)
        gained = self._energy.took(step.slab.end, *energies, received=received(step.ledger))
        found = list(given_back(self._energy, gained, step.slab.end, step.slab.span))
        seen = step.certificate
        if self._counted(step.slab.start, step.slab.end):
            depths = self._depths(step)
            seen = replace(seen, gap_nodes=0.0 - depths.nodes, gap_between=0.0 - depths.between)
            found += [*depths.findings, *self._balanced(step), *self._pushed(step)]
        told = {(event.kind, event.contact) for event in step.events}
        found = [event for event in found if (event.kind, event.contact) not in told]
        changed = bool(found) or seen is not step.certificate
        return replace(step, certificate=seen, events=(*step.events, *found)) if changed else step

    def _group(self, group: StepGroup) -> Iterator[Step | StepGroup]:
        """Parts of a group between its slabs with findings, which become steps."""
        numbers, begin = group.numbers(), 0
        columns = [np.broadcast_to(getattr(numbers.ledger, name), len(group)).tolist() for name in ENERGIES]
        times = zip(np.ravel(numbers.slab.end).tolist(), np.ravel(numbers.slab.span).tolist(), strict=True)
        for k, ((end, span), energies) in enumerate(zip(times, zip(*columns, strict=True), strict=True)):
            gained = self._energy.took(end, *energies)
            found = tuple(given_back(self._energy, gained, end, span))
            if found:
                yield from (group.part(begin, k),) if k > begin else ()
                yield replace(group.step(k), events=found)
                begin = k + 1
        self._slabs += len(group)
        if begin < len(group):
            yield group.part(begin, len(group)) if begin else group

    def _geometry_of(self, start: RunStart) -> "_Geometry":
        """Solids on the meshes of a start, and their geometric audit."""
        cells = layout(start.meshes, {})
        return _Geometry(start=start, cells=cells, auditor=auditor(cells, self.obstacles(self.opening.initial)))

    def _depths(self, step: Step) -> Depths:
        """Depths and findings at the end of a slab, on its meshes."""
        start = self.opening.of(step)
        if start is not self._geometry.start:
            self._geometry = self._geometry_of(start)
        return self._geometry.depths(step.after, self.obstacles(step.after))

    def _counted(self, before: float, after: float) -> bool:
        """Count a slab between two times; true if it is audited."""
        self._slabs += 1
        if not (
            self.opening.ended(after)
            or (self._slabs - self._audited >= APART and self.opening.frame_due(before, after))
        ):
            return False
        self._audited = self._slabs
        return True

    def _balanced(self, step: Step) -> Iterator[Event]:
        """Findings on balances that miss, and on energies and momenta that do not agree with the fields."""
        ledger, time = step.ledger, step.after.time
        yield from missed(self._energy)
        start = self.opening.of(step)
        if start.balances is None:
            return
        again = start.balances(step.after)
        energies = (("kinetic", again.kinetic, ledger.energy_kinetic), ("strain", again.strain, ledger.energy_strain))
        for name, found, given in energies:
            if found is not None and not abs(found - given) <= AGREED * self._energy.scale + self.opening.rounding:
                text = f"the {name} energy of the fields is {found:.9g} J, that of the ledger {given:.9g} J"
                yield finding(time, ENERGY, ("all",), text)
        vectors = (
            (MOMENTUM, again.momentum - ledger.momentum, again.moving, "kg m/s"),
            (SPIN, again.spin - ledger.spin, again.turning, "kg m^2/s"),
        )
        for kind, difference, scale, unit in vectors:
            greatest = float(np.abs(difference).max())
            if not greatest <= AGREED * scale:
                text = f"the {kind} of the fields and that of the ledger differ by {greatest:.3g} {unit}"
                yield finding(time, kind, ("all",), text)

    def _pushed(self, step: Step) -> Iterator[Event]:
        """Findings on bodies whose changes of momentum and spin are more than all their contacts give.

        The resultant of normal forces is no larger than their sum, whatever their directions are, and their moment no
        larger than the sum times the arm of the body.
        """
        pushed = self.opening.of(step).pushed
        if pushed is None:
            return
        contacts = [(c.label, {name.partition(".")[0] for name in c.between}) for c in self.opening.scene.contacts]
        for group, needed in pushed(step).items():
            mine = [step.ledger.contacts[label] for label, bodies in contacts if bodies.intersection(group)]
            told = f"'{group[0]}' is" if len(group) == 1 else f"{' and '.join(map(repr, group))} are"
            given = sum(c.force_n + c.force_t for c in mine)
            force, moment = (float(np.linalg.norm(part)) for part in (needed.resultant, needed.moment))
            if not force <= (1.0 + TURNED) * given + UNPUSHED * needed.scale + needed.rounding:
                text = f"{told} pushed by {force:.6g} N, the contacts give at most {given:.6g} N"
                yield finding(step.after.time, MOMENTUM, group, text)
            most, blur = given * needed.arm, needed.rounding * needed.arm
            if not moment <= (1.0 + TURNED) * most + UNTURNED * needed.turning + blur:
                text = f"{told} turned by {moment:.6g} N m, the contacts give at most {most:.6g} N m"
                yield finding(step.after.time, SPIN, group, text)


def watcher(opening: RunStart) -> Watcher:
    """Audit of a run from its start."""
    tools = {name: body for name, body in opening.scene.bodies.items() if isinstance(body, Tool)}
    rigid = {} if opening.scene.mechanism is None else opening.scene.mechanism.bodies

    def obstacles(state: State) -> Mapping[str, PlacedShape]:
        return {**{name: tool.at(state.time) for name, tool in tools.items()}, **placed_bodies(rigid, state)}

    return Watcher(obstacles, opening)
