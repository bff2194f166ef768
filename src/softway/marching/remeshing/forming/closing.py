"""Balances of a change of meshes, closed when the massless nodes are in equilibrium."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from softway.adaptivity.unrelated.motion import HeavySolid, balanced_on
from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.marching.remeshing.forming.formed_scene import FormedScene
from softway.marching.state.model_state import ModelState
from softway.model.model import Model


def heavy(model: Model, part: DiscreteSolid) -> HeavySolid:
    """A solid with its inertia in a model."""
    mass, follow = (matrix[part.nodes][:, part.nodes] for matrix in (model.mass, model.follow))
    return HeavySolid(part=part, mass=mass, follow=follow)


def dissipated(model: Model, state: ModelState) -> Array:
    """Energy (parts,) that the materials have dissipated since the start of the march [J]."""
    states = state.start.states or tuple(part.internal.state for part in model.parts)
    return np.array([part.internal.dissipated_energy(one) for part, one in zip(model.parts, states, strict=True)])


def closed(
    old: FormedScene, new: FormedScene, before: ModelState, found: ModelState, lost: Array, changed: Sequence[str]
) -> tuple[ModelState, Array]:
    """State on new meshes with the momentum, spin and energy before, and what the change has taken of the energy of
    each solid (parts,) [J].

    The velocities of the solids that have ``changed`` get what equilibrium has released of the stored energies, those
    of solids that keep their meshes as well: in proportion to their kinetic energies.

    Parameters
    ----------
    old, new
        The scene on both meshes.
    before, found
        The state on the old meshes, and that on the new ones with projected velocities.
    lost
        (parts,) energy that the materials have dissipated in the change [J].
    changed
        Solids with new meshes.
    """
    names, velocity = [part.name for part in new.model.parts], found.start.velocity.copy()
    kinetic, stored = old.model.kinetic(before.start.velocity), found.start.energy
    released = before.start.energy - stored - lost
    moved = np.isin(names, changed)
    total = float(kinetic[moved].sum())
    aims = kinetic + released
    if total > 0.0:
        aims = np.where(moved, aims + kinetic / total * float(released[~moved].sum()), kinetic)
    for name in changed:
        pair = heavy(old.model, old.part(name)), heavy(new.model, new.part(name))
        was, here = old.part(name).nodes, new.part(name).nodes
        both = before.start.velocity[was], velocity[here]
        aim = float(aims[names.index(name)])
        velocity[here] = balanced_on(*pair, before.start.displacement[was], both, aim)
    taken = np.asarray(aims - new.model.kinetic(velocity))
    return replace(found, start=replace(found.start, velocity=velocity)), taken
