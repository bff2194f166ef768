"""Internal force on some nodes from the elements around them, without the rest of the body."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.assembled import internal_force
from softway.bodies.internal_force.body_force import BodyForce
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Piece:
    """Elements of one body that have a chosen node.

    Parameters
    ----------
    part
        Number of the body.
    nodes, own
        (k,) numbers of the nodes of the elements in the model, and in the body.
    points
        (q,) numbers of the quadrature points of the elements in the body.
    cells
        (e, a) nodes of the elements of each cell type, numbered 0 to k - 1.
    internal
        Internal force of the elements.
    chosen
        (k,) True at chosen nodes.
    """

    part: int
    nodes: IntArray
    own: IntArray
    points: IntArray
    cells: tuple[IntArray, ...]
    internal: BodyForce
    chosen: BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layer:
    """Internal force of all elements with a chosen node; it is complete on the chosen nodes."""

    pieces: tuple[Piece, ...]

    def during(self, parts: Sequence[DiscreteSolid]) -> "Layer":
        """Layer in the slab of the internal forces of the solids."""
        return Layer(pieces=tuple(_during(piece, parts[piece.part].internal) for piece in self.pieces))

    def force(self, u: Array) -> Array:
        """Internal force (n, d) on the chosen nodes, zero on the others [N]."""
        out = np.zeros_like(u)
        for piece in self.pieces:
            here = np.flatnonzero(piece.chosen)
            out[piece.nodes[here]] = piece.internal.force(u.take(piece.nodes, axis=0)).take(here, axis=0)
        return out

    def alone(self) -> tuple[IntArray, "Layer"]:
        """Nodes (k,) of the elements, and the layer for fields (k, d) on these nodes alone."""
        ends = np.cumsum([0] + [len(piece.nodes) for piece in self.pieces])
        pieces = [
            replace(piece, nodes=np.arange(first, last))
            for piece, first, last in zip(self.pieces, ends[:-1], ends[1:], strict=True)
        ]
        nodes = np.concatenate([np.zeros(0, int), *(piece.nodes for piece in self.pieces)])
        return nodes, Layer(pieces=tuple(pieces))

    def tangent(self, u: Array, moving: BoolArray) -> sp.csc_array:
        """Derivative (f, f) of the force for the ``moving`` components (n, d) of chosen nodes [N/m]."""
        blocks = []
        for piece in self.pieces:
            keep = np.flatnonzero(moving[piece.nodes])
            blocks.append(piece.internal.tangent(u[piece.nodes])[:, keep][keep])
        return sp.csc_array(sp.block_diag(blocks, format="csc")) if blocks else sp.csc_array((0, 0))

    def around(self, nodes: BoolArray) -> BoolArray:
        """Mask (n,) of the ``nodes`` and of all nodes that share an element of the layer with one of them."""
        out = nodes.copy()
        for piece in self.pieces:
            own = nodes[piece.nodes]
            for cells in piece.cells:
                out[piece.nodes[cells[own[cells].any(axis=1)]]] = True
        return out


def layer(parts: Sequence[DiscreteSolid], chosen: BoolArray) -> Layer:
    """Build the :class:`Layer` around the ``chosen`` nodes (n,) of some solids."""
    pieces = [_piece(k, part, chosen[part.nodes]) for k, part in enumerate(parts)]
    return Layer(pieces=tuple(piece for piece in pieces if piece is not None))


def _piece(number: int, part: DiscreteSolid, own: BoolArray) -> Piece | None:
    kept = {kind: np.flatnonzero(own[cells].any(axis=1)) for kind, cells in part.mesh.blocks.items()}
    blocks = {kind: part.mesh.blocks[kind][k] for kind, k in kept.items() if len(k)}
    if not blocks:
        return None
    nodes = np.unique(np.concatenate([cells.ravel() for cells in blocks.values()]))
    mesh = Mesh(
        points=part.mesh.points[nodes],
        blocks={kind: np.searchsorted(nodes, cells) for kind, cells in blocks.items()},
    )
    counts = [len(cells) for cells in part.mesh.blocks.values()]
    starts = np.cumsum([0, *counts[:-1]])
    numbers = np.concatenate([start + k for start, k in zip(starts, kept.values(), strict=True)])
    old = part.internal
    return Piece(
        part=number,
        nodes=nodes + part.nodes.start,
        own=nodes,
        points=_points(old, list(kept.values())),
        cells=tuple(mesh.blocks.values()),
        internal=internal_force(mesh, part.materials.part(numbers), old.section, part.dilatation),
        chosen=own[nodes],
    )


def _points(internal: BodyForce, kept: list[IntArray]) -> IntArray:
    """Numbers (q,) of the quadrature points of the kept elements of each cell type."""
    out, start = [], 0
    for table, cells in zip(internal.sampling.rows, kept, strict=True):
        e, q = table.shape[:2]
        out.append((start + cells[:, None] * q + np.arange(q)).ravel())
        start += e * q
    return np.concatenate(out)


def _during(piece: Piece, body: BodyForce) -> Piece:
    return replace(piece, internal=body.transferred(piece.internal, piece.own, piece.points))
