"""Ties that break: a cohesive law between two surfaces, with the damage as a companion field
(docs/theory/contact/cohesion.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.elements.section import Axisymmetric
from softway.contact.assembly.tie import Tie
from softway.contact.assembly.tied_surfaces import TiedSurfaces
from softway.contact.mortar.jump import Jump, end_jump, jump
from softway.errors import InputError
from softway.laws.cohesive_law import BilinearCohesive
from softway.model.field import Field, FieldEquations, FieldSlab, FieldSolution, FieldState


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CohesiveTie:
    """One tie that breaks.

    Parameters
    ----------
    tie, number
        Its declaration, and its number among the ties of the scene.
    law
        Its law.
    jump
        Jump between the surfaces; its areas are those of the section [m^2].
    part
        Number of the solid that has its energy.
    """

    tie: Tie
    number: int
    law: BilinearCohesive
    jump: Jump
    part: int

    def opened(self, u: Array, x: Array) -> tuple[Array, Array, Array]:
        """Jump (m, d), its normal part (m,), positive if open [m], and the normals (m, d), at the displacement ``u``
        and the positions ``x`` (n, d).
        """
        leap, normal = np.asarray(self.jump.rows @ u), self.jump.normals.at(x)
        return leap, np.asarray(np.einsum("md,md->m", leap, normal)), normal

    def effective(self, leap: Array, opening: Array) -> tuple[Array, Array]:
        """Opening (m,) that damages [m], and the share (m,) of sliding in its energy; closing does not damage."""
        square = np.einsum("md,md->m", leap, leap)
        open_ = np.maximum(opening, 0.0) ** 2
        slide = np.maximum(square - opening**2, 0.0)
        total = open_ + slide
        return np.sqrt(total), np.where(total > 0.0, slide / np.where(total > 0.0, total, 1.0), 0.0)

    def grown(self, damage: Array, u: Array, x: Array) -> tuple[Array, Array]:
        """Damage (m,) after the displacement ``u`` from one before, and the energy dissipated by it [J/m^2]."""
        size, mode = self.effective(*self.opened(u, x)[:2])
        new = np.maximum(damage, self.law.damage(size, mode))
        lost = self.law.dissipated(new, mode) - self.law.dissipated(damage, mode)
        return new, np.where(new > damage, lost, 0.0)

    def stored(self, damage: Array, u: Array, x: Array) -> tuple[float, Array]:
        """Energy [J] and force (n, d) [N] with a damage (m,)."""
        leap, opening, normal = self.opened(u, x)
        closed, whole = np.minimum(opening, 0.0), 1.0 - damage
        stiffness = self.law.stiffness * self.jump.area
        energy = 0.5 * stiffness @ (whole * np.einsum("md,md->m", leap, leap) + damage * closed**2)
        traction = stiffness[:, None] * (whole[:, None] * leap + (damage * closed)[:, None] * normal)
        return float(energy), np.asarray(self.jump.rows.T @ traction)

    def held(self, damage: Array, u: Array, x: Array) -> Array:
        """Derivative (m, d, d) of the tractions times area by the jumps at a constant damage (m,) and normal."""
        leap, opening, normal = self.opened(u, x)
        pressed = (damage * (opening < 0.0))[:, None, None] * normal[:, :, None] * normal[:, None, :]
        whole = (1.0 - damage)[:, None, None] * np.eye(leap.shape[1])
        return (self.law.stiffness * self.jump.area)[:, None, None] * (whole + pressed)

    def stiffness(self, damage: Array, u: Array, x: Array) -> Array:
        """Derivative (m, d, d) of the tractions times area by the jumps, symmetric: at a constant mode and normal."""
        leap, opening, normal = self.opened(u, x)
        size, mode = self.effective(leap, opening)
        reached = self.law.damage(size, mode)
        grows, new = reached >= damage, np.maximum(reached, damage)
        slope = np.where(grows, self.law.slope(size, mode), 0.0) / np.where(size > 0.0, size, 1.0)
        pulled = leap - np.minimum(opening, 0.0)[:, None] * normal
        unit = np.eye(leap.shape[1])
        out = (1.0 - new)[:, None, None] * unit
        out = out - slope[:, None, None] * pulled[:, :, None] * pulled[:, None, :]
        out = out + (new * (opening < 0.0))[:, None, None] * normal[:, :, None] * normal[:, None, :]
        return (self.law.stiffness * self.jump.area)[:, None, None] * out


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CohesiveTies:
    """:class:`~softway.model.field.FieldEquations` of the damage of all ties that break, one component for each.

    Parameters
    ----------
    ties
        The ties.
    points
        (n, d) reference positions [m].
    parts
        Number of the solids.
    damage
        (n, ties) damage at the start of the slab.
    """

    ties: tuple[CohesiveTie, ...]
    points: Array
    parts: int
    damage: Array

    @property
    def field(self) -> Field:
        """The damage: zero intact, one broken."""
        return Field(name="damage", unit="1", components=len(self.ties))

    def initial(self) -> Array:
        """No damage (n, ties)."""
        return np.zeros((len(self.points), len(self.ties)))

    def during(self, start: FieldState) -> "CohesiveTies":
        """Ties in a slab that starts from a state."""
        return replace(self, damage=start.values)

    def at(self, values: Array, u: Array) -> FieldState:
        """State with the damage ``values`` (n, ties) at the displacement ``u`` (n, d)."""
        energy, force = np.zeros(self.parts), np.zeros_like(u)
        x = self.points + u
        for k, tie in enumerate(self.ties):
            own, pull = tie.stored(values[tie.jump.node, k], u, x)
            energy[tie.part] += own
            force += pull
        return FieldState(values=values, energy=energy, force=force)

    def solve(self, slab: FieldSlab) -> FieldSolution:
        """Damage at the end of a slab, with the energy that it dissipates."""
        values, lost = slab.start.values.copy(), np.zeros(self.parts)
        x = self.points + slab.u1
        for k, tie in enumerate(self.ties):
            new, spent = tie.grown(values[tie.jump.node, k], slab.u1, x)
            values[tie.jump.node, k] = new
            lost[tie.part] += tie.jump.area @ spent
        end = self.at(values, slab.u1)
        mean = slab.first * slab.start.force + (1.0 - slab.first) * end.force
        return FieldSolution(end=end, mean_force=mean, lost=lost)

    @property
    def rows(self) -> sp.csr_array:
        """Jumps (m, n) of all ties from a component of the displacement."""
        return sp.csr_array(sp.vstack([tie.jump.rows for tie in self.ties]))

    def stiffness(self, u: Array) -> Array:
        """Stiffnesses (m, d, d) of the jumps of all ties at the displacement ``u`` (n, d) [N/m]."""
        x = self.points + u
        return np.concatenate([t.stiffness(self.damage[t.jump.node, k], u, x) for k, t in enumerate(self.ties)])

    def held(self, u: Array) -> Array:
        """Stiffnesses (m, d, d) of the jumps of all ties with the damage that they have [N/m]."""
        x = self.points + u
        return np.concatenate([t.held(self.damage[t.jump.node, k], u, x) for k, t in enumerate(self.ties)])

    def tangent_product(self, u: Array, w: Array) -> Array:
        """Product (n, d) of the derivative of the force with a field ``w`` (n, d) [N]."""
        return np.asarray(self.rows.T @ np.einsum("mij,mj->mi", self.stiffness(u), self.rows @ w))

    def tangent_blocks(self, u: Array) -> Array:
        """Diagonal blocks (n, d, d) of the derivative of the force [N/m]."""
        blocks = self.stiffness(u)
        square = sp.csr_array(self.rows.multiply(self.rows).T)
        return np.asarray(square @ blocks.reshape(len(blocks), -1)).reshape(-1, *blocks.shape[1:])


def cohesive_ties(
    pairs: Sequence[TiedSurfaces], parts: Sequence[DiscreteSolid], points: Array
) -> tuple[CohesiveTies, ...]:
    """Ties that break, from their surfaces at the reference positions ``points`` (n, d); empty without."""
    found = tuple(_tie(pair, pair.tie.breaks, parts, points) for pair in pairs if pair.tie.breaks is not None)
    if not found:
        return ()
    return (CohesiveTies(ties=found, points=points, parts=len(parts), damage=np.zeros((len(points), len(found)))),)


def damaged(companions: tuple[FieldEquations, ...], fields: Sequence[FieldState]) -> tuple[FieldEquations, ...]:
    """Companion fields in a slab that starts from their states: ties have their damage."""
    pairs = zip(companions, fields, strict=True)
    return tuple(c.during(state) if isinstance(c, CohesiveTies) else c for c, state in pairs)


def intact(bonds: tuple[CohesiveTies, ...], u: Array) -> tuple[CohesiveTies, ...]:
    """The ties, which the initial displacement ``u`` (n, d) must leave intact.

    Raises
    ------
    InputError
        If it damages one.
    """
    for tie in (tie for bond in bonds for tie in bond.ties):
        x = bonds[0].points + u
        if tie.grown(np.zeros(len(tie.jump.node)), u, x)[0].any():
            size, mode = tie.effective(*tie.opened(u, x)[:2])
            least = float(tie.law.openings(mode)[0].min())
            problem = f"the initial displacement opens it by {size.max():.3g} m; above {least:.3g} m it is damaged"
            remedy = f"the same displacement on {' and '.join(tie.tie.between)}"
            raise InputError(f"ties[{tie.number}].breaks", problem, remedy)
    return bonds


def with_glue(tangent: sp.csc_array, glue: Sequence[CohesiveTies], u: Array) -> sp.csc_array:
    """Tangent stiffness (n d, n d) with that of ties at the displacement ``u`` (n, d), with the damage that they have
    [N/m].
    """
    d = u.shape[1]
    for one in glue:
        rows, blocks = sp.csr_array(sp.kron(one.rows, sp.eye_array(d), format="csr")), one.held(u)
        m = len(blocks)
        springs = sp.bsr_array((blocks, np.arange(m), np.arange(m + 1)), shape=(m * d, m * d))
        tangent = sp.csc_array(tangent + rows.T @ springs @ rows)
    return tangent


def _tie(pair: TiedSurfaces, law: BilinearCohesive, parts: Sequence[DiscreteSolid], points: Array) -> CohesiveTie:
    """One tie that breaks."""
    first, second = pair.ordered
    if first.side.dim == 1:
        made = end_jump(int(first.side.nodes[0]), int(second.side.nodes[0]), float(first.side.ends[0]), len(points))
    else:
        reach = float(max(first.edge, second.edge))
        made = jump(first.side.facets, second.side.facets, points, reach)
    number = {part.name: k for k, part in enumerate(parts)}
    names = pair.tie.bodies if first is pair.surfaces[0] else pair.tie.bodies[::-1]
    own, other = (parts[number[name]] for name in names)
    if any(isinstance(part.internal.section, Axisymmetric) for part in (own, other)):
        problem, remedy = "a cohesive law on bodies of revolution", "a tie without breaks, or a model in space"
        raise InputError(f"ties[{pair.number}].breaks", problem, remedy)
    place = points[made.node]
    width = np.minimum(own.internal.section.measure(place), other.internal.section.measure(place))
    return CohesiveTie(
        tie=pair.tie, number=pair.number, law=law, jump=replace(made, area=made.area * width), part=number[names[0]]
    )
