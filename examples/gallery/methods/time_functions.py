"""
Four virtual time functions
===========================

Inside a slab (time step) the velocity is linear in time. The equation of motion holds in the mean,
weighted by a virtual time function. This example compares a constant function (balance of
momentum), a peak in the middle (collocation), and peaks at both ends.
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw
from softway.apps.verify.exact import oscillator
from softway.model.time_weight import moments

# %%
# One element with a fixed end is an oscillator. Its consistent mass is a third of the mass of the
# bar, so its frequency is the square root of 3. The slab is rather long here, half a radian.

OMEGA, SLAB, ROUNDS = np.sqrt(3.0), 0.5 / np.sqrt(3.0), 8
weights = {
    "Momentum()": sw.model.Momentum(),
    "Collocation()": sw.model.Collocation(),
    "EndPeaks()": sw.model.EndPeaks(),
    "EndPeaks(theta=0.6)": sw.model.EndPeaks(theta=0.6),
}


def swung(weight):
    """Times and displacements of the free end."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=1),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        displacement=sw.bodies.OnTag(tag="right", value=1.0),
        supports=(sw.Fixed(on="left"),),
    )
    until = ROUNDS * 2.0 * np.pi / OMEGA
    steps = list(sw.march(sw.Scene(bodies={"bar": bar}), until=until, step=SLAB, weight=weight))
    time = [0.0] + [step.after.time for step in steps]
    return np.array(time), np.array([1.0] + [s.after.displacement["bar"][1, 0] for s in steps])


runs = {name: swung(weight) for name, weight in weights.items()}

# %%
# A slab multiplies (x, h v) by a matrix. Its determinant and trace follow from two moments of the
# time function, and can be computed from any three consecutive displacements. The modulus of its
# eigenvalue is the amplitude growth in a slab, and its angle gives the frequency. Both have a
# closed form.

print(f"{'':20} growth in a slab         frequency / exact")
for name, (time, x) in runs.items():
    matrix = np.column_stack([x[1:-1], -x[:-2]])
    trace, determinant = np.linalg.lstsq(matrix, x[2:])[0]
    z, pair = OMEGA * time[1], moments(weights[name])
    growth = np.sqrt(determinant)
    ratio = np.arccos(0.5 * trace / growth) / z
    print(f"{name:20} {growth:.9f} ({oscillator.radius(pair, z):.9f})", end="")
    print(f"  {ratio:.9f} ({oscillator.frequency(pair, z):.9f})")
    assert abs(growth - oscillator.radius(pair, z)) < 1e-9
    assert abs(ratio - oscillator.frequency(pair, z)) < 1e-9

# %%
# The first three functions preserve the amplitude. Peaks at the ends do so for slabs of any length,
# so they are the default. The weight 0.6 of the later end adds damping.

fig, (above, below) = plt.subplots(2, 1, figsize=(9.0, 5.4), layout="constrained", sharex=True)
fine = np.linspace(0.0, time[-1], 800)
above.plot(fine, np.cos(OMEGA * fine), color="0.8", lw=4, label="exact")
for name, (time, x) in runs.items():
    above.plot(time, x, ".-", lw=1.0, ms=4, label=name)
    below.plot(time, x - np.cos(OMEGA * time), ".-", lw=1.0, ms=4, label=name)
above.set(ylabel="displacement", title="Eight periods of an oscillator")
below.set(ylabel="error", xlabel="time", title="Errors of phase and amplitude")
fig.legend(*above.get_legend_handles_labels(), loc="outside right upper")
