"""Free expansion of a solid, of its temperature and its liquid share: the forces of the strain that it would have.

    psi = -sum_i e_i H_i(u),   H_i = int psi_i k ln J dV

with the free strain ``e`` of the nodes, ``k = 3 kappa`` in a volume, ``E / (1 - nu)`` in plane stress and ``E`` in a
bar, and J the ratio of volumes, areas or lengths; for a law of the linear theory the trace of the strain takes the
place of ln J.  In bodies with free faces a law with a history tells the elastic part of ln J, see
:mod:`softway.bodies.internal_force.inelastic.eigenstrain`.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, vstack

from softway.arrays import Array, IntArray
from softway.bodies.assembled.material_states import MaterialStates, own_state
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.heat_functions import heat_functions
from softway.bodies.elements.quadrature import sampled_cells
from softway.bodies.elements.section import Section, free_axes
from softway.bodies.elements.strain_operator import StrainOperator
from softway.bodies.internal_force.body_force import BodyForce
from softway.bodies.internal_force.inelastic.eigenstrain import FreeStrainModuli, dilation
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce
from softway.bodies.internal_force.material_state import MaterialState
from softway.bodies.internal_force.regions import RegionForces
from softway.errors import InputError
from softway.heat.coupled.strain.compiled_expansion import CompiledExpansion, compiled_expansion
from softway.kernels.assembly.assembler import gather_table
from softway.kernels.linalg import tensors
from softway.laws.elasticity.free_faces import condensed
from softway.laws.law import Material, RateLaw, initial_moduli
from softway.laws.strain_measures import Small

SKEW = 1e-9
"""Difference of the thermal stresses along two axes, relative to the greatest, that is rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Expansion:
    """Free expansion of the elements of one law.

    Parameters
    ----------
    solid
        Name of the solid.
    cells
        (e,) their numbers in the solid.
    nodes
        (k,) their nodes among those of all solids; a slice of consecutive ones.
    values
        (p, k) functions of heat at the quadrature points.
    sampling
        Strain operator of the law.
    directions
        (p, m, D) or (1, m, D) reference directions of the points.
    small
        True for a law of the linear theory.
    modulus, held
        Stress that a free strain of one along each axis takes where it is held, k [Pa], and the number of axes along
        which it is: in plane strain the one out of the plane, too.
    compiled
        Energies and forces by kernels; None where there are none for the elements.
    number, region
        Number of the solid, and name of the region of the law; empty for a solid of one law.
    relieved
        Moduli of a law with a history in a body with free faces, which knows an eigenstrain; None for other laws.
    """

    solid: str
    cells: IntArray
    nodes: IntArray | slice
    values: csr_array
    sampling: StrainOperator
    directions: Array
    small: bool
    modulus: float
    held: int
    compiled: CompiledExpansion | None = None
    number: int = 0
    region: str = ""
    relieved: FreeStrainModuli | None = None

    def stress(self, free: Array, factor: Array, u: Array, states: MaterialStates) -> Array:
        """Mean Cauchy stress (e, 3, 3) [Pa] of free strains (n,) of the nodes, at ``u`` (n, d).

        It is that in the axes of the section; a bar has it along its axis, but in its own axes beside a law with a
        history, whose stress is in these.

        Parameters
        ----------
        free
            Free strains times the ``factor`` of the moduli.
        factor
            (n,) factor of the moduli.
        u, states
            Displacement [m], and material states of all solids, of which the law knows the eigenstrains.
        """
        if self.relieved is not None:
            return self._beside(free, factor, u, own_state(states, self.number, self.region))
        H, (pressure, ratio) = self.sampling.derivatives(u[self.nodes]), self.pressures(free, u)
        m, size = H.shape[-2:]
        mean, axes = -self.sampling.cell_means(pressure, self.sampling.volume * ratio), np.zeros((len(H), 3, 3))
        if m == size:
            axes[:] = self._held_axes()
        else:
            along = np.broadcast_to(self.directions, H.shape)[:, 0] + (0.0 if self.small else H[:, 0])
            along /= np.linalg.norm(along, axis=1)[:, None]
            axes[:, :size, :size] = along[:, :, None] * along[:, None, :]
        return np.asarray(mean[:, None, None] * self.sampling.cell_means(axes, self.sampling.volume))

    def pressures(self, free: Array, u: Array) -> tuple[Array, Array]:
        """Pressures (p,) [Pa] of free strains (n,) where all axes are held, at ``u`` (n, d), and ratios of volumes."""
        change = self.change(u[self.nodes])[0]
        ratio = np.ones(len(change)) if self.small else np.exp(change)
        return self.modulus * (self.values @ free[self.nodes]) / ratio, ratio

    def _beside(self, free: Array, factor: Array, u: Array, state: MaterialState) -> Array:
        """Mean stress (e, 3, 3) [Pa] of what the free strains are more than the eigenstrain of a law with a history."""
        at, known = self.values @ free[self.nodes], state.eigenstrain
        if known is not None:
            at = at - (self.values @ factor[self.nodes]) * known
        ratio = np.exp(self.change(u[self.nodes])[0]) * state.lateral.prod(axis=1)
        mean = self.sampling.cell_means(self.modulus * at / ratio, self.sampling.volume * ratio)
        return np.asarray(-mean[:, None, None] * self._held_axes())

    def _held_axes(self) -> Array:
        """Stress (3, 3) of a unit stress along each of the axes that are held."""
        return np.diag([1.0] * self.held + [0.0] * (3 - self.held))

    def change(self, u: Array) -> tuple[Array, Array]:
        """Change of volume (p,), ln J or the trace of the strain, and its derivative (p, m, D) by the derivatives."""
        H, g = self.sampling.derivatives(u), self.directions
        if self.small:
            return tensors.double_dot(np.broadcast_to(g, H.shape), H), np.broadcast_to(g, H.shape)
        return dilation(H, g)

    def elastic(self, change: Array, states: MaterialStates) -> tuple[Array, MaterialState | None]:
        """Elastic part (p,) of a ``change`` (p,) of volume, and the state of a law that knows an eigenstrain."""
        if self.relieved is None:
            return change, None
        state = own_state(states, self.number, self.region)
        assert state.eigenstrain is not None
        return self.relieved.energy(change, state.lateral, state.eigenstrain) / self.modulus, state

    def flow(self, start: MaterialState, end: MaterialState, change: Array, span: float) -> Array:
        """Energies (3, k) of the inelastic ``change`` (p,) of volume in a slab at the nodes [J], see
        :meth:`Strained.flow`.
        """
        assert start.eigenstrain is not None and end.eigenstrain is not None
        size = self.modulus * self.sampling.volume * change
        rows = [size, 0.5 * (start.eigenstrain + end.eigenstrain) * size, np.zeros_like(size)]
        factor = start.coming_stiffness(span)
        if factor is not None and start.stiffness is not None:
            spent = self.sampling.volume * (end.dissipated - start.dissipated)
            rows[1] = rows[1] + spent / (0.5 * (start.stiffness + factor))
            rows[2] = -spent
        return np.stack([self.values.T @ row for row in rows])


@dataclass(frozen=True, slots=True, eq=False)
class Strained:
    """Solids with n nodes at a displacement: of each expansion that (k, d) of its nodes and, where it is not compiled,
    the change of volume (p,) and its derivative (p, m, D), and the elastic part of that change with the state of a law
    that knows an eigenstrain.
    """

    expansions: tuple[Expansion, ...]
    own: tuple[Array, ...]
    changes: tuple[tuple[Array, Array] | None, ...]
    elastic: tuple[tuple[Array, MaterialState | None] | None, ...]
    n: int

    def held(self) -> Array:
        """Energies (n,) that free strains of one of the nodes would take from the elastic strain, H [J]."""
        out = np.zeros(self.n)
        for it, own, found in zip(self.expansions, self.own, self.elastic, strict=True):
            if it.compiled is not None:
                out[it.nodes] += it.compiled.held(own)
            elif found is not None:
                out[it.nodes] += it.values.T @ (it.modulus * it.sampling.volume * found[0])
        return out

    def flow(self, start: "Strained", span: float) -> Array | None:
        """Energies (3, n) of inelastic strain in a slab of length ``span`` [s] at the nodes [J]; None without.

        With the potentials of free strain and elastic energy, and one, they are the work of the stress that the laws
        did not know: that of the free strain less the eigenstrain, and of the factor of the moduli less the expected.
        """
        if all(it.relieved is None for it in self.expansions):
            return None
        out = np.zeros((3, self.n))
        for k, it in enumerate(self.expansions):
            first, last, before, after = start.changes[k], self.changes[k], start.elastic[k], self.elastic[k]
            if first is None or last is None or before is None or after is None:
                continue
            if before[1] is not None and after[1] is not None:
                change = (last[0] - first[0]) - (after[0] - before[0])
                out[:, it.nodes] += it.flow(before[1], after[1], change, span)
        return out

    def forces(self, free: Array, dim: int) -> Array:
        """Forces (c, n, d) [N] of each of the free strains (c, n) of the nodes."""
        out = np.zeros((*free.shape, dim))
        for it, own, found in zip(self.expansions, self.own, self.changes, strict=True):
            if it.compiled is not None:
                out[:, it.nodes] += it.compiled.forces(own, free[:, it.nodes])
            elif found is not None:
                for one, strain in zip(out, free, strict=True):
                    stress = -it.modulus * (it.values @ strain[it.nodes])
                    one[it.nodes] += it.sampling.nodal(stress[:, None, None] * found[1], own)
        return out


def strained(expansions: tuple[Expansion, ...], u: Array, states: MaterialStates = ()) -> Strained:
    """Solids in material states, with some ``expansions``, at the displacement ``u`` (n, d) [m]."""
    own = tuple(u[it.nodes] for it in expansions)
    changes = tuple(
        None if it.compiled is not None else it.change(mine) for it, mine in zip(expansions, own, strict=True)
    )
    elastic = (None if found is None else it.elastic(found[0], states)
               for it, found in zip(expansions, changes, strict=True))  # fmt: skip
    return Strained(expansions, own, changes, tuple(elastic), len(u))


def expansions(number: int, part: DiscreteSolid) -> Iterator[Expansion]:
    """Free expansions of the laws of the solid of this ``number``.

    Raises
    ------
    InputError
        If a law has no isotropic resistance to a change of volume.
    """
    section, whole = part.internal.section, point_values(part)
    for region, cells, nodes, points, internal, law in pieces(part):
        modulus = thermal_stiffness(law, section, f"material.{region}" if region else "material")
        small = not isinstance(law, RateLaw) and isinstance(law.measure, Small)
        yield Expansion(
            solid=part.name,
            cells=cells,
            nodes=part.nodes if len(nodes) == part.mesh.n_nodes else nodes + part.nodes.start,
            values=csr_array(whole[points][:, nodes]),
            sampling=internal.sampling,
            directions=internal.directions,
            small=small,
            modulus=modulus,
            held=3 - len(free_axes(section)),
            compiled=compiled_expansion(part, internal.sampling, cells, nodes, modulus, small),
            number=number,
            region=region,
            relieved=internal.points.moduli_of_free_strain if isinstance(internal, InelasticForce) else None,
        )


def thermal_stiffness(law: Material, section: Section, where: str = "material") -> float:
    """Stress for a strain of one along each axis of the section [Pa]: 3 kappa, E/(1 - nu) in plane stress, E in a bar.

    Raises
    ------
    InputError
        If the law is not isotropic, or does not resist a change of volume.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar, PlaneStress, Volume
    >>> from softway.laws.bulk import LinearElastic
    >>> steel = LinearElastic(E=3.0, nu=0.25)
    >>> [round(thermal_stiffness(steel, section), 9) for section in (Volume(), PlaneStress(), Bar())]
    [6.0, 4.0, 3.0]
    """
    free = free_axes(section)
    stress = np.einsum("ijkk->ij", condensed(initial_moduli(law), 3 - len(free), free))
    found, size = float(stress[0, 0]), float(np.abs(stress).max())
    if not 0.0 < found < np.inf:
        problem = f"expansion of {type(law).__name__}, which does not resist a change of volume"
        raise InputError(where, problem, "thermal.expansion = 0, or a law with an elastic part")
    if np.abs(stress - found * np.eye(len(stress))).max() > SKEW * size:
        problem = f"expansion of {type(law).__name__}, which is not isotropic"
        raise InputError(where, problem, "thermal.expansion = 0, or an isotropic law")
    return found


def pieces(part: DiscreteSolid) -> Iterator[tuple[str, IntArray, IntArray, IntArray, BodyForce, Material]]:
    """Region, cells (e,), nodes (k,), points (q,), internal force and law of each law of a solid."""
    internal, materials = part.internal, part.materials
    if isinstance(internal, RegionForces):
        for term in internal.terms:
            yield term.region, term.cells, term.nodes, term.points, term.internal, materials.laws[term.number]
    else:
        points = np.arange(len(internal.sampling.volume))
        yield "", np.arange(part.mesh.n_cells), np.arange(part.mesh.n_nodes), points, internal, materials.laws[0]


def point_values(part: DiscreteSolid) -> csr_array:
    """Functions (p, n) of heat of the nodes at the quadrature points of a solid."""
    kinds = sampled_cells(part.mesh, part.internal.section, "point", small=False).kinds
    tables = [gather_table(cells.nodes, heat_functions(cells)[..., None], part.mesh.n_nodes) for cells in kinds]
    return csr_array(vstack(tables, format="csr"))
