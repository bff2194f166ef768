"""
A bar thrown at a wall
======================

An elastic bar hits a rigid wall. A wave runs through it and returns from the free end. After the
time 2 L/c it releases the bar from the wall, stress free and with its initial speed. How accurately
do the three contact rules reproduce this?
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw
from softway.apps.verify.exact.thrown import Thrown

# %%
# The exact solution is d'Alembert's. Length, modulus, density and speed are 1, so the wave speed
# and the force on the wall are 1 too.

exact = Thrown(gap=0.3)


def thrown(rule, cells=40):
    """Slabs (time steps) of the march with a contact rule."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=cells),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + exact.gap, normal=-1.0))
    touch = sw.Contact(between=("bar.right", "wall"), timing=rule)
    scene = sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(touch,))
    return list(sw.march(scene, until=3.0))


runs = {
    type(rule).__name__: thrown(rule)
    for rule in (sw.contact.Energy(), sw.contact.Impulse(), sw.contact.Paper())
}

# %%
# All rules find the contact instant inside its slab. They differ in the energy. ``Energy``, the
# default, conserves it up to rounding. The other two lose the energy of the node at the tip, in
# proportion to the cell size.

fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained")
time = np.linspace(0.0, 3.0, 301)
left.plot(time, exact.tip(time), color="0.75", lw=5, label="exact")
for name, steps in runs.items():
    t = [step.after.time for step in steps]
    left.plot(t, [step.after.displacement["bar"][-1, 0] for step in steps], lw=1.2, label=name)
    energy = [step.ledger.energy_kinetic + step.ledger.energy_strain for step in steps]
    right.plot(t, np.array(energy) / exact.energy, lw=1.5, label=name)
left.set(xlabel="time", ylabel="displacement of the tip", title="The tip")
right.set(xlabel="time", ylabel="energy / energy at the start", title="Energy")
left.legend()
right.legend(loc="center right")

# %%
# Instants and energy, compared with the exact values. If a claim of an example were wrong, its
# assertion would fail here, and with it the tests and the build of these pages.

print(f"{'exact':8} touch {exact.touch:.6f}, release {exact.release:.4f}, energy kept {1:.12f}")
for name, steps in runs.items():
    times = [event.time for step in steps for event in step.events]
    last = steps[-1].ledger
    kept = (last.energy_kinetic + last.energy_strain) / exact.energy
    print(f"{name:8} touch {times[0]:.6f}, release {times[-1]:.4f}, energy kept {kept:.12f}")
    assert abs(times[0] - exact.touch) < 1e-9
    assert abs(times[-1] - exact.release) < 0.03
    assert kept < 1.0 + 1e-9
    assert abs(kept - 1.0) < (1e-12 if name == "Energy" else 0.03)
