"""Immutable mesh: points, cells in blocks of one type, and named sets of nodes."""

import difflib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from softway.arrays import Array, BoolArray, IntArray
from softway.errors import InputError
from softway.kernels.geometry.jacobians import determinants
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.element import element
from softway.meshes.topology import HangingNodes, Rounding, check_topology

Scalar = TypeVar("Scalar", bound=np.generic)

LARGEST = 1e50
"""Greatest coordinate of a node [m]; the volumes of larger cells are no numbers."""

# A cell is degenerate if its Jacobian determinant is below this fraction of the product of the lengths of the columns
# of the Jacobian.
_DEGENERATE = 1e-10


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Mesh:
    """Mesh of a body in its reference configuration.

    Parameters
    ----------
    points
        (n, d) reference coordinates [m], d = 1, 2 or 3. Every point belongs to a cell.
    blocks
        Cell name -> (e, a) node numbers in VTK order. All cells have the topological dimension d, or 1 for bars in any
        space.
    tags
        Name -> node numbers, kept sorted and unique. Two tags need not be given: ``all`` nodes, and ``surface``, the
        nodes of the boundary facets.
    regions
        Name -> cell numbers in the order of the blocks, kept sorted and unique: tags of volumes, such as the parts of
        the body with one material. The region ``all`` need not be given.
    hanging
        Nodes in the middle of edges and faces of larger cells, which follow their corners; None in a conforming mesh.
    filling
        (e, a) volume of the body per volume of the cell, at the nodes of each cell, where linear cells of one type
        approximate a curved boundary: a factor of the mass.  None for ones.
    rounding
        Smooth surface through the boundary nodes, which a mesh refined in a march follows; None for the facets.

    Examples
    --------
    >>> mesh = Mesh(points=np.array([[0.0], [0.5], [1.0]]), blocks={"bar2": np.array([[0, 1], [1, 2]])})
    >>> mesh.dim, mesh.n_nodes, mesh.edge(), mesh.nodes("surface").tolist()
    (1, 3, 0.5, [0, 2])
    >>> mesh.with_tag("right", lambda x: x[:, 0] > 0.9).nodes("right").tolist()
    [2]
    >>> mesh.with_region("tip", lambda x: x[:, 0] > 0.5).cells("tip").tolist()
    [1]
    """

    points: Array
    blocks: Mapping[str, IntArray]
    tags: Mapping[str, IntArray] = field(default_factory=dict)
    regions: Mapping[str, IntArray] = field(default_factory=dict)
    hanging: HangingNodes | None = None
    filling: Array | None = None
    rounding: Rounding | None = None

    def __post_init__(self) -> None:
        points = _frozen(np.array(self.points, dtype=float))
        blocks = {name: _frozen(np.array(cells, dtype=np.int64)) for name, cells in self.blocks.items() if len(cells)}
        tags = {name: _frozen(np.unique(np.asarray(nodes, dtype=np.int64))) for name, nodes in self.tags.items()}
        regions = {name: _frozen(np.unique(np.asarray(c, dtype=np.int64))) for name, c in self.regions.items()}
        _check_shapes(points, blocks, tags)
        _check_regions(regions, sum(len(cells) for cells in blocks.values()))
        for name, cells in blocks.items():
            _check_cells(points, name, cells)
        for name, value in (("points", points), ("blocks", blocks), ("tags", tags), ("regions", regions)):
            object.__setattr__(self, name, value)
        check_topology(points, blocks, self.edge())

    @property
    def dim(self) -> int:
        """Dimension d of space."""
        return int(self.points.shape[1])

    @property
    def cell_dim(self) -> int:
        """Topological dimension of the cells: 1 for bars."""
        return CELLS[next(iter(self.blocks))].dim

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return len(self.points)

    @property
    def n_cells(self) -> int:
        """Number of cells of all blocks together."""
        return sum(len(cells) for cells in self.blocks.values())

    def nodes(self, tag: str) -> IntArray:
        """Sorted node numbers of a tag; capitals and small letters differ only if another tag has the same letters."""
        found = self.tags.get(tag)
        if found is None and tag == "all":
            found = np.arange(self.n_nodes)
        if found is None and tag == "surface":
            found = np.unique(np.concatenate([facets.ravel() for facets in self.boundary().values()]))
        same = [name for name in self.tags if name.casefold() == tag.casefold()]
        if found is None and len(same) == 1:
            found = self.tags[same[0]]
        if found is None or len(found) == 0:
            known = list(dict.fromkeys([*sorted(self.tags), "all", "surface"]))
            near = difflib.get_close_matches(tag, known, n=1)
            raise InputError(
                "", f"tag {tag!r} matches nothing", f"{near[0] + ', or ' if near else ''}one of: {', '.join(known)}"
            )
        return found

    def boundary(self) -> Mapping[str, IntArray]:
        """Boundary facets (they belong to one cell only), facing outward: facet cell name -> (f, b) node numbers."""
        single = outer_facets(self.blocks)
        if self.hanging is not None:
            inside = self.hanging.inside
            single = {name: found[~inside(found[:, : CELLS[name].corners])] for name, found in single.items()}
        return {facet: found for facet, found in single.items() if len(found)}

    def facets_on(self, tag: str) -> Mapping[str, IntArray]:
        """Boundary facets with all nodes in the tag."""
        inside = np.zeros(self.n_nodes, dtype=bool)
        inside[self.nodes(tag)] = True
        found = {name: facets[inside[facets].all(axis=1)] for name, facets in self.boundary().items()}
        return {name: facets for name, facets in found.items() if len(facets)}

    def with_tag(self, name: str, where: Callable[[Array], BoolArray]) -> "Mesh":
        """Copy of the mesh with one more tag: the nodes where the boolean array ``where(points)`` (n,) is true."""
        nodes = np.flatnonzero(np.asarray(where(self.points), dtype=bool))
        return replace(self, tags={**self.tags, name: nodes})

    def cells(self, region: str) -> IntArray:
        """Sorted cell numbers of a region, in the order of the blocks; letters as for :meth:`nodes`."""
        found = self.regions.get(region)
        if found is None and region == "all":
            found = np.arange(self.n_cells)
        same = [name for name in self.regions if name.casefold() == region.casefold()]
        if found is None and len(same) == 1:
            found = self.regions[same[0]]
        if found is None or len(found) == 0:
            known = ", ".join(dict.fromkeys([*sorted(name for name, c in self.regions.items() if len(c)), "all"]))
            raise InputError("", f"the mesh has no region {region!r}", f"one of: {known}; or Mesh.with_region")
        return found

    def centres(self) -> Array:
        """Means (e, d) of the corners of the cells [m]."""
        parts = [self.points[cells[:, : CELLS[name].corners]].mean(axis=1) for name, cells in self.blocks.items()]
        return np.concatenate(parts)

    def with_region(self, name: str, where: Callable[[Array], BoolArray]) -> "Mesh":
        """Copy of the mesh with one more region: the cells where ``where(centres)`` (e,) is true.

        Parameters
        ----------
        name
            Name of the region.
        where
            Boolean array (e,) from the centres (e, d) of the cells [m].
        """
        cells = np.flatnonzero(np.asarray(where(self.centres()), dtype=bool))
        return replace(self, regions={**self.regions, name: cells})

    def nearest(self, point: Sequence[float] | float) -> int:
        """Node nearest to a point (d,)."""
        at = np.atleast_1d(np.asarray(point, dtype=float))
        if at.shape != (self.dim,):
            raise InputError(
                "at", f"a point of {len(at)} coordinates in a body of {self.dim} dimensions", f"{self.dim} coordinates"
            )
        return int(np.argmin(((self.points - at) ** 2).sum(axis=1)))

    def edge(self) -> float:
        """Length of the shortest edge between two corners [m]."""
        return float(self.edges().min())

    def edges(self) -> Array:
        """Shortest edge (n,) of the cells around each node [m]."""
        shortest = np.full(self.n_nodes, np.inf)
        for cells, lengths in zip(self.blocks.values(), self.cell_edges(), strict=True):
            np.minimum.at(shortest, cells, lengths[:, None])
        return shortest

    def edge_ends(self) -> IntArray:
        """Corners (e, 2) at the ends of the edges, each edge once."""
        pairs = [cells[:, np.array(CELLS[name].edges)].reshape(-1, 2) for name, cells in self.blocks.items()]
        return np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)

    def cell_edges(self) -> tuple[Array, ...]:
        """Shortest edge (e,) of each cell [m], one array for each type of cell."""
        out = []
        for name, cells in self.blocks.items():
            ends = self.points[cells[:, np.array(CELLS[name].edges)]]
            out.append(np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1).min(axis=1))
        return tuple(out)


def _frozen(array: NDArray[Scalar]) -> NDArray[Scalar]:
    array.flags.writeable = False
    return array


def outer_facets(blocks: Mapping[str, IntArray]) -> dict[str, IntArray]:
    """Facets (f, b) of cells that belong to one of them only, facing outward, by facet cell name.

    Examples
    --------
    >>> outer_facets({"tri3": np.array([[0, 1, 2], [0, 2, 3]])})["bar2"].tolist()
    [[0, 1], [1, 2], [2, 3], [3, 0]]
    """
    parts: dict[str, list[IntArray]] = {}
    for name, cells in blocks.items():
        for facet, local in FACETS[name]:
            parts.setdefault(facet, []).append(cells[:, local])
    return {facet: _single(np.concatenate(part), CELLS[facet].corners) for facet, part in parts.items()}


def _single(facets: IntArray, corners: int) -> IntArray:
    """Rows of ``facets`` (f, b) whose corners occur once, in any order."""
    key = np.sort(facets[:, :corners], axis=1)
    order = np.lexsort(key.T)
    same = (key[order[1:]] == key[order[:-1]]).all(axis=1)
    single = ~(np.concatenate([[False], same]) | np.concatenate([same, [False]]))
    found: IntArray = facets[np.sort(order[single])]
    return found


def _check_shapes(points: Array, blocks: Mapping[str, IntArray], tags: Mapping[str, IntArray]) -> None:
    """Check the shapes of the arrays, the names and the node numbers."""
    if points.ndim == 2 and not np.isfinite(points).all():
        node = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise InputError("points", f"node {node} lies at {points[node].tolist()}", "finite coordinates")
    if points.ndim == 2 and np.abs(points).max(initial=0.0) > LARGEST:
        node = int(np.argmax(np.abs(points).max(axis=1)))
        raise InputError("points", f"node {node} lies at {points[node].tolist()}", f"coordinates up to {LARGEST:g} m")
    if points.ndim != 2 or points.shape[1] not in (1, 2, 3):
        raise InputError("points", f"array of shape {points.shape}", "finite coordinates (n, d), d = 1, 2 or 3")
    if not blocks:
        raise InputError("blocks", "no cells", f"at least one block of: {', '.join(FACETS)}")
    for name, cells in blocks.items():
        if name not in FACETS:
            raise InputError(f"blocks.{name}", "unknown cell", f"one of: {', '.join(FACETS)}")
        if cells.ndim != 2 or cells.shape[1] != len(CELLS[name].nodes):
            raise InputError(
                f"blocks.{name}", f"array of shape {cells.shape}", f"(e, {len(CELLS[name].nodes)}) node numbers"
            )
    dims = {CELLS[name].dim for name in blocks}
    if len(dims) > 1 or not dims <= {1, points.shape[1]}:
        raise InputError(
            "blocks", f"{', '.join(blocks)} in {points.shape[1]} dimensions", "cells that fill the space, or bars alone"
        )
    used = np.zeros(len(points), dtype=bool)
    for name, nodes in (*blocks.items(), *tags.items()):
        if nodes.size and not 0 <= nodes.min() <= nodes.max() < len(points):
            raise InputError(name, f"node numbers from {nodes.min()} to {nodes.max()}", f"0 to {len(points) - 1}")
    for cells in blocks.values():
        used[cells] = True
    if not used.all():
        raise InputError("points", f"node {int(np.argmin(used))} belongs to no cell", "remove unused points")


def _check_regions(regions: Mapping[str, IntArray], count: int) -> None:
    """Check the numbers of the cells of the regions."""
    for name, cells in regions.items():
        if cells.size and not 0 <= cells.min() <= cells.max() < count:
            raise InputError(
                f"regions.{name}", f"cell numbers from {cells.min()} to {cells.max()}", f"0 to {count - 1}"
            )


def _check_cells(points: Array, name: str, cells: IntArray) -> None:
    """Check for positive Jacobian determinants at the quadrature points, and for positive lengths of bars."""
    jacobian = np.einsum("eai,qar->eqir", points[cells], element(name).dN, optimize=True)
    size = np.prod(np.linalg.norm(jacobian, axis=-2), axis=-1)
    det = size if jacobian.shape[-1] < jacobian.shape[-2] else determinants(jacobian)
    scale = np.linalg.norm(np.ptp(points, axis=0)) ** CELLS[name].dim
    wrong = (det <= _DEGENERATE * size).any(axis=1) | (size <= 1e-30 * scale).any(axis=1)
    if not wrong.any():
        return
    first = int(np.argmax(wrong))
    centre = ", ".join(f"{value:.6g}" for value in points[cells[first]].mean(axis=0))
    kind = "inverted" if det[first].min() < 0.0 else "degenerate"
    raise InputError(
        f"blocks.{name}[{first}]",
        f"{kind} cell number {first} with its centre at ({centre}) m; {int(wrong.sum())} of {len(cells)} cells",
        "number its nodes in the order of VTK (positive volume), and mesh again where cells have folded over",
    )
