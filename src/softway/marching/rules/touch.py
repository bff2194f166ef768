"""Effect of a touch inside a slab on nodes with inertia: literal (Paper) or mass-consistent (Impulse)."""

from dataclasses import dataclass
from typing import ClassVar, Literal, Protocol

import numpy as np
from scipy import sparse

from softway.arrays import Array, BoolArray
from softway.contact.contact_rows import ContactRows
from softway.contact.slab_motion.trajectory import ContactEvents
from softway.contact.slab_motion.trapezoid_triangle import TrapezoidTriangle
from softway.errors import InputError
from softway.kernels.linalg.dense import solve_dense
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.model.time_weight import TimeWeight
from softway.solve.constraints.impact_multipliers import ImpactMultipliers
from softway.solve.equations.mean_force import MeanForce, SplitMean, WeightedMean


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class VelocityJump:
    """Velocity jump: ``instant`` tau, rows ``hits`` (m,), velocity change ``field`` (n, d), normal impulses (m,), and
    normal velocities ``speed`` (m,) of the hit rows just before the jump.
    """

    instant: float
    hits: BoolArray
    field: Array
    impulse: Array
    speed: Array


class Touch(Protocol):
    """Effect of a touch on the velocity field."""

    balanced: ClassVar[bool]
    """True if all nodes take part in the jump, so that momentum is balanced."""

    @property
    def inertia(self) -> ImpactMultipliers:
        """Mass of all nodes."""
        ...

    def average(self, weight: TimeWeight) -> MeanForce:
        """Average of the internal force over a slab."""
        ...

    def slope(self, rows: ContactRows, now: ModelState, span: float, solved: Array) -> Array:
        """Change (m,) of the normal velocities before a touch, over a slab [m/s]; ``solved`` (m,) is computed."""
        ...

    def jump(self, model: Model, rows: ContactRows, approach: Array, hits: BoolArray) -> tuple[Array, Array] | None:
        """Velocity change (n, d) of the touching nodes alone, and its impulses (m,); None if all nodes take part.

        ``approach`` (m,) are the normal velocities of the hit rows.
        """
        ...

    def loss(
        self,
        model: Model,
        rows: ContactRows,
        events: ContactEvents,
        found: tuple[VelocityJump, ...],
        v: tuple[Array, Array],
        span: float,
    ) -> float:
        """Kinetic energy lost in the jumps of a slab [J]; ``v`` are the velocities (n, d) at its ends."""
        ...


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InelasticImpact:
    """Mass-consistent jump: every node moves, so that momentum is balanced."""

    balanced: ClassVar[bool] = True

    inertia: ImpactMultipliers

    def average(self, weight: TimeWeight) -> MeanForce:
        """Mean by the virtual time function."""
        return WeightedMean(weight)

    def slope(self, rows: ContactRows, now: ModelState, span: float, solved: Array) -> Array:
        """Return the computed change."""
        return solved

    def jump(self, model: Model, rows: ContactRows, approach: Array, hits: BoolArray) -> None:
        """Return None: all nodes take part."""

    def loss(
        self,
        model: Model,
        rows: ContactRows,
        events: ContactEvents,
        found: tuple[VelocityJump, ...],
        v: tuple[Array, Array],
        span: float,
    ) -> float:
        """Half the product of impulses and approach speeds [J]."""
        total = 0.0
        for jump in found:
            total -= 0.5 * float(jump.impulse @ jump.speed)
        return total


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class NodalStop:
    """Literal rule: only the normal velocity of the touching node is reset.

    Its row of the mass matrix determines the lost momentum.  Between two bodies the nodes on both sides share the
    change, weighted by the sums of their mass rows.  All nodes take part in the touches of nodes ``shared``.

    Parameters
    ----------
    inertia
        Mass of all nodes, for the touches that all of them take part in.
    shared
        (n,) nodes without an inertia of their own, see :func:`without_own_inertia`.
    approach
        Velocity before the instant: kept or extrapolated from the slab before.
    split
        Trapezoid and triangle in place of the product elements at a touch (Fig. 4); None for product elements.
    """

    balanced: ClassVar[bool] = False

    inertia: ImpactMultipliers
    shared: BoolArray
    approach: Literal["kept", "extrapolated"] = "kept"
    split: TrapezoidTriangle | None = None

    def average(self, weight: TimeWeight) -> MeanForce:
        """Mean by the virtual time function, with split elements if there are any."""
        weighted = WeightedMean(weight)
        return weighted if self.split is None else SplitMean(weighted, self.split)

    def slope(self, rows: ContactRows, now: ModelState, span: float, solved: Array) -> Array:
        """Change of the previous slab, or zero."""
        return (
            span * rows.normal_component(now.acceleration) if self.approach == "extrapolated" else np.zeros_like(solved)
        )

    def jump(self, model: Model, rows: ContactRows, approach: Array, hits: BoolArray) -> tuple[Array, Array] | None:
        """Velocity change (n, d) of only the nodes of the hit rows, and its impulses (m,); None if one is shared."""
        inertia = np.asarray(model.mass.sum(axis=1)).reshape(-1, 1)
        index = np.flatnonzero(hits & rows.reachable(model.dofs))
        some = rows.gradient[index]
        nodes = np.unique(some.tocoo().coords[1] // model.shape[1])
        if self.shared[nodes].any():
            return None
        if nodes.size <= np.unique(rows.node[index]).size:
            field = rows.motion(-approach, hits, model.free)
            return field, rows.normal_forces(inertia * field, hits, model.free)
        mobility = np.where(model.free & (inertia > 0.0), 1.0 / np.where(inertia > 0.0, inertia, 1.0), 0.0).ravel()
        impulse = np.zeros(len(hits))
        impulse[index] = solve_dense((some @ sparse.diags_array(mobility) @ some.T).toarray(), -approach[index])
        return mobility.reshape(model.shape) * rows.spread(impulse, model.shape), impulse

    def loss(
        self,
        model: Model,
        rows: ContactRows,
        events: ContactEvents,
        found: tuple[VelocityJump, ...],
        v: tuple[Array, Array],
        span: float,
    ) -> float:
        """``-(v . M J + J . M J / 2)`` with v just before each jump J [J]."""
        total, tool = 0.0, rows.tool_motion / span
        before, smooth = v[0], v[1] - sum((jump.field for jump in found), v[0])
        for jump in found:
            at = before + jump.instant * smooth
            before = before + jump.field
            stopped = (events.closed & ~np.isfinite(events.touch)) | (events.touch < jump.instant)
            normal = np.where(jump.hits, jump.speed + tool, np.where(stopped, tool, rows.normal_component(at)))
            at = at + rows.motion(normal - rows.normal_component(at), events.kinked, model.free)
            total += float(jump.impulse @ tool) - model.space.total((at + 0.5 * jump.field) * (model.mass @ jump.field))
        return total


def without_own_inertia(model: Model) -> BoolArray:
    """Nodes (n,) that create energy when they are stopped alone in uniform motion.

    Their rows of the mass have a sum below half the diagonal: corners of quadratic simplices and serendipity cells.
    """
    return np.asarray(np.asarray(model.mass.sum(axis=1)).ravel() < 0.5 * model.mass.diagonal())


def split_elements(model: Model) -> TrapezoidTriangle:
    """Two-node bars at the contact rows, for the split of Fig. 4.

    Raises
    ------
    InputError
        If the scene does not consist of straight two-node bars of LinearElastic in one dimension with contact at their
        ends.
    """
    where = "contacts[0].timing.split"
    bars = model.shape[1] == 1 and all(set(p.mesh.blocks) == {"bar2"} for p in model.parts)
    if not (bars and model.linear):
        raise InputError(where, "'triangle' is for two-node bars of LinearElastic in 1D", "split = 'product'")
    stiffness = model.tangent(np.zeros(model.shape)).tocsr()
    inner, value = [], []
    for node in model.contacts.node:
        row = stiffness[[node]].tocoo()
        others = row.coords[1] != node
        if others.sum() != 1:
            raise InputError(where, f"node {node} is not the end of a bar", "contact tags at the ends of bars")
        inner.append(int(row.coords[1][others][0]))
        value.append(-float(row.data[others][0]))
    return TrapezoidTriangle(inner=np.array(inner, int), stiffness=np.array(value))
