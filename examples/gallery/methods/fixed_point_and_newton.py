"""
Fixed point and Newton's method
===============================

The equations of a slab (time step) are solved by a fixed-point iteration with a factor that is
reused for many slabs, or by Newton's method with a new matrix in each iteration. What do they cost,
and do the results agree?
"""

import time

import matplotlib.pyplot as plt
import numpy as np

import softway as sw

# %%
# A rubber block falls on its corner, rotated by fifteen degrees. The contact, which starts at one
# node, grows, and the rotations are large.

block = sw.Solid(
    mesh=sw.meshes.Rectangle(size=(0.04, 0.03), cells=(12, 9)),
    material=sw.NeoHookean(E=2e6, nu=0.4),
    density=1100.0,
    velocity=sw.bodies.Uniform(value=(0.0, -3.0)),
    place=sw.bodies.Placement(rotations=(sw.bodies.Rotation(angle=np.deg2rad(15.0)),), bottom=1e-4),
)
floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
contact = sw.Contact(between=("block.surface", "floor"), name="floor")
model = sw.build(sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,)))
methods = {"fixed point": sw.FixedPoint(), "Newton": sw.Newton()}
runs, clock = {}, {}
for name, method in methods.items():
    begun = time.perf_counter()
    runs[name] = list(sw.march(model, until=4e-3, step=5e-5, method=method))
    clock[name] = time.perf_counter() - begun

# %%
# Both methods iterate to the same tolerance of the balance, so the motions agree to many digits.
# The fixed point needs more iterations, but each only solves with an existing factor.

for name, steps in runs.items():
    iterations = sum(step.report.iterations for step in steps)
    factors = steps[-1].report.factorisations
    energy = max(abs(step.ledger.energy_error) for step in steps) / steps[0].ledger.energy_kinetic
    print(f"{name:12} {len(steps)} slabs, {iterations} iterations, {factors} factors, ", end="")
    print(f"{clock[name]:.1f} s, energy error {energy:.0e}")
    assert energy < 1e-10
ends = [steps[-1].after.displacement["block"] for steps in runs.values()]
apart = float(np.abs(ends[0] - ends[1]).max() / np.abs(ends[0]).max())
print(f"displacements at the end differ by {apart:.0e} of the greatest")
assert apart < 1e-6

fig, (left, right) = plt.subplots(2, 1, figsize=(9.0, 5.0), layout="constrained", sharex=True)
for name, steps in runs.items():
    t = 1e3 * np.array([step.after.time for step in steps])
    left.step(t, [step.report.iterations for step in steps], where="mid", label=name)
    right.plot(t, [step.ledger.contacts["floor"].force_n / 1e3 for step in steps], label=name)
left.set(ylabel="iterations of a slab", title="Cost")
right.set(ylabel="force [kN/m]", xlabel="time [ms]", title="Result")
left.legend()
