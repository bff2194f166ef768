"""
Four virtual time functions
===========================

Inside a slab the velocity is linear in time. The equation of motion holds in the mean, weighted by
a virtual time function: what is the difference between a constant one (the theorem of momentum), a
peak in the middle (collocation), and peaks at both ends?
"""

import matplotlib.pyplot as plt
import numpy as np

import softway as sw
from softway.time.weight import moments
from softway.verify.exact import oscillator

# %%
# One element with a fixed end is an oscillator. Its consistent mass is a third of that of the bar,
# so that its frequency is the root of 3. A slab is rather long here, half a radian.

OMEGA, SLAB, ROUNDS = np.sqrt(3.0), 0.5 / np.sqrt(3.0), 8
weights = {
    "Momentum()": sw.Momentum(),
    "Collocation()": sw.Collocation(),
    "EndPeaks()": sw.EndPeaks(),
    "EndPeaks(theta=0.6)": sw.EndPeaks(theta=0.6),
}


def swung(weight):
    """Times and displacements of the free end."""
    bar = sw.Solid(
        mesh=sw.Interval(length=1.0, cells=1),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        displacement=sw.OnTag(tag="right", value=1.0),
        supports=(sw.Fixed(on="left"),),
    )
    until = ROUNDS * 2.0 * np.pi / OMEGA
    steps = list(sw.march(sw.Scene(bodies={"bar": bar}), until=until, step=SLAB, weight=weight))
    time = [0.0] + [step.after.time for step in steps]
    return np.array(time), np.array([1.0] + [s.after.displacement["bar"][1, 0] for s in steps])


runs = {name: swung(weight) for name, weight in weights.items()}

# %%
# A slab multiplies (x, h v) by a matrix. Its determinant and trace follow from two moments of the
# time function, and can be read off any three displacements in a row. The modulus of its eigenvalue
# is the growth of the amplitude in a slab, its angle the frequency: both have a closed form.

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
# The first three keep the amplitude. Peaks at the ends do so for slabs of any length, which is why
# they are the default; the weight 0.6 of the later end damps.

fig, (above, below) = plt.subplots(2, 1, figsize=(9.0, 5.4), layout="constrained", sharex=True)
fine = np.linspace(0.0, time[-1], 800)
above.plot(fine, np.cos(OMEGA * fine), color="0.8", lw=4, label="exact")
for name, (time, x) in runs.items():
    above.plot(time, x, ".-", lw=1.0, ms=4, label=name)
    below.plot(time, x - np.cos(OMEGA * time), ".-", lw=1.0, ms=4, label=name)
above.set(ylabel="displacement", title="Eight periods of an oscillator")
below.set(ylabel="error", xlabel="time", title="Slow or fast, and damped")
fig.legend(*above.get_legend_handles_labels(), loc="outside right upper")
