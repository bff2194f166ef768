"""The certificate of a slab: what the contact conditions and the conservation laws leave over, and what is too much."""

import numpy as np

from softway.bodies.part import UNSTRAINED
from softway.bodies.section import Axisymmetric
from softway.contact.timing import Energy, Paper
from softway.march.ledger import resultant
from softway.march.outcome import Outcome
from softway.march.situation import Situation
from softway.march.standing import Account
from softway.march.step import Certificate, Ledger
from softway.model import Model
from softway.time.weight import EndPeaks
from softway.typing import Array

DEPTH = 1e-12
"""Greatest depth at the end of a slab, relative to the coordinates."""
TENSION = 1e-12
"""Greatest tension, relative to the greatest contact force."""
LOSS = 1e-9
"""Greatest error of the energy balance of one slab under the Energy rule, relative to the energies that take part."""
UNSTABLE = 0.1
"""Growth of the energy in one slab of central differences, relative to the energies that take part, that only a slab
beyond the stability limit has."""
MOMENTUM = 1e-9
"""Greatest error of the momentum balance of one slab, relative to the momenta that take part."""
FORCES = 1e-6
"""The same without inertia, where it is a balance of forces that stiff bodies hold up to the accuracy of places."""
AT_REST = 1e10
"""Energies in units of the rounding of the stored energy below which bodies are at rest: strains of 1e-9."""
BEQUEST = 0.5
"""Share of the error that the momentum balance may have which the slab may leave to the next one."""
PLACES = 16.0 * float(np.finfo(float).eps)
"""Rounding of places, relative to the coordinates, after the sums that make forces of them."""
INTERNAL = 1e-4
"""Share of the impulses of internal forces, which cancel but for rounding, that counts as taking part."""


def certified(
    model: Model, out: Outcome, after: Situation, last: Account, ledger: Ledger, leftover: Array
) -> Certificate:
    """What a solved slab leaves over; ``leftover`` (d,) is that of its :func:`balance`."""
    searched = out.system.searched
    rows = out.rows if searched is None else searched.at(after.start.displacement)
    gap = np.where(rows.near, rows.gap(after.start.displacement), np.inf)
    closed = after.closed & rows.near
    return Certificate(
        min_gap=float(gap.min(initial=np.inf)),
        min_force=float(after.pressure.min(initial=0.0)),
        complementarity=float(np.abs(after.pressure[closed] * gap[closed]).sum()),
        power_residual=float(sum(c.power_residual for c in ledger.contacts.values())),
        momentum_error=float(np.abs(leftover).max()),
        energy_error=ledger.energy_error - last.energy_error,
    )


def violation(
    model: Model,
    before: Situation,
    out: Outcome,
    after: Situation,
    ledger: Ledger,
    found: Certificate,
) -> str | None:
    """The first condition that a certificate violates, in words; None if it holds."""
    kept = (found.min_gap, found.min_force, found.power_residual, found.momentum_error, found.energy_error)
    if np.isnan(kept).any() or not np.isfinite(kept[1:]).all():
        return "a gap, a force or a balance is not a number"
    if found.min_gap < 0.0 and found.min_gap < -DEPTH * _reach(model, after):
        return f"a node ends {-found.min_gap:.3g} m inside its opponent"
    if found.min_force < -TENSION * float(np.abs(after.pressure).max(initial=0.0)):
        return f"contact pulls with {-found.min_force:.3g} N"
    return _energetic(model, before, out, after, ledger, found) or _pushing(model, before, out, after, ledger, found)


def _closes(out: Outcome) -> bool:
    """Whether the slab closes its energy balance."""
    return bool(out.system.model.massive.any()) and (out.system.balanced or out.system.located is not None)


def _ruled(model: Model, out: Outcome) -> bool:
    """Whether the energy balance says whether a slab holds."""
    return isinstance(model.timing, Energy) and out.system.weight == EndPeaks()


def _energetic(
    model: Model, before: Situation, out: Outcome, after: Situation, ledger: Ledger, found: Certificate
) -> str | None:
    """What is wrong with the energy; what takes part is summed up only where a part of it does not suffice already."""
    closes, error = _closes(out), found.energy_error
    error = abs(error) if closes else error
    level = float(np.abs(before.start.energy).sum() + np.abs(after.start.energy).sum()) + ledger.energy_kinetic
    level += abs(ledger.work_external)
    growth, rest = (0.0 if closes else UNSTABLE), AT_REST * float(model.floor.sum())
    if not _ruled(model, out) or error <= (growth + LOSS) * level + rest:
        return None
    level += float(model.kinetic(before.start.velocity).sum())
    moved = np.abs(after.start.displacement - before.start.displacement).max(axis=1)
    if error <= (growth + LOSS) * level + rest + float(np.sum(_blurred(model, after) * moved)):
        return None
    if closes:
        return f"the energy balance is left with {found.energy_error:.3g} J of {level:.3g} J"
    return f"the energy grows by {error:.3g} J of {level:.3g} J: beyond the stability limit"


def _pushing(
    model: Model, before: Situation, out: Outcome, after: Situation, ledger: Ledger, found: Certificate
) -> str | None:
    """What is wrong with the momentum; what takes part is at least the whole momentum."""
    if isinstance(model.timing, Paper):
        return None
    accuracy = MOMENTUM if model.massive.any() else FORCES
    settles = _ruled(model, out) and _closes(out)
    if not settles and found.momentum_error <= accuracy * float(np.abs(ledger.momentum).sum()):
        return None
    scale = _participating(model, before, out, after)
    most = accuracy * scale + float(np.sqrt(2.0 * model.mass.sum() * model.floor.sum()))
    most += (after.time - before.time) * float(_blurred(model, after).sum())
    if found.momentum_error > most:
        return f"the momentum balance is left with {found.momentum_error:.3g} of {scale:.3g} kg m/s"
    unrest = float(np.abs(_unrest(out, after)).max()) if settles else 0.0
    if unrest > BEQUEST * most:
        return f"forces on nodes without inertia leave {unrest:.3g} of {scale:.3g} kg m/s to the next slab"
    return None


def _unrest(out: Outcome, after: Situation) -> Array:
    """Momentum (d,) of forces on nodes without inertia that nothing balances at the end, over such a slab.

    They are there at the start of the next slab, whose iterations cannot take them away.
    """
    model = out.system.model
    force = after.start.force - model.load - out.rows.spread(after.pressure, model.shape)
    if out.rows.shear is not None and after.traction is not None:
        force = force - out.rows.shear.spread(after.traction)
    here = model.free & ~model.massive[:, None]
    return np.asarray(out.system.path.span * np.where(here, force, 0.0).sum(axis=0))


def _blurred(model: Model, after: Situation) -> Array:
    """Forces (n,) [N] on nodes without inertia that are rounding, as places are: they miss their equilibrium by these.

    Bodies that slide to rest lose their energy with the square of the speed, what these forces do with the speed alone.
    """
    share = model.floor / UNSTRAINED**2 / [p.mesh.n_nodes for p in model.parts]
    spring = share[model.part_of] / model.edge**2
    return PLACES * _reach(model, after) * np.where(model.massive, 0.0, spring)


def _reach(model: Model, after: Situation) -> float:
    """The greatest coordinate [m]."""
    return float(np.abs(model.points + after.start.displacement).max())


def balance(model: Model, before: Situation, out: Outcome, after: Situation) -> Array:
    """What the change of momentum (d,) has beyond loads, contact and supports [kg m/s]."""
    keep = np.ones(model.shape[1])
    keep[0] = not any(isinstance(p.internal.section, Axisymmetric) for p in model.parts)
    gained = (model.mass @ np.ones(len(model.massive))) @ (after.start.velocity - before.start.velocity)
    pushed = sum(resultant(part) for part in _given(out))
    return np.asarray((gained - (after.time - before.time) * pushed) * keep)


def _given(out: Outcome) -> tuple[Array, Array, Array]:
    """Mean forces (n, d) of loads, contact and supports [N]."""
    return out.system.model.slab_load(out.solution.end.scalar), out.push, out.support


def _participating(model: Model, before: Situation, out: Outcome, after: Situation) -> float:
    """The momenta that take part in the balance [kg m/s]."""
    own = np.abs(model.mass @ before.start.velocity).sum() + np.abs(model.mass @ after.start.velocity).sum()
    inner = INTERNAL * (after.time - before.time) * (np.abs(before.start.force).sum() + np.abs(after.start.force).sum())
    return float(own + (after.time - before.time) * np.abs(sum(_given(out))).sum() + inner)
