"""Balances of energy and spin over a slab, closed by one scalar and one vector for each group of touching bodies.

The mean force of the end peaks is completed to ``f_mean + a (f1 - f0) + M (b x (x - centre))``; the scalar a closes the
energy balance and, for bodies of the :class:`~softway.bodies.internal_force.slab_average.EnergyMomentum` force, the
vector b the balance of angular momentum (docs/theory/contact/energy.md).
"""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.internal_force.slab_average import EnergyMomentum
from softway.contact.contact_rows import ContactRows
from softway.model.model import Model
from softway.solve.equations.end_forces import EndForces
from softway.solve.equations.friction_work import FrictionWork, friction_work
from softway.solve.equations.missing_work import blurred_work, missing_work, moving_part
from softway.solve.equations.spin_balance import SpinBalance, middle, moment, spin_balance
from softway.tolerances import AT_REST, SUMS

TINY = 1e-10
"""Residual energy, relative to the energy, below which the balance may always be closed along the motion."""
BOUND = 0.5
"""Greatest scalar: with |a| <= 1/2 the mean force stays between those at the two ends."""
WEIGHING = 2.0
"""Greatest scalar without inertia, where it only weights the works at the two ends."""
SLIGHT = 1e-2
"""Residual, relative to the work of the internal forces, that is closed along the motion if the scalar is bounded."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class EnergyClosure:
    """Completed mean force (n, d); for each solid (parts,) the scalar and the relative ``missing_work``; ``bounded`` if
    the scalar alone does not close the balance of a group; ``clipped`` if that balance is left open; and the energy
    ``lost`` by dissipation (parts,) [J].
    """

    mean: Array
    scalar: Array
    missing_work: Array
    clipped: bool
    bounded: bool = False
    lost: Array | float = 0.0


def body_groups(model: Model, *touching: tuple[ContactRows, BoolArray]) -> IntArray:
    """Number (parts,) of the group of each solid; shared unknowns and ``touching`` rows (m,) connect solids.

    Rows with rigid tools do not connect solids.
    """
    label, d = model.linked.copy(), model.shape[1]
    if len(label) == 1:
        return label
    for rows, mask in touching:
        here = mask & ~model.against_tool[rows.contact]
        if not here.any():
            continue
        count = np.diff(rows.gradient.indptr)
        met = model.part_of[rows.gradient.indices[np.repeat(here, count)] // d]
        pairs = np.repeat(model.part_of[rows.node[here]], count[here]) * len(label) + met
        for one, other in zip(*np.divmod(np.unique(pairs), len(label)), strict=True):
            label[label == label[other]] = label[one]
    return np.unique(label, return_inverse=True)[1]


def close_energy(model: Model, ends: EndForces, fallback: bool) -> EnergyClosure:
    """Close the balances of every group, with friction that creates no energy.

    Beyond the bound of the scalar a slight residual is closed along the motion; with ``fallback`` any residual.  Bodies
    that fly without strain have no scalar: their forces are rounding errors.
    """
    touching = (ends.force0 > 0.0) | (ends.force1 > 0.0)
    label = body_groups(model, (ends.rows0, ends.force0 > 0.0), (ends.rows1, ends.force1 > 0.0))
    touched = (np.bincount(label[model.part_of[ends.rows0.node[touching]]], minlength=len(label)) > 0)[label]
    num, den, level, work = missing_work(model, ends, touched)
    num, den, level, work, floor = (_grouped(label, v) for v in (num, den, level, work, model.floor))
    members = [label == g for g in range(len(num))]
    spins = _closed_spins(model, ends, members, (num, den))
    rounding = SUMS * level + floor
    if touching.any():
        rounding = rounding + _grouped(label, blurred_work(model, ends))
    excess, rubbing, damping = np.zeros(len(num)), None, None
    if ends.rows0.shear.count:
        group = label[model.part_of[ends.rows0.node]]
        rubbing = friction_work(ends.tangential, ends.u1 - ends.u0, group, len(members))
        num, den, reset = _without_created_energy((num, den), rounding, rubbing, model.inert)
    strained = _grouped(label, np.abs(ends.V0) + np.abs(ends.V1)) > AT_REST * floor
    if ends.viscous is not None:
        supply = _grouped(label, model.space.totals(ends.viscous * moving_part(model, ends)))
        damping, num = _by_viscous_forces(num, den, supply * np.array([g not in spins for g in range(len(num))]))
    wanted = np.where(strained | (_grouped(label, touched) > 0.0), _quotient(num, den, rounding), 0.0)
    wanted, released = _without_snaps(model, ends, label, wanted, num)
    a = _bounded(wanted, model.inert)
    if rubbing is not None:
        excess = np.where(reset, np.maximum(rubbing.dissipated(a), 0.0), 0.0)
    mean = ends.mean + model.nodal(a[label]) * (ends.f1 - ends.f0) if a.any() else ends.mean.copy()
    if damping is not None and ends.viscous is not None:
        mean += model.nodal(damping[label]) * ends.viscous
    for g, spin in spins.items():
        mean += spin.force(-spin.solve(spin.torque + a[g] * spin.slope))
    missing = np.where(strained, _relative(num, rounding, work), 0.0)
    bounded = a != wanted
    rest = np.where(bounded | (excess > 0.0), num - a * den + excess, 0.0) * model.inert
    great = (np.abs(rest) > np.maximum(SLIGHT * work, TINY * level)) & (not fallback)
    for g in np.flatnonzero(np.where(great, 0.0, rest)).tolist():
        mean += rest[g] * _along_motion(model, ends, moving_part(model, ends), members[g])
    return EnergyClosure(
        mean=mean, scalar=a[label], missing_work=missing[label], lost=released,
        clipped=bool(great.any()), bounded=bool(bounded.any()),
    )  # fmt: skip


def _closed_spins(
    model: Model, ends: EndForces, members: list[BoolArray], balance: tuple[Array, Array]
) -> dict[int, SpinBalance]:
    """Balances of spin by the numbers of their groups; their work joins the energy ``balance`` of these groups."""
    num, den = balance
    spins = {g: spin_balance(model, ends, m) for g, m in enumerate(members) if _closes_spin(model, m)}
    for g, spin in spins.items():
        moving = moving_part(model, ends)
        num[g] += spin.work(moving) @ spin.solve(spin.torque)
        den[g] -= spin.work(moving) @ spin.solve(spin.slope)
    return spins


def _relative(num: Array, rounding: Array, work: Array) -> Array:
    """Missing work (groups,) relative to the ``work``; zero where it is ``rounding``, infinite where it overflows."""
    with np.errstate(over="ignore"):
        return np.where(np.abs(num) > rounding, np.abs(num) / np.maximum(work, 1e-300), 0.0)


def _without_snaps(
    model: Model, ends: EndForces, label: IntArray, wanted: Array, num: Array
) -> tuple[Array, Array | float]:
    """Scalars (groups,), and energy (parts,) that ties release without inertia, when they break at once [J].

    No weight of the two ends accounts for it: there the scalar is zero, and the energy is dissipated.  Less than a
    slight part of the work is an error of the mean force.
    """
    if model.inert or not model.bonds:
        return wanted, 0.0
    bonded = np.zeros(len(num), bool)
    bonded[[label[tie.part] for bond in model.bonds for tie in bond.ties]] = True
    work = np.bincount(label, weights=model.space.totals(np.abs(0.5 * (ends.f0 + ends.f1) * (ends.u1 - ends.u0))))
    snapped = bonded & (np.abs(wanted) > WEIGHING) & (num < -SLIGHT * work)
    released = np.zeros(len(label))
    released[np.unique(label, return_index=True)[1]] = np.where(snapped, -num, 0.0)
    return np.where(snapped, 0.0, wanted), released


def _grouped(label: IntArray, values: Array | BoolArray) -> Array:
    """Sums over the solids (parts,) of each group."""
    return np.asarray(values if len(label) == 1 else np.bincount(label, weights=values), float)


def _by_viscous_forces(num: Array, den: Array, supply: Array) -> tuple[Array, Array]:
    """Factor (groups,) of additional viscous forces, and the missing work (groups,) that they leave to the scalar.

    Both share the work in proportion to the squares of what they can supply.  The forces at the two ends of a damped
    body that flies are nearly the same, and a scalar alone would not be determined.
    """
    factor = np.clip(num * supply / np.maximum(den * den + supply * supply, 1e-300), -BOUND, BOUND)
    return factor, num - factor * supply


def _quotient(num: Array, den: Array, rounding: Array) -> Array:
    """Scalars (groups,) that close the balances: zero where the missing work is ``rounding``, infinite if none does."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(np.abs(num) > rounding, num / den, 0.0)


def _bounded(wanted: Array, inert: bool) -> Array:
    """Scalars (groups,) within their bound; zero where none closes the balance.

    With inertia they fall as ``BOUND**2 / wanted`` beyond it: as the derivative of a balance passes zero, a scalar held
    at its bound would jump to the other one, and no iteration would converge.
    """
    if not inert:
        return np.where(np.isfinite(wanted), np.clip(wanted, -WEIGHING, WEIGHING), 0.0)
    return np.clip(wanted, -BOUND, BOUND) / np.maximum(np.abs(wanted) / BOUND, 1.0)


def _without_created_energy(
    balance: tuple[Array, Array], rounding: Array, rubbing: FrictionWork, inert: bool
) -> tuple[Array, Array, BoolArray]:
    """Missing work and its derivative (groups,), without the work of friction where it would create energy.

    The third array marks these groups: there the dissipated energy is zero, and the scalar closes the balance with it.
    """
    num, den = balance
    if not (rubbing.first.any() or rubbing.last.any()):
        return num, den, np.zeros(len(num), bool)
    created = rubbing.dissipated(_bounded(_quotient(num, den, rounding), inert)) < -rounding
    num = np.where(created, num - rubbing.dissipated(np.zeros(len(num))), num)
    return num, np.where(created, den + rubbing.slope, den), created


def end_force_closure(model: Model, ends: EndForces) -> EnergyClosure:
    """Use the forces at the end for the whole slab, as with a scalar of 1/2, and compute the dissipated energy."""
    du = ends.u1 - ends.u0
    with np.errstate(invalid="ignore"):
        change = np.where(
            ends.force1 > 0.0, ends.force1 * (ends.rows1.normal_component(du) - ends.rows1.tool_motion), 0.0
        )
    gaps = np.bincount(model.part_of[ends.rows1.node], weights=change, minlength=len(model.parts))
    work = model.space.totals(np.where(model.massive[:, None], ends.mean, ends.f1) * du)
    lost = work - gaps - (ends.V1 - ends.V0)
    half = np.full(len(lost), 0.5)
    return EnergyClosure(mean=ends.mean, scalar=half, missing_work=0.0 * half, clipped=False, lost=lost)


def _along_motion(model: Model, ends: EndForces, moving: Array, members: BoolArray) -> Array:
    """Forces (n, d) of unit work along the motion of each body of a group, relative to the mean of its free nodes.

    They have no resultant, and on unsupported bodies no moment.
    """
    space, weight = model.space, np.asarray(model.mass.sum(axis=1)).reshape(-1, 1) * model.free
    out = np.zeros_like(moving)
    for rows in (p.nodes for p, here in zip(model.parts, members, strict=True) if here):
        own = space.among(rows)
        mean = own.sums(weight[rows] * moving[rows]) / np.maximum(own.sums(weight[rows]), 1e-300)
        out[rows] = moving[rows] - mean
    out = model.mass @ (out - model.supported(out))
    if _unsupported(model, members):
        spin = spin_balance(model, ends, members)
        out -= spin.force(spin.solve(moment(space, middle(model, ends, members), out)))
    done = space.total(out * moving)
    return np.asarray(out / done if done > 0.0 else np.zeros_like(out))


def _unsupported(model: Model, members: BoolArray) -> bool:
    """True if no body of a group has supports."""
    return all(
        model.space.every(model.dofs.unsupported[p.nodes]) for p, here in zip(model.parts, members, strict=True) if here
    )


def _closes_spin(model: Model, members: BoolArray) -> bool:
    """True if the balance of spin of a group is closed."""
    forces = [p.average for p, here in zip(model.parts, members, strict=True) if here]
    return all(isinstance(f, EnergyMomentum) for f in forces) and _unsupported(model, members)
