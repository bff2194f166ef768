"""Mesh that has replaced another one in a march, and where its matter was at the start."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.errors import InputError
from softway.meshes.mesh import Mesh

Densities = float | Mapping[str, float]
"""Mass per volume of a solid, or of each of its materials by region [kg/m^3]."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RemeshedMesh:
    """Present mesh of a solid whose meshes are replaced; its reference is the shape of the body when it was new.

    Parameters
    ----------
    first
        Mesh at the start of the march.
    mesh
        Present mesh, with n nodes.
    density
        Mass per volume of this mesh, or of each material by region [kg/m^3]: it keeps their masses.
    origin
        (n, d) places at the start of the matter that was in the nodes of the present mesh when it was new [m].
    matter
        (k, n) values of nodal fields at the matter that was in the k nodes of the first mesh.
    sizes
        (n,) lengths of the edges asked for at the nodes when the cells were made [m].
    base
        (n, d) places of the nodes in which the cells have their best shapes; None where it is the first mesh [m].

    Examples
    --------
    >>> from softway.meshes.generators.shapes import interval
    >>> remeshed_mesh(interval(1.0, cells=1), 2.0, np.ones(2)).origin.tolist()
    [[0.0], [1.0]]
    """

    first: Mesh
    mesh: Mesh
    density: Densities
    origin: Array
    matter: sp.csr_array
    sizes: Array
    base: Array | None = None

    @property
    def replaced(self) -> bool:
        """Whether it is another mesh than that of the start."""
        return not np.array_equal(self.mesh.points, self.first.points)

    @property
    def ideal(self) -> Mesh:
        """Mesh with the same cells, in their best shapes."""
        return self.first if self.base is None else replace(self.mesh, points=self.base)

    def followed(self, mesh: Mesh, sizes: Array) -> "RemeshedMesh":
        """The mesh that replaces this one, before its matter is known; the best shapes of other cells are those that
        they have now.
        """
        same = mesh.blocks.keys() == self.mesh.blocks.keys() and all(
            np.array_equal(cells, self.mesh.blocks[name]) for name, cells in mesh.blocks.items()
        )
        base = self.base if same else np.array(mesh.points)
        return replace(self, mesh=mesh, sizes=sizes, base=base)

    def require_of(self, first: Mesh) -> None:
        """Refuse a mesh, such as one of a damaged file, of a march that began on another mesh.

        Raises
        ------
        InputError
            With what does not fit.
        """
        n, rows = self.mesh.n_nodes, self.matter
        begun = self.first.blocks.keys() == first.blocks.keys() and np.array_equal(self.first.points, first.points)
        if not (begun and self.mesh.dim == first.dim and first.tags.keys() <= self.mesh.tags.keys()):
            raise InputError("mesh", "a mesh of another body", "the mesh of this march")
        fits = self.origin.shape == self.mesh.points.shape and rows.shape == (first.n_nodes, n)
        numbers = fits and np.isfinite(self.origin).all() and np.isfinite(rows.data).all()
        masses = np.array(list(self.density.values()) if isinstance(self.density, Mapping) else [self.density])
        if not (numbers and np.isfinite(masses).all() and (masses > 0.0).all()):
            raise InputError("origin", "no places of the matter at the start, or no density", "those of this march")
        if self.sizes.shape != (n,) or not (np.isfinite(self.sizes).all() and (self.sizes > 0.0).all()):
            raise InputError("sizes", "no lengths of edges at the nodes", "those of this march")
        best = self.first.points if self.base is None else self.base
        if best.shape != self.mesh.points.shape or not np.isfinite(best).all():
            raise InputError("base", "another number of nodes than the mesh", "the mesh of this march")


def remeshed_mesh(first: Mesh, density: Densities, sizes: Array) -> RemeshedMesh:
    """The mesh at the start of a march, which nothing has replaced yet, with the lengths (n,) of its edges [m]."""
    matter = sp.csr_array(sp.eye_array(first.n_nodes, format="csr"))
    origin = np.array(first.points)
    return RemeshedMesh(first=first, mesh=first, density=density, origin=origin, matter=matter, sizes=sizes)
