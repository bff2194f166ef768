"""Successive compiled slabs (time steps): their numbers as arrays, and a step of each where one is asked for."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.errors import Cancel, heed
from softway.kernels.slab.tables import (
    CLOSED_POWER,
    COMPLEMENTARITY,
    COUNT,
    ERROR,
    FORCE,
    FORCE_T,
    GAP,
    KINETIC,
    LOST,
    MOMENTUM,
    POWER,
    SPIN,
    STRAIN,
    UNCLOSED,
    WORK,
)
from softway.marching.results.step import Certificate, ContactLedger, Ledger, Report, Step
from softway.marching.slab.slab_batch import BatchMotion, BatchStates, SlabBatch
from softway.marching.state.march_state import MarchState
from softway.model.model import Model
from softway.model.slab import Slab


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GroupNumbers:
    """Numbers of successive slabs: those of a :class:`~softway.marching.results.step.Step` with arrays of one value
    for each slab, or one value where all are the same.

    Parameters
    ----------
    slab
        Intervals of the slabs.
    ledger
        Energies and momenta.
    certificate
        Residuals.
    report
        Iterations.
    """

    slab: Slab
    ledger: Ledger
    certificate: Certificate
    report: Report


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class StepGroup:
    """Slabs of a batch, from the number ``start`` up to the one before ``stop``.

    Parameters
    ----------
    batch
        All slabs of the compiled call.
    start, stop
        Numbers of the first slab and of the one after the last.
    """

    batch: SlabBatch
    start: int
    stop: int

    @classmethod
    def whole(cls, batch: SlabBatch) -> "StepGroup":
        """All slabs of a batch."""
        return cls(batch=batch, start=0, stop=len(batch.iterations))

    def __len__(self) -> int:
        return self.stop - self.start

    def part(self, start: int, stop: int) -> "StepGroup":
        """Slabs from a number up to another, counted from the first of this group."""
        return StepGroup(batch=self.batch, start=self.start + start, stop=self.start + stop)

    @property
    def model(self) -> Model:
        """The model."""
        return self.batch.model

    @property
    def slab(self) -> Slab:
        """Intervals of the slabs."""
        time: Any = self.batch.course.time
        first, last = time[self.start : self.stop], time[self.start + 1 : self.stop + 1]
        return Slab(start=first, end=last, weight=self.batch.begun.settings.weight)

    def numbers(self) -> GroupNumbers:
        """Numbers of all slabs."""
        batch, which = self.batch, slice(self.start, self.stop)
        iterations: Any = np.array(batch.iterations[which])
        ratios: Any = np.array(batch.contractions[which])
        sums, contacts = self._sums, self._contacts
        return GroupNumbers(
            slab=self.slab,
            ledger=_ledger(batch, sums, contacts),
            certificate=_certificate(sums, self._errors, contacts, self._shapes),
            report=_report(batch, iterations, ratios, batch.course.scalar[which].T),
        )

    @property
    def motion(self) -> BatchMotion:
        """Motions at the ends of the slabs: solid -> (slabs, n, d)."""
        course, (n, d), between = self.batch.course, self.model.shape, slice(self.start + 1, self.stop + 1)
        u, v = (field[between].reshape(len(self), n, d) for field in (course.u, course.v))
        return BatchMotion(displacement=self._split(u), velocity=self._split(v))

    @property
    def reactions(self) -> Mapping[str, Array]:
        """Solid -> (slabs, n, d) mean force of the supports on the nodes [N]."""
        support, (n, d) = self.batch.course.support, self.model.shape
        found = support[self.start : self.stop] if len(support) else np.zeros((len(self), n * d))
        return self._split(found.reshape(len(self), n, d))

    @property
    def march_state(self) -> MarchState:
        """State of the march after the last slab."""
        return self.batch.march_state(self.stop)

    def step(self, number: int) -> Step:
        """Step of a slab, counted from the first of this group."""
        return next(self.part(number, number + 1).steps())

    def steps(self, cancel: Cancel | None = None) -> Iterator[Step]:
        """Steps of the slabs; each asks as often if the march is cancelled as if it were solved alone."""
        batch, which = self.batch, slice(self.start, self.stop)
        course, labels = batch.course, self.model.contacts.labels
        time, sums, met = course.time.tolist(), course.sums[which].tolist(), course.met[which].tolist()
        errors, scalars, shapes = self._errors.tolist(), course.scalar[which].tolist(), self._shapes.tolist()
        rows = zip(sums, errors, met, scalars, shapes, strict=True)
        for k, (row, error, at_contacts, scalar, shape) in enumerate(rows, self.start):
            slab = Slab(start=time[k], end=time[k + 1], weight=batch.begun.settings.weight)
            for _ in range(0 if cancel is None else 1 + batch.iterations[k]):
                heed(cancel, slab.start)
            contacts = {label: _contact(c, int(c[COUNT])) for label, c in zip(labels, at_contacts, strict=True)}
            yield Step(
                model=batch.model,
                slab=slab,
                ledger=_ledger(batch, row, contacts, course.sums[k]),
                certificate=_certificate(row, error, contacts, shape),
                events=(),
                report=_report(batch, batch.iterations[k], batch.contractions[k], scalar),
                states=BatchStates(batch=batch, number=k),
            )

    def _split(self, field: Array) -> dict[str, Array]:
        """Field (slabs, n, d) of each solid by name."""
        return {p.name: field[:, p.nodes] for p in self.model.parts}

    @property
    def _sums(self) -> Any:
        """Sums of the slabs, (SUMS, slabs)."""
        return self.batch.course.sums[self.start : self.stop].T

    @property
    def _errors(self) -> Array:
        """Errors of the energy balance before the slabs (slabs,) [J]."""
        return np.concatenate(
            [[self.batch.begun.account.energy_error], self.batch.course.sums[: self.stop - 1, ERROR]]
        )[self.start :]

    @property
    def _shapes(self) -> Any:
        """Least shapes of the cells after the slabs (slabs,)."""
        shapes = self.batch.shapes
        return np.full(len(self), np.nan) if shapes is None else shapes[self.start : self.stop]

    @property
    def _contacts(self) -> Mapping[str, ContactLedger]:
        """Audits of the contacts."""
        met: Any = self.batch.course.met[self.start : self.stop]
        return {label: _contact(met[:, k].T, met[:, k, COUNT]) for k, label in enumerate(self.model.contacts.labels)}


def in_steps(groups: Iterator[Step | StepGroup], cancel: Cancel | None = None) -> Iterator[Step]:
    """Steps of all slabs."""
    for one in groups:
        if isinstance(one, StepGroup):
            yield from one.steps(cancel)
        else:
            yield one


def _report(batch: SlabBatch, iterations: int, ratio: float, scalars: Any) -> Report:
    """Report on slabs with these numbers of iterations, ratios of successive changes, and scalars of the solids."""
    return Report(
        iterations=iterations,
        pairs=batch.pairs,
        factorisations=batch.memory.factorisations,
        renewals=batch.memory.renewals,
        passes=1,
        contraction=ratio,
        scalars={part.name: a for part, a in zip(batch.model.parts, scalars, strict=True)},
    )


def _contact(met: Any, count: int) -> ContactLedger:
    """Audit of a contact from its sums."""
    return ContactLedger(
        force_n=met[FORCE], force_t=met[FORCE_T], min_gap=met[GAP], power_residual=met[CLOSED_POWER], count=count
    )


def _ledger(batch: SlabBatch, row: Any, contacts: Mapping[str, ContactLedger], sums: Array | None = None) -> Ledger:
    """Ledger after slabs from their sums; ``sums`` are the same numbers as an array."""
    account, vectors = batch.begun.account, row if sums is None else sums
    return Ledger(
        energy_kinetic=row[KINETIC],
        energy_strain=row[STRAIN],
        work_external=row[WORK],
        dissipation=row[LOST],
        energy_error=row[ERROR],
        momentum=vectors[MOMENTUM : MOMENTUM + 3],
        spin=vectors[SPIN : SPIN + 3],
        contacts=contacts,
        remeshing=account.remeshing,
    )


def _certificate(row: Any, error: Any, contacts: Mapping[str, ContactLedger], shape: Any) -> Certificate:
    """Certificate of slabs from their sums; ``error`` is that of the energy balance before each [J], ``shape`` the
    least shape of the cells.
    """
    return Certificate(
        min_gap=reduce(_lower, (c.min_gap for c in contacts.values()), np.inf),
        min_force=0.0,
        complementarity=row[COMPLEMENTARITY],
        power_residual=row[POWER],
        momentum_error=row[UNCLOSED],
        energy_error=row[ERROR] - error,
        shape=shape,
    )


def _lower(one: Any, other: Any) -> Any:
    """Lower of two numbers or arrays."""
    return min(one, other) if isinstance(one, float) and isinstance(other, float) else np.minimum(one, other)
