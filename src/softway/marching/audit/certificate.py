"""Certificate of a slab (time step): residuals of the contact conditions and conservation laws, and their limits."""

import numpy as np

from softway.arrays import Array
from softway.bodies.assembled.following_nodes import reactions
from softway.bodies.elements.section import Axisymmetric
from softway.contact.contact_rows import ContactRows
from softway.marching.audit.balances import rounding_forces
from softway.marching.audit.heat_audit import fallen
from softway.marching.audit.ledger import resultant
from softway.marching.results.slab_result import SlabResult
from softway.marching.results.step import Certificate, Ledger
from softway.marching.state.march_state import EnergyAccount
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.equations.slab_values import SlabStart
from softway.tolerances import AT_REST, BEQUEST, DEPTH, ENERGY, FORCES, GAINED, MOMENTUM, TENSION, UNSTABLE

INTERNAL = 1e-4
"""Fraction of the impulses of internal forces, which cancel up to rounding, in the scale of momentum."""


def certify(
    model: Model, out: SlabResult, after: ModelState, last: EnergyAccount, ledger: Ledger, leftover: Array
) -> Certificate:
    """Certificate of a solved slab; ``leftover`` (d,) is its momentum error from :func:`balance`.

    The gaps are those to the nearest surfaces; forces belong to the rows that carry them, which may be on others.
    """
    rows = _nearest(out, after)
    gap = np.where(rows.near, rows.gap(after.start.displacement), np.inf)
    closed = after.closed & out.rows.near
    held = out.rows.gap(after.start.displacement)[closed]
    return Certificate(
        min_gap=float(gap.min(initial=np.inf)),
        min_force=float(after.pressure.min(initial=0.0)),
        complementarity=float(np.abs(after.pressure[closed] * held).sum()),
        power_residual=float(sum(c.power_residual for c in ledger.contacts.values())),
        momentum_error=float(np.abs(leftover).max()),
        energy_error=ledger.energy_error - last.energy_error,
    )


def _nearest(out: SlabResult, after: ModelState) -> ContactRows:
    """Rows at the end of a slab on the facets that are nearest there: those of the solution if it chose them there."""
    contact, end = out.system.contact, after.start.displacement
    same = out.solution.last.system.contact is contact and not contact.kept
    if same and np.array_equal(end, out.solution.end.displacement):
        return out.solution.end.rows
    return contact.nearest_rows(end)


def violation(
    model: Model,
    before: ModelState,
    out: SlabResult,
    after: ModelState,
    ledger: Ledger,
    found: Certificate,
) -> str | None:
    """Message on the first violated condition of a certificate; None if it is valid."""
    kept = (found.min_gap, found.min_force, found.power_residual, found.momentum_error, found.energy_error)
    if np.isnan(kept).any() or not np.isfinite(kept[1:]).all():
        return "a gap, a force or a balance is not a number"
    if found.min_gap < 0.0 and found.min_gap < -DEPTH * model.extent(after.start.displacement):
        return f"a node ends {-found.min_gap:.3g} m inside its opponent"
    if found.min_force < -TENSION * float(np.abs(after.pressure).max(initial=0.0)):
        return f"a contact row is in tension: {-found.min_force:.3g} N"
    broken = _energetic(model, before, out, after, ledger, found) or _pushing(model, before, out, after, ledger, found)
    return broken or fallen(ledger.heat)


def _energetic(
    model: Model, before: ModelState, out: SlabResult, after: ModelState, ledger: Ledger, found: Certificate
) -> str | None:
    """Message on the energy balance; the full energy scale is computed only if a part of it is not sufficient."""
    closes, limited = (out.required.energy == kind for kind in ("closed", "limited"))
    error = abs(found.energy_error) if closes else ledger.energy_error if limited else found.energy_error
    level = float(np.abs(before.start.energy).sum() + np.abs(after.start.energy).sum()) + ledger.energy_kinetic
    level += abs(ledger.work_external)
    growth, rest = (0.0 if closes else UNSTABLE), AT_REST * float(model.floor.sum())
    if out.required.energy == "free" or (not limited and error <= (growth + ENERGY) * level + rest):
        return None
    level += float(model.kinetic(before.start.velocity).sum())
    if limited and found.energy_error > GAINED * level + rest:
        return f"the energy grows by {found.energy_error:.3g} J of {level:.3g} J: the slab is too long for its touches"
    level += max(ledger.dissipation, 0.0) if limited else 0.0
    moved = np.abs(after.start.displacement - before.start.displacement).max(axis=1)
    if error <= (growth + ENERGY) * level + rest + model.space.total(_blurred(model, after) * moved):
        return None
    if closes:
        return f"the energy balance misses {found.energy_error:.3g} J of {level:.3g} J"
    if limited:
        return f"the energy has grown by {error:.3g} J of {level:.3g} J: slabs are too long for the touches in them"
    return f"the energy grows by {error:.3g} J of {level:.3g} J: beyond the stability limit"


def _pushing(
    model: Model, before: ModelState, out: SlabResult, after: ModelState, ledger: Ledger, found: Certificate
) -> str | None:
    """Message on the momentum balance; its scale is at least the total momentum."""
    if not out.required.momentum:
        return None
    accuracy = MOMENTUM if model.inert else FORCES
    closes = out.required.energy == "closed"
    if not closes and found.momentum_error <= accuracy * float(np.abs(ledger.momentum).sum()):
        return None
    scale = _participating(model, before, out, after)
    most = accuracy * scale + float(np.sqrt(2.0 * model.space.total(model.mass.sum(axis=1)) * model.floor.sum()))
    most += (after.time - before.time) * model.space.total(_blurred(model, after))
    if found.momentum_error > most:
        return f"the momentum balance misses {found.momentum_error:.3g} of {scale:.3g} kg m/s"
    unrest = float(np.abs(_unrest(out, after)).max()) if closes else 0.0
    if unrest > BEQUEST * most:
        return f"unbalanced forces on massless nodes leave {unrest:.3g} of {scale:.3g} kg m/s to the next slab"
    return None


def _unrest(out: SlabResult, after: ModelState) -> Array:
    """Momentum (d,) over a slab of the unbalanced forces on massless nodes at its end.

    They persist at the start of the next slab, whose iterations cannot remove them.
    """
    model = out.system.model
    force = after.start.force - model.load - out.rows.spread(after.pressure, model.shape)
    if out.rows.shear.count:
        force = force - out.rows.shear.spread(after.traction)
    force = model.dofs.gathered(force) - reactions(model.dofs, force)
    force = np.where(model.massive[:, None], 0.0, force)
    return np.asarray(out.system.path.span * model.space.sums(force))


def _blurred(model: Model, after: ModelState) -> Array:
    """Rounding error (n,) of the equilibrium of massless nodes, from the rounding of positions [N].

    The energy of bodies that slide to rest decreases with the square of the speed, the work of these forces with the
    speed only.
    """
    return np.where(model.massive, 0.0, rounding_forces(model, after.start.displacement))


def balance(model: Model, before: ModelState, out: SlabResult, after: ModelState) -> Array:
    """Change of momentum (d,) less the impulses of loads, contact and supports [kg m/s]."""
    keep = np.ones(model.shape[1])
    keep[0] = not any(isinstance(p.internal.section, Axisymmetric) for p in model.parts)
    space = model.space
    gained = space.products(model.mass @ np.ones(len(model.massive)), after.start.velocity - before.start.velocity)
    pushed = sum(resultant(space, part) for part in _given(out))
    return np.asarray((gained - (after.time - before.time) * pushed) * keep)


def _given(out: SlabResult) -> tuple[Array, Array, Array]:
    """Mean forces (n, d) of loads, contact and supports [N]."""
    return out.system.model.slab_load(out.solution.end.scalar), out.push, out.support


def _parts(start: SlabStart) -> tuple[Array, ...]:
    """Internal forces (n, d) of the solids and of each companion field, which may cancel [N]."""
    return (start.force_of_solids, *(field.force for field in start.fields))


def _participating(model: Model, before: ModelState, out: SlabResult, after: ModelState) -> float:
    """Scale of the momentum balance [kg m/s]."""
    total, span = model.space.total, after.time - before.time
    own = sum(total(np.abs(model.mass @ state.start.velocity)) for state in (before, after))
    inner = INTERNAL * span * sum(total(np.abs(force)) for state in (before, after) for force in _parts(state.start))
    return own + span * total(np.abs(sum(_given(out)))) + inner
