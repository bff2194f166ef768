"""Solids that rigid bodies carry: frequencies, balances, light carriers, restarts, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import softway as sw
from softway.marching.march import march
from softway.marching.state.march_state import MarchState
from softway.mechanisms import Hinge, Mechanism, Rigid, Slider, Weld
from softway.obstacles.primitives import Sphere
from softway.record.storage.serialisation import packed, unpacked

AT = np.linspace(0.0, 1.0, 21)
ROD = sw.Solid(
    mesh=sw.meshes.Rectangle(size=(1.0, 0.1), cells=(20, 1)),
    material=sw.LinearElastic(E=10.0, nu=0.0),
    density=10.0,
    section=sw.bodies.PlaneStress(),
    supports=(sw.Fixed(on="left"), sw.bodies.Carried(on="right", by="mass")),
)
"""Rod from x = 0 to 1 with wave speed 1 and mass 1, held at its left and carried at its right."""


@pytest.mark.slow
@pytest.mark.parametrize("mass", [2.0, 0.05], ids=["heavy", "light"])
def test_a_mass_at_the_end_of_a_rod_swings_with_its_frequency(mass):
    omega = brentq(lambda w: w * np.tan(w) - 1.0 / mass, 1e-6, np.pi / 2 - 1e-9)
    mode = sw.bodies.Profile(at=tuple(AT), values=tuple((x, 0.0) for x in np.sin(omega * AT)))
    body = Rigid(mass=mass, centre=(1.1, 0.05), inertia=1.0, velocity=(np.sin(omega), 0.0))
    guide = Slider(between=("ground", "mass"), at=(1.1, 0.05), axis=(1.0, 0.0))
    mechanism = Mechanism(bodies={"mass": body}, joints={"guide": guide})
    scene = sw.Scene(bodies={"rod": replace(ROD, velocity=mode)}, mechanism=mechanism)
    period = 2.0 * np.pi / omega
    steps = list(march(scene, until=1.1 * period, step=0.03))
    t = np.array([s.after.time for s in steps])
    x = np.array([s.after.rigid["mass"].centre[0] - 1.1 for s in steps])
    k = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0) & (t[:-1] > 0.5 * period))[0]
    assert t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k]) == pytest.approx(period, rel=2e-3)
    energy = steps[0].ledger.energy_kinetic + steps[0].ledger.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * energy
    right = ROD.mesh.build().nodes("right")
    moved = steps[-1].after.displacement["rod"][right, 0]
    assert np.abs(moved - x[-1]).max() < 1e-13


def spinning(mass=2.0, joints=None, **hub):
    """Beam that a hub carries, both in the same rotation."""
    beam = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(2.0, 0.2), cells=(16, 2), origin=(0.2, -0.1)),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        supports=(sw.bodies.Carried(on="left", by="hub"),),
        velocity=sw.bodies.Affine(gradient=((0.0, -2.0), (2.0, 0.0))),
    )
    body = Rigid(mass=mass, centre=(0.0, 0.0), inertia=0.1 * mass, spin=2.0, **hub)
    return sw.Scene(bodies={"beam": beam}, mechanism=Mechanism(bodies={"hub": body}, joints=joints or {}))


@pytest.mark.parametrize("mass", [2.0, 0.01], ids=["heavy", "light"])
def test_a_free_hub_with_a_beam_keeps_energy_momentum_and_spin(mass):
    steps = list(march(spinning(mass), until=0.3, step=0.01))
    first = steps[0].ledger
    energy = first.energy_kinetic + first.energy_strain
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * energy
    assert max(float(np.abs(s.ledger.momentum - first.momentum).max()) for s in steps) < 1e-10
    assert np.ptp([s.ledger.spin[2] for s in steps]) < 1e-4 * first.spin[2]


@pytest.mark.few(1)
@pytest.mark.parametrize("mass", [0.01, 0.1, 2.0])
def test_a_carrier_costs_at_most_half_as_many_iterations_again(mass):
    pin = Hinge(between=("ground", "hub"), at=(0.0, 0.0))
    scenes = spinning(1e9, joints={"pin": pin}), spinning(mass)  # the first hub turns as nothing can change it
    held, free = ([s.report.iterations for s in march(scene, until=0.2, step=0.01)] for scene in scenes)
    assert np.mean(free) <= 1.5 * np.mean(held)


@pytest.mark.slow
@pytest.mark.parametrize("mass", [2.0, 0.02], ids=["heavy", "light"])
def test_a_carrier_that_touches_another_solid_keeps_energy_and_momentum(mass):
    ball = {"centre": (2.1, 2.55), "radius": 0.5}
    material = sw.LinearElastic(E=1000.0, nu=0.3)
    block = sw.Solid(mesh=sw.meshes.Rectangle(size=(4.0, 2.0), cells=(12, 6)), material=material, density=1.0)
    tail = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.4, 1.0), cells=(2, 5), origin=(1.9, 2.8)),
        material=sw.NeoHookean(E=500.0, nu=0.3),
        density=1.0,
        supports=(sw.bodies.Carried(on="bottom", by="ball"),),
        velocity=sw.bodies.Affine(value=(0.0, -1.0)),
    )
    body = Rigid(mass=mass, centre=ball["centre"], inertia=0.1 * mass, velocity=(0.0, -1.0), shape=Sphere(**ball))
    scene = sw.Scene(
        bodies={"block": block, "tail": tail},
        contacts=(sw.Contact(between=("block.top", "ball")),),
        mechanism=Mechanism(bodies={"ball": body}),
    )
    steps = list(march(scene, until=0.2, step=0.01))
    first = steps[0].ledger
    assert max(s.ledger.contacts["block.top-ball"].force_n for s in steps) > 0.0
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-10 * first.energy_kinetic
    assert max(float(np.abs(s.ledger.momentum - first.momentum).max()) for s in steps) < 1e-11


def test_a_carrier_welded_to_the_ground_stays():
    still = replace(spinning(), bodies={"beam": replace(spinning().bodies["beam"], velocity=sw.bodies.Uniform())})
    hub, free = (Rigid(mass=1.0, centre=(x, 0.0), inertia=1.0) for x in (0.0, -5.0))
    weld = Weld(between=("ground", "hub"), at=(0.0, 0.0))
    push = sw.Gravity(acceleration=(0.0, -1.0))
    scene = replace(still, mechanism=Mechanism(bodies={"hub": hub, "free": free}, joints={"weld": weld}), loads=(push,))
    last = list(march(scene, until=0.1, step=0.01))[-1].after.displacement["beam"]
    left = scene.bodies["beam"].mesh.build().nodes("left")
    assert np.abs(last[left]).max() < 1e-15 and np.abs(last).max() > 1e-4


@pytest.mark.slow
def test_a_beam_on_a_hinged_hub_turns_about_the_hinge():
    pin = Hinge(between=("ground", "hub"), at=(0.0, 0.0))
    steps = list(march(spinning(joints={"pin": pin}), until=0.5, step=0.01))
    last = steps[-1].after
    assert np.abs(last.rigid["hub"].centre).max() < 1e-14
    turn, place = last.rigid["hub"].rotation, np.array([0.2, -0.1])
    assert last.displacement["beam"][0] + place == pytest.approx(turn @ place, abs=1e-13)


def test_a_march_goes_on_with_the_same_bits_after_a_checkpoint():
    scene = spinning(joints={"pin": Hinge(between=("ground", "hub"), at=(0.0, 0.0))})
    whole = list(march(scene, until=0.2, step=0.01))
    stored = unpacked(*packed(whole[9].march_state))
    assert isinstance(stored, MarchState)
    rest = list(march(scene, until=0.2, step=0.01, state=stored))
    for one, other in zip(whole[10:], rest, strict=True):
        assert (one.after.displacement["beam"] == other.after.displacement["beam"]).all()
        assert (one.after.rigid["hub"].rotation == other.after.rigid["hub"].rotation).all()
        assert one.ledger.energy_error == other.ledger.energy_error


@pytest.mark.slow
def test_a_march_goes_on_from_a_state():
    whole = list(march(spinning(), until=0.2, step=0.01))
    rest = list(march(spinning(), until=0.2, step=0.01, state=whole[9].after))
    one, other = whole[-1].after, rest[-1].after
    assert other.displacement["beam"] == pytest.approx(one.displacement["beam"], abs=1e-8)
    assert other.rigid["hub"].rotation == pytest.approx(one.rigid["hub"].rotation, abs=1e-8)


@pytest.mark.parametrize(
    ("supports", "place", "remedy"),
    [
        ((sw.bodies.Carried(on="left", by="hob"),), "bodies.beam.supports[0].by", "one of ['hub']"),
        ((sw.bodies.Carried(on="rim", by="hub"),), "bodies.beam.supports[0].on", ""),
        (
            (sw.bodies.Carried(on="left", by="hub"), sw.Driven(on="bottom", velocity=1.0)),
            "bodies.beam.supports[1].on",
            "tags without common nodes",
        ),
    ],
    ids=["no such body", "no such tag", "driven twice"],
)
def test_wrong_carriers_are_refused(supports, place, remedy):
    scene = spinning()
    bodies = {"beam": replace(scene.bodies["beam"], supports=supports)}
    with pytest.raises(sw.InputError) as refused:
        march(replace(scene, bodies=bodies), until=0.1, step=0.01)
    assert refused.value.where == place
    assert remedy in refused.value.remedy
