"""
Finer and finer meshes
======================

How large is the error of the contact instants, and how fast does it fall with the mesh? A sweep
computes a scenario over a list of values, each in a process of its own, and gives one table.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import softway as sw

# %%
# The bar that flies at a wall, as a file. Its exact release is at 2.3 s, the impulse 2 N s.

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
# In a script of yours the call stands below ``if __name__ == "__main__":``, since processes begin by
# importing it.
#
# The touch is found inside its slab, exactly. The release comes late, since the wave that takes the
# bar off is smeared over some cells: its error falls nearly with the first power of their size.

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
