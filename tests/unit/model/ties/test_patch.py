"""Patch test: a linear field of two tied blocks with irregular meshes that do not match is in equilibrium."""

from itertools import product

import numpy as np
import pytest

import softway as sw
from softway.meshes.cells import CELLS
from softway.meshes.generators.shapes import box, rectangle

E, NU = 3.0, 0.3
LAME, SHEAR = E * NU / (1.0 + NU) / (1.0 - 2.0 * NU), 0.5 * E / (1.0 + NU)
NORMALS = {"left": (0, -1.0), "right": (0, 1.0), "front": (1, -1.0), "back": (1, 1.0)}


def irregular(mesh: sw.Mesh, seed: int) -> sw.Mesh:
    """Mesh of a block whose corners are moved at random, on its sides along them; other nodes stay in the middle."""
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    shift = np.random.default_rng(seed).uniform(-0.12, 0.12, mesh.points.shape) * mesh.edge()
    shift[(mesh.points == low) | (mesh.points == high)] = 0.0
    points = mesh.points + shift
    for name, cells in mesh.blocks.items():
        points[cells] = np.einsum("bk,ekd->ebd", from_corners(name), points[cells[:, : CELLS[name].corners]])
    return sw.Mesh(points=points, blocks=mesh.blocks, tags=mesh.tags)


def from_corners(name: str) -> np.ndarray:
    """Places (b, k) of the nodes of a cell from its corners."""
    cell = CELLS[name]
    x, powers = cell.nodes, product(range(2), repeat=cell.dim)
    simplex = cell.corners == cell.dim + 1
    terms = np.stack([np.prod(x**p, axis=1) for p in powers if not simplex or sum(p) < 2], axis=1)
    return np.asarray(terms @ np.linalg.inv(terms[: cell.corners]))


def blocks(cell: str) -> dict[str, sw.Mesh]:
    """Two blocks on each other: the lower one from z = 0 to 1, the upper one from 1 to 1.7."""
    if CELLS[cell].dim == 2:
        below = rectangle((1.0, 1.0), (3, 3), cell=cell)
        above = rectangle((1.0, 0.7), (5, 2), cell=cell, origin=(0.0, 1.0))
    else:
        below = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell)
        above = box((1.0, 1.0, 0.7), (3, 3, 2), cell=cell, origin=(0.0, 0.0, 1.0))
    return {"below": irregular(below, 1), "above": irregular(above, 2)}


def stretched(cell: str) -> tuple[sw.Scene, np.ndarray]:
    """The blocks with the tractions of a uniform stress, and the gradient (d, d) of the displacement."""
    dim = CELLS[cell].dim
    gradient = np.random.default_rng(3).uniform(-0.01, 0.01, (dim, dim))
    strain = 0.5 * (gradient + gradient.T)
    stress = LAME * np.trace(strain) * np.eye(dim) + 2.0 * SHEAR * strain
    sides = {k: v for k, v in NORMALS.items() if dim == 3 or k in ("left", "right")}
    faces = [(f"{b}.{s}", *n) for b in ("below", "above") for s, n in sides.items()]
    faces += [("below.bottom", dim - 1, -1.0), ("above.top", dim - 1, 1.0)]
    loads = tuple(sw.Traction(on=on, value=tuple(sign * stress[axis])) for on, axis, sign in faces)
    law = sw.LinearElastic(E=E, nu=NU)
    solids = {name: sw.Solid(mesh=mesh, material=law, density=1.0) for name, mesh in blocks(cell).items()}
    return sw.Scene(bodies=solids, ties=(sw.Tie(between=("below.top", "above.bottom")),), loads=loads), gradient


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad8", "quad9", "tri6", "hex8", "tet4", "hex20", "hex27", "tet10"])
def test_a_linear_field_is_in_equilibrium(cell: str) -> None:
    scene, gradient = stretched(cell)
    model = sw.build(scene)
    u = model.points @ gradient.T
    np.testing.assert_allclose(model.dofs.nodes(model.dofs.unknowns(u)), u, atol=1e-12 * np.abs(u).max())
    left = model.dofs.forces(model.force(u) - model.load)
    assert np.abs(left).max() < 1e-9 * np.abs(model.force(u)).max()


@pytest.mark.parametrize("cell", ["quad4", "tet10"])
def test_without_the_tie_it_is_not(cell: str) -> None:
    """The tractions of the glue are those of the uniform stress: single blocks are not in equilibrium."""
    scene, gradient = stretched(cell)
    model = sw.build(sw.Scene(bodies=scene.bodies, loads=scene.loads))
    u = model.points @ gradient.T
    assert np.abs(model.force(u) - model.load).max() > 1e-2 * np.abs(model.force(u)).max()


@pytest.mark.parametrize("inset", [0.5, 1.0, 1.1, 1.5])
@pytest.mark.parametrize("angle", [0.0, 0.7])
def test_a_pane_on_a_part_of_a_surface_follows_it(inset: float, angle: float) -> None:
    """Facets that are covered by half, or to rounding, do not matter: the pane follows a linear field of the plate."""
    place = sw.bodies.Placement(
        rotations=(sw.bodies.Rotation(angle=angle, axis=(1.0, 2.0, 0.0)),), about=(0.0, 0.0, 0.0)
    )
    plate = place.applied(box((5.0, 5.0, 1.0), (5, 5, 1), cell="hex20"))
    size = 5.0 - 2.0 * inset
    pane = place.applied(box((size, size, 0.5), (3, 3, 1), cell="hex20", origin=(inset, inset, 1.0)))
    law = sw.LinearElastic(E=E, nu=NU)
    solids = {name: sw.Solid(mesh=m, material=law, density=1.0) for name, m in (("plate", plate), ("pane", pane))}
    model = sw.build(sw.Scene(bodies=solids, ties=(sw.Tie(between=("plate.top", "pane.bottom")),)))
    u = model.points @ np.random.default_rng(4).normal(size=(3, 3))
    np.testing.assert_allclose(model.dofs.nodes(model.dofs.unknowns(u)), u, atol=1e-12 * np.abs(u).max())
