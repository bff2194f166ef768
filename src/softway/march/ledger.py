"""The audit of a slab: energies, works, momentum, and the power of the contact force (eq. 3.9)."""

from dataclasses import replace

import numpy as np

from softway.bodies import past
from softway.bodies.section import Axisymmetric
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.march.standing import Account
from softway.march.step import ContactLedger, Ledger
from softway.model import Model
from softway.solve.balance import moment
from softway.typing import Array, BoolArray


def opening(model: Model, now: Situation) -> Ledger:
    """The ledger at the start: energies and momentum, no work yet."""
    rows, momenta = model.rows(now.start.displacement, now.time), model.mass @ now.start.velocity
    gap = rows.gap(now.start.displacement)
    contacts = {
        name: ContactLedger(
            force_n=float(now.pressure[rows.of(k)].sum()),
            force_t=_resultant(now.traction, rows.of(k)),
            min_gap=float(gap[rows.of(k)].min(initial=np.inf)),
            power_residual=0.0,
            count=int(now.closed[rows.of(k)].sum()),
        )
        for k, name in enumerate(rows.labels)
    }
    return Ledger(
        energy_kinetic=_kinetic(now.start.velocity, momenta),
        energy_strain=float(now.start.energy.sum()),
        work_external=0.0,
        dissipation=0.0,
        energy_error=0.0,
        momentum=momentum(momenta),
        spin=spin(model, now.start.displacement, momenta),
        contacts=contacts,
    )


def _kinetic(v: Array, momenta: Array) -> float:
    return 0.5 * float(np.vdot(v, momenta))


def resultant(field: Array) -> Array:
    """Sum (d,) of a nodal field (n, d).

    Examples
    --------
    >>> resultant(np.array([[1.0, 0.0], [2.0, 3.0]]))
    array([3., 3.])
    """
    return np.ones(len(field)) @ field


def momentum(momenta: Array) -> Array:
    """Linear momentum (3,) of nodal momenta (n, d) [kg m/s]."""
    out = np.zeros(3)
    out[: momenta.shape[1]] = resultant(momenta)
    return out


def spin(model: Model, u: Array, momenta: Array) -> Array:
    """Angular momentum (3,) of nodal momenta (n, d) about the origin [kg m^2/s]; zero in 1D and around an axis of
    revolution.
    """
    out = np.zeros(3)
    round_ = any(isinstance(p.internal.section, Axisymmetric) for p in model.parts)
    found = moment(model.points + u, momenta)
    if len(found) and not round_:
        out[3 - len(found) :] = found
    return out


def opened(ledger: Ledger) -> Account:
    """The account of a march that starts with a ledger."""
    return Account(energy_start=ledger.energy_kinetic + ledger.energy_strain)


def booked(account: Account, ledger: Ledger) -> Account:
    """The account after a slab with its ledger."""
    return replace(
        account,
        work_external=ledger.work_external,
        dissipation=ledger.dissipation,
        energy_error=ledger.energy_error,
    )


def audited(model: Model, last: Account, before: Situation, out: Outcome, after: Situation) -> Ledger:
    """The ledger after a slab, continuing the account."""
    moved = after.start.displacement - before.start.displacement
    load = out.system.model.slab_load(out.solution.end.scalar)
    work = last.work_external + float(np.vdot(load, moved)) + out.work
    lost = last.dissipation + out.dissipation + float(np.sum(out.solution.end.lost))
    lost += past.dissipated(model.parts, after.start.memory) - past.dissipated(model.parts, before.start.memory)
    momenta = model.mass @ after.start.velocity
    kinetic = _kinetic(after.start.velocity, momenta)
    strain = float(after.start.energy.sum())
    return Ledger(
        energy_kinetic=kinetic,
        energy_strain=strain,
        work_external=work,
        dissipation=lost,
        energy_error=kinetic + strain - last.energy_start - work + lost,
        momentum=momentum(momenta),
        spin=spin(model, after.start.displacement, momenta),
        contacts=_contacts(model, before, out, after),
    )


def _contacts(model: Model, before: Situation, out: Outcome, after: Situation) -> dict[str, ContactLedger]:
    """Force, least gap and power of each contact; the power is that of the phases in which a row is closed."""
    rows, first = out.rows, out.system.first
    gap0, gap1 = first.gap(before.start.displacement), rows.gap(after.start.displacement)
    drift = np.where(after.closed & rows.near, gap1, 0.0) - np.where(before.closed & first.near, gap0, 0.0)
    power = np.abs(out.force * drift)
    return {
        name: ContactLedger(
            force_n=float(out.force[rows.of(k)].sum()),
            force_t=_resultant(None if out.rub is None else out.rub.mean, rows.of(k)),
            min_gap=float(gap1[rows.of(k)].min(initial=np.inf)),
            power_residual=float(power[rows.of(k)].sum()),
            count=int(after.closed[rows.of(k)].sum()),
        )
        for k, name in enumerate(rows.labels)
    }


def _resultant(shear: Array | None, which: BoolArray) -> float:
    """Size of the sum of some tangential forces (m, d) [N]."""
    return 0.0 if shear is None else float(np.linalg.norm(shear[which].sum(axis=0)))
