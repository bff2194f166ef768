"""Meshes of all cells that follow waves and contacts: balances, contact forces, a wave from a corner."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest
from adapting import adaptive_march
from passing import begins_as_it_ended

import softway as sw
from softway.adaptivity.adapted_solid import adapted_solid
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.overlay import embedding
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.adaptive.surfaces.surface import rounded
from softway.meshes.generators.shapes import box, disc, rectangle
from softway.meshes.mesh import Mesh
from softway.record.write.history_columns import columns

NONE = np.zeros(0, dtype=np.int64)


def dropped(mesh: Mesh, surface: str, law: object = sw.NeoHookean(E=1.0, nu=0.3)) -> sw.Scene:
    """A body that falls on a floor, which is inclined in space, just above it."""
    up = np.array([0.0, 1.0]) if mesh.dim == 2 else np.array([2.0, 1.0, 2.0]) / 3.0
    low = float((mesh.points @ up).min())
    body = sw.Solid(mesh=mesh, material=law, density=1.0, velocity=sw.bodies.Uniform(value=tuple(-0.1 * up)))
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=tuple((low - 0.005) * up), normal=tuple(up)))
    return sw.Scene(bodies={"body": body, "floor": floor}, contacts=(sw.Contact(between=(f"body.{surface}", "floor")),))


def on_finest(scene: sw.Scene, name: str, levels: int) -> tuple[sw.Scene, AdaptedMesh]:
    """The scene with a solid on the uniform mesh of the finest cells."""
    body = scene.bodies[name]
    fine = refined(rounded(body.mesh), np.full(body.mesh.n_cells, levels))
    return replace(scene, bodies={**scene.bodies, name: replace(body, mesh=fine.mesh)}), fine


def carried(steps: Sequence[sw.Step]) -> None:
    """Each slab begins as the last one ended, and the energy balance of the whole march is exact."""
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        begins_as_it_ended(last, taken)
        energy = last.ledger.energy_kinetic + last.ledger.energy_strain
        assert abs(taken.ledger.energy_error) < 1e-12 * energy


@pytest.mark.parametrize(
    ("mesh", "surface", "levels"),
    [
        (disc(0.5, 4, cell="tri3"), "boundary", 4),
        (disc(0.5, 4, cell="tri6"), "boundary", 3),
        (box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet4"), "bottom", 6),
        (box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet10"), "bottom", 3),
        (disc(0.5, 4, cell="quad4"), "boundary", 4),
        (disc(0.5, 4, cell="quad8"), "boundary", 4),
        (disc(0.5, 4, cell="quad9"), "boundary", 4),
        pytest.param(box((1.0, 1.0, 1.0), (2, 2, 2), cell="hex8"), "bottom", 6, marks=pytest.mark.slow),
        pytest.param(box((0.5, 0.5, 3.0), (1, 1, 6), cell="hex20"), "bottom", 3, marks=pytest.mark.slow),
    ],
    ids=["tri3", "tri6", "tet4", "tet10", "quad4", "quad8", "quad9", "hex8", "hex20"],
)
def test_balances_of_a_body_that_meets_the_floor(mesh: Mesh, surface: str, levels: int) -> None:
    adapt = {"body": Adapt(levels=levels, tolerance=4.0, every=6, contact_cells=1, buffer=1)}
    steps = list(adaptive_march(dropped(mesh, surface), adapt, until=2.4, step=0.06))
    energy = float(steps[0].model.kinetic(steps[0].model.velocity).sum())
    carried(steps)
    last = steps[-1].ledger
    assert last.energy_kinetic + last.energy_strain == pytest.approx(energy, rel=1e-9)
    assert sum(bool(taken.transfers) for taken in steps) > 1
    assert abs(last.remeshing) < 1e-9 * energy
    assert max(c.count for taken in steps for c in taken.ledger.contacts.values()) > 0


def met(cell: str = "tri3") -> sw.Scene:
    """A disc that falls on a block at rest, whose cells are ``cell``."""
    ball = sw.Solid(
        mesh=disc(0.5, 4, cell="tri3"),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, -0.1)),
    )
    block = sw.Solid(
        mesh=rectangle((1.0, 0.5), (6, 3), cell=cell, origin=(-0.5, -1.005)),
        material=sw.LinearElastic(E=2.0, nu=0.3),
        density=2.0,
    )
    contact = sw.Contact(between=("ball.boundary", "block.top"))
    return sw.Scene(bodies={"ball": ball, "block": block}, contacts=(contact,))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cell", "names"),
    [("tri3", ("ball", "block")), ("tri3", ("ball",)), ("quad4", ("ball", "block")), ("quad4", ("ball",))],
)
def test_two_solids_that_collide(cell: str, names: tuple[str, ...]) -> None:
    adapt = {name: Adapt(levels=4, tolerance=2.0, contact_cells=2, buffer=1) for name in names}
    steps = list(adaptive_march(met(cell), adapt, until=2.0, step=0.05))
    first = steps[0].ledger
    energy = first.energy_kinetic + first.energy_strain
    carried(steps)
    for taken in steps:
        assert taken.ledger.momentum == pytest.approx(first.momentum, abs=1e-12 * abs(first.momentum[1]))
    assert sum(bool(taken.transfers) for taken in steps) > 2
    assert max(taken.ledger.contacts["ball.boundary-block.top"].count for taken in steps) > 2
    assert abs(steps[-1].ledger.remeshing) < 1e-9 * energy


def test_the_columns_of_the_history() -> None:
    (step,) = adaptive_march(met(), {"ball": Adapt(levels=1)}, until=0.05, step=0.05)
    energy, nodes = (column for column in columns((), adapts=True) if column not in columns(()))
    assert (energy.name, energy.unit) == ("remeshing", "J")
    assert energy.value(replace(step, ledger=replace(step.ledger, remeshing=0.25))) == 0.25
    assert (nodes.name, nodes.unit) == ("mesh.nodes", "1")
    assert nodes.value(step) == sum(mesh.n_nodes for mesh in step.model.meshes.values())


@dataclass(frozen=True)
class Source:
    """A wave from a short side at a corner of a block, and its errors in the energy norm."""

    levels: int
    step: float
    until: float = 0.5
    cell: str = "tri3"

    @property
    def scene(self) -> sw.Scene:
        """Block of the base mesh, pushed for a short time."""
        mesh = rectangle((1.0, 1.0), (8, 8), cell=self.cell).with_tag(
            "source", lambda x: (x[:, 0] == 0) & (x[:, 1] < 0.13)
        )
        body = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0)
        ramp = sw.bodies.Ramp(times=(0.0, 0.05, 0.1), factors=(0.0, 1.0, 0.0))
        return sw.Scene(bodies={"body": body}, loads=(sw.Traction(on="body.source", value=(1.0, 0.0), ramp=ramp),))

    def uniform(self, levels: int, step: float) -> tuple[AdaptedMesh, sw.Step, int]:
        """Finest mesh, last slab, and sum of the nodes over the slabs."""
        scene, fine = on_finest(self.scene, "body", levels)
        steps = list(sw.march(scene, until=self.until, step=step))
        return fine, steps[-1], len(steps) * fine.mesh.n_nodes

    def adapted(self, adapt: Adapt) -> list[sw.Step]:
        """Slabs on adapted meshes."""
        return list(adaptive_march(self.scene, {"body": adapt}, until=self.until, step=self.step))

    def errors(self, found: Sequence[tuple[AdaptedMesh, sw.Step]]) -> list[float]:
        """Errors relative to the motion on cells of half the size, in half the time."""
        fine, exact, _ = self.uniform(self.levels + 2, self.step / 2)
        on = adapted_solid("body", self.scene.bodies["body"], fine, NONE)
        stiffness = on.part.tangent(np.zeros(fine.mesh.points.shape))

        def energy(u: Array, v: Array) -> float:
            return on.kinetic(v) + 0.5 * float(u.ravel() @ (stiffness @ u.ravel()))

        u, v = exact.after.displacement["body"], exact.after.velocity["body"]
        out = []
        for mesh, last in found:
            into = embedding(mesh, fine)
            apart = (into @ field["body"] for field in (last.after.displacement, last.after.velocity))
            out.append(float(np.sqrt(energy(*(a - b for a, b in zip(apart, (u, v), strict=True))) / energy(u, v))))
        return out


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_a_wave_from_a_corner(cell: str) -> None:
    case = Source(levels=6, step=0.008, cell=cell)
    steps = case.adapted(Adapt(levels=6, tolerance=1.0, every=8, buffer=5))
    fine, last, count = case.uniform(6, case.step)
    adapted, uniform = case.errors([(steps[-1].model.adapted["body"], steps[-1]), (fine, last)])
    assert adapted < 1.03 * uniform
    assert sum(taken.model.shape[0] for taken in steps) < count / 3
    ledger = steps[-1].ledger
    assert ledger.momentum[:2] == pytest.approx([0.05 * 0.125, 0.0], abs=1e-15)
    assert abs(ledger.energy_error) < 1e-14
    carried(steps)


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_the_contact_force_is_that_on_the_finest_mesh(cell: str) -> None:
    """The lower part of the circle may touch: massless nodes in large cells above would spoil the waves."""
    mesh = disc(0.5, 4, cell=cell).with_tag("under", lambda x: (np.hypot(*x.T) > 0.49) & (x[:, 1] < -0.3))
    scene, levels = dropped(mesh, "under"), 6
    adapt = {"body": Adapt(levels=levels, tolerance=0.5)}
    steps = list(adaptive_march(scene, adapt, until=2.8, step=0.04))
    fine = list(sw.march(on_finest(scene, "body", levels)[0], until=2.8, step=0.04))
    one, other = (
        np.array([step.ledger.contacts["body.under-floor"].force_n for step in some]) for some in (steps, fine)
    )
    assert len(one) == len(other)
    assert np.linalg.norm(one - other) < 0.01 * np.linalg.norm(other)
    assert one.sum() == pytest.approx(other.sum(), rel=5e-3)
