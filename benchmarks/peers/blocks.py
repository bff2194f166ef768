"""The peers' problem of two bodies: a block with a crowned face is thrown at another one.  NumPy alone.

The lower block, of edge 1 and n + 1 cells an edge, is at rest; the upper one, of edge 0.9 and n cells, has the velocity
(0, 0, -5).  Nothing holds them.  The lower face of the upper block is crowned: it is higher by ``CROWN`` at the middles
of its edges, so that the contact spreads and the force is smooth.  Their meshes do not match.  Materials, steps and
penalty are those of the cube (``cube.py``).
"""

import argparse

import numpy as np
from cube import FACES, PENALTY, SPEED, STEP, lattice

END = 0.036
SMALL, CROWN, ASIDE, GAP = 0.9, 0.04, (0.043, 0.061), 0.01
"""Edge of the upper block, height of its crown, corner over that of the lower one, and gap [m]."""


def lower(n):
    """Points and cubes of the lower block, whose upper face is at z = 0."""
    points, cubes = lattice(n + 1)
    return points - [0.0, 0.0, 1.0], cubes


def upper(n):
    """Points and cubes of the upper block."""
    points, cubes = lattice(n)
    across = 2.0 * points[:, :2] - 1.0
    points = SMALL * points
    points[:, 2] += CROWN * (across**2).sum(axis=1) * (1.0 - points[:, 2] / SMALL)
    return points + [*ASIDE, GAP], cubes


def faces(cubes, side, others=False):
    """Corners (f, 4) of the outer faces on one side of a block, 0 below or 1 above, or on all ``others``."""
    n = round(len(cubes) ** (1 / 3))
    k, j, i = np.unravel_index(np.arange(n**3), (n, n, n))
    outer = (k == 0, k == n - 1, j == 0, i == n - 1, j == n - 1, i == 0)
    return np.concatenate([cubes[outer[s]][:, FACES[s]] for s in range(6) if (s == side) is not others])


def chosen(description):
    """What the command line asks for."""
    options = argparse.ArgumentParser(description=description)
    options.add_argument("--cells", type=int, default=7, help="cells along each edge of the upper block")
    options.add_argument("--end", type=float, default=END, help="time at which the run ends")
    options.add_argument("--step", type=float, default=STEP, help="length of a step")
    options.add_argument("--speed", type=float, default=SPEED, help="speed at the start of the upper block")
    options.add_argument("--penalty", type=float, default=PENALTY, help="stiffness of the contact per unit of area")
    options.add_argument("--order", type=int, default=4, help="order of integration of the contact")
    options.add_argument("--radius", type=float, help="spectral radius of generalised-alpha; trapezoidal without")
    options.add_argument(
        "--kept", type=float, default=0.1, help="an iteration reduces the residual to this: keep factor"
    )
    options.add_argument("--mass", help="NumPy file of a mass matrix: rows, columns and values over the points")
    options.add_argument("--threads", type=int, default=1)
    return options.parse_args()
