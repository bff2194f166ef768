"""The cells around some nodes: forces on these nodes without those of the rest of the body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from softway.bodies.internal import InternalForce, internal_force
from softway.bodies.part import Part
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layer:
    """Internal forces of the cells that have one of the chosen nodes: complete on those nodes.

    ``pieces`` are the nodes (k,) of a body that these cells have, their internal force, and which of them are chosen.
    """

    pieces: tuple[tuple[IntArray, InternalForce, BoolArray], ...]

    def force(self, u: Array) -> Array:
        """Internal force (n, d) on the chosen nodes, zero on all others [N]."""
        out = np.zeros_like(u)
        for nodes, internal, chosen in self.pieces:
            out[nodes[chosen]] = internal.force(u[nodes])[chosen]
        return out


def layer(parts: Sequence[Part], chosen: BoolArray) -> Layer:
    """The :class:`Layer` around the ``chosen`` nodes (n,) of some bodies."""
    pieces = []
    for part in parts:
        own = chosen[part.rows]
        blocks = {kind: cells[own[cells].any(axis=1)] for kind, cells in part.mesh.blocks.items()}
        blocks = {kind: cells for kind, cells in blocks.items() if len(cells)}
        if not blocks:
            continue
        nodes = np.unique(np.concatenate([cells.ravel() for cells in blocks.values()]))
        mesh = Mesh(
            points=part.mesh.points[nodes],
            blocks={kind: np.searchsorted(nodes, cells) for kind, cells in blocks.items()},
        )
        internal = internal_force(mesh, part.internal.material, part.internal.section)
        pieces.append((nodes + part.rows.start, internal, own[nodes]))
    return Layer(pieces=tuple(pieces))
