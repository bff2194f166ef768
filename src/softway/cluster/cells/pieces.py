"""Pieces of solids: the cells of one material, of which a rank holds some."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from softway.arrays import IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.laws.law import Material
from softway.model.model import Model


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Piece:
    """Cells of one material of a solid.

    Parameters
    ----------
    solid
        Number of the solid.
    region
        Region of the material; empty in a solid of one material.
    material
        The law.
    corners
        (e, a) nodes of the cells, ascending as in the solid, numbered in the model.
    nodes
        (k,) nodes of the piece, numbered in the model: those on which its material state has displacements.
    """

    solid: int
    region: str
    material: Material
    corners: IntArray
    nodes: IntArray


def pieces_of(model: Model) -> tuple[Piece, ...]:
    """Pieces of the solids of a model, each of which has cells of one type, solid after solid."""
    return tuple(piece for number, part in enumerate(model.parts) for piece in _of_solid(number, part))


def of_solid(pieces: tuple[Piece, ...], solid: int) -> list[int]:
    """Numbers of the pieces of a solid."""
    return [k for k, piece in enumerate(pieces) if piece.solid == solid]


def _of_solid(solid: int, part: DiscreteSolid) -> Iterator[Piece]:
    """Pieces of the solid with this number, in the order of its materials; a material without cells has none."""
    materials, (corners,) = part.materials, part.mesh.blocks.values()
    corners = corners + part.nodes.start
    if materials.owner is None:
        nodes = np.arange(part.nodes.start, part.nodes.stop)
        yield Piece(solid=solid, region="", material=materials.laws[0], corners=corners, nodes=nodes)
        return
    for number, (region, law) in enumerate(zip(materials.regions, materials.laws, strict=True)):
        mine = corners[materials.owner == number]
        if len(mine):
            yield Piece(solid=solid, region=region, material=law, corners=mine, nodes=np.unique(mine))
