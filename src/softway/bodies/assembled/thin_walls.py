"""Walls one cell thick in two layers: the nodes between these carry the mass (docs/theory/bodies/mass.md)."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from softway.arrays import IntArray
from softway.bodies.discretised import DiscreteSolid, free_components
from softway.bodies.setup.initial_fields import Affine, FieldSum, OnTag, Profile, Uniform
from softway.bodies.setup.placement import Placement
from softway.bodies.solid import Solid
from softway.errors import within
from softway.meshes.topology import require_none
from softway.meshes.walls.division import divided_at
from softway.meshes.walls.wall_edges import wall_edges


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layered:
    """Solid with two layers of cells in its walls one cell thick.

    Parameters
    ----------
    solid
        The solid with the divided mesh, in place.
    faces
        (f,) nodes of the solid at the ends of the edges across its walls.
    """

    solid: Solid
    faces: IntArray


def layered(part: DiscreteSolid, solid: Solid, touching: IntArray) -> Layered | None:
    """Solid with its walls one cell thick divided where nodes of the model, ``touching`` (k,), may touch; None without
    such walls, and for a solid whose nodes are all held or driven.
    """
    own = touching[(touching >= part.nodes.start) & (touching < part.nodes.stop)] - part.nodes.start
    edges = wall_edges(part.mesh, own)
    if not len(edges) or not free_components(solid.supports, part.mesh).any():
        return None
    with within(f"bodies.{part.name}"):
        require_none(part.mesh.hanging, "walls one cell thick that may touch")
    with within(f"bodies.{part.name}.mesh"):
        found = divided_at(part.mesh, edges)
    velocity, displacement = (_between(field, found.weights) for field in (solid.velocity, solid.displacement))
    divided = replace(solid, mesh=found.mesh, place=Placement(), group=(), velocity=velocity, displacement=displacement)
    return Layered(solid=divided, faces=np.unique(edges))


def _between(field: Any, weights: sp.csr_array) -> Any:
    """Initial field, with values at the new nodes if it is given by values (m, d) at the old ones."""
    if isinstance(field, Uniform | Affine | Profile | OnTag | FieldSum | Callable):
        return field
    return weights @ np.asarray(field, dtype=float)
