"""
A hundred bounces
=================

An elastic bar bounces between two walls. This test reveals schemes that lose or gain a little
energy at each contact.
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw

# %%
# Length, stiffness, density and speed are 1. A contact lasts 2 and the free flight 0.1, so a
# hundred bounces take the time 210. Four elements and slabs (time steps) of 0.25 are coarse. Waves
# remain in the bar, but the energy must still be conserved.

BOUNCES, GAP = 100, 0.1


def bounced(rule, bounces):
    """Relative energy after each slab, contacts so far, and displacement of the middle."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=4),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
    )
    bodies = {
        "bar": bar,
        "right": sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + 0.5 * GAP, normal=-1.0)),
        "left": sw.Tool(shape=sw.obstacles.HalfSpace(point=-0.5 * GAP, normal=1.0)),
    }
    contacts = tuple(
        sw.Contact(between=(f"bar.{side}", side), timing=rule) for side in ("left", "right")
    )
    energy, touches, rows = 1.0, 0, [(0.0, 1.0, 0, 0.0)]
    for step in sw.march(sw.Scene(bodies=bodies, contacts=contacts), until=2.1 * bounces, step=0.25):
        energy = (step.ledger.energy_kinetic + step.ledger.energy_strain) / 0.5
        touches += sum(event.kind == "touch" for event in step.events)
        rows.append((step.after.time, energy, touches, step.after.displacement["bar"].mean()))
    return np.array(rows).T


runs = {
    "Energy": bounced(sw.contact.Energy(), BOUNCES),
    "Impulse": bounced(sw.contact.Impulse(), 10),
    "Paper": bounced(sw.contact.Paper(), 10),
}

# %%
# The default rule conserves the energy up to rounding. With the other rules the node in contact
# loses its kinetic energy at once.

time, energy, touches, middle = runs["Energy"]
drift = np.abs(energy - 1.0).max()
print(
    f"Energy: {touches[-1]:.0f} touches, energy changed by {drift:.1e} of that at the start (exact 0)"
)
for name in ("Impulse", "Paper"):
    print(f"{name}: {runs[name][2][-1]:.0f} touches leave {runs[name][1][-1]:.3f} of the energy")
assert drift < 1e-11 and touches[-1] >= BOUNCES - 10

fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained")
for name, (time, energy, touches, middle) in runs.items():
    right.plot(time / 2.1, energy, label=name)
time, _, _, middle = runs["Energy"]
left.plot(time / 2.1, middle, lw=1.0)
left.set(xlabel="time / 2.1", ylabel="displacement of the middle", title="A hundred bounces")
right.set(
    xlabel="time / 2.1", ylabel="energy / energy at the start", title="The energy", ylim=(0.0, 1.1)
)
right.legend()
