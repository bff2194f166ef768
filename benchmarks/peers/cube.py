"""The peers' problem: a cube of hexahedra or tetrahedra thrown at a rigid plane.  NumPy alone, for any interpreter.

The unit cube has E = 1e4, nu = 0.3, density 1 and the velocity (0, 0, -5); the plane is ``gap`` below it.  Implicit
peers take steps of 5e-4.  Contact is a penalty of 50 E per unit of area.
"""

import argparse
import json
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

E, NU, DENSITY, SPEED, END, STEP = 1e4, 0.3, 1.0, 5.0, 0.05, 5e-4
LAMBDA, MU = E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))
PENALTY = 50.0 * E
ENERGY = 0.5 * DENSITY * SPEED**2
FACES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
"""Corners of the faces of a cube, anticlockwise from outside; the first is the lower, the second the upper."""
TETRAHEDRA = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])
"""Six tetrahedra that make up a cube."""


def lattice(n):
    """Points ((n+1)^3, 3) and cubes (n^3, 8) of the unit cube; the lowest layer of cubes comes first."""
    x = np.linspace(0.0, 1.0, n + 1)
    z, y, x = np.meshgrid(x, x, x, indexing="ij")
    k, j, i = np.meshgrid(*(np.arange(n),) * 3, indexing="ij")
    first, row, layer = (i + (n + 1) * (j + (n + 1) * k)).ravel(), n + 1, (n + 1) ** 2
    corners = np.array([0, 1, 1 + row, row])
    cubes = first[:, None] + np.concatenate([corners, corners + layer])
    return np.stack([x.ravel(), y.ravel(), z.ravel()], 1), cubes


def slab(gap):
    """Corners (8, 3) of a block larger than the cube whose upper face is the plane."""
    low, high = np.array([-0.5, -0.5, -gap - 0.25]), np.array([1.5, 1.5, -gap])
    return np.where(lattice(1)[0][[0, 1, 3, 2, 4, 5, 7, 6]] > 0.5, high, low)


def tetrahedra(cubes):
    """The tetrahedra (6 e, 4) of cubes (e, 8)."""
    return cubes[:, TETRAHEDRA].reshape(-1, 4)


def chosen(description, step=STEP):
    """What the command line asks for."""
    options = argparse.ArgumentParser(description=description)
    options.add_argument("--cells", type=int, default=9, help="cells along each edge")
    options.add_argument("--gap", type=float, default=0.05, help="distance of the plane")
    options.add_argument("--end", type=float, default=END, help="time at which the run ends")
    options.add_argument("--step", type=float, default=step, help="length of a step, where the peer does not choose it")
    options.add_argument("--threads", type=int, default=2)
    return options.parse_args()


@dataclass
class Clock:
    """Seconds of every step, and whether the cube touched in it."""

    seconds: list = field(default_factory=list)
    touching: list = field(default_factory=list)
    start: float = field(default_factory=perf_counter)

    def step(self, action):
        """Do one step."""
        start = perf_counter()
        result = action()
        self.seconds.append(perf_counter() - start)
        return result

    def told(self, peer, version, unknowns, velocity, energy):
        """Print the line: ``velocity`` is the mean one along z at the end, ``energy`` that over the first."""
        line = {
            "peer": peer,
            "version": version,
            "unknowns": int(unknowns),
            "wall": perf_counter() - self.start,
            "seconds": [round(s, 6) for s in self.seconds],
            "touching": [bool(t) for t in self.touching],
            "velocity": float(velocity),
            "energy": None if energy is None else float(energy),
        }
        print("\n" + json.dumps(line), flush=True)
