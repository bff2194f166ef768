"""Successive slabs (time steps) of central differences on a device; fields come to the processor when asked for."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from softway.arrays import Array
from softway.kernels.slab.tables import (
    CLOSED_POWER,
    COMPLEMENTARITY,
    COUNT,
    ERROR,
    FIRST,
    FORCE,
    GAP,
    ITERATIONS,
    KINETIC,
    LAST,
    LOST,
    MET,
    MOMENTUM,
    POWER,
    SPIN,
    STRAIN,
    SUMS,
    UNCLOSED,
    WORK,
    Course,
)
from softway.marching.slab.resident_model import ResidentModel
from softway.marching.slab.slab_batch import AHEAD, TOGETHER, SlabBatch
from softway.marching.state.march_state import EnergyAccount, MarchState, Settings
from softway.marching.state.step_control import above
from softway.model.scene import State
from softway.solve.operators.operator_memory import OperatorMemory
from softway.tolerances import BALANCED, DEPTH, UNSTABLE
from softway.tolerances import MOMENTUM as MISSED

BYTES = 1e9
"""Greatest number of bytes of the states of a batch on the device."""
FIELDS = 7
"""Nodal fields of a state."""
MIDDLE = 1.0 / 12.0
"""Factor of ``h^2 |a1 - a0|`` in the error of a displacement."""


@dataclass(frozen=True, slots=True, eq=False)
class Kept:
    """Rows (N,) of fields, or slices of them, that are copied to the processor when they are asked for."""

    count: int
    row: Callable[[int], Array]

    def __len__(self) -> int:
        """Number of rows."""
        return self.count

    def __getitem__(self, k: int | slice) -> Array:
        """Row k, or rows k."""
        return np.stack([self.row(i) for i in range(*k.indices(self.count))]) if isinstance(k, slice) else self.row(k)


def next_resident(
    resident: ResidentModel, march_state: MarchState, before: State, memory: OperatorMemory
) -> SlabBatch | None:
    """Slabs on the device from a march state on, up to one in which something happens; None if that is the next one.

    The state alone decides which slabs these are, so that a resumed march has the same bits.
    """
    now, history, settings = march_state.state, march_state.step_history, march_state.settings
    active = np.flatnonzero(now.pressure > 0.0)
    calm = not (history.altered or history.energy_along_motion or history.recent_rejections)
    if not (calm and history.length <= history.span) or now.rows is not None or not resident.moved[active].all():
        return None
    fields = now.start.displacement, now.start.velocity, now.acceleration, now.start.force
    closed, most = resident.closed(active), int(min(TOGETHER, max(1.0, BYTES / (8.0 * FIELDS * fields[0].size))))
    states = [resident.slabs.state(now.time, fields, now.pressure, now.start.energy)]
    sums, met, lengths = np.zeros((most, SUMS)), np.zeros((most, len(resident.model.contacts.labels), MET)), []
    length, account = history.length, march_state.account
    for k in range(most):
        if settings.until - states[-1].time <= AHEAD * history.span:
            break
        new, told = resident.slabs.advance(states[-1], length, closed, active)
        _filled(sums[k], met[k], told, new.energy, account)
        if not _holds(resident, sums[k], told, (states[-1].energy, new.energy), account):
            break
        states.append(new)
        account = replace(account, work_external=float(sums[k, WORK]), energy_error=float(sums[k, ERROR]))
        length = _next(settings, history.span, length, told)
        lengths.append(length)
    if not lengths:
        return None
    model, course = resident.model, _course(resident, states, sums, met)
    rows = model.contacts.rest(model.displacement, 0.0).start(model.displacement)
    begun = march_state, before, memory
    return SlabBatch.of(model, course, rows, len(lengths), begun, lengths=tuple(lengths))


def _filled(sums: Array, met: Array, told: Any, energy: Array, account: EnergyAccount) -> None:
    """Write the sums of a slab in the columns of :mod:`softway.kernels.slab.tables`."""
    kinetic, work = float(told.sums[0]), account.work_external + float(told.sums[1])
    strain = float(energy.sum())
    sums[KINETIC], sums[STRAIN], sums[WORK] = kinetic, strain, work
    sums[ERROR] = kinetic + strain - account.energy_start - work + account.dissipation + account.remeshing
    sums[MOMENTUM : MOMENTUM + 3], sums[SPIN : SPIN + 3] = told.sums[2:5], told.sums[5:8]
    sums[UNCLOSED] = np.abs(told.sums[8:11]).max()
    sums[POWER], sums[COMPLEMENTARITY] = told.met[:, 1].sum(), told.met[:, 2].sum()
    sums[ITERATIONS], sums[FIRST], sums[LAST], sums[LOST] = 1.0, 0.0, 0.0, account.dissipation
    met[:, FORCE], met[:, CLOSED_POWER], met[:, COUNT] = told.met[:, 0], told.met[:, 1], told.met[:, 3]
    met[:, GAP] = -told.worst[:, 0]


def _holds(
    resident: ResidentModel, sums: Array, told: Any, energies: tuple[Array, Array], account: EnergyAccount
) -> bool:
    """True if nothing happens in a slab and its balances certainly hold."""
    model, limit = resident.model, BALANCED * DEPTH * resident.slabs.extent
    level = float(np.abs(energies[0]).sum() + np.abs(energies[1]).sum()) + sums[KINETIC] + abs(sums[WORK])
    touched, tension = told.worst[:, 1].max(initial=-np.inf), told.worst[:, 2].max(initial=-np.inf)
    still = told.found and told.below <= 0.0 and touched <= 0.0 and tension < 0.0
    grown = sums[ERROR] - account.energy_error
    kept = grown <= BALANCED * UNSTABLE * level + float(model.floor.sum())
    balanced = sums[UNCLOSED] <= BALANCED * MISSED * float(told.sums[11])
    return bool(still and kept and balanced and told.worst[:, 0].max(initial=-np.inf) <= limit)


def _next(settings: Settings, span: float, length: float, told: Any) -> float:
    """Length of the next slab: as in a march on the processor, shorter where cells are compressed [s]."""
    following = span
    if above(span, length):
        error = 8.0 * length**2 * MIDDLE * told.jerk
        following = min(span, 2.0 * length) if error <= settings.control.growth else length
    return float(min(following, span * told.ratio))


def _course(resident: ResidentModel, states: list[Any], sums: Array, met: Array) -> Course:
    """States of the slabs: fields as rows that are copied when they are asked for."""
    model, count = resident.model, len(states)
    held = ~model.free.ravel()

    def support(k: int) -> Array:
        one, two = states[k], states[k + 1]
        inner = 0.5 * (one.handed.numpy() + two.handed.numpy()) - 0.5 * (one.push.numpy() + two.push.numpy())
        return np.where(held, (inner - model.load).ravel(), 0.0)

    def rows(name: str) -> Array:
        return cast(Array, Kept(count, lambda k: np.array(getattr(states[k], name).numpy()).ravel()))

    supported = 0 if model.space.every(model.dofs.unsupported) else count - 1
    return Course(
        time=np.array([state.time for state in states]),
        u=rows("u"),
        v=rows("v"),
        slope=rows("slope"),
        force=rows("force"),
        pressure=rows("pressure"),
        energy=np.array([state.energy for state in states]),
        scalar=np.zeros((count - 1, len(model.parts))),
        support=cast(Array, Kept(supported, support)),
        sums=sums,
        met=met,
    )
