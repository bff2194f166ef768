"""
A block slides to rest
======================

A block slides over a floor at 2 m/s. Coulomb friction stops it after v / (mu g) and a distance of
v^2 / (2 mu g), independent of its weight. Both follow from the law alone: nothing is regularised,
and a block at rest does not creep.
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw

SPEED, GRAVITY = 2.0, 9.81


def slid(mu):
    """Slabs (time steps) until the block has been at rest for some time."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(0.2, 0.1), cells=(6, 3)),
        material=sw.LinearElastic(E=1e7, nu=0.3),
        density=1000.0,
        velocity=sw.bodies.Uniform(value=(SPEED, 0.0)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), name="floor", friction=sw.Coulomb(mu=mu))
    scene = sw.Scene(
        bodies={"block": block, "floor": floor},
        contacts=(contact,),
        loads=(sw.Gravity(acceleration=(0.0, -GRAVITY)),),
        start=sw.model.StaticStart(loads=(sw.Gravity(acceleration=(mu * GRAVITY, -GRAVITY)),)),
    )
    return list(sw.march(scene, until=1.25 * SPEED / (mu * GRAVITY), step=0.01))


# %%
# The march starts from the equilibrium of a decelerating block, so that it does not vibrate: the
# static load includes the inertia force.

runs = {mu: slid(mu) for mu in (0.2, 0.3, 0.5)}

# %%
# Distance and time to rest, and the energy dissipated by friction, which is all of the kinetic
# energy.

for mu, steps in runs.items():
    way = float(steps[-1].after.displacement["block"][:, 0].mean())
    exact = SPEED**2 / (2.0 * mu * GRAVITY)
    rest = next(step.after.time for step in steps if step.ledger.momentum[0] < 20.0 * 0.005 * SPEED)
    last = steps[-1].ledger
    share = last.dissipation / (0.5 * 20.0 * SPEED**2)
    print(f"mu = {mu}: way {way:.4f} m ({exact:.4f}), ", end="")
    print(
        f"rest by {rest:.3f} s ({SPEED / (mu * GRAVITY):.3f}), friction took {share:.4f} of the energy"
    )
    assert abs(rest - SPEED / (mu * GRAVITY)) < 0.015
    assert abs(way / exact - 1.0) < 5e-3 and abs(share - 1.0) < 5e-3

# %%
# Speed over time, with the exact lines in grey.

fig, axis = plt.subplots(figsize=(8.0, 4.0), layout="constrained")
for mu, steps in runs.items():
    time = np.array([step.after.time for step in steps])
    axis.plot(time, (SPEED - mu * GRAVITY * time).clip(0.0), color="0.8", lw=5)
    speed = [step.ledger.momentum[0] / 20.0 for step in steps]
    axis.plot(time, speed, lw=1.4, label=f"mu = {mu}")
axis.set(xlabel="time [s]", ylabel="speed [m/s]", title="Down to rest")
axis.legend()
