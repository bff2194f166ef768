"""The inertia of one solid: its nodal masses, and whom its nodes without inertia follow."""

import numpy as np
import scipy.sparse as sp

from softway.bodies.mass import following, nodal_mass
from softway.bodies.part import Part
from softway.bodies.redistribution import redistributed
from softway.bodies.solid import Solid
from softway.errors import InputError, within
from softway.typing import IntArray


def part_following(part: Part, light: IntArray) -> sp.csr_array:
    """Velocities (n, n) of all nodes from those with inertia; ``light`` are the nodes without."""
    if not len(light):
        return sp.csr_array(sp.eye_array(part.mesh.n_nodes))
    return following(part.mesh, light)


def part_mass(part: Part, solid: Solid, candidates: IntArray, spread: int) -> sp.csr_array:
    """Nodal masses (n, n) [kg]; those of the ``candidates`` of contact are spread over ``spread`` layers of cells."""
    section = part.internal.section
    with within(f"bodies.{part.name}"):
        if len(candidates):
            if not solid.supports:
                _require_inertia(part, candidates)
            return redistributed(part.mesh, solid.density, section, solid.mass, candidates, spread, part.name)
        return nodal_mass(part.mesh, solid.density, section, solid.mass)


def _require_inertia(part: Part, candidates: IntArray) -> None:
    """Refuse a free body whose nodes with inertia lie on one point, or in space on one line."""
    points = np.delete(part.mesh.points, candidates, axis=0)
    if not len(points):
        return  # refused with the mass
    rank = int(np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-9 * float(np.ptp(part.mesh.points))))
    if rank < part.mesh.dim - 1:
        problem = f"{len(points)} nodes are no candidates of contact; they have no moment of inertia"
        raise InputError("mesh", problem, "a finer mesh, or a smaller tag in the contact")
