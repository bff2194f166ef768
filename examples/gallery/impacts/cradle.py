"""
Three bars in a row
===================

A bar hits two others at rest. Bars of the same length, stiffness and density transfer all their
momentum: the first stops, the second passes the momentum on to the third. No waves remain, and
every instant is known.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

import softway as sw

# %%
# Length, stiffness and density are 1, so waves cross a bar in the time 1 and contacts last 2. The
# first gap is 0.2. The far end of b moves when the wave arrives at 1.2, with the velocity 1 since
# it is free. The second gap, 0.5, closes at 1.7, before a is released.

STARTS, CELLS = (0.0, 1.2, 2.7), 40
EXACT = {"a-b": (0.2, 2.2), "b-c": (1.7, 3.7)}


def bar(start, velocity):
    """Bar with its initial position and velocity."""
    return sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=CELLS, origin=start),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=velocity),
    )


bodies = {name: bar(start, 1.0 if name == "a" else 0.0) for name, start in zip("abc", STARTS)}
contacts = tuple(
    sw.Contact(between=(f"{one}.right", f"{other}.left"), name=f"{one}-{other}")
    for one, other in ("ab", "bc")
)
scene = sw.Scene(bodies=bodies, contacts=contacts)
steps = list(sw.march(scene, until=5.0))

# %%
# Contact instants, and the final velocities of the three bars, exactly 0, 0 and 1.

for name, exact in EXACT.items():
    found = [e.time for step in steps for e in step.events if e.contact == name]
    print(f"{name}: touch {found[0]:.4f} ({exact[0]}), release {found[-1]:.4f} ({exact[1]})")
    assert np.allclose((found[0], found[-1]), exact, atol=0.04)
means = [float(steps[-1].after.velocity[name].mean()) for name in "abc"]
print("velocities at the end", np.round(means, 4), "(0, 0, 1)")
assert np.allclose(means, (0.0, 0.0, 1.0), atol=0.02)
ledger = steps[-1].ledger
print(f"momentum {ledger.momentum[0]:.12f} (1), energy error {ledger.energy_error:.1e} (0)")
assert abs(ledger.momentum[0] - 1.0) < 1e-10 and abs(ledger.energy_error) < 1e-10

# %%
# Position over time of every fourth node, coloured by velocity. Paths bend at wave fronts. Contacts
# are where the paths of two bars run side by side.

fig, axis = plt.subplots(figsize=(9.0, 5.6), layout="constrained")
time = np.array([step.after.time for step in steps])
for name, start in zip("abc", STARTS):
    place = start + np.linspace(0.0, 1.0, CELLS + 1)
    x = place + np.array([step.after.displacement[name][:, 0] for step in steps])
    v = np.array([step.after.velocity[name][:, 0] for step in steps])
    for node in range(0, CELLS + 1, 4):
        points = np.column_stack([time, x[:, node]])
        pieces = np.stack([points[:-1], points[1:]], axis=1)
        lines = LineCollection(pieces, array=v[1:, node], cmap="viridis", lw=1.6, clim=(0.0, 1.0))
        axis.add_collection(lines)
    axis.text(0.06, start + 0.5, name, va="center", bbox={"color": "white", "pad": 2.0})
axis.set(
    xlim=(0.0, 5.0), ylim=(-0.1, 5.1), xlabel="time", ylabel="position", title="Transfer of momentum"
)
fig.colorbar(lines, ax=axis, label="velocity")
