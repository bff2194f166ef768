"""
A wavy tool
===========

A tool can have any shape with a known signed distance function. Here a rigid wave is pressed into
an elastic block, first with its crests, then with more and more of its surface. Westergaard (1939)
gives the contact area at a mean pressure, and the distribution of the pressure.
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw
from softway.apps.verify.exact.contact import contact_modulus
from softway.meshes.generators.graded import geometric
from softway.meshes.generators.recipes import Grid

LENGTH, HEIGHT, YOUNGS, POISSON = 1.0, 0.002, 1.0, 0.3
FULL = np.pi * contact_modulus(YOUNGS, POISSON) * HEIGHT / LENGTH

# %%
# The wave y = 1 - h cos(2 pi x) is above the block, with a crest pointing down in the middle. It is
# so flat that the distance is the vertical distance divided by the length of the slope vector.


def distance(places):
    """Signed distance, positive below the wave."""
    x, y = 2.0 * np.pi * places[:, 0] / LENGTH, places[:, 1]
    slope = 2.0 * np.pi * HEIGHT / LENGTH * np.sin(x)
    return (LENGTH + HEIGHT * (1.0 - np.cos(x)) - y) / np.hypot(1.0, slope)


# %%
# One wave length of the block, which cannot expand sideways because of its neighbours. The wave
# moves down without inertia. The contact conditions hold for the position of the tool at the end of
# each slab (time step).

depth = geometric(0.0, LENGTH, 16, 1.0 / 8.0)
block = sw.Solid(
    mesh=Grid(x=tuple(np.linspace(-0.5, 0.5, 81)), y=depth),
    material=sw.LinearElastic(E=YOUNGS, nu=POISSON),
    density=1.0,
    section=sw.bodies.PlaneStrain(),
    supports=(
        sw.Fixed(on="bottom", components="y"),
        sw.Fixed(on="left", components="x"),
        sw.Fixed(on="right", components="x"),
    ),
)
wave = sw.Tool(
    shape=sw.obstacles.SignedDistance(function=distance, dim=2),
    motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
)
touch = sw.Contact(between=("block.top", "wave"), name="wave")
scene = sw.Scene(bodies={"block": block, "wave": wave}, contacts=(touch,), inertia=sw.bodies.Off())
model = sw.build(scene)
steps = list(sw.march(model, until=0.008, step=0.0005))

# %%
# The half width a of the contact follows from the mean pressure, sin^2(pi a/l) = p / p_full.

mesh = model.meshes["block"]
x = np.sort(mesh.points[mesh.nodes("top"), 0])
order = np.argsort(mesh.points[mesh.nodes("top"), 0])
length = np.full(len(x), x[1] - x[0])
length[[0, -1]] *= 0.5


def westergaard(place, mean):
    """Pressure under a wave at a given mean pressure."""
    share = mean / FULL
    root = np.sqrt(np.maximum(share - np.sin(np.pi * place / LENGTH) ** 2, 0.0))
    return 2.0 * mean / share * np.cos(np.pi * place / LENGTH) * root


fig, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.9), layout="constrained")
means, widths = [], []
for number, step in enumerate(steps):
    force = step.after.pressure["wave"][order]
    mean = force.sum() / LENGTH
    means.append(mean)
    widths.append(length[force > 0.0].sum())
    if number in (3, 7, 11):
        fine = np.linspace(-0.5, 0.5, 400)
        left.plot(fine, westergaard(fine, mean) / FULL, color="0.8", lw=4)
        left.plot(x, force / length / FULL, ".-", ms=3, lw=0.8, label=f"p = {mean / FULL:.2f} p_full")
        worst = np.abs(force / length - westergaard(x, mean)).max() / westergaard(0.0, mean)
        print(f"p = {mean / FULL:.3f} p_full: pressure differs by {100 * worst:.1f} % of the greatest")
        assert worst < 0.06
left.set(xlabel="x / l", ylabel="pressure / p_full", title="Dots are nodes, grey is Westergaard")
left.legend()
share = np.linspace(0.0, 1.0, 100)
right.plot(share, 2.0 / np.pi * np.arcsin(np.sqrt(share)), color="0.8", lw=4, label="exact")
right.plot(np.array(means) / FULL, widths, ".-", label="nodes that touch")
right.set(
    xlabel="mean pressure / p_full", ylabel="share of the surface in contact", title="Contact grows"
)
right.set(xlim=(0.0, 1.2), ylim=(0.0, 1.05))
right.legend()
