"""The peers' problem: a cube of hexahedra or tetrahedra thrown at a rigid plane.  NumPy alone, for any interpreter.

The unit cube has E = 1e4, nu = 0.3, density 1 and the velocity (0, 0, -5); the plane is ``gap`` below it.  Implicit
peers take steps of 5e-4 unless told otherwise.  Contact is a penalty, of 50 E per unit of area unless told otherwise.
The motion is plane at the touch: the impact force per unit of area is ``SPEED`` times the impedance of waves of
pressure, and the residual of the equations that experts ask for is a part ``TOLERANCE`` of that force.
"""

import argparse
import json
import os
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

E, NU, DENSITY, SPEED, END, STEP = 1e4, 0.3, 1.0, 5.0, 0.05, 5e-4
LAMBDA, MU = E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))
PENALTY = 50.0 * E
ENERGY = 0.5 * DENSITY * SPEED**2
TOLERANCE = 1e-8
RESIDUAL = TOLERANCE * SPEED * (DENSITY * (LAMBDA + 2.0 * MU)) ** 0.5
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
    options.add_argument("--speed", type=float, default=SPEED, help="speed at the start, towards the plane")
    options.add_argument("--load", type=float, default=0.0, help="acceleration towards the plane by a weight")
    options.add_argument("--end", type=float, default=END, help="time at which the run ends")
    options.add_argument("--step", type=float, default=step, help="length of a step, where the peer does not choose it")
    options.add_argument("--penalty", type=float, default=PENALTY, help="stiffness of the contact per unit of area")
    options.add_argument("--radius", type=float, help="spectral radius of generalised-alpha; trapezoidal without")
    options.add_argument("--mass", help="NumPy file of a mass matrix: rows, columns and values over the points")
    options.add_argument("--threads", type=int, default=2)
    return options.parse_args()


@dataclass(frozen=True)
class Newmark:
    """The generalised-alpha rule of Chung and Hulbert; without a spectral radius the trapezoidal rule.

    The accelerations weigh ``1 - am`` at the end and ``am`` at the start of a step, the forces ``1 - af`` and ``af``.
    """

    am: float = 0.0
    af: float = 0.0

    @classmethod
    def of(cls, radius):
        """The rule with this spectral radius at infinity."""
        return cls() if radius is None else cls((2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0))

    @property
    def gamma(self):
        """Weight of the acceleration at the end in the velocity."""
        return 0.5 - self.am + self.af

    @property
    def beta(self):
        """Half the weight of the acceleration at the end in the place."""
        return (1.0 - self.am + self.af) ** 2 / 4.0


def in_pattern(file, rows, columns, count):
    """Values of the mass matrix in a file at the entries of a pattern that contains its own."""
    given = np.load(file)
    keys, places = given["rows"] * count + given["columns"], rows * count + columns
    order = np.argsort(keys)
    at = np.minimum(np.searchsorted(keys[order], places), len(keys) - 1)
    return np.where(keys[order][at] == places, given["values"][order][at], 0.0)


def now():
    """Time by the clock, and that of the processors in this process and in those that it waited for [s]."""
    used = os.times()
    return perf_counter(), used.user + used.system + used.children_user + used.children_system


@dataclass
class Clock:
    """Seconds of every step, whether the cube touched in it, and the time, momentum along z and contact force after."""

    seconds: list = field(default_factory=list)
    touching: list = field(default_factory=list)
    time: list = field(default_factory=list)
    momentum: list = field(default_factory=list)
    force: list = field(default_factory=list)
    depth: float | None = None
    start: tuple = field(default_factory=lambda: now())

    def step(self, action):
        """Do one step."""
        start = perf_counter()
        result = action()
        self.seconds.append(perf_counter() - start)
        return result

    def note(self, time, touching, momentum, force):
        """Note the state after a step."""
        self.time.append(time)
        self.touching.append(touching)
        self.momentum.append(momentum)
        self.force.append(force)

    def sunk(self, depth):
        """Note how deep the cube is in the plane; the deepest place counts."""
        self.depth = max(self.depth or 0.0, float(depth))

    def told(self, peer, version, unknowns, velocity, energy):
        """Print the line: ``velocity`` is the mean one along z at the end, ``energy`` that over the first."""
        end = now()
        line = {
            "peer": peer,
            "version": version,
            "unknowns": int(unknowns),
            "wall": end[0] - self.start[0],
            "cpu": end[1] - self.start[1],
            "seconds": [round(s, 6) for s in self.seconds],
            "touching": [bool(t) for t in self.touching],
            "time": [float(f"{t:.8g}") for t in self.time],
            "momentum": [float(f"{p:.8g}") for p in self.momentum],
            "force": [float(f"{f:.6g}") for f in self.force],
            "depth": self.depth,
            "velocity": float(velocity),
            "energy": None if energy is None else float(energy),
        }
        print("\n" + json.dumps(line), flush=True)
