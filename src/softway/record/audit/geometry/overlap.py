"""Overlap of deformable bodies, and of a body with itself, at nodes and between them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.element import tabulate
from softway.record.audit.geometry import flat_pieces
from softway.record.audit.geometry.crossings import between, crossings
from softway.record.audit.geometry.folding import folded
from softway.record.audit.geometry.inside import depths, local_coordinates, slopes
from softway.record.audit.geometry.lattice import lattice
from softway.record.audit.geometry.near import near
from softway.record.audit.geometry.solids import Block, Solids, boxes

BULGE = 0.1
"""Fraction of the size of the box around the nodes of a quadratic cell by which the cell may bulge out of it."""

DIVISIONS = 8
"""Number of intervals along the side of a curved facet between which its overlap is looked at."""

SHALLOW = 1e-6
"""Depth, relative to the size of the body, up to which the distance from the outer faces of the cell is exact."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Points:
    """Points of the boundary, each near two nodes (which agree for a node itself).

    Parameters
    ----------
    ends
        (k, 2) the two nodes: ends of a line that the point is on, or the nearest ones of a curved facet.
    place, rest
        (k, d) places now and at rest [m].
    """

    ends: IntArray
    place: Array
    rest: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Inside:
    """Points inside of a body that they do not belong to, or of their own body far from their own cells.

    Parameters
    ----------
    ends
        (k, 2) the nodes between which the points lie; they agree for a node.
    place
        (k, d) places [m].
    body
        (k,) number of the body that they are in.
    depth
        (k,) distance to the boundary of that body [m].
    """

    ends: IntArray
    place: Array
    body: IntArray
    depth: Array


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Window:
    """Parts of space in which bodies may overlap.

    Parameters
    ----------
    solids, x
        Bodies, and positions (n, d) of their nodes [m].
    low, high
        (bodies, d) boxes of the bodies [m].
    meeting
        (bodies, bodies) true for pairs whose boxes overlap, and on the diagonal for bodies that may have folded.
    fold
        (n,) nodes that may touch their own body.
    """

    solids: Solids
    x: Array
    low: Array
    high: Array
    meeting: BoolArray
    fold: BoolArray

    def reached(self, corners: IntArray, *, whole: bool = False, curved: bool = False) -> BoolArray:
        """Things (k,) with nodes ``corners`` (k, c) that reach into the common part of two boxes, or may touch their
        own body; with ``whole`` all things of a body that may touch itself. ``curved`` things bulge.
        """
        owner, places = self.solids.owner[corners[:, 0]], self.x[corners]
        low, high = places.min(axis=1), places.max(axis=1)
        if curved:
            margin = BULGE * (high - low).max(axis=1, keepdims=True)
            low, high = low - margin, high + margin
        out = np.diagonal(self.meeting)[owner] if whole else self.fold[corners].any(axis=1)
        for a, b in np.argwhere(np.triu(self.meeting, 1)):
            least, most = np.maximum(self.low[a], self.low[b]), np.minimum(self.high[a], self.high[b])
            out = out | ((owner == a) | (owner == b)) & (low <= most).all(axis=1) & (least <= high).all(axis=1)
        return np.asarray(out)


def overlaps(solids: Solids, x: Array) -> Inside:
    """All nodes of the boundary, and points between its crossings, that lie inside of a body at positions x (n, d)."""
    if solids.dim == 1 and len(solids.names) == 1:
        return _none(solids.dim)
    window = _window(solids, x)
    if not window.meeting.any():
        return _none(solids.dim)
    nodes = solids.surface[window.reached(solids.surface[:, None], whole=True)]
    at_nodes = Points(ends=np.stack([nodes, nodes], axis=1), place=x[nodes], rest=solids.reference[nodes])
    looked_at = [at_nodes, *([_crossed(solids, x, window)] if solids.dim > 1 else []), *_curved(solids, x, window)]
    return _together([_inside(solids, x, points, window.meeting) for points in looked_at])


def _together(found: Sequence[Inside]) -> Inside:
    return Inside(
        ends=np.concatenate([f.ends for f in found]),
        place=np.concatenate([f.place for f in found]),
        body=np.concatenate([f.body for f in found]),
        depth=np.concatenate([f.depth for f in found]),
    )


def _none(dim: int) -> Inside:
    none = np.zeros(0)
    return Inside(ends=np.zeros((0, 2), np.int64), place=np.zeros((0, dim)), body=np.zeros(0, np.int64), depth=none)


def _window(solids: Solids, x: Array) -> Window:
    """Parts of space in which bodies may overlap."""
    low, high = boxes(x, solids.owner, len(solids.names))
    bulge = _bulges(solids, x)[:, None]
    low, high = low - bulge, high + bulge
    meeting: BoolArray = np.all((low[:, None] <= high[None, :]) & (low[None, :] <= high[:, None]), axis=2)
    fold = folded(solids, x)
    meeting[np.diag_indices(len(meeting))] = False
    meeting[solids.owner[fold], solids.owner[fold]] = True
    return Window(solids=solids, x=x, low=low, high=high, meeting=meeting, fold=fold)


def _bulges(solids: Solids, x: Array) -> Array:
    """Distances (bodies,) by which curved facets may bulge out of the boxes around the nodes of their bodies [m]."""
    out = np.zeros(len(solids.names))
    for facets in solids.curved.values():
        np.maximum.at(out, solids.owner[facets[:, 0]], BULGE * np.ptp(x[facets], axis=1).max(axis=1))
    return out


def _crossed(solids: Solids, x: Array, window: Window) -> Points:
    """Points between the crossings of the lines of the boundary with its flat pieces, in the facets of the lines."""
    number = np.flatnonzero(window.reached(solids.lines.ends))
    lines = solids.lines.ends[number]
    pieces = solids.flat[window.reached(solids.flat)]
    ends, corners = x[lines], x[pieces]
    i, j = near(ends.min(axis=1), ends.max(axis=1), corners.min(axis=1), corners.max(axis=1))
    keep = window.meeting[solids.owner[lines[i, 0]], solids.owner[pieces[j, 0]]]
    keep &= ~(lines[i][:, :, None] == pieces[j][:, None, :]).any(axis=(1, 2))
    i, j = i[keep], j[keep]
    fraction, hit = crossings(ends[i], corners[j])
    samples = between(number[i[hit]], fraction[hit])
    place, rest = (solids.on_lines(samples.line, samples.fraction, at) for at in (x, solids.reference))
    return Points(ends=solids.lines.ends[samples.line], place=place, rest=rest)


def _curved(solids: Solids, x: Array, window: Window) -> Iterator[Points]:
    """Points of a lattice in the facets that are curved: their flat pieces need not cross where they overlap."""
    for name, facets in solids.curved.items():
        near_others = facets[window.reached(facets, curved=True)]
        shares, _ = tabulate(name, lattice(name, DIVISIONS))
        nearest = np.argsort(-shares, axis=1, kind="stable")[:, :2]
        place, rest = (
            np.einsum("pb,fbd->fpd", shares, at[near_others]).reshape(-1, solids.dim) for at in (x, solids.reference)
        )
        yield Points(ends=near_others[:, nearest].reshape(-1, 2), place=place, rest=rest)


def _inside(solids: Solids, x: Array, points: Points, meeting: BoolArray) -> Inside:
    """Those of the points that lie inside of a body."""
    found = [_none(solids.dim)]
    for block in solids.blocks:
        which, cells, depth = _in_block(solids, block, x, points, meeting)
        found.append(Inside(ends=points.ends[which], place=points.place[which], body=block.body[cells], depth=depth))
    return _together(found)


def _in_block(
    solids: Solids, block: Block, x: Array, points: Points, meeting: BoolArray
) -> tuple[IntArray, IntArray, Array]:
    """Numbers of points, of the cells that they are in, and their depths [m].

    In a cell at the boundary the depth is the distance from its outer faces, to first order: exact as it vanishes. A
    deeper point may be nearer to a piece of the boundary beside its cell.
    """
    place, corners = points.place, x[block.nodes]
    low, high = corners.min(axis=1), corners.max(axis=1)
    margin = BULGE * (high - low).max(axis=1, keepdims=True) if block.nodes.shape[1] > 2**solids.dim else 0.0
    i, j = near(place, place, low - margin, high + margin)
    keep = meeting[solids.owner[points.ends[i, 0]], block.body[j]]
    keep &= ~(points.ends[i][:, :, None] == block.nodes[j][:, None, :]).any(axis=2).all(axis=1)
    i, j = i[keep], j[keep]
    where, within = local_coordinates(block.cell, corners[j], place[i])
    i, j, where = i[within], j[within], where[within]
    if not len(i):
        return i, j, np.zeros(0)
    faces = np.where(block.outer[j], depths(block.cell, where) / slopes(block.cell, corners[j], where), np.inf)
    depth = faces.min(axis=1)
    deep = np.flatnonzero(depth > SHALLOW * solids.extents[block.body[j]])
    centre = solids.reference[block.nodes[j[deep]]].mean(axis=1)
    own = solids.owner[points.ends[i[deep], 0]] == block.body[j[deep]]
    rest = np.where(own[:, None], points.rest[i[deep]], np.inf)
    far = flat_pieces.distance(solids, x, place[i[deep]], block.body[j[deep]], centre, rest)
    depth[deep] = np.minimum(depth[deep], far)
    return i, j, depth
