"""Scenarios whose nodes are moved a little in the reference configuration."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from softway.bodies.solid import Solid
from softway.meshes.mesh import Mesh
from softway.scenario.scenario import Scenario

Held = Mapping[str, Mapping[str, tuple[int, ...]]]


def jittered(scenario: Scenario, size: float, seed: int, held: Held) -> Scenario:
    """Scenario with the nodes of all solids moved by up to ``size`` cells along each axis of their meshes.

    Parameters
    ----------
    size
        Greatest movement, relative to the shortest edge around a node.
    seed
        Seed of the movements.
    held
        Body -> tag -> components that stay.
    """
    rng = np.random.default_rng(seed)
    bodies = {
        name: replace(body, mesh=_moved(body, size, rng, held.get(name, {}))) if isinstance(body, Solid) else body
        for name, body in scenario.bodies.items()
    }
    return replace(scenario, bodies=bodies)


def _moved(solid: Solid, size: float, rng: np.random.Generator, held: Mapping[str, tuple[int, ...]]) -> Mesh:
    mesh = solid.mesh if isinstance(solid.mesh, Mesh) else solid.mesh.build()
    move = size * mesh.edges()[:, None] * rng.uniform(-1.0, 1.0, mesh.points.shape)
    for tag, components in held.items():
        move[np.ix_(mesh.nodes(tag), components)] = 0.0
    return replace(mesh, points=mesh.points + move)
