"""
Finer and finer meshes
======================

How large is the error of the contact instants, and how does it decrease with the mesh size? A sweep
computes a scenario for a list of values, each in its own process, and returns one table.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import softway as sw

# %%
# The bar on a wall, as a scenario file. The exact release is at 2.3 s, the impulse is 2 N s.

SCENARIO = """
[bodies.bar]
kind = "Solid"
mesh = { kind = "Interval", length = 1, cells = 10 }
material = { kind = "LinearElastic", E = 1 }
density = 1
velocity = 1

[bodies.wall]
kind = "Tool"
shape = { kind = "HalfSpace", point = 1.3, normal = -1 }

[[contacts]]
name = "wall"
between = ["bar.right", "wall"]

[time]
end = 3
"""
CELLS = (10, 20, 40, 80)

# %%
# In a script, put the call below ``if __name__ == "__main__":``, because each process imports it.
#
# First contact is found exactly, inside its slab (time step). The release is late, because the wave
# that releases the bar is smeared over some cells. Its error is nearly of first order in the cell
# size.

if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        file = Path(folder) / "bar.toml"
        file.write_text(SCENARIO)
        runs = Path(folder) / "runs"
        table = sw.sweep(file, {"bodies.bar.mesh.cells": CELLS}, out=runs, jobs=2).table

    touch = table["contact.wall.first_touch"] - 0.3
    release = table["contact.wall.last_release"] - 2.3
    impulse = 2.0 - table["contact.wall.impulse"]
    print("cells  touch - 0.3  release - 2.3  2 - impulse")
    for row in zip(CELLS, touch, release, impulse):
        print("{:5d} {:12.1e} {:14.4f} {:12.5f}".format(*row))
    order = -np.polyfit(np.log(CELLS), np.log(release), 1)[0]
    print(f"order of the release {order:.2f}")
    assert abs(touch).max() < 1e-12 and 0.75 < order < 1.1

    fig, axis = plt.subplots(figsize=(7.0, 4.2), layout="constrained")
    size = 1.0 / np.array(CELLS)
    axis.loglog(size, release, "o-", label="release")
    axis.loglog(size, release[-1] * size / size[-1], color="0.6", ls="--", label="first power")
    axis.set(xlabel="size of a cell", ylabel="error of the release", title="Finer meshes")
    axis.legend()
