"""Solids in motion on meshes that follow a place, and their balances."""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid, adapted_solid
from softway.adaptivity.balances import spin
from softway.adaptivity.marking.even_surface import even
from softway.adaptivity.transfer import Motion
from softway.arrays import Array
from softway.meshes.adaptive.refinement import refined
from softway.meshes.mesh import Mesh

NONE = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Balances:
    """Momentum, angular momentum about the origin and energy, and the sums of absolute values behind them."""

    momentum: Array
    spin: Array
    energy: float
    momenta: float
    moments: float


def solid(mesh: Mesh, law: object = sw.LinearElastic(E=1.0, nu=0.3), **others: object) -> sw.Solid:
    return sw.Solid(mesh=mesh, material=law, density=1.0, **others)


def on_levels(body: sw.Solid, levels: Array, light: str = "", spread: int = 5) -> AdaptedSolid:
    """Solid on a refinement of its mesh, with massless nodes on a tag, on which no node hangs."""
    fine = even(refined(body.mesh, np.asarray(levels, dtype=np.int64)), [light] if light else [])
    return adapted_solid("body", body, fine, fine.mesh.nodes(light) if light else NONE, spread)


def around(body: sw.Solid, place: Array, deep: int, radius: float = 0.25) -> Array:
    """Levels of the cells of the mesh: ``deep`` around a place, else 1."""
    return np.where(np.linalg.norm(body.mesh.centres() - place, axis=1) < radius, deep, 1)


def moving(on: AdaptedSolid) -> Motion:
    """Body turned far, strained and in a motion that is no rigid one."""
    x = on.points
    d = x.shape[1]
    turn = np.eye(d)
    if d > 1:
        turn[:2, :2] = [[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]]
    strained = x + 0.04 * np.sin(3.0 * x + np.arange(d))
    velocity = 0.2 + 0.1 * np.cos(5.0 * x[:, ::-1] + np.arange(d))
    if d > 1:
        velocity[:, :2] += 0.5 * np.column_stack([-x[:, 1], x[:, 0]])
    free = on.part.dofs
    return Motion(
        displacement=free.nodes(free.unknowns(strained @ turn.T - x)),
        velocity=on.following(free.nodes(free.unknowns(velocity))),
    )


def balances(on: AdaptedSolid, motion: Motion) -> Balances:
    """Balances of a solid in motion."""
    momenta, places = on.mass @ motion.velocity, on.points + motion.displacement
    internal = on.part.internal
    stored = internal.energy(motion.displacement)
    if motion.state is not None:
        stored = internal.stored_force(motion.state, motion.displacement)[0]
    return Balances(
        momentum=momenta.sum(axis=0),
        spin=spin(places, momenta),
        energy=on.kinetic(motion.velocity) + stored,
        momenta=float(abs(momenta).sum()),
        moments=float((np.linalg.norm(places, axis=1) * np.linalg.norm(momenta, axis=1)).sum()),
    )
