"""
Two discs, two meshes
=====================

A soft disc hits a stiffer one off-centre. Their meshes do not match at the contact. The mortar
method transmits pressure in the mean over each facet. Momentum and angular momentum that one disc
loses, the other must gain, and no energy may be lost.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import softway as sw

# %%
# ``EnergyMomentum`` is the time average of the internal force that conserves the angular momentum
# of large rotations up to rounding.


def disc(cells, stiffness, centre, velocity):
    """Disc of rubber."""
    return sw.Solid(
        mesh=sw.meshes.Disc(radius=1.0, cells=cells, centre=centre),
        material=sw.NeoHookean(E=stiffness, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=velocity),
        force=sw.bodies.EnergyMomentum(),
    )


soft = disc(12, 10.0, (-1.05, -0.35), (1.0, 0.0))
stiff = disc(8, 40.0, (1.05, 0.35), (0.0, 0.0))
contact = sw.Contact(between=("soft.surface", "stiff.surface"), name="discs")
model = sw.build(sw.Scene(bodies={"soft": soft, "stiff": stiff}, contacts=(contact,)))
steps = list(sw.march(model, until=2.4, step=0.05))

# %%
# Greatest change of the conserved quantities over the whole impact.

first, mass = steps[0].ledger, float(model.mass.sum())
changes = {
    "momentum": max(np.abs(s.ledger.momentum - first.momentum).max() for s in steps),
    "angular momentum": max(abs(s.ledger.spin[2] - first.spin[2]) for s in steps),
    "energy": max(abs(s.ledger.energy_error) for s in steps),
}
for name, change in changes.items():
    print(f"{name:18} changed by {change:.1e} (exact 0)")
    assert change < 1e-10 * mass

# %%
# Each disc alone is deflected from its course, and begins to rotate.

for name in ("soft", "stiff"):
    velocity = model.split(model.mass @ model.join(steps[-1].after.velocity))[name].sum(axis=0)
    print(f"{name:6} leaves with momentum ({velocity[0]:.3f}, {velocity[1]:.3f})")

# %%
# Before contact, at the greatest force, and after; the colour is the greater principal pressure in
# the plane.

force = [step.ledger.contacts["discs"].force_n for step in steps]
shown = [steps[0], steps[int(np.argmax(force))], steps[-1]]
fig, axes = plt.subplots(1, 3, figsize=(11.0, 3.6), layout="constrained", sharey=True)
for axis, step in zip(axes, shown):
    for name, body in model.scene.bodies.items():
        mesh = model.meshes[name]
        points = mesh.points + step.after.displacement[name]
        stress = model.stress(name, step.after.displacement[name])[:, :2, :2]
        pressure = -np.linalg.eigvalsh(stress)[:, 0]
        cells = points[mesh.blocks["quad4"]]
        drawn = PolyCollection(cells, array=pressure, cmap="magma_r", edgecolors="0.4", linewidths=0.4)
        drawn.set_clim(0.0, 4.0)
        axis.add_collection(drawn)
    axis.set(xlim=(-2.2, 3.3), ylim=(-2.0, 2.0), aspect="equal", title=f"t = {step.after.time:.2f}")
    axis.grid(visible=False)
fig.colorbar(drawn, ax=axes, label="pressure", shrink=0.8)
