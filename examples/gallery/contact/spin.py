"""
A ball that begins to spin
==========================

A disc is thrown obliquely at a floor, like a tennis ball at the court. If it slips throughout the
contact, the friction force at every instant is the coefficient times the normal force. The change
of its speed then follows from the normal impulse alone. If the impact is steeper, the disc sticks
for a while. An elastic disc then rebounds along the floor, unlike a rigid one.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import softway as sw
from softway.apps.verify.exact.rigid_impact import collide

MU, DOWN = 0.2, 0.5


def thrown(along):
    """Model and slabs (time steps) of the impact with a speed along the floor."""
    disc = sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=8),
        material=sw.NeoHookean(E=50.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(along, -DOWN)),
        force=sw.bodies.EnergyMomentum(),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -1.01), normal=(0.0, 1.0)))
    friction = sw.Coulomb(mu=MU)
    contact = sw.Contact(between=("disc.surface", "floor"), name="floor", friction=friction)
    model = sw.build(sw.Scene(bodies={"disc": disc, "floor": floor}, contacts=(contact,)))
    return model, list(sw.march(model, until=1.0, step=0.03))


runs = {along: thrown(along) for along in (0.1, 0.25, 0.5, 1.0)}

# %%
# Comparison with a rigid disc after Routh: the velocity of the contact point changes by W times the
# impulse, with W = diag(3, 1)/m. Its restitution is taken from our result.


def rigid(along, restitution):
    """Speed along the floor of a rigid disc after the impact, per unit of mass."""
    found = collide(np.diag([3.0, 1.0]), np.array([along, -DOWN]), mu=MU, restitution=restitution)
    return along + found.impulse[0]


print("speed along the floor:  before  after  (slip throughout)  (rigid)")
for along, (model, steps) in runs.items():
    mass, last = model.mass.sum(), steps[-1].ledger
    normal = sum(step.ledger.contacts["floor"].force_n * step.slab.span for step in steps) / mass
    after, slips = last.momentum[0] / mass, along - MU * normal
    stiff = rigid(along, last.momentum[1] / mass / DOWN)
    print(f"{along:29.2f} {after:7.4f} {slips:17.4f} {stiff:11.4f}")
    if along == 1.0:
        assert abs(after - slips) < 1e-9
    assert abs(last.energy_error) < 1e-12 and after > slips - 1e-9

# %%
# The disc with the flattest impact, with a spoke painted on it, and the final speeds over the
# initial ones. Results below the line of slip are discs that stuck for a while.

fig, (left, right) = plt.subplots(1, 2, figsize=(10.6, 3.6), layout="constrained", width_ratios=(5, 3))
model, steps = runs[1.0]
mesh = model.meshes["disc"]
spoke = np.flatnonzero((np.abs(mesh.points[:, 0]) < 1e-9) & (mesh.points[:, 1] > -1e-9))
for number, step in enumerate((steps[0], steps[14], steps[-1])):
    points = mesh.points + step.after.displacement["disc"]
    points[:, 0] += 2.4 * number - points[:, 0].mean()
    cells = points[mesh.blocks["quad4"]]
    left.add_collection(PolyCollection(cells, facecolors="#dbe9f4", edgecolors="0.5", lw=0.4))
    left.plot(*points[spoke].T, color="#D55E00", lw=3.0)
    left.text(2.4 * number, 1.35, f"t = {step.after.time:.2f}", ha="center")
left.axhline(-1.01, color="0.2", lw=2.0)
left.set(xlim=(-1.2, 6.0), ylim=(-1.1, 1.7), aspect="equal", title="The floor gives it a spin")
left.axis("off")
before = np.array(list(runs))
masses = [model.mass.sum() for model, _ in runs.values()]
after = [s[-1].ledger.momentum[0] / mass for mass, (_, s) in zip(masses, runs.values())]
fine = np.linspace(0.0, 1.0, 100)
right.plot(fine, [rigid(along, 0.95) for along in fine], color="0.6", label="rigid")
right.plot(fine, fine - MU * 0.976, color="0.6", ls="--", label="slip throughout")
right.plot(before, after, "o", label="softway")
right.set(xlabel="speed along the floor before", ylabel="after", title="Speeds", ylim=(-0.02, 0.85))
right.legend()
