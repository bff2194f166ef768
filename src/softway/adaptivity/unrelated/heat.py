"""Heat of a body on a mesh that replaces another one: its content passes over exactly, without new extremes, and its
entropy never falls (docs/theory/bodies/remeshing.md#heat).
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.adaptivity.unrelated.fields import within_simplices
from softway.adaptivity.unrelated.transport_plan import TransportPlan, transport_plan
from softway.arrays import Array, IntArray
from softway.bodies.elements.cut_cells import simplices_of
from softway.bodies.elements.section import Section
from softway.errors import InputError

HALVINGS = 60
"""Bisections of the share of the fluxes that the entropy allows."""
ROUNDING = 1e-15
"""Fall of the entropy, relative to its terms, that is rounding."""
_INNER = {2: 1.0 / 6.0, 3: (5.0 - 5.0**0.5) / 20.0}
"""Shares of the other corners at the points of a simplex that integrate quadratic functions."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sampled:
    """Mesh of n nodes with p points in the simplices between its nodes.

    Parameters
    ----------
    cells
        (s, d + 1) nodes of the simplices.
    places
        (n, d) places of the nodes [m].
    points, weights
        (p, d) points [m], and their volumes (p,) [m^3]; none of a cell that is folded.
    values
        (p, n) linear functions of the nodes at the points.
    """

    cells: IntArray
    places: Array
    points: Array
    weights: Array
    values: sp.csr_array

    def at(self, points: Array) -> sp.csr_array:
        """Linear functions (q, n) of the nodes at points (q, d), none negative; outside of the nearest simplex."""
        return within_simplices(self.cells, self.places, points)


def require_simplices(blocks: Iterable[str]) -> None:
    """Refuse cells without simplices between their nodes.

    Raises
    ------
    InputError
        For ``hex20``.
    """
    for cell in blocks:
        if not simplices_of(cell):
            raise InputError("mesh", f"heat in {cell}, which have no simplices between their nodes", "hex27 or hex8")


def sampled(blocks: Mapping[str, IntArray], places: Array, section: Section) -> Sampled:
    """Points of the cells of a mesh with nodes at the places (n, d) [m].

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> found = sampled({"quad4": np.array([[0, 1, 2, 3]])}, square, PlaneStrain(thickness=2.0))
    >>> len(found.points), round(float(found.weights.sum()), 12)
    (6, 2.0)
    """
    parts = [nodes[:, np.array(simplices_of(cell))].reshape(-1, places.shape[1] + 1) for cell, nodes in blocks.items()]
    cells = np.concatenate(parts)
    d, x = places.shape[1], places[cells]
    shares = np.full((d + 1, d + 1), _INNER[d])
    np.fill_diagonal(shares, 1.0 - d * _INNER[d])
    points = np.einsum("qa,sad->sqd", shares, x)
    factorial = 2.0 if d == 2 else 6.0
    volume = np.maximum(np.linalg.det(x[:, 1:] - x[:, :1]), 0.0) / factorial
    weights = volume[:, None] / (d + 1) * section.measure(points)
    count = points.shape[0] * points.shape[1]
    rows = np.repeat(np.arange(count), d + 1)
    columns = np.repeat(cells, d + 1, axis=0).ravel()
    values = sp.csr_array((np.tile(shares.ravel(), len(cells)), (rows, columns)), shape=(count, len(places)))
    return Sampled(cells=cells, places=places, points=points.reshape(count, d), weights=weights.ravel(), values=values)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeatTransfer:
    """Transfer of the heat of n nodes to m nodes of another mesh of the same body.

    Parameters
    ----------
    plan
        Capacities, or masses, that pass from the old nodes to the new ones.
    capacity
        (m,) capacities of the new nodes.
    near
        (m, n) linear functions of the old nodes at the new ones.
    around
        (m, n) old nodes from which a new one has something.
    links
        (m, m) capacities that new nodes have in common; symmetric.
    """

    plan: TransportPlan
    capacity: Array
    near: sp.csr_array
    around: sp.csr_array
    links: sp.csr_array

    def carried(self, values: Array, least: float, entropy: Callable[[Array], Array]) -> Array:
        """Values (m,) on the new mesh of a quantity per capacity from those (n,) on the old one: temperatures,
        specific contents.

        Parameters
        ----------
        values
            (n,) values on the old mesh.
        least
            Entropy of these values, which is not to fall.
        entropy
            Concave entropy of a value.
        """
        low = self.plan.means(values)
        near, fluxes = np.asarray(self.near @ values), sp.coo_array(self.links)
        rows, columns = fluxes.coords
        flux = fluxes.data * (near[rows] - near[columns])
        room = self.room(values, low)
        allowed = _allowed(rows, flux, room)
        share = np.where(flux > 0.0, np.minimum(allowed[0][rows], allowed[1][columns]),
                         np.minimum(allowed[1][rows], allowed[0][columns]))  # fmt: skip
        change = np.bincount(rows, share * flux, len(low)) / self.capacity

        def falls(part: float) -> bool:
            terms = self.capacity * entropy(low + part * change)
            return bool(terms.sum() < least - ROUNDING * np.abs(terms).sum())

        return np.asarray(low + _greatest(falls) * change)

    def mixed(self, values: Array) -> Array:
        """Values (m,) on the new mesh after an exchange between neighbours, which has the same content and no less
        entropy.
        """
        links = sp.coo_array(self.links)
        rows, columns = links.coords
        flux = 0.5 * links.data * (values[columns] - values[rows])
        return np.asarray(values + np.bincount(rows, flux, len(values)) / self.capacity)

    def room(self, values: Array, low: Array) -> tuple[Array, Array]:
        """Capacities (m,) times the distances of the values ``low`` from the greatest and the least one around."""
        around = values[self.around.indices]
        most = np.maximum(np.maximum.reduceat(around, self.around.indptr[:-1]), low)
        fewest = np.minimum(np.minimum.reduceat(around, self.around.indptr[:-1]), low)
        return self.capacity * (most - low), self.capacity * (low - fewest)


def heat_transfer(old: Sampled, new: Sampled, before: Array, after: Array) -> HeatTransfer:
    """Transfer between two meshes whose nodes have the capacities ``before`` (n,) and ``after`` (m,), of the same sum.

    Examples
    --------
    >>> from softway.bodies.elements.section import PlaneStrain
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> one = sampled({"quad4": np.array([[0, 1, 2, 3]])}, square, PlaneStrain())
    >>> two = sampled({"tri3": np.array([[0, 1, 2], [0, 2, 3]])}, square, PlaneStrain())
    >>> passes = heat_transfer(one, two, np.full(4, 0.25), np.array([2.0, 1.0, 2.0, 1.0]) / 6.0)
    >>> found = passes.carried(np.array([1.0, 2.0, 3.0, 2.0]), 0.25 * np.log(12.0), np.log)
    >>> round(float(passes.capacity @ found), 12)
    2.0
    """
    scale = after.sum() / before.sum()
    pairs = ((old.values, new.at(old.points), old.weights), (old.at(new.points), new.values, new.weights))
    kernel = sum(_products(one, other, weights) for one, other, weights in pairs)
    links = sum(_products(other, other, weights) for _, other, weights in pairs)
    plan, near = transport_plan(kernel, before * scale, after), old.at(new.places)
    own = transport_plan(sp.csr_array(links), after, after).amounts
    around = sp.csr_array(abs(sp.csr_array(kernel.T)) + near)
    around.eliminate_zeros()
    return HeatTransfer(plan=plan, capacity=after, near=near, around=around,
                        links=sp.csr_array(0.5 * (own + own.T)))  # fmt: skip


def _products(one: sp.csr_array, other: sp.csr_array, weights: Array) -> sp.csr_array:
    """Integrals (n, m) of products of functions (p, n) and (p, m) with weights (p,)."""
    return sp.csr_array(one.T @ sp.csr_array(sp.diags_array(weights) @ other))


def _allowed(rows: IntArray, flux: Array, room: tuple[Array, Array]) -> tuple[Array, Array]:
    """Shares (m,) of the positive and the negative fluxes into each node that its room allows."""
    out = []
    for sign, space in zip((1.0, -1.0), room, strict=True):
        total = np.bincount(rows, np.maximum(sign * flux, 0.0), len(space))
        out.append(np.where(total > space, space / np.where(total > 0.0, total, 1.0), 1.0))
    return out[0], out[1]


def _greatest(falls: Callable[[float], bool]) -> float:
    """Greatest share up to one at which nothing falls; at zero nothing does."""
    if not falls(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if falls(middle) else (middle, high)
    return low
