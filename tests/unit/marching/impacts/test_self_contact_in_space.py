"""A strip in space that is crushed until its folds meet, and bodies of a list that meet, with a check of their own."""

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array, IntArray
from softway.contact.contact import Contact
from softway.meshes import Box


def pierced(x: Array, quads: IntArray) -> float:
    """Greatest distance by which an edge passes through a facet, split about its centre: of its nearer end [m]."""
    pairs = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    edges, deepest = np.unique(np.sort(pairs, axis=1), axis=0), 0.0
    for k in range(4):
        corner = x[quads[:, k]]
        one, two = x[quads[:, (k + 1) % 4]] - corner, x[quads].mean(axis=1) - corner
        normal = np.cross(one, two)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        for a, b in edges:
            apart = ~((quads == a) | (quads == b)).any(axis=1)
            along = x[b] - x[a]
            matrix = np.stack([one, two, np.broadcast_to(-along, one.shape)], axis=2)
            near = apart & (np.abs(np.linalg.det(matrix)) > 0.0)
            u, v, t = np.linalg.solve(matrix[near], (x[a] - corner[near])[..., None])[..., 0].T
            inside = (u > 1e-9) & (v > 1e-9) & (u + v < 1 - 1e-9) & (t > 1e-9) & (t < 1 - 1e-9)
            depth = np.minimum(t, 1.0 - t) * np.abs(normal[near] @ along)
            deepest = max(deepest, float(depth[inside].max(initial=0.0)))
    return deepest


def surface(mesh: sw.Mesh) -> IntArray:
    return np.asarray(mesh.boundary()["quad4"])


@pytest.mark.minutes
def test_the_folds_of_a_crushed_strip_meet_and_part_again() -> None:
    """A column of rubber, 2 x 2 x 30 cells, is driven to a third of its length; its sides meet on 23 slabs or more."""
    plain = Box(size=(0.08, 0.08, 1.0), cells=(2, 2, 30)).build()
    x = np.array(plain.points)
    x[:, 0] += 0.01 * np.sin(np.pi * x[:, 2])
    mesh = sw.Mesh(points=x, blocks=plain.blocks, tags=plain.tags)
    held = (
        sw.Fixed(on="bottom"),
        sw.Driven(on="top", components="z", velocity=-5.0),
        sw.Fixed(on="top", components="xy"),
    )
    strip = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1e6, nu=0.4), density=1000.0, supports=held)
    scene = sw.Scene(bodies={"strip": strip}, contacts=(Contact(between=("strip", "strip")),))
    touching = rejections = 0
    for step in sw.march(scene, until=0.1334, step=2.3e-4):
        touching += step.ledger.contacts["strip-strip"].count > 0
        rejections += len(step.report.rejections)
    assert touching > 23
    assert rejections < 20
    assert abs(step.ledger.energy_error) < 1e-10 * step.ledger.energy_strain
    assert pierced(x + step.after.displacement["strip"], surface(mesh)) == 0.0


@pytest.mark.slow
def test_three_blocks_that_fall_on_each_other_keep_energy_and_no_edge_pierces_a_facet() -> None:
    """The blocks are turned and shifted: edges cross edges, and corners lie on faces.

    The diagonals of warped facets have no rows against each other: this leaves up to a
    fraction of the warp on single slabs.
    """
    bodies, at, offset = {}, {}, 0
    quads, points = [], []
    for k, name in enumerate("abc"):
        plain = Box(size=(0.1, 0.1, 0.1), cells=(3, 3, 3)).build()
        angle = 0.35 * k
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
        x = (np.asarray(plain.points) - 0.05) @ turn.T + [0.02 * k, 0.013 * k, 0.103 * k]
        mesh = sw.Mesh(points=x, blocks=plain.blocks, tags=plain.tags)
        bodies[name] = sw.Solid(
            mesh=mesh,
            material=sw.NeoHookean(E=1e6, nu=0.3),
            density=1000.0,
            velocity=sw.bodies.Uniform(value=(0.0, 0.0, -2.0 * k)),
        )
        quads.append(surface(mesh) + offset)
        points.append(x)
        at[name], offset = offset, offset + len(x)
    scene = sw.Scene(bodies=bodies, contacts=(Contact(between=("a", "b", "c")),))
    most, depths = 0, []
    for step in sw.march(scene, until=0.008, step=4e-4):
        most = max(most, step.ledger.contacts["a-b-c"].count)
        now = np.concatenate([p + step.after.displacement[n] for p, n in zip(points, "abc", strict=True)])
        depths.append(pierced(now, np.concatenate(quads)))
    assert most > 8
    assert np.median(depths) < 1e-15
    assert max(depths) < 1e-3 * 0.1 / 3
    energy = step.ledger.energy_kinetic + step.ledger.energy_strain
    assert abs(step.ledger.energy_error) < 1e-11 * energy
