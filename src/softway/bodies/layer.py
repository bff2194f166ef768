"""The cells around some nodes: forces on these nodes without those of the rest of the body."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.bodies.internal import InternalForce
from softway.bodies.part import Part, force_of
from softway.bodies.rate_force import RateForce
from softway.space.mesh import Mesh
from softway.typing import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Piece:
    """The cells of one body that have a chosen node.

    Parameters
    ----------
    part
        Number of the body.
    nodes, own
        (k,) their nodes in the model, and in the body.
    points
        Numbers of their points in the body.
    cells
        (e, a) their nodes, as places among the (k,), kind by kind.
    internal
        Their internal force.
    chosen
        (k,) which of the nodes are chosen.
    """

    part: int
    nodes: IntArray
    own: IntArray
    points: IntArray
    cells: tuple[IntArray, ...]
    internal: InternalForce | RateForce
    chosen: BoolArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Layer:
    """Internal forces of the cells that have one of the chosen nodes: complete on those nodes."""

    pieces: tuple[Piece, ...]

    def during(self, parts: Sequence[Part]) -> "Layer":
        """The layer in the slab in which the bodies stand."""
        return Layer(pieces=tuple(_during(piece, parts[piece.part].internal) for piece in self.pieces))

    def force(self, u: Array) -> Array:
        """Internal force (n, d) on the chosen nodes, zero on all others [N]."""
        out = np.zeros_like(u)
        for piece in self.pieces:
            here = np.flatnonzero(piece.chosen)
            out[piece.nodes[here]] = piece.internal.force(u.take(piece.nodes, axis=0)).take(here, axis=0)
        return out

    def alone(self) -> tuple[IntArray, "Layer"]:
        """The nodes (k,) of its cells, and the same layer of fields (k, d) on them alone."""
        ends = np.cumsum([0] + [len(piece.nodes) for piece in self.pieces])
        pieces = [
            replace(piece, nodes=np.arange(first, last))
            for piece, first, last in zip(self.pieces, ends[:-1], ends[1:], strict=True)
        ]
        nodes = np.concatenate([np.zeros(0, int), *(piece.nodes for piece in self.pieces)])
        return nodes, Layer(pieces=tuple(pieces))

    def tangent(self, u: Array, moving: BoolArray) -> sp.csc_array:
        """Derivative (f, f) of the force to the ``moving`` components (n, d), which are of chosen nodes [N/m]."""
        blocks = []
        for piece in self.pieces:
            keep = np.flatnonzero(moving[piece.nodes])
            blocks.append(piece.internal.tangent(u[piece.nodes])[:, keep][keep])
        return sp.csc_array(sp.block_diag(blocks, format="csc")) if blocks else sp.csc_array((0, 0))

    def around(self, nodes: BoolArray) -> BoolArray:
        """The ``nodes`` (n,) and those that share a cell of the layer with one of them."""
        out = nodes.copy()
        for piece in self.pieces:
            own = nodes[piece.nodes]
            for cells in piece.cells:
                out[piece.nodes[cells[own[cells].any(axis=1)]]] = True
        return out


def layer(parts: Sequence[Part], chosen: BoolArray) -> Layer:
    """The :class:`Layer` around the ``chosen`` nodes (n,) of some bodies."""
    pieces = [_piece(k, part, chosen[part.rows]) for k, part in enumerate(parts)]
    return Layer(pieces=tuple(piece for piece in pieces if piece is not None))


def _piece(number: int, part: Part, own: BoolArray) -> Piece | None:
    kept = {kind: np.flatnonzero(own[cells].any(axis=1)) for kind, cells in part.mesh.blocks.items()}
    blocks = {kind: part.mesh.blocks[kind][k] for kind, k in kept.items() if len(k)}
    if not blocks:
        return None
    nodes = np.unique(np.concatenate([cells.ravel() for cells in blocks.values()]))
    mesh = Mesh(
        points=part.mesh.points[nodes],
        blocks={kind: np.searchsorted(nodes, cells) for kind, cells in blocks.items()},
    )
    old = part.internal
    return Piece(
        part=number,
        nodes=nodes + part.rows.start,
        own=nodes,
        points=_points(old, list(kept.values())),
        cells=tuple(mesh.blocks.values()),
        internal=force_of(mesh, old.material, old.section, part.dilatation),
        chosen=own[nodes],
    )


def _points(internal: InternalForce | RateForce, kept: list[IntArray]) -> IntArray:
    """Numbers of the points of the kept cells of each kind."""
    out, start = [], 0
    for table, cells in zip(internal.sampling.rows, kept, strict=True):
        e, q = table.shape[:2]
        out.append((start + cells[:, None] * q + np.arange(q)).ravel())
        start += e * q
    return np.concatenate(out)


def _during(piece: Piece, body: InternalForce | RateForce) -> Piece:
    if not isinstance(piece.internal, RateForce) or not isinstance(body, RateForce):
        return piece
    return replace(piece, internal=piece.internal.during(body.memory.part(piece.own, piece.points), body.span))
