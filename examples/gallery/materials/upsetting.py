"""
A hot billet is upset
=====================

A cylinder of hot metal is pressed to half of its height. Without friction it stays a cylinder, and
the force of the platen is known in closed form. With friction it becomes a barrel and the force is
larger. Forming is slow: inertia is off, and the length of a slab (time step) is limited only by the
motion of the platen.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import softway as sw
from softway.apps.verify.exact.flow import upsetting

HEIGHT, RADIUS, STROKE, M = 0.75, 1.0, 0.5, 0.3


def pressed(friction):
    """Mesh and slabs of the upper half, with Norton and Hoff's material, K = 1."""
    mesh = sw.meshes.Rectangle(size=(RADIUS, HEIGHT), cells=(8, 6)).build()
    billet = sw.Solid(
        mesh=mesh,
        material=sw.laws.NortonHoff(K=1.0, m=M),
        density=1.0,
        section=sw.bodies.Axisymmetric(),
        dilatation="mean",
        supports=(sw.Fixed(on="bottom", components="y"), sw.Fixed(on="left", components="x")),
    )
    platen = sw.Tool(
        shape=sw.obstacles.HalfSpace(point=(0.0, HEIGHT), normal=(0.0, -1.0)),
        motion=sw.bodies.Translation(velocity=(0.0, -1.0)),
    )
    contacts = (
        sw.Contact(between=("billet.top", "platen"), name="platen", friction=friction),
        sw.Contact(between=("billet.right", "platen"), name="side", friction=friction),
    )
    scene = sw.Scene(
        bodies={"billet": billet, "platen": platen}, contacts=contacts, inertia=sw.bodies.Off()
    )
    return mesh, list(sw.march(scene, until=STROKE * HEIGHT, step=STROKE * HEIGHT / 20))


runs = {
    "no friction": pressed(sw.laws.Frictionless()),
    "much friction": pressed(sw.laws.NortonHoffFriction(alpha=0.5, p=M)),
}

# %%
# The mean force of a slab belongs to the middle of the slab.


def force(steps):
    """Reductions in the middle of the slabs, and forces of the platen."""
    stroke = np.array([0.5 * (s.slab.start + s.slab.end) for s in steps]) / HEIGHT
    return stroke, np.array([sum(c.force_n for c in s.ledger.contacts.values()) for s in steps])


stroke, found = force(runs["no friction"][1])
worst = np.abs(found / upsetting(stroke, M, HEIGHT) - 1.0)[1:].max()
print(f"force without friction differs from the closed form by at most {100 * worst:.3f} %")
assert worst < 2e-3

# %%
# Half sections at the end, with the initial shape in grey: with friction on the left, without on
# the right.

fig, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.9), layout="constrained")
fine = np.linspace(0.0, STROKE, 100)
left.plot(100 * fine, upsetting(fine, M, HEIGHT), color="0.8", lw=5, label="exact, no friction")
for side, (name, (mesh, steps)) in zip((1.0, -1.0), runs.items()):
    stroke, found = force(steps)
    left.plot(100 * stroke, found, label=name)
    points = mesh.points + steps[-1].after.displacement["billet"]
    for mirror in (1.0, -1.0):
        cells = points[mesh.blocks["quad4"]] * (side, mirror)
        right.add_collection(PolyCollection(cells, facecolors="#f2d6b3", edgecolors="0.4", lw=0.5))
left.set(xlabel="reduction [%]", ylabel="force", title="Force of the platen")
left.legend()
right.plot([-1, 1, 1, -1, -1], [-HEIGHT, -HEIGHT, HEIGHT, HEIGHT, -HEIGHT], color="0.6", ls="--")
right.set(xlim=(-1.7, 1.7), ylim=(-0.85, 0.85), aspect="equal", title="A barrel, and a cylinder")
right.grid(visible=False)
