"""Energies and forces of free strains by kernels: against arrays, and as derivatives of each other."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.arrays import Array
from softway.bodies.conductor import Thermal
from softway.heat.coupled.build import build
from softway.heat.coupled.solid_temperature import temperatures_of
from softway.heat.coupled.strain.expansion import Strained, strained
from softway.kernels.jit import threads
from softway.meshes.generators.shapes import box, rectangle
from softway.meshes.mesh import Mesh

PLANE, SPACE = (1.5, 1.0), (1.5, 1.0, 0.8)
LARGE = sw.NeoHookean(E=1.0, nu=0.3)
PLATE = rectangle(PLANE, (5, 3), cell="quad8")
RING = replace(PLATE, points=PLATE.points + np.array([0.5, 0.0]))
SOLIDS = {
    "quad4": (rectangle(PLANE, (5, 3), cell="quad4"), LARGE, {}),
    "quad8 around an axis": (
        RING, LARGE, {"section": sw.bodies.Axisymmetric()},
    ),
    "tri6, linear theory": (
        rectangle(PLANE, (5, 3), cell="tri6"), sw.LinearElastic(E=1.0, nu=0.3), {},
    ),
    "hex8": (box(SPACE, (3, 2, 3), cell="hex8"), LARGE, {}),
    "hex20": (box(SPACE, (2, 2, 1), cell="hex20"), LARGE, {}),
    "tet10": (box(SPACE, (2, 1, 1), cell="tet10"), LARGE, {}),
}  # fmt: skip


def deformed(mesh: Mesh, material: object, amplitude: float = 0.02, **given: object) -> tuple[Strained, Array]:
    """A solid at a random displacement, and two random free strains (2, n) of its nodes."""
    thermal = Thermal(law=sw.heat.Conduction(conductivity=1.0, capacity=1.0), temperature=300.0, expansion=1e-3)
    body = sw.Solid(mesh=mesh, material=material, density=1.0, thermal=thermal, **given)
    model = build(sw.Scene(bodies={"body": body}))
    ((_, temperature),) = temperatures_of(model.companions)
    rng = np.random.default_rng(7)
    found = strained(temperature.expansions, amplitude * rng.normal(size=model.shape))
    return found, rng.normal(size=(2, model.shape[0]))


def agree(one: Array, other: Array) -> None:
    assert np.abs(one - other).max() <= 1e-14 * np.abs(other).max()


def moved(found: Strained, change: Array) -> Strained:
    """The solid at a displacement that differs by ``change`` (n, d)."""
    return strained(found.expansions, found.own[0] + change)


@pytest.mark.parametrize("name", SOLIDS)
def test_kernels_agree_with_arrays(name: str) -> None:
    mesh, material, given = SOLIDS[name]
    found, free = deformed(mesh, material, **given)
    assert all(it.compiled is not None for it in found.expansions)
    plain = strained(tuple(replace(it, compiled=None) for it in found.expansions), found.own[0])
    dim = found.own[0].shape[1]
    agree(found.held(), plain.held())
    agree(found.forces(free, dim), plain.forces(free, dim))


@pytest.mark.parametrize("name", SOLIDS)
def test_forces_are_derivatives_of_energies(name: str) -> None:
    mesh, material, given = SOLIDS[name]
    found, (free, _) = deformed(mesh, material, **given)
    change = 1e-5 * np.random.default_rng(3).normal(size=found.own[0].shape)
    (force,) = found.forces(free[None], change.shape[1])
    difference = -free @ (moved(found, change).held() - moved(found, -change).held())
    assert 2.0 * (force * change).sum() == pytest.approx(difference, rel=1e-7)


def test_an_inverted_element_has_no_energy() -> None:
    found, free = deformed(*SOLIDS["hex8"][:2], amplitude=2.0)
    assert np.isnan(found.held()).any()
    assert np.isnan(found.forces(free, 3)).any()


def test_a_tiny_strain_keeps_its_digits() -> None:
    found, _ = deformed(*SOLIDS["hex8"][:2], amplitude=0.0)
    x = SOLIDS["hex8"][0].points
    stretch = 1e-12
    held = moved(found, stretch * x).held()
    kappa, volume = 1.0 / (3.0 * (1.0 - 2.0 * 0.3)), float(np.prod(SPACE))
    assert held.sum() == pytest.approx(3.0 * kappa * 3.0 * stretch * volume, rel=1e-10)


def test_regions_have_kernels_of_their_own() -> None:
    mesh = rectangle(PLANE, (6, 4), cell="quad8")
    mesh = mesh.with_region("left", lambda x: x[:, 0] < 0.75).with_region("right", lambda x: x[:, 0] > 0.75)
    found, free = deformed(mesh, {"left": LARGE, "right": sw.NeoHookean(E=2.0, nu=0.2)})
    assert len(found.expansions) == 2 and all(it.compiled is not None for it in found.expansions)
    u = np.zeros((mesh.n_nodes, 2))
    for it, own in zip(found.expansions, found.own, strict=True):
        u[it.nodes] = own
    plain = strained(tuple(replace(it, compiled=None) for it in found.expansions), u)
    agree(found.held(), plain.held())
    agree(found.forces(free, 2), plain.forces(free, 2))


def test_threads_do_not_change_a_bit() -> None:
    found, free = deformed(box(SPACE, (20, 16, 16), cell="hex8"), LARGE, amplitude=0.002)
    with threads.use(1):
        held, forces = found.held(), found.forces(free, 3)
    with threads.use(3):
        assert (found.held() == held).all()
        assert (found.forces(free, 3) == forces).all()
