"""Rigid bodies, bulk viscosity, and what is refused, where meshes change."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from adapting import adaptive_march
from passing import finest, keeps_its_balances

import softway as sw
from softway.errors import InputError
from softway.mechanisms import Mechanism, Rigid
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.generators.shapes import rectangle
from softway.meshes.mesh import Mesh

ADAPT = Adapt(levels=3, tolerance=1.0, buffer=1, contact_cells=2)
HARDENING = sw.laws.LinearHardening(modulus=0.1)
BLOCK = sw.Solid(
    mesh=rectangle((2.0, 1.0), (4, 2), cell="tri3"), material=sw.NeoHookean(E=10.0, nu=0.3), density=1.0,
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("mu", [0.0, 0.3], ids=["smooth", "rough"])
def test_a_rigid_disc_that_hits_a_solid(mu: float) -> None:
    place = (1.1, 1.52)
    shape = sw.obstacles.Sphere(centre=place, radius=0.5)
    disc = Rigid(mass=1.0, centre=place, inertia=0.1, velocity=(0.1, -0.3), spin=0.2, shape=shape)
    friction = sw.laws.Coulomb(mu=mu) if mu else sw.laws.Frictionless()
    contact = sw.Contact(between=("block.top", "disc"), friction=friction)
    scene = sw.Scene(bodies={"block": BLOCK}, contacts=(contact,), mechanism=Mechanism(bodies={"disc": disc}))
    steps = list(adaptive_march(scene, {"block": ADAPT}, until=1.0, step=0.02))
    ledgers = [taken.ledger for taken in steps]
    energy = ledgers[0].energy_kinetic + ledgers[0].energy_strain
    assert sum(bool(taken.transfers) for taken in steps) >= 3
    assert max(abs(ledger.energy_error) for ledger in ledgers) < 1e-11 * energy
    for ledger in ledgers:
        assert ledger.momentum == pytest.approx(ledgers[0].momentum, abs=1e-12)
    assert max(ledger.contacts["block.top-disc"].count for ledger in ledgers) > 1
    assert (ledgers[-1].dissipation > 1e-4 * energy) == (mu > 0.0)


@pytest.mark.slow
def test_a_shock_with_bulk_viscosity() -> None:
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=10), material=sw.LinearElastic(E=1.0, nu=0.0), density=1.0,
        velocity=sw.bodies.Uniform(value=0.1), shock=sw.bodies.BulkViscosity(),
    )  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.005, normal=-1.0))
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(sw.Contact(between=("bar.right", "wall")),))
    steps = list(adaptive_march(scene, {"bar": Adapt(levels=3)}, until=0.8, step=0.01))
    fine = replace(bar, mesh=sw.meshes.Interval(length=1.0, cells=80))
    *_, exact = sw.march(replace(scene, bodies={"bar": fine, "wall": wall}), until=0.8, step=0.01)
    assert keeps_its_balances(steps) > 3
    assert steps[-1].ledger.dissipation == pytest.approx(exact.ledger.dissipation, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("cell", ["tri3", "quad4"])
@pytest.mark.parametrize(
    "law",
    [sw.NeoHookean(E=1.0, nu=0.3), sw.J2(E=1.0, nu=0.3, yield_stress=0.05, hardening=HARDENING)],
    ids=["elastic", "plastic"],
)
def test_a_beam_without_inertia_bends_as_on_the_finest_mesh(cell: str, law: object) -> None:
    ramp = sw.bodies.Ramp(times=(0.0, 1.0), factors=(0.0, 1.0))
    body = sw.Solid(
        mesh=rectangle((2.0, 1.0), (8, 4), cell=cell), material=law, density=1.0, supports=(sw.Fixed(on="bottom"),)
    )
    load = sw.Traction(on="block.right", value=(0.0, -0.05), ramp=ramp)
    scene = sw.Scene(bodies={"block": body}, loads=(load,), inertia=sw.bodies.Off())
    steps = list(adaptive_march(scene, {"block": replace(ADAPT, levels=4, every=2)}, until=1.0, step=0.1))
    *_, fine = sw.march(finest(scene, 4, "block"), until=1.0, step=0.1)
    *_, base = sw.march(scene, until=1.0, step=0.1)
    assert sum(bool(taken.transfers) for taken in steps) >= 1
    assert steps[-1].model.shape[0] < 0.7 * fine.model.shape[0]
    _in_equilibrium(steps)
    energy = fine.ledger.work_external
    assert abs(steps[-1].ledger.remeshing) < 5e-3 * energy
    assert abs(steps[-1].ledger.work_external - energy) < 0.05 * abs(base.ledger.work_external - energy)


@pytest.mark.parametrize("cell", ["tri3", "quad4"])
def test_a_block_without_inertia_meets_a_round_tool(cell: str) -> None:
    moved = sw.Driven(on="bottom", components="y", velocity=(0.05,)), sw.Fixed(on="bottom", components="x")
    body = sw.Solid(
        mesh=rectangle((2.0, 1.0), (8, 4), cell=cell), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
        supports=moved,
    )  # fmt: skip
    tool = sw.Tool(shape=sw.obstacles.Sphere(centre=(1.0, 2.01), radius=1.0))
    scene = sw.Scene(
        bodies={"block": body, "tool": tool}, contacts=(sw.Contact(between=("block.top", "tool")),),
        inertia=sw.bodies.Off(),
    )  # fmt: skip
    adapt = Adapt(levels=4, tolerance=1.0, buffer=1, every=2, contact_cells=3)
    steps = list(adaptive_march(scene, {"block": adapt}, until=1.0, step=0.1))
    fine, base = (list(sw.march(one, until=1.0, step=0.1)) for one in (finest(scene, 4, "block"), scene))
    assert sum(bool(taken.transfers) for taken in steps) >= 3
    _in_equilibrium(steps)
    forces = [[taken.ledger.contacts["block.top-tool"].force_n for taken in some] for some in (steps, fine, base)]
    assert forces[0] == pytest.approx(forces[1], rel=0.02)
    assert abs(forces[2][-1] - forces[1][-1]) > 5.0 * abs(forces[0][-1] - forces[1][-1])


def _in_equilibrium(steps: Sequence[sw.Step]) -> None:
    """The energy is closed, and each slab begins in equilibrium on its mesh but at its supports."""
    most = max(abs(taken.ledger.work_external) for taken in steps)
    for taken in steps:
        assert abs(taken.ledger.energy_error) < 1e-12 * most
        if taken.transfers:
            start = taken.before
            model, u = taken.model, taken.model.join(start.displacement)
            (state,) = start.memory.values() or (None,)
            internal = model.parts[0].internal
            force = internal.force(u) if state is None else internal.stored_force(state, u)[1]
            pressed = model.loads.at(start.time)
            if start.pressure:
                rows = model.rows(u, start.time)
                pressed = pressed + rows.spread(np.concatenate(list(start.pressure.values())), model.shape)
            left = model.dofs.forces(force - pressed)
            assert abs(left).max() < 1e-9 * abs(force).max() + 1e-15


MIXED = Mesh(
    points=np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0]]),
    blocks={"quad4": np.array([[0, 1, 4, 3]]), "tri3": np.array([[1, 2, 4]])},
)


def test_cells_of_several_types_are_refused() -> None:
    with pytest.raises(InputError) as refusal:
        adaptive_march(sw.Scene(bodies={"block": replace(BLOCK, mesh=MIXED)}), {"block": ADAPT}, until=0.1, step=0.01)
    assert refusal.value.where == "bodies.block.adapt"
    assert refusal.value.remedy


def test_auto_where_nothing_can_adapt_is_a_mesh_that_stays() -> None:
    block = replace(BLOCK, mesh=MIXED, adapt="auto")
    scenario = sw.Scenario(bodies={"block": block}, time=sw.Time(end=0.1, step=0.01))
    checked = sw.check(scenario)
    assert [note.where for note in checked.notes if "mesh stays" in note.problem] == ["bodies.block.adapt"]
    steps = list(sw.march(sw.Scene(bodies={"block": block}), until=0.1, step=0.01))
    assert not steps[-1].model.adapted
    *_, explicit = sw.march(sw.Scene(bodies={"block": replace(BLOCK, adapt="auto")}), until=0.01, method=sw.Explicit())
    assert not explicit.model.adapted


def on_a_floor(timing: object, cell: str, adapt: object) -> sw.Scene:
    """A block above a floor."""
    block = replace(BLOCK, mesh=rectangle((2.0, 1.0), (4, 2), cell=cell), material=sw.LinearElastic(E=1.0), adapt=adapt)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.01), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), timing=timing)
    return sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,))


def test_exact_instants_and_hanging_nodes_do_not_go_together() -> None:
    located = sw.contact.Energy(located=True)
    with pytest.raises(InputError) as refusal:
        sw.march(on_a_floor(located, "quad4", ADAPT), until=0.1, step=0.01)
    assert refusal.value.where == "contacts[0].timing.located"
    *_, stays = sw.march(on_a_floor(located, "quad4", "auto"), until=0.1, step=0.01)
    assert not stays.model.adapted
    *_, triangles = sw.march(on_a_floor(located, "tri3", ADAPT), until=0.1, step=0.01)
    assert triangles.model.adapted


def test_one_solid_stays_and_another_adapts() -> None:
    other = replace(BLOCK, mesh=rectangle((2.0, 1.0), (4, 2), cell="tri3", origin=(5.0, 0.0)), adapt="auto")
    scene = sw.Scene(bodies={"block": replace(BLOCK, mesh=MIXED, adapt="auto"), "other": other})
    *_, last = sw.march(scene, until=0.1, step=0.01)
    assert list(last.model.adapted) == ["other"]
