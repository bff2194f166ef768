"""Audit of a slab (time step): energies, works, momentum, and the power of the contact force (eq. 3.9)."""

from dataclasses import replace

import numpy as np

from softway.arrays import Array, BoolArray
from softway.bodies.assembled import material_states
from softway.bodies.assembled.vector_space import VectorSpace
from softway.bodies.elements.section import Axisymmetric
from softway.marching.audit.heat_audit import heat_audit, initial_heat
from softway.marching.audit.rigid_balances import rigid_balances
from softway.marching.audit.tie_ledger import tie_ledgers
from softway.marching.results.slab_result import SlabResult
from softway.marching.results.step import ContactLedger, Ledger
from softway.marching.state.march_state import EnergyAccount
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.equations.spin_balance import moment


def initial_ledger(model: Model, now: ModelState) -> Ledger:
    """Ledger at the start: energies and momentum, no work."""
    rows, momenta = model.rows(now.start.displacement, now.time), model.mass @ now.start.velocity
    gap = rows.gap(now.start.displacement)
    contacts = {
        name: ContactLedger(
            force_n=float(now.pressure[rows.of_contact(k)].sum()),
            force_t=_resultant(now.traction, rows.of_contact(k)),
            min_gap=float(gap[rows.of_contact(k)].min(initial=np.inf)),
            power_residual=0.0,
            count=int(now.closed[rows.of_contact(k)].sum()),
        )
        for k, name in enumerate(rows.labels)
    }
    rigid = rigid_balances(model, now, now)
    return Ledger(
        energy_kinetic=0.5 * model.space.dot(now.start.velocity, momenta) + rigid.kinetic,
        energy_strain=float(now.start.energy.sum()) + rigid.springs,
        work_external=0.0,
        dissipation=0.0,
        energy_error=0.0,
        momentum=momentum(model.space, momenta) + rigid.momentum,
        spin=spin(model, now.start.displacement, momenta) + rigid.spin,
        contacts=contacts,
        ties=tie_ledgers(model, (), now, now),
        heat=initial_heat(model, now),
    )


def resultant(space: VectorSpace, field: Array) -> Array:
    """Sum (d,) of a nodal field (n, d).

    Examples
    --------
    >>> from softway.bodies.assembled.vector_space import LocalSpace
    >>> resultant(LocalSpace(()), np.array([[1.0, 0.0], [2.0, 3.0]]))
    array([3., 3.])
    """
    return space.products(np.ones(len(field)), field)


def momentum(space: VectorSpace, momenta: Array) -> Array:
    """Linear momentum (3,) of nodal momenta (n, d) [kg m/s]."""
    out = np.zeros(3)
    out[: momenta.shape[1]] = resultant(space, momenta)
    return out


def spin(model: Model, u: Array, momenta: Array) -> Array:
    """Angular momentum (3,) of nodal momenta (n, d) about the origin [kg m^2/s]; zero in 1D and around an axis of
    revolution.
    """
    out = np.zeros(3)
    round_ = any(isinstance(p.internal.section, Axisymmetric) for p in model.parts)
    found = moment(model.space, model.points + u, momenta)
    if len(found) and not round_:
        out[3 - len(found) :] = found
    return out


def open_account(ledger: Ledger) -> EnergyAccount:
    """Energy account of a march that starts with a ledger."""
    return EnergyAccount(energy_start=ledger.energy_kinetic + ledger.energy_strain, heat=ledger.heat)


def update_account(account: EnergyAccount, ledger: Ledger) -> EnergyAccount:
    """Energy account after a slab with its ledger."""
    return replace(
        account,
        work_external=ledger.work_external,
        dissipation=ledger.dissipation,
        energy_error=ledger.energy_error,
        ties=tuple(tie.dissipated for tie in ledger.ties.values()),
        heat=ledger.heat,
    )


def audit(model: Model, last: EnergyAccount, before: ModelState, out: SlabResult, after: ModelState) -> Ledger:
    """Ledger after a slab, continuing the energy account."""
    moved = after.start.displacement - before.start.displacement
    load = out.system.model.slab_load(out.solution.end.scalar)
    work = last.work_external + model.space.dot(load, moved) + out.work
    lost = last.dissipation + out.dissipation + float(np.sum(out.solution.end.lost))
    lost += material_states.dissipated_energy(model.parts, after.start.states) - material_states.dissipated_energy(
        model.parts, before.start.states
    )
    momenta = model.mass @ after.start.velocity
    rigid = rigid_balances(model, before, after)
    kinetic = 0.5 * model.space.dot(after.start.velocity, momenta) + rigid.kinetic
    strain = float(after.start.energy.sum()) + rigid.springs
    work, lost = work + rigid.work, lost + rigid.dissipation
    return Ledger(
        energy_kinetic=kinetic,
        energy_strain=strain,
        work_external=work,
        dissipation=lost,
        energy_error=kinetic + strain - last.energy_start - work + lost + last.remeshing,
        momentum=momentum(model.space, momenta) + rigid.momentum,
        spin=spin(model, after.start.displacement, momenta) + rigid.spin,
        contacts=_contacts(model, before, out, after),
        ties=tie_ledgers(model, last.ties, before, after),
        heat=heat_audit(last.heat, out),
        remeshing=last.remeshing,
    )


def _contacts(model: Model, before: ModelState, out: SlabResult, after: ModelState) -> dict[str, ContactLedger]:
    """Force, least gap and power of each contact; the power counts while a row is closed."""
    rows, first = out.rows, out.system.contact.initial.rows
    gap0, gap1 = first.gap(before.start.displacement), rows.gap(after.start.displacement)
    drift = np.where(after.closed & rows.near, gap1, 0.0) - np.where(before.closed & first.near, gap0, 0.0)
    power = np.abs(out.force * drift)
    return {
        name: ContactLedger(
            force_n=float(out.force[rows.of_contact(k)].sum()),
            force_t=_resultant(out.friction.mean, rows.of_contact(k)),
            min_gap=float(gap1[rows.of_contact(k)].min(initial=np.inf)),
            power_residual=float(power[rows.of_contact(k)].sum()),
            count=int(after.closed[rows.of_contact(k)].sum()),
        )
        for k, name in enumerate(rows.labels)
    }


def _resultant(shear: Array, which: BoolArray) -> float:
    """Magnitude of the sum of the tangential forces (m, d) of the rows ``which`` (m,) [N]."""
    if not shear.any():
        return 0.0
    return float(np.linalg.norm(shear[which].sum(axis=0)))
