"""A transfer keeps momentum, spin and energy to rounding, and tells what it cannot keep."""

from dataclasses import replace

import numpy as np
import pytest
from turning import around, balances, moving, on_levels, solid

import softway as sw
from softway.adaptivity.adapted_solid import AdaptedSolid
from softway.adaptivity.transfer import Motion, Transferred, transfer
from softway.meshes.adaptive.squares.balanced import BALANCED
from softway.meshes.adaptive.surfaces.surface import ROUND, rounded
from softway.meshes.generators.shapes import ball, box, disc, interval, rectangle
from softway.meshes.mesh import Mesh

ROUNDING = 1e-12
"""Of the sums of absolute values: the bound of the task."""


def kept(before: AdaptedSolid, motion: Motion, after: AdaptedSolid, found: Transferred) -> None:
    """Momentum, spin and energy are the same, all of them."""
    old, new = balances(before, motion), balances(after, found.motion)
    assert new.momentum == pytest.approx(old.momentum, abs=ROUNDING * old.momenta)
    assert new.spin == pytest.approx(old.spin, abs=ROUNDING * old.moments)
    assert new.energy == pytest.approx(old.energy, rel=ROUNDING)
    assert abs(found.booked) <= ROUNDING * old.energy


@pytest.mark.parametrize("light", ["", "bottom"])
@pytest.mark.parametrize(
    ("cell", "law"),
    [
        ("tri3", sw.laws.StVenantKirchhoff(E=1.0, nu=0.3)),
        ("tri3", sw.NeoHookean(E=1.0, nu=0.3)),
        ("quad4", sw.laws.StVenantKirchhoff(E=1.0, nu=0.3)),
        ("quad8", sw.NeoHookean(E=1.0, nu=0.3)),
    ],
)
def test_ten_remeshings_of_a_turning_square(cell: str, law: object, light: str) -> None:
    body = solid(rectangle((1.0, 1.0), (5, 5), cell=cell), law)
    before = on_levels(body, around(body, np.array([0.8, 0.5]), 4), light)
    motion = moving(before)
    for k in range(1, 11):
        place = 0.5 + 0.3 * np.array([np.cos(k), np.sin(k)])
        after = on_levels(body, around(body, place, 4), light)
        found = transfer(before, after, motion)
        kept(before, motion, after, found)
        assert abs(found.scalar - 1.0) < (0.02 if light else 0.002)
        before, motion = after, found.motion


@pytest.mark.parametrize(
    "mesh",
    [disc(1.0, 4, cell="tri3"), disc(1.0, 8, cell="quad4"), ball(1.0, 4, cell="tet4"), ball(1.0, 4, cell="hex8")],
    ids=["tri3", "quad4", "tet4", "hex8"],
)
def test_ten_remeshings_of_a_turning_round_body(mesh: Mesh) -> None:
    body = solid(rounded(mesh, ROUND), sw.NeoHookean(E=1.0, nu=0.3))
    deep, turn = (4 if mesh.dim == 2 else 6), np.zeros((mesh.dim, mesh.dim))
    turn[:2, :2] = [[-1.0, -1.0], [1.0, -1.0]]
    before = on_levels(body, around(body, 0.9 * np.eye(mesh.dim)[0], deep, 0.3))
    motion, mass = moving(before), float(before.mass.sum())
    for k in range(1, 11 if mesh.dim == 2 else 4):
        place = 0.9 * (np.cos(k) * np.eye(mesh.dim)[0] + np.sin(k) * np.eye(mesh.dim)[1])
        after = on_levels(body, around(body, place, deep, 0.3))
        found = transfer(before, after, motion)
        kept(before, motion, after, found)
        assert float(after.mass.sum()) == pytest.approx(mass, rel=ROUNDING)
        assert abs(found.scalar - 1.0) < 0.005
        for field in (found.projection.displacement, found.projection.velocity):
            assert field(before.points @ turn.T) == pytest.approx(after.points @ turn.T, abs=1e-12)
        before, motion = after, found.motion


@pytest.mark.parametrize(
    "mesh",
    [
        interval(1.0, cells=6),
        interval(1.0, cells=4, cell="bar3"),
        rectangle((1.0, 1.0), (3, 3), cell="tri6"),
        disc(1.0, 4, cell="tri6"),
        box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"),
        box((1.0, 1.0, 1.0), (2, 1, 1), cell="tet10"),
        disc(1.0, 4, cell="quad4"),
        disc(1.0, 4, cell="quad9"),
        rectangle((1.0, 1.0), (3, 3), cell="quad8"),
        box((1.0, 1.0, 1.0), (2, 2, 1), cell="hex8"),
        box((1.0, 1.0, 1.0), (2, 1, 1), cell="hex20"),
        box((1.0, 1.0, 1.0), (2, 1, 1), cell="hex27"),
    ],
    ids=lambda mesh: next(iter(mesh.blocks)),
)
def test_all_cells(mesh: Mesh) -> None:
    body = solid(mesh)
    ends = np.array([mesh.points.min(axis=0), mesh.points.max(axis=0)])
    deep = 2 * mesh.dim if next(iter(mesh.blocks)) in BALANCED else 3
    before, after = (on_levels(body, around(body, place, deep, 0.75)) for place in ends)
    assert before.adapted.mesh.n_cells != np.ldexp(mesh.n_cells, deep)
    motion = moving(before)
    found = transfer(before, after, motion)
    kept(before, motion, after, found)


@pytest.mark.parametrize(
    ("mesh", "law"),
    [
        (interval(1.0, cells=6), sw.NeoHookean(E=1.0, nu=0.0)),
        (rectangle((1.0, 1.0), (4, 4), cell="tri3"), sw.NeoHookean(E=1.0, nu=0.3)),
        (rectangle((1.0, 1.0), (3, 3), cell="tri6"), sw.LinearElastic(E=1.0, nu=0.3)),
        (box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"), sw.NeoHookean(E=1.0, nu=0.3)),
        (rectangle((1.0, 1.0), (3, 3), cell="quad9"), sw.LinearElastic(E=1.0, nu=0.3)),
        (rectangle((1.0, 1.0), (3, 3), cell="quad8"), sw.LinearElastic(E=1.0, nu=0.3)),
    ],
    ids=["bar2", "tri3", "tri6", "tet4", "quad9", "quad8"],
)
def test_nothing_changes_on_a_finer_mesh(mesh: Mesh, law: object) -> None:
    body = solid(mesh, law)
    low = mesh.points.min(axis=0)
    before, after = on_levels(body, around(body, low, 2)), on_levels(body, around(body, low, 4, 0.4))
    motion = moving(before)
    found = transfer(before, after, motion)
    old = balances(before, motion)
    assert found.momentum == pytest.approx(np.zeros(mesh.dim), abs=ROUNDING * old.momenta)
    assert found.spin == pytest.approx(np.zeros(3), abs=ROUNDING * old.moments)
    assert abs(found.energy) <= ROUNDING * old.energy
    assert abs(found.scalar - 1.0) <= 1e-9  # the square root of rounding over the energy of the rest
    n = before.adapted.base.n_nodes
    assert found.motion.velocity[:n] == pytest.approx(motion.velocity[:n], abs=1e-11)
    assert found.motion.displacement[:n] == pytest.approx(motion.displacement[:n], abs=1e-11)


def test_defects_of_coarser_meshes_shrink_with_the_cells() -> None:
    body = solid(rectangle((1.0, 1.0), (4, 4), cell="tri3"), sw.NeoHookean(E=1.0, nu=0.3))
    energies = []
    for level in (2, 4, 6):
        fine, coarse = (on_levels(body, np.full(32, k)) for k in (level + 2, level))
        motion = moving(fine)
        found = transfer(fine, coarse, motion)
        energies.append(abs(found.energy) / balances(fine, motion).energy)
    ratios = np.array(energies[:-1]) / np.array(energies[1:])
    assert (ratios > 3.0).all()  # second order: 4


def test_a_body_at_rest_has_the_difference_booked() -> None:
    body = solid(interval(1.0, cells=4))
    fine, coarse = on_levels(body, np.full(4, 4)), on_levels(body, np.full(4, 1))
    x = fine.points
    motion = Motion(displacement=0.01 * np.sin(9.0 * x), velocity=np.zeros_like(x))
    found = transfer(fine, coarse, motion)
    new, old = balances(coarse, found.motion), balances(fine, motion)
    assert found.scalar == 1.0
    assert found.motion.velocity == pytest.approx(np.zeros_like(coarse.points), abs=1e-15)
    assert found.booked == pytest.approx(old.energy - new.energy, abs=1e-15 * old.energy)
    assert found.booked > 0.0


@pytest.mark.parametrize("cell", ["tri3", "tri6", "quad4", "quad8"])
def test_a_coarser_mesh_never_raises_the_energy_of_a_linear_body(cell: str) -> None:
    body = solid(rectangle((1.0, 1.0), (4, 4), cell=cell))
    cells = body.mesh.n_cells
    fine, coarse = on_levels(body, np.full(cells, 4)), on_levels(body, 2 * (np.arange(cells) % 2))
    rng = np.random.default_rng(0)
    for _ in range(4):
        motion = Motion(displacement=0.01 * rng.normal(size=fine.points.shape), velocity=0.0 * fine.points)
        assert transfer(fine, coarse, motion).booked > 0.0


def test_a_rough_motion_on_a_coarse_mesh_is_booked() -> None:
    body = solid(interval(1.0, cells=4))
    fine, coarse = on_levels(body, np.full(4, 4)), on_levels(body, np.full(4, 1))
    motion = Motion(displacement=0.0 * fine.points, velocity=np.cos(40.0 * fine.points))
    found = transfer(fine, coarse, motion)
    old, new = balances(fine, motion), balances(coarse, found.motion)
    assert found.scalar == 1.0
    assert found.booked == pytest.approx(old.energy - new.energy, rel=1e-12)
    assert found.booked > 0.5 * old.energy
    assert new.momentum == pytest.approx(old.momentum, abs=ROUNDING * old.momenta)


def test_supports_hold_and_the_free_translation_is_kept() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3")
    body = solid(mesh, sw.NeoHookean(E=1.0, nu=0.3), supports=(sw.Fixed(on="bottom", components="y"),))
    before, after = (on_levels(body, around(body, np.array(p), 5), "top") for p in ((0.2, 0.2), (0.8, 0.6)))
    motion = replace(moving(before), displacement=0.05 * before.points[:, ::-1] * before.points[:, 1:])
    found = transfer(before, after, motion)
    old, new = balances(before, motion), balances(after, found.motion)
    low = after.adapted.mesh.nodes("bottom")
    assert not found.motion.velocity[low, 1].any()
    assert not found.motion.displacement[low, 1].any()
    assert new.momentum[0] == pytest.approx(old.momentum[0], abs=ROUNDING * old.momenta)
    assert new.energy == pytest.approx(old.energy, rel=ROUNDING)


def test_the_moment_about_a_pin_is_kept() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3").with_tag("pin", lambda x: (x == 0.0).all(axis=1))
    body = solid(mesh, sw.NeoHookean(E=1.0, nu=0.3), supports=(sw.Fixed(on="pin"),))
    before, after = (on_levels(body, around(body, np.array(p), 5)) for p in ((0.2, 0.2), (0.8, 0.6)))
    motion = moving(before)
    found = transfer(before, after, motion)
    old, new = balances(before, motion), balances(after, found.motion)
    assert new.spin == pytest.approx(old.spin, abs=ROUNDING * old.moments)  # about the pin, the origin
    assert new.energy == pytest.approx(old.energy, rel=ROUNDING)


def test_driven_nodes_keep_their_speed() -> None:
    body = solid(interval(1.0, cells=4), supports=(sw.Driven(on="left", velocity=(0.3,)),))
    before, after = on_levels(body, np.array([3, 1, 1, 1])), on_levels(body, np.array([1, 1, 3, 1]))
    x = before.points
    motion = Motion(displacement=0.02 * np.sin(4.0 * x), velocity=0.3 * np.cos(x) + 0.2 * np.sin(9.0 * x))
    found = transfer(before, after, motion)
    assert found.motion.velocity[0, 0] == 0.3  # as given
    assert balances(after, found.motion).energy == pytest.approx(balances(before, motion).energy, rel=ROUNDING)
    assert found.scalar != 1.0


def test_a_body_of_revolution_keeps_its_axial_momentum() -> None:
    mesh = rectangle((1.0, 1.0), (4, 4), cell="tri3")
    supports = (sw.Fixed(on="left", components="x"),)
    body = solid(mesh, section=sw.bodies.Axisymmetric(), supports=supports)
    before, after = (on_levels(body, around(body, np.array(p), 4)) for p in ((0.2, 0.2), (0.8, 0.6)))
    x = before.points
    motion = Motion(displacement=0.02 * np.sin(3.0 * x) * x[:, :1], velocity=np.cos(3.0 * x) * x[:, :1] + [0.0, 0.5])
    found = transfer(before, after, motion)
    old, new = balances(before, motion), balances(after, found.motion)
    assert new.momentum[1] == pytest.approx(old.momentum[1], abs=ROUNDING * old.momenta)
    assert new.energy == pytest.approx(old.energy, rel=ROUNDING)


def test_massless_nodes_move_as_the_nodes_behind_them() -> None:
    body = solid(interval(1.0, cells=8))
    before, after = on_levels(body, np.full(8, 1), "right"), on_levels(body, np.array([0] * 6 + [3, 3]), "right")
    x, end = before.points, before.adapted.mesh.nodes("right")
    velocity = np.ones_like(x)
    velocity[end] = 50.0  # the speed of a massless node means nothing
    found = transfer(before, after, Motion(displacement=0.0 * x, velocity=velocity))
    assert found.motion.velocity == pytest.approx(np.ones_like(after.points), abs=1e-13)
    assert found.momentum == pytest.approx([0.0], abs=1e-13)


def test_a_bar_in_space_has_no_spin_about_itself() -> None:
    body = solid(interval(1.0, cells=4, direction=(1.0, 0.0, 0.0)))
    before, after = on_levels(body, np.array([2, 1, 1, 1])), on_levels(body, np.array([0, 1, 1, 2]))
    x = before.points
    velocity = np.cos(3.0 * x[:, :1] + np.arange(3)) + 0.1
    motion = Motion(displacement=0.01 * np.sin(3.0 * x), velocity=velocity)
    kept(before, motion, after, transfer(before, after, motion))
