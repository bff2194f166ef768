"""Internal force of a body with several materials: a sum of forces on shared nodes."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array

from softway.arrays import Array, IntArray
from softway.bodies.elements.quadrature import SampledCells
from softway.bodies.elements.section import Section
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.material_state import MaterialState, regional_history
from softway.bodies.internal_force.slab_average import SlabForce


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Term:
    """Internal force of the elements of one region.

    Parameters
    ----------
    region, number
        Name of the region, and its number among the materials of the body.
    nodes, cells, points
        Numbers in the body of the nodes (k,), elements (c,) and quadrature points (q,) of the region, ascending.
    entries
        (z,) positions of the entries of its tangent among those of the body.
    internal
        Internal force on the k nodes.
    """

    region: str
    number: int
    nodes: IntArray
    cells: IntArray
    points: IntArray
    entries: IntArray
    internal: BodyForce


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RegionForces:
    """:class:`~softway.bodies.internal_force.body_force.BodyForce` of a body with several materials.

    Energy, force, tangent and material state are sums over the ``terms``; the pattern of the tangent is fixed.  The
    material state has those of the regions with a path-dependent law, and the stored energy of all others.

    Parameters
    ----------
    terms
        Forces of the regions.
    sampled
        Elements of the whole body, with the volume change of each point.
    indices, indptr
        Pattern of the tangent, by columns.
    shape
        Shape (n, d) of the nodal fields.
    """

    terms: tuple[Term, ...]
    sampled: SampledCells
    indices: IntArray
    indptr: IntArray
    shape: tuple[int, int]

    @property
    def section(self) -> Section:
        """Section of the elements."""
        return self.sampled.sampling.section

    @property
    def sampling(self) -> StrainOperator:
        """Strain operator between nodes and all quadrature points, with the volume change of each point."""
        return self.sampled.sampling

    @property
    def volumes(self) -> dict[str, float]:
        """Reference volume of each region [m^3]."""
        return {term.region: float(self.sampling.volume[term.points].sum()) for term in self.terms}

    @property
    def directions(self) -> Array:
        """(p, m, D) or (1, m, D) reference directions of the points."""
        return self.sampled.directions

    @property
    def linear(self) -> bool:
        """True if the tangents of all terms are constant."""
        return all(term.internal.linear for term in self.terms)

    @property
    def path_dependent(self) -> bool:
        """True if a term depends on a material state."""
        return any(term.internal.path_dependent for term in self.terms)

    @property
    def state(self) -> MaterialState | None:
        """Material states of the regions at the start of the slab; None for an elastic body."""
        states = {t.region: state for t in self.terms if (state := t.internal.state) is not None}
        return regional_history(np.zeros(self.shape), states, 0.0) if states else None

    def during(self, state: MaterialState | None, span: float) -> "RegionForces":
        """Force in a slab of length ``span`` [s] that starts from a state; the force itself without one."""
        if state is None:
            return self
        terms = (replace(t, internal=t.internal.during(_own(t, state), span)) for t in self.terms)
        return replace(self, terms=tuple(terms))

    def transferred(self, piece: BodyForce, nodes: IntArray, points: IntArray) -> BodyForce:
        """Force ``piece`` of some nodes (k,) and points (q,) of the body, in the slab of this force."""
        if not isinstance(piece, RegionForces):
            raise TypeError("a piece of a body with several materials has the same materials")
        mine, terms = {term.region: term for term in self.terms}, []
        for term in piece.terms:
            whole = mine[term.region]
            own_nodes = np.searchsorted(whole.nodes, nodes[term.nodes])
            own_points = np.searchsorted(whole.points, points[term.points])
            internal = whole.internal.transferred(term.internal, own_nodes, own_points)
            terms.append(replace(term, internal=internal))
        return replace(piece, terms=tuple(terms))

    def energy(self, u: Array) -> float:
        """Energy of :meth:`energy_and_force` [J]."""
        return sum(term.internal.energy(u[term.nodes]) for term in self.terms)

    def force(self, u: Array) -> Array:
        """Force of :meth:`energy_and_force`, (n, d) [N]."""
        return self._sum((t, t.internal.force(u[t.nodes])) for t in self.terms)

    def energy_and_force(self, u: Array) -> tuple[float, Array]:
        """Stored energy plus the energy dissipated in the slab [J], and the force (n, d) [N] at the end of the slab."""
        found = [term.internal.energy_and_force(u[term.nodes]) for term in self.terms]
        pairs = zip(self.terms, (force for _, force in found), strict=True)
        return sum(energy for energy, _ in found), self._sum(pairs)

    def end_force(self, u: Array) -> tuple[float, Array, Array | None]:
        """Energy [J] and force of :meth:`energy_and_force`, and the part of the force due to the mean rate of the slab,
        (n, d) [N], None without viscosity, in one evaluation.
        """
        return self._joined({t.region: t.internal.end_force(u[t.nodes]) for t in self.terms})

    def slab_average(self, rule: SlabForce, u0: Array, u1: Array) -> Array | None:
        """Force averaged along the chord from u0 to u1 by a rule, (n, d) [N]; None for rules without a chord."""
        return self._some(lambda t: t.internal.slab_average(rule, u0[t.nodes], u1[t.nodes]))

    def tangent(self, u: Array) -> csc_array:
        """Derivative of the force, (n d, n d) [N/m]; number of a component: ``node * d + component``."""
        return self._matrix([(t, t.internal.tangent(u[t.nodes])) for t in self.terms])

    def secant(self, u: Array) -> csc_array:
        """Tangent at fixed viscosity where the law has such moduli, otherwise :meth:`tangent`, (n d, n d) [N/m]."""
        return self._matrix([(t, t.internal.secant(u[t.nodes])) for t in self.terms])

    def viscous_tangent(self, u: Array) -> csc_array | None:
        """Derivative of the viscous part of the force on the pattern of the tangent, (n d, n d) [N/m]; None without."""
        found = [(t, t.internal.viscous_tangent(u[t.nodes])) for t in self.terms]
        some = [(term, matrix) for term, matrix in found if matrix is not None]
        return self._matrix(some) if some else None

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) [N] of the tangent at u with a change w (n, d) [m] of the displacement."""
        return self._sum((t, t.internal.tangent_product(u[t.nodes], w[t.nodes])) for t in self.terms)

    def tangent_diagonal_blocks(self, u: Array) -> Array:
        """Diagonal blocks of the tangent, (n, d, d) [N/m], one for each node."""
        out = np.zeros((*self.shape, self.shape[1]))
        for term in self.terms:
            out[term.nodes] += term.internal.tangent_diagonal_blocks(u[term.nodes])
        return out

    def committed(self, u: Array) -> MaterialState | None:
        """Material state at the end of the slab; None for an elastic body."""
        found = {t.region: state for t in self.terms if (state := t.internal.committed(u[t.nodes])) is not None}
        elastic = (t.internal.energy(u[t.nodes]) for t in self.terms if not t.internal.path_dependent)
        return regional_history(u.copy(), found, sum(elastic, 0.0)) if found else None

    def stored_energy(self, state: MaterialState | None, energy: float) -> float:
        """Stored energy [J] in a committed state where :meth:`energy_and_force` gave ``energy`` [J]."""
        if state is None:
            return energy
        with_history = [(t, _own(t, state)) for t in self.terms if t.internal.path_dependent]
        return state.elastic + sum(t.internal.stored_energy(own, np.nan) for t, own in with_history)

    def dissipated_energy(self, state: MaterialState | None) -> float:
        """Energy dissipated from the start of the march up to a committed state [J]."""
        return sum(t.internal.dissipated_energy(_own(t, state)) for t in self.terms)

    def stored_force(self, state: MaterialState | None, u: Array) -> tuple[float, Array, Array | None]:
        """Stored energy [J], force (n, d) and its viscous part (n, d) or None [N], of a committed state at u."""
        return self._joined({t.region: t.internal.stored_force(_own(t, state), u[t.nodes]) for t in self.terms})

    def _joined(self, found: Mapping[str, tuple[float, Array, Array | None]]) -> tuple[float, Array, Array | None]:
        """Energy [J], force (n, d) and its viscous part (n, d) or None [N], from those of the regions."""
        force = self._sum((t, found[t.region][1]) for t in self.terms)
        return sum(energy for energy, _, _ in found.values()), force, self._some(lambda t: found[t.region][2])

    def stored_viscous_force(self, state: MaterialState | None) -> Array | None:
        """Viscous part of the force in a committed state, (n, d) [N]; None without viscosity."""
        return self._some(lambda t: t.internal.stored_viscous_force(_own(t, state)))

    def stress(self, u: Array, state: MaterialState | None = None) -> Array:
        """Cauchy stress (e, 3, 3) [Pa] at the end of the slab, or in a committed state, averaged over each element."""
        out = np.zeros((sum(len(term.cells) for term in self.terms), 3, 3))
        for term in self.terms:
            out[term.cells] = term.internal.stress(u[term.nodes], _own(term, state))
        return out

    def stored_scalars(self, state: MaterialState | None) -> dict[str, Array]:
        """Scalars (e,) of a committed state by name, zero in regions without them.

        ``material`` is the number of the law of each element, from one on in the order of the materials of the body.
        """
        count = sum(len(term.cells) for term in self.terms)
        out = {"material": np.zeros(count)}
        for term in self.terms:
            out["material"][term.cells] = term.number + 1
            for name, values in term.internal.stored_scalars(_own(term, state)).items():
                out.setdefault(name, np.zeros(count))[term.cells] = values
        return out

    def volume_ratio(self, u: Array) -> float:
        """Least det F over all points; zero or less where the material is inverted."""
        return min(term.internal.volume_ratio(u[term.nodes]) for term in self.terms)

    def _sum(self, found: Iterator[tuple[Term, Array]]) -> Array:
        """Field (n, d) from the fields (k, d) of the terms."""
        out = np.zeros(self.shape)
        for term, field in found:
            out[term.nodes] += field
        return out

    def _some(self, of: Callable[[Term], Array | None]) -> Array | None:
        """Field (n, d) from those terms that have one; None if none has."""
        found = [(term, field) for term in self.terms if (field := of(term)) is not None]
        return self._sum(iter(found)) if found else None

    def _matrix(self, found: Sequence[tuple[Term, csc_array]]) -> csc_array:
        """Matrix (n d, n d) from those of the terms, on the fixed pattern."""
        data, size = np.zeros(len(self.indices)), len(self.indptr) - 1
        for term, matrix in found:
            data[term.entries] += matrix.data
        return csc_array((data, self.indices, self.indptr), (size, size))


def joined(terms: Sequence[Term], sampled: SampledCells, shape: tuple[int, int]) -> RegionForces:
    """:class:`RegionForces` of terms on nodes (n, d); the pattern of the tangent is the union of theirs."""
    size = shape[0] * shape[1]
    keys = [_keys(term, shape[1], size) for term in terms]
    every = np.unique(np.concatenate(keys))
    column, row = np.divmod(every, size)
    return RegionForces(
        terms=tuple(replace(t, entries=np.searchsorted(every, k)) for t, k in zip(terms, keys, strict=True)),
        sampled=sampled,
        indices=row.astype(np.int32),
        indptr=np.searchsorted(column, np.arange(size + 1)).astype(np.int32),
        shape=shape,
    )


def _keys(term: Term, d: int, size: int) -> IntArray:
    """Numbers ``column size + row`` (z,) in the body of the entries of a tangent."""
    pattern = term.internal.tangent(np.zeros((len(term.nodes), d)))
    place = (term.nodes[:, None] * d + np.arange(d)).ravel()
    columns = np.repeat(place, np.diff(pattern.indptr))
    return np.asarray(columns * size + place[pattern.indices])


def _own(term: Term, state: MaterialState | None) -> MaterialState | None:
    """State of a region in the state of a body."""
    return None if state is None else state.regions.get(term.region)
