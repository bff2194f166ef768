"""Energies and momenta of the rigid bodies of a model, and their works over a slab (time step)."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.rigid_motion import rotations
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.rigid.rigid_state import RigidState


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigidBalances:
    """Balances of the rigid bodies after a slab.

    Parameters
    ----------
    kinetic, springs
        Kinetic energy, and energy stored in springs [J].
    work
        Work over the slab of weight, forces, torques and motors, less the work of the rigid bodies on the solids, which
        those count as that of tools [J].
    dissipation
        Energy dissipated by dampers over the slab [J].
    momentum, spin
        Momentum (3,) [kg m/s], and angular momentum (3,) about the origin [kg m^2/s].
    moving, turning
        Sums of the sizes of their parts.
    """

    kinetic: float = 0.0
    springs: float = 0.0
    work: float = 0.0
    dissipation: float = 0.0
    momentum: Array | float = 0.0
    spin: Array | float = 0.0
    moving: float = 0.0
    turning: float = 0.0


def rigid_balances(model: Model, before: ModelState, after: ModelState) -> RigidBalances:
    """Balances after a slab between two states; zero without rigid bodies."""
    rigid, first, last = model.rigid, before.rigid, after.rigid
    if rigid is None or first is None or last is None:
        return RigidBalances()
    now, (momentum, spin) = rigid.energies(last), rigid.momenta(last)
    done, lost = (last.work - first.work).tolist()
    return RigidBalances(
        kinetic=now.kinetic,
        springs=now.springs,
        work=done + rigid.energies(first).weight - now.weight + _from_solids(first, last),
        dissipation=lost,
        momentum=momentum.sum(axis=0),
        spin=spin.sum(axis=0),
        moving=float(np.abs(momentum).sum()),
        turning=float(np.abs(spin).sum()),
    )


def _from_solids(before: RigidState, after: RigidState) -> float:
    """Work of the solids on the rigid bodies over a slab [J]."""
    first, last, given = rotations(before.turn), rotations(after.turn), after.given
    pushed = float((given[:, 0] * (after.place - before.place)[:-1]).sum())
    return pushed + float(np.einsum("nkc,nck->", given[:, 1:], (last - first)[:-1]))
