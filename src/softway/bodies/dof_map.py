"""Maps from the unknowns of a model to the velocities of its nodes: ``v = J w`` with a Jacobian J.

The unknowns of a solid are the components of its nodes that have no support: J picks them.  Where some components
depend on others (ties, hanging nodes, rigid parts), J has their coefficients.  Contact, friction and the slab see the
nodes only; forces on the nodes become those on the unknowns by ``J^T`` (docs/theory/solver/dof_map.md).
"""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from softway.arrays import Array, BoolArray, IntArray
from softway.bodies.inertia.matrix_sum import CombinedSum
from softway.bodies.inertia.matrix_sum import MatrixSum as MatrixSum
from softway.kernels.assembly.sparsity import sum_of


class DofMap(Protocol):
    """Velocities of nodes (n, d) from unknowns (f,)."""

    @property
    def free(self) -> BoolArray:
        """Components (n, d) that the unknowns move; the others have supports."""
        ...

    @property
    def unsupported(self) -> BoolArray:
        """Nodes (n,) without any support."""
        ...

    @property
    def size(self) -> int:
        """Number f of unknowns (degrees of freedom)."""
        ...

    @property
    def components(self) -> IntArray | None:
        """Components (f,), numbered ``j d + i``, that are the unknowns; None if unknowns move several components."""
        ...

    @property
    def jacobian(self) -> sp.csr_array:
        """J (n d, f)."""
        ...

    def nodes(self, unknowns: Array, given: Array | float = 0.0) -> Array:
        """Field (n, d) of the ``unknowns`` (f,), with the supported part of the field ``given`` (n, d)."""
        ...

    def supported(self, field: Array) -> Array:
        """Part (n, d) of a field (n, d) along the directions that supports hold or drive."""
        ...

    def unknowns(self, field: Array) -> Array:
        """Unknowns (f,) of a field (n, d); of the nearest one that the unknowns describe."""
        ...

    def forces(self, force: Array) -> Array:
        """Forces (f,) on the unknowns by forces (n, d) on the nodes, ``J^T force``."""
        ...

    def gathered(self, force: Array) -> Array:
        """Forces (n, d) with those on nodes that follow others on the nodes that they follow."""
        ...

    def rows(self, gradient: sp.csr_array) -> sp.csr_array:
        """Rows (m, f) on the unknowns from rows (m, n d) on the nodes, ``gradient J``."""
        ...

    def squares(self, gradient: sp.csr_array) -> Array:
        """Squares (m,) of the magnitudes of :meth:`rows`; zero for a row that no unknown changes."""
        ...

    def matrix(self, nodal: sp.csc_array) -> sp.csc_array:
        """Matrix (f, f) on the unknowns from one (n d, n d) on the nodes, ``J^T nodal J``."""
        ...

    def sum(self, constant: sp.csc_array, other: sp.csc_array) -> MatrixSum:
        """Sum of a constant and a changing matrix, both (n d, n d) on the nodes."""
        ...

    def block_inverse(self, blocks: Array) -> sp.csr_array:
        """Inverse (f, f) of a matrix with the diagonal ``blocks`` (n, d, d), or of its diagonal.

        Raises
        ------
        LinAlgError
            If a block is singular.
        """
        ...

    def moving(self, nodes: IntArray) -> IntArray:
        """Unknowns (k,) that move one of the ``nodes``."""
        ...

    def only(self, nodes: BoolArray) -> "DofMap":
        """Map of the unknowns that move no other than the given nodes (n,)."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class NodalDofs:
    """Unknowns that are components of nodes: those (n, d) that are ``free`` of supports.

    Examples
    --------
    >>> dofs = NodalDofs(np.array([[True, False], [True, True]]))
    >>> dofs.size, dofs.nodes(np.array([1.0, 2.0, 3.0])).tolist()
    (3, [[1.0, 0.0], [2.0, 3.0]])
    """

    free: BoolArray
    components: IntArray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "components", np.flatnonzero(self.free.ravel()))

    @property
    def size(self) -> int:
        """Number f of unknowns."""
        return len(self.components)

    @property
    def jacobian(self) -> sp.csr_array:
        """J (n d, f), one entry in a column."""
        f = self.size
        return sp.csr_array((np.ones(f), (self.components, np.arange(f))), shape=(self.free.size, f))

    def nodes(self, unknowns: Array, given: Array | float = 0.0) -> Array:
        """Field (n, d) of the unknowns (f,)."""
        out: Array = np.where(self.free, 0.0, given)
        out[self.free] = unknowns
        return out

    @property
    def unsupported(self) -> BoolArray:
        """Nodes (n,) without any support."""
        return np.asarray(self.free.all(axis=1))

    def supported(self, field: Array) -> Array:
        """Field (n, d) on the supported components, zero on the free ones."""
        return np.where(self.free, 0.0, field)

    def unknowns(self, field: Array) -> Array:
        """Free components (f,) of a field (n, d)."""
        return field[self.free]

    def forces(self, force: Array) -> Array:
        """Forces (f,) on the free components."""
        return force[self.free]

    def gathered(self, force: Array) -> Array:
        """The forces: no node follows another."""
        return force

    def rows(self, gradient: sp.csr_array) -> sp.csr_array:
        """Columns (m, f) of the free components."""
        return gradient if self.size == self.free.size else gradient[:, self.components]

    def squares(self, gradient: sp.csr_array) -> Array:
        """Squares (m,) of the magnitudes of the rows on the free components."""
        return np.asarray(gradient.power(2) @ self.free.ravel().astype(float))

    def matrix(self, nodal: sp.csc_array) -> sp.csc_array:
        """Rows and columns (f, f) of the free components."""
        return sp.csc_array(nodal[self.components][:, self.components])

    def sum(self, constant: sp.csc_array, other: sp.csc_array) -> MatrixSum:
        """Sum with a fixed pattern."""
        return sum_of(constant, other, self.free.ravel())

    def block_inverse(self, blocks: Array) -> sp.csr_array:
        """Inverse (f, f) of the blocks on the free components."""
        n, d = self.free.shape
        both = self.free[:, :, None] & self.free[:, None, :]
        inverse = np.linalg.inv(np.where(both, blocks, np.eye(d)))
        full = sp.bsr_array((inverse, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d)).tocsr()
        return sp.csr_array(full[self.components][:, self.components])

    def moving(self, nodes: IntArray) -> IntArray:
        """Numbers (k,) of the free components of the nodes."""
        flat = np.zeros(self.free.shape, bool)
        flat[nodes] = True
        return np.flatnonzero(flat[self.free])

    def only(self, nodes: BoolArray) -> "NodalDofs":
        """Map of the free components of the given nodes (n,)."""
        return NodalDofs(self.free & nodes[:, None])


@dataclass(frozen=True, slots=True, eq=False)
class CombinedDofs:
    """Unknowns that move several components: ``jacobian`` (n d, f) of full column rank, for nodes (n,) in ``d``
    dimensions.  A component with an empty row is supported; supports along other directions of nodes have their
    projector ``inclined`` (n d, n d), whose range no unknown moves, and nodes that hang between supported ones their
    share of it.  Nodes that follow others have their motion from that of all nodes, ``follow`` (n d, n d).

    Examples
    --------
    Two nodes on a line that move as one:

    >>> dofs = CombinedDofs(sp.csr_array(np.ones((2, 1))), 1)
    >>> dofs.nodes(np.array([3.0])).tolist(), dofs.forces(np.array([[1.0], [2.0]])).tolist()
    ([[3.0], [3.0]], [3.0])
    """

    jacobian: sp.csr_array
    d: int
    inclined: sp.csr_array | None = None
    follow: sp.csr_array | None = None
    free: BoolArray = field(init=False)
    normal: SuperLU = field(init=False)

    def __post_init__(self) -> None:
        moved = np.diff(self.jacobian.indptr) > 0
        object.__setattr__(self, "free", moved.reshape(-1, self.d))
        object.__setattr__(self, "normal", splu(sp.csc_array(self.jacobian.T @ self.jacobian)))

    @property
    def size(self) -> int:
        """Number f of unknowns."""
        return int(self.jacobian.shape[1])

    @property
    def components(self) -> None:
        """None: unknowns are no components."""
        return None

    def nodes(self, unknowns: Array, given: Array | float = 0.0) -> Array:
        """Field (n, d) of the unknowns (f,)."""
        moved = np.asarray(self.jacobian @ unknowns).reshape(self.free.shape)
        if self.inclined is None:
            return np.where(self.free, moved, given)
        return np.asarray(moved + self.supported(np.broadcast_to(given, moved.shape)))

    @property
    def unsupported(self) -> BoolArray:
        """Nodes (n,) without any support."""
        found = self.free.all(axis=1)
        if self.inclined is not None:
            found &= (self.inclined.diagonal().reshape(self.free.shape) == 0.0).all(axis=1)
        return np.asarray(found)

    def supported(self, field: Array) -> Array:
        """Part (n, d) of a field (n, d) on the supported components and along the supported directions."""
        out = np.where(self.free, 0.0, field)
        return out if self.inclined is None else out + (self.inclined @ field.ravel()).reshape(out.shape)

    def unknowns(self, field: Array) -> Array:
        """Unknowns (f,) of the nearest field, by least squares."""
        own = field if self.follow is None else field - self.supported(field)
        return np.asarray(self.normal.solve(self.forces(own)))

    def forces(self, force: Array) -> Array:
        """Forces (f,) on the unknowns."""
        return np.asarray(self.jacobian.T @ force.ravel())

    def gathered(self, force: Array) -> Array:
        """Forces (n, d) with those on nodes that follow others on the nodes that they follow."""
        return force if self.follow is None else np.asarray(self.follow.T @ force.ravel()).reshape(force.shape)

    def rows(self, gradient: sp.csr_array) -> sp.csr_array:
        """Rows (m, f) on the unknowns."""
        return sp.csr_array(gradient @ self.jacobian)

    def squares(self, gradient: sp.csr_array) -> Array:
        """Squares (m,) of the magnitudes of the rows on the unknowns."""
        return np.asarray(self.rows(gradient).power(2).sum(axis=1)).ravel()

    def matrix(self, nodal: sp.csc_array) -> sp.csc_array:
        """Matrix (f, f) on the unknowns."""
        return sp.csc_array(self.jacobian.T @ nodal @ self.jacobian)

    def sum(self, constant: sp.csc_array, other: sp.csc_array) -> MatrixSum:
        """Sum on the nodes, then on the unknowns."""
        return CombinedSum(jacobian=self.jacobian, constant=constant, other=other)

    def block_inverse(self, blocks: Array) -> sp.csr_array:
        """Inverse (f, f) of the diagonal."""
        n, d = self.free.shape
        full = sp.bsr_array((blocks, np.arange(n), np.arange(n + 1)), shape=(n * d, n * d))
        diagonal = self.matrix(sp.csc_array(full)).diagonal()
        if not np.all(diagonal != 0.0):
            raise np.linalg.LinAlgError("singular diagonal")
        return sp.csr_array(sp.diags_array(1.0 / diagonal))

    def moving(self, nodes: IntArray) -> IntArray:
        """Unknowns (k,) that move one of the nodes."""
        components = (np.asarray(nodes)[:, None] * self.d + np.arange(self.d)).ravel()
        return np.unique(self.jacobian[components].indices)

    def only(self, nodes: BoolArray) -> "CombinedDofs":
        """Map of the unknowns that move no other than the given nodes (n,)."""
        others = self.moving(np.flatnonzero(~nodes))
        kept = np.setdiff1d(np.arange(self.size), others)
        return CombinedDofs(sp.csr_array(self.jacobian[:, kept]), self.d)
