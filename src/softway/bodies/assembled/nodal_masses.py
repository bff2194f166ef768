"""Inertia of solids: nodal masses, and interpolation of the velocity of massless nodes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.inertia.mass_matrix import condensation, nodal_mass
from softway.bodies.inertia.mass_redistribution import redistribute_mass
from softway.bodies.solid import Solid
from softway.errors import InputError, within

TINY, EPSILON = float(np.finfo(float).tiny), float(np.finfo(float).eps)


def solid_following(part: DiscreteSolid, light: IntArray) -> sp.csr_array:
    """Matrix (n, n) that gives the velocities of all nodes from those with mass; ``light`` are the massless nodes."""
    if not len(light):
        return sp.csr_array(sp.eye_array(part.mesh.n_nodes))
    return condensation(part.mesh, light)


def solid_mass(part: DiscreteSolid, solid: Solid, candidates: IntArray, spread: int) -> sp.csr_array:
    """Nodal mass matrix (n, n) [kg]; mass of the contact nodes ``candidates`` goes to ``spread`` layers of cells."""
    section, density = part.internal.section, part.materials.density
    with within(f"bodies.{part.name}"):
        for region, one in zip(part.materials.regions, part.materials.densities, strict=True):
            _require_numbers(part, one, f"density.{region}" if region else "density")
        if len(candidates):
            _require_even(part, candidates)
            if not solid.supports:
                _require_inertia(part, candidates)
            return redistribute_mass(part.mesh, density, section, solid.mass, candidates, spread, part.name)
        return nodal_mass(part.mesh, density, section, solid.mass)


def _require_numbers(part: DiscreteSolid, density: float, where: str) -> None:
    """Refuse a density at which masses of nodes leave the range of floating-point numbers, or lose digits near it."""
    least, greatest = TINY / EPSILON, EPSILON / TINY
    size = float(np.linalg.norm(np.ptp(part.mesh.points, axis=0)))
    mass = float(density) * size**part.mesh.cell_dim / part.mesh.n_nodes
    if not least < mass < greatest:
        problem = f"{density:g} kg/m^3 gives nodes a mass of about {mass:.2g} kg, beyond the range of numbers"
        raise InputError(where, problem, "the density of a material, such as 1000 kg/m^3")


def _require_even(part: DiscreteSolid, candidates: IntArray) -> None:
    """Refuse massless nodes that hang, or on which nodes hang: a hanging node would give them its mass."""
    hanging = part.mesh.hanging
    if hanging is None:
        return
    wrong = hanging.at(candidates)
    if len(wrong):
        problem = f"{len(wrong)} hanging nodes at contact nodes"
        raise InputError(
            "mesh", problem, "cells of one size along the surface, softway.adaptivity.marking.even_surface.even"
        )


def _require_inertia(part: DiscreteSolid, candidates: IntArray) -> None:
    """Refuse a free body whose nodes with mass lie on one point, or in 3D on one line."""
    points = np.delete(part.mesh.points, candidates, axis=0)
    if not len(points):
        return  # redistribute_mass refuses it
    rank = int(np.linalg.matrix_rank(points - points.mean(axis=0), tol=1e-9 * float(np.ptp(part.mesh.points))))
    if rank < part.mesh.dim - 1:
        problem = f"only {len(points)} nodes are not in a contact tag; mass on them has no moment of inertia"
        raise InputError("mesh", problem, "a finer mesh, or a smaller tag in the contact")


@dataclass(frozen=True, slots=True, eq=False)
class Massless:
    """Nodes without inertia: those ``touching`` (k,), whose mass is spread over some layers of cells, and those that
    rigid bodies carry, ``carried`` (c,).
    """

    touching: IntArray
    carried: IntArray
    spread: int

    def of(self, nodes: slice) -> tuple[IntArray, int]:
        """Numbers of those of a solid in it, and the layers of cells."""
        both = self.touching, self.carried
        mine = [some[(some >= nodes.start) & (some < nodes.stop)] - nodes.start for some in both]
        return np.unique(np.concatenate(mine)), self.spread if len(mine[0]) else 1


@dataclass(frozen=True, slots=True, eq=False)
class KnownInertia:
    """Inertia of a solid that is known: its massless nodes (k,), masses (n, n) [kg], and velocities (n, n) of all nodes
    from those with mass.
    """

    light: IntArray
    mass: sp.csr_array
    follow: sp.csr_array


def inertia_of(
    parts: Sequence[DiscreteSolid],
    solids: Mapping[str, Solid],
    light: Massless,
    factor: float,
    known: Mapping[str, KnownInertia] | None = None,
) -> tuple[sp.csr_array, Array, sp.csr_array]:
    """Mass (n, n) times the ``factor``, nodal mass (n,) for the weight, and velocities (n, n) of all nodes from those
    with mass; solids with a ``known`` inertia keep it if they have the same massless nodes.
    """
    masses, follow = [], []
    for part in parts:
        nodes, layers = light.of(part.nodes)
        found = None if known is None else known.get(part.name)
        if found is not None and np.array_equal(found.light, nodes):
            masses.append(found.mass)
            follow.append(found.follow)
            continue
        masses.append(solid_mass(part, solids[part.name], nodes, layers))
        follow.append(solid_following(part, nodes))
    weight, following = (sp.csr_array(sp.block_diag(blocks, format="csr")) for blocks in (masses, follow))
    mass = sp.csr_array(factor * weight) if factor > 0.0 else sp.csr_array(weight.shape)
    return mass, np.asarray(weight.sum(axis=1)).ravel(), following
