"""
A steel ball meets a plane
==========================

A ball of 10 mm radius hits a rigid plane at 1 m/s. In Hertz's theory the ball is a mass on the
static contact spring of a half-space. The contact lasts 52 microseconds, which is long compared
with the time of a wave through the ball, and the force reaches 2.3 kN.
"""

from math import pi

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import softway as sw
from softway.apps.verify.exact.contact import Impact, contact_modulus
from softway.meshes.generators.recipes import GradedDisc

RADIUS, DENSITY, YOUNGS, POISSON, SPEED = 0.01, 7850.0, 210e9, 0.3, 1.0
hertz = Impact(
    mass=4.0 / 3.0 * pi * RADIUS**3 * DENSITY,
    speed=SPEED,
    stiffness=4.0 / 3.0 * contact_modulus(YOUNGS, POISSON) * RADIUS**0.5,
)

# %%
# The ball is axisymmetric: the mesh is half a disc, with small cells at the contact. The largest
# contact radius is the square root of R times the approach, 0.4 mm, and spans five cells.

width = (RADIUS * hertz.approach) ** 0.5
mesh = GradedDisc(radius=RADIUS, focus=1.4 * width, cells=7, part="right").build()
ball = sw.Solid(
    mesh=mesh,
    material=sw.LinearElastic(E=YOUNGS, nu=POISSON),
    density=DENSITY,
    section=sw.bodies.Axisymmetric(),
    velocity=sw.bodies.Uniform(value=(0.0, -SPEED)),
    supports=(sw.Fixed(on="axis", components="x"),),
)
plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -RADIUS), normal=(0.0, 1.0)))
touch = sw.Contact(between=("ball.focus", "plane"), name="plane")
model = sw.build(sw.Scene(bodies={"ball": ball, "plane": plane}, contacts=(touch,)))
steps = list(sw.march(model, until=1.1 * hertz.duration, step=hertz.duration / 30))

# %%
# The ball is slightly stiffer than a half-space, and some energy remains in its vibrations. Both
# effects are a few percent at this speed.

force = np.array([step.ledger.contacts["plane"].force_n for step in steps])
instants = [event.time for step in steps for event in step.events]
back = steps[-1].ledger.momentum[1] / model.mass.sum() / SPEED
found = {
    "greatest force [N]": (force.max(), hertz.force),
    "duration [us]": (1e6 * (max(instants) - min(instants)), 1e6 * hertz.duration),
    "speed after / before": (back, 1.0),
}
for name, (ours, exact) in found.items():
    print(f"{name:22} {ours:9.3f}   Hertz {exact:9.3f}   {100 * (ours / exact - 1):+.1f} %")
    assert abs(ours / exact - 1.0) < 0.04

# %%
# Force over time, and the vertical stress around the contact at the greatest force.

fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.9), layout="constrained")
middle = np.array([0.5 * (step.slab.start + step.slab.end) for step in steps])
left.plot(1e6 * middle, force / 1e3, ".-", label="softway")
left.axhline(hertz.force / 1e3, color="0.5", lw=1.0, ls="--", label="greatest force by Hertz")
left.set(xlabel="time [us]", ylabel="force [kN]", title="Force of the plane")
left.legend()
most = steps[int(np.argmax(force))].after
stress = model.stress("ball", most.displacement["ball"])[:, 1, 1] / 1e9
points = 1e3 * (mesh.points + most.displacement["ball"])
for side in (1.0, -1.0):
    cells = points[mesh.blocks["quad4"]] * (side, 1.0)
    drawn = PolyCollection(cells, array=stress, cmap="magma", edgecolors="0.5", linewidths=0.2)
    right.add_collection(drawn)
right.axhline(-10.0, color="0.2", lw=2.0)
right.set(xlim=(-1.3, 1.3), ylim=(-10.05, -8.4), aspect="equal", xlabel="mm", ylabel="mm")
right.set_title("At the greatest force")
right.grid(visible=False)
fig.colorbar(drawn, ax=right, label="vertical stress [GPa]", shrink=0.8)
