"""Patch test: a uniform stress goes through a cohesive tie of meshes that do not match, with its uniform jump."""

import numpy as np
import pytest

import softway as sw
from softway.meshes.cells import CELLS
from softway.meshes.generators.shapes import box, rectangle

E, NU, STIFFNESS = 3.0, 0.3, 7.0
LAME, SHEAR = E * NU / (1.0 + NU) / (1.0 - 2.0 * NU), 0.5 * E / (1.0 + NU)
NORMALS = {"left": (0, -1.0), "right": (0, 1.0), "front": (1, -1.0), "back": (1, 1.0)}
GLUE = sw.BilinearCohesive(strength=1.0, energy=10.0, stiffness=STIFFNESS)


def blocks(cell: str) -> dict[str, sw.Mesh]:
    """Two blocks on each other: the lower one from z = 0 to 1, the upper one from 1 to 1.7."""
    if CELLS[cell].dim == 2:
        below = rectangle((1.0, 1.0), (3, 3), cell=cell)
        above = rectangle((1.0, 0.7), (5, 2), cell=cell, origin=(0.0, 1.0))
    else:
        below = box((1.0, 1.0, 1.0), (2, 2, 2), cell=cell)
        above = box((1.0, 1.0, 0.7), (3, 3, 2), cell=cell, origin=(0.0, 0.0, 1.0))
    return {"below": below, "above": above}


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad8", "quad9", "tri6", "hex8", "tet4", "hex20", "hex27", "tet10"])
def test_a_uniform_stress_is_in_equilibrium(cell: str) -> None:
    """The jump is the traction over the stiffness; no node is pushed, to 1e-12 of the forces."""
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
    tie = sw.Tie(between=("below.top", "above.bottom"), breaks=GLUE)
    model = sw.build(sw.Scene(bodies=solids, ties=(tie,), loads=loads))
    (bond,) = model.bonds
    u = model.points @ gradient.T
    u[model.parts[1].nodes] += stress[dim - 1] / STIFFNESS
    state = bond.at(bond.initial(), u)
    scale = np.abs(model.force(u)).max()
    assert np.abs(model.force(u) + state.force - model.load).max() < 1e-12 * scale
    assert bond.ties[0].jump.area.sum() == pytest.approx(1.0, abs=1e-13)
    assert state.energy.sum() == pytest.approx(0.5 * stress[dim - 1] @ stress[dim - 1] / STIFFNESS, rel=1e-12)


@pytest.mark.parametrize("cell", ["quad4", "tet4", "tri6"])
def test_the_stiffness_is_the_derivative_of_the_force(cell: str) -> None:
    """Central differences of the force at a constant damage, of damaged glue that opens below its greatest opening."""
    solids = {n: sw.Solid(mesh=m, material=sw.LinearElastic(E=E, nu=NU), density=1.0) for n, m in blocks(cell).items()}
    tie = sw.Tie(between=("below.top", "above.bottom"), breaks=GLUE)
    model = sw.build(sw.Scene(bodies=solids, ties=(tie,)))
    random, (bond,) = np.random.default_rng(1), model.bonds
    damage = np.full((len(model.points), 1), 0.8)
    u = random.uniform(-0.01, 0.01, model.shape)
    u[model.parts[1].nodes, -1] += 0.2
    w = random.uniform(-1.0, 1.0, model.shape)
    bond = bond.during(bond.at(damage, u))
    change = 1e-6
    forces = [bond.at(damage, u + sign * change * w).force for sign in (1.0, -1.0)]
    found = bond.tangent_product(u, w)
    np.testing.assert_allclose(found, (forces[0] - forces[1]) / (2.0 * change), atol=1e-7 * np.abs(found).max())
    blocks_ = bond.tangent_blocks(u)
    unit = np.zeros(model.shape)
    node = int(bond.ties[0].jump.node[1])
    unit[node, 0] = 1.0
    np.testing.assert_allclose(blocks_[node, :, 0], bond.tangent_product(u, unit)[node], atol=1e-13)
