"""Rigid bodies that hit deformable solids: balances, exact solutions, friction, and the motion of prescribed tools."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.exact.contact import Impact, contact_modulus
from softway.bodies.internal_force.slab_average import EnergyMomentum
from softway.laws.friction import Frictionless
from softway.marching.march import march
from softway.mechanisms import Mechanism, PlaneStop, Rigid, Slider
from softway.meshes.generators.graded import grid
from softway.model.scene import StaticStart
from softway.obstacles.half_space import HalfSpace
from softway.obstacles.primitives import Block, Sphere
from softway.record.storage.serialisation import packed, unpacked

BLOCK = sw.Solid(
    mesh=sw.meshes.Rectangle(size=(12.0, 6.0), cells=(12, 6)), material=sw.LinearElastic(E=1000.0, nu=0.3), density=1.0
)
PLACE = (6.7, 7.05)
DISC = Rigid(
    mass=20.0, centre=PLACE, inertia=10.0, velocity=(0.3, -1.0), spin=3.0, shape=Sphere(centre=PLACE, radius=1)
)


def scene(block=BLOCK, disc=DISC, mu=0.0, **mechanism):
    friction = sw.Coulomb(mu=mu) if mu else Frictionless()
    contact = sw.Contact(between=("block.top", "disc"), friction=friction)
    return sw.Scene(
        bodies={"block": block}, contacts=(contact,), mechanism=Mechanism(bodies={"disc": disc}, **mechanism)
    )


@pytest.mark.slow
@pytest.mark.few(2)
@pytest.mark.parametrize("mass", [20.0, 0.02], ids=["heavy", "lighter than a cell"])
@pytest.mark.parametrize("mu", [0.0, 0.3], ids=["smooth", "rough"])
def test_energy_and_momentum_are_kept_through_an_impact(mass, mu):
    disc = replace(DISC, mass=mass, inertia=0.5 * mass)
    steps = list(march(scene(disc=disc, mu=mu), until=1.5, step=0.02))
    first, last = steps[0].ledger, steps[-1].ledger
    energy = first.energy_kinetic + first.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * energy
    drift = max(float(np.abs(s.ledger.momentum - first.momentum).max()) for s in steps)
    assert drift < 1e-12 * max(mass, 1.0)
    assert {e.kind for s in steps for e in s.events} >= {"touch", "release"}
    assert (last.dissipation > 1e-3 * energy) == (mu > 0.0)
    assert steps[-1].after.rigid["disc"].velocity[1] > 0.0


@pytest.mark.slow
def test_spin_is_kept_by_a_solid_of_large_strain():
    block = replace(BLOCK, material=sw.NeoHookean(E=1000.0, nu=0.3), force=EnergyMomentum())
    drift = []
    for step in (0.02, 0.01):
        spins = [s.ledger.spin[2] for s in march(scene(block=block, mu=0.3), until=0.8, step=step)]
        drift.append(np.ptp(spins) / abs(spins[0]))
    assert drift[0] < 1e-3
    assert drift[1] < 0.6 * drift[0]  # the arms of friction at both ends of a slab differ by the slip


@pytest.mark.slow
def test_a_rigid_mass_hits_an_elastic_rod_as_by_st_venant():
    mass, speed, length, n = 4.0, 0.1, 1.0, 50  # rod: c = 1, rho A = 1; the force decays by exp(-rho A c t / m)
    rod = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(length, 0.02), cells=(n, 1)),
        material=sw.LinearElastic(E=1.0 / 0.02, nu=0.0),
        density=1.0 / 0.02,
        section=sw.bodies.PlaneStress(),
        supports=(sw.Fixed(on="right"),),
    )
    ram = Rigid(mass=mass, centre=(-0.5, 0.01), inertia=1.0, velocity=(speed, 0.0),
                shape=Block(low=(-1.0, -1.0), high=(-0.001, 1.0)))  # fmt: skip
    guide = Slider(between=("ground", "ram"), at=(-0.5, 0.01), axis=(1.0, 0.0))
    contact = sw.Contact(between=("rod.left", "ram"), timing=sw.contact.Energy(spread=1))
    mechanism = Mechanism(bodies={"ram": ram}, joints={"guide": guide})
    steps = list(march(sw.Scene(bodies={"rod": rod}, contacts=(contact,), mechanism=mechanism), until=1.8, step=0.01))
    touch = 0.001 / speed
    for step in steps:
        since = step.after.time - touch
        if 0.3 < since < 1.7:
            exact = speed * np.exp(-since / mass)
            assert step.after.rigid["ram"].velocity[0] == pytest.approx(exact, rel=1e-3)


@pytest.mark.slow
def test_a_rigid_sphere_on_an_elastic_block_touches_for_hertz_s_time():
    radius, density, young, nu, speed = 0.01, 7850.0, 210e9, 0.3, 1.0
    mass = 4.0 / 3.0 * np.pi * radius**3 * density
    hertz = Impact(mass=mass, speed=speed, stiffness=4.0 / 3.0 * contact_modulus(young, nu) * radius**0.5)
    width, gap = (radius * hertz.approach) ** 0.5, 0.02 * hertz.approach
    lines = list(np.linspace(0.0, 2.0 * width, 15))
    while lines[-1] < 200.0 * width:
        lines.append(lines[-1] + 1.3 * (lines[-1] - lines[-2]))
    block = sw.Solid(
        mesh=grid(lines, [-x for x in reversed(lines)]),
        material=sw.LinearElastic(E=young, nu=nu),
        density=density,
        section=sw.bodies.Axisymmetric(),
        supports=(sw.Fixed(on="left", components="x"),),
    )
    place = (0.0, radius + gap)
    ball = Rigid(mass=mass, centre=place, inertia=0.4 * mass * radius**2, velocity=(0.0, -speed),
                 shape=Sphere(centre=place, radius=radius))  # fmt: skip
    axis = Slider(between=("ground", "ball"), at=place, axis=(0.0, 1.0))
    mechanism = Mechanism(bodies={"ball": ball}, joints={"axis": axis})
    contact = sw.Contact(between=("block.top", "ball"))
    found = sw.Scene(bodies={"block": block}, contacts=(contact,), mechanism=mechanism)
    steps = list(march(found, until=gap / speed + 1.3 * hertz.duration, step=hertz.duration / 60))
    instants = [e.time for s in steps for e in s.events]
    assert max(instants) - min(instants) == pytest.approx(hertz.duration, rel=1e-2)
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * 0.5 * mass * speed**2
    momenta = [s.ledger.momentum[1] for s in steps]
    assert np.ptp(momenta) < 1e-12 * mass * speed


@pytest.mark.slow
def test_a_very_heavy_body_moves_the_solid_as_a_tool_does():
    down = (0.0, -1.0)
    disc = replace(DISC, mass=1e9, inertia=1e9, velocity=down, spin=0.0)
    tool = sw.Tool(shape=disc.shape, motion=sw.bodies.Translation(velocity=down))
    fixed = replace(BLOCK, supports=(sw.Fixed(on="bottom"),))
    pushed = list(march(scene(block=fixed, disc=disc), until=0.5, step=0.01))
    driven = sw.Scene(bodies={"block": fixed, "disc": tool}, contacts=scene().contacts)
    for one, other in zip(pushed, march(driven, until=0.5, step=0.01), strict=True):
        u, v = one.after.displacement["block"], other.after.displacement["block"]
        assert np.abs(u - v).max() < 1e-7 * max(np.abs(v).max(), 1e-3)


@pytest.mark.slow
def test_a_box_that_slides_on_an_elastic_layer_is_braked_by_coulomb_s_law():
    layer = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(4.0, 0.5), cells=(16, 2), origin=(-1.0, -0.5)),
        material=sw.LinearElastic(E=2e5, nu=0.3),
        density=1.0,
        supports=(sw.Fixed(on="bottom"),),
    )
    box = Rigid(
        mass=1.0,
        centre=(0.0, 0.05),
        inertia=0.1,
        velocity=(1.0, 0.0),
        shape=Block(low=(-0.6, 0.0), high=(0.6, 0.1)),
    )
    contact = sw.Contact(between=("layer.top", "box"), friction=sw.Coulomb(mu=0.2))
    mechanism = Mechanism(bodies={"box": box}, gravity=(0.0, -9.81))
    sliding = sw.Scene(bodies={"layer": layer}, contacts=(contact,), mechanism=mechanism)
    steps = list(march(sliding, until=0.2, step=4e-3))
    last = steps[-1].after.rigid["box"]
    pressed = 9.81 * 0.2 + last.velocity[1]  # impulse of the normal forces per mass
    assert last.velocity[0] == pytest.approx(1.0 - 0.2 * pressed, rel=1e-3)
    energy = steps[0].ledger.energy_kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * energy


@pytest.mark.slow
@pytest.mark.parametrize(("restitution", "mu"), [(1.0, 0.0), (0.5, 0.2)], ids=["elastic", "rough"])
def test_a_disc_bounces_between_a_solid_and_a_stop_and_goes_on_after_a_checkpoint(restitution, mu):
    ceiling = PlaneStop(between=("ground", "disc"), point=PLACE, plane=(0.0, 8.2), normal=(0.0, -1.0), radius=1.0,
                        restitution=restitution, friction=mu)  # fmt: skip
    fixed = replace(BLOCK, supports=(sw.Fixed(on="bottom"),))
    bouncing = scene(block=fixed, stops={"ceiling": ceiling})
    steps = list(march(bouncing, until=2.0, step=0.02))
    energy = steps[0].ledger.energy_kinetic
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11 * energy
    assert (steps[-1].ledger.dissipation > 0.1) == (restitution < 1.0)
    touches = [e for s in steps for e in s.events if e.contact == "ceiling"]
    assert [e.kind for e in touches][0] == "touch"
    assert touches[0].velocity_after == pytest.approx(-restitution * touches[0].velocity_before, rel=1e-9)
    rest = list(march(bouncing, until=2.0, step=0.02, state=unpacked(*packed(steps[49].march_state))))
    for one, other in zip(steps[50:], rest, strict=True):
        assert (one.after.rigid["disc"].centre == other.after.rigid["disc"].centre).all()
        assert (one.after.displacement["block"] == other.after.displacement["block"]).all()


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"inertia": sw.bodies.Scaled(factor=2.0)}, "inertia"),
        ({"start": StaticStart()}, "start"),
        ({"contacts": (sw.Contact(between=("block.top", "disc"), timing=sw.contact.Impulse()),)}, "contacts[0].timing"),
        ({"mechanism": Mechanism(bodies={"block": DISC})}, "mechanism.bodies.block"),
        ({"mechanism": Mechanism(bodies={"disc": replace(DISC, shape=None)})}, "contacts[0].between"),
    ],
    ids=["inertia", "static", "rule", "names", "surface"],
)
def test_what_does_not_go_with_rigid_bodies_is_refused(change, place):
    with pytest.raises(sw.InputError) as refused:
        list(march(replace(scene(), **change), until=0.1, step=0.01))
    assert refused.value.where == place


def test_central_differences_and_bodies_off_the_axis_are_refused():
    with pytest.raises(sw.InputError, match="Explicit with rigid bodies"):
        march(scene(), until=0.1, step=1e-3, method=sw.Explicit())
    round_ = replace(BLOCK, section=sw.bodies.Axisymmetric())
    with pytest.raises(sw.InputError, match="can leave the axis"):
        march(scene(block=round_), until=0.1, step=0.01)


def test_a_half_space_is_a_surface_of_a_rigid_body():
    plate = Rigid(mass=5.0, centre=(6.0, 7.0), inertia=2.0, velocity=(0.0, -1.0),
                  shape=HalfSpace(point=(6.0, 6.5), normal=(0.0, -1.0)))  # fmt: skip
    steps = list(march(scene(disc=plate), until=1.0, step=0.02))
    assert steps[-1].after.rigid["disc"].velocity[1] > 0.0
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-11
