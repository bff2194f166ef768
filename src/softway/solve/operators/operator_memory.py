"""Operator memory: the frozen operator that slabs share, and the rule for its renewal.

The operator itself is a cache: :class:`OperatorOrigin` describes how it was made, and
:func:`softway.solve.operators.operator_refresh.restored` makes it again with the same bits.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from softway.arrays import Array, IntArray
from softway.bodies.assembled.contact_layer import Layer
from softway.bodies.assembled.material_states import MaterialStates
from softway.model.field import FieldState
from softway.model.model import Model
from softway.solve.constraints.compliance import FrozenOperator
from softway.solve.equations.slab_equations import SlabEquations
from softway.solve.equations.slab_matrix import SlabMatrix
from softway.solve.linear.interface import Analysis, Factor
from softway.solve.operators import Operator, OperatorChoice
from softway.solve.operators.nodal_rotation import NodalRotation

USUAL = 6
"""Usual number of iterations of a slab with a new factor."""
WORN = 1.5
"""Multiple of the least number of iterations since the last factor below which the factor is kept."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OperatorOrigin:
    """Origin of an operator: all data needed to make it again.

    Parameters
    ----------
    operator, analyst
        Declared operators that made it, and that did its symbolic work; None for central differences, and without
        symbolic work.
    at
        (n, d) displacement where it was made [m].
    states, span
        History of the materials, and length of the slab [s].
    stiffness_factor, viscous_factor, positive_definite
        As for :class:`~softway.solve.equations.slab_matrix.SlabMatrix`.
    fields
        Companion fields at the start of the slab.
    """

    operator: Operator | None
    analyst: Operator | None
    at: Array
    states: MaterialStates
    span: float
    stiffness_factor: float
    viscous_factor: float
    positive_definite: bool = False
    fields: tuple[FieldState, ...] = ()

    @classmethod
    def of(
        cls, system: SlabEquations, at: Array, operator: Operator | None = None, analyst: Operator | None = None
    ) -> "OperatorOrigin":
        """Origin of an operator of this slab."""
        matrix = system.stiffness
        return cls(
            operator=operator,
            analyst=analyst,
            at=at,
            states=system.start.states,
            span=system.path.span,
            stiffness_factor=matrix.stiffness_factor,
            viscous_factor=matrix.viscous_factor,
            positive_definite=matrix.positive_definite,
            fields=system.start.fields if _dependent(system.model) else (),
        )

    def stiffness(self, model: Model) -> SlabMatrix:
        """Matrix that was inverted."""
        return SlabMatrix(
            model=model.during(self.states, self.span).bonded(self.fields),
            stiffness_factor=self.stiffness_factor,
            viscous_factor=self.viscous_factor,
            positive_definite=self.positive_definite,
        )


def _dependent(model: Model) -> bool:
    """True if the operator depends on companion fields: on the damage of ties, or on temperatures."""
    return bool(model.bonds) or any(part.factor is not None for part in model.parts)


@dataclass(frozen=True, slots=True, kw_only=True)
class IterationCount:
    """Iterations of successive slabs: number of slabs, total, least of a slab, and those of the last two slabs.

    Examples
    --------
    >>> IterationCount().with_slab(7).with_slab(5).with_slab(6)
    IterationCount(slabs=3, total=18, least=5, last=(5, 6))
    """

    slabs: int = 0
    total: int = 0
    least: int = 0
    last: tuple[int, ...] = ()

    def with_slab(self, iterations: int) -> "IterationCount":
        """Iteration count with one more slab."""
        least = min(self.least, iterations) if self.slabs else iterations
        last = (*self.last[-1:], iterations)
        return IterationCount(slabs=self.slabs + 1, total=self.total + iterations, least=least, last=last)

    def with_slabs(self, iterations: Sequence[int]) -> "IterationCount":
        """Iteration count with several more slabs, as :meth:`with_slab` for each of them.

        Examples
        --------
        >>> IterationCount().with_slab(7).with_slabs([5, 6])
        IterationCount(slabs=3, total=18, least=5, last=(5, 6))
        """
        if not iterations:
            return self
        least = min(self.least, *iterations) if self.slabs else min(iterations)
        return IterationCount(
            slabs=self.slabs + len(iterations),
            total=self.total + sum(iterations),
            least=least,
            last=(*self.last, *iterations)[-2:],
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Skin:
    """Stiffness of all massless nodes, for central differences.

    Parameters
    ----------
    origin
        Origin of the stiffness.
    remaining
        Fraction of the unbalanced forces that the last correction left.
    before
        Greatest unbalanced force before a single correction, away from contact [N]; zero between slabs.
    worn
        True if the stiffness has to be renewed.
    factor
        Factor of the stiffness.
    """

    origin: OperatorOrigin
    remaining: float = 1.0
    before: float = 0.0
    worn: bool = False
    factor: Factor | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Near:
    """Massless nodes (k,) near contact, with the cells around them, for central differences."""

    nodes: IntArray
    layer: Layer | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OperatorMemory:
    """Frozen operator and its statistics, passed from slab to slab.

    It may be dropped: the next slab then makes its own operator, with results that differ by rounding.

    Parameters
    ----------
    frozen
        Operator.
    origin
        Origin of the operator; None before the first one.
    mixed, batches
        For memories made by :meth:`bare`: True if all contact directions are components, and the columns of the
        compliance in the batches in which they were computed.
    choice
        Declared operator with the reason of its choice.
    span
        Slab length that ``frozen`` serves, for the default time weight [s].
    analysis
        Symbolic work of the factor, the same for all slab lengths.
    turning
        Sampling of the nodal rotations.
    stale
        True if the next slab needs a new factor.
    factorisations
        Number of factors made so far.
    renewals
        Number of these that the fixed point made inside slabs, at an iterate.
    taken
        Iterations of the slabs since the last factor.
    price
        Cost of a factor, in iterations.
    skin, near
        For central differences, where ``frozen`` is the operator of the nodes near contact.
    room, others
        Greatest number of operators of other slab lengths that are kept, and their memories, the last used first: zero
        and none unless the march chooses its lengths by a tolerance.
    """

    frozen: FrozenOperator | None = None
    origin: OperatorOrigin | None = None
    mixed: bool = False
    batches: tuple[IntArray, ...] = ()
    choice: OperatorChoice | None = None
    span: float = 0.0
    analysis: Analysis | None = None
    turning: NodalRotation | None = None
    stale: bool = False
    factorisations: int = 0
    renewals: int = 0
    taken: IterationCount = IterationCount()
    price: float = 0.0
    skin: Skin | None = None
    near: Near | None = None
    room: int = 0
    others: tuple["OperatorMemory", ...] = ()

    def failed(self) -> "OperatorMemory":
        """Memory after a slab without solution: everything is renewed."""
        return replace(self, stale=True, skin=None, near=None, others=())

    def serving(self, span: float) -> "OperatorMemory":
        """Memory with the operator of the slab length ``span`` [s] if it is among the others that are kept.

        The present one is kept in its place; without one of this length it stays present, for its symbolic work.
        """
        if not self.room or self.stale or self.origin is None or self.serves(span):
            return self
        present, kept = replace(self, others=()), [m for m in self.others if m.serves(span)]
        others = (present, *(m for m in self.others if m not in kept))[: self.room]
        if not kept:
            return replace(self, others=others)
        return replace(kept[0], others=others, factorisations=self.factorisations, renewals=self.renewals)

    def serves(self, span: float) -> bool:
        """True if the operator is that of the slab length ``span`` [s] of the default time weight."""
        return abs(self.span / span - 1.0) <= 1e-9

    def after(self, iterations: int) -> "OperatorMemory":
        """Memory after a slab with a number of iterations; it requests a new factor if this saves time.

        The slab is too expensive if the last two slabs took more iterations than the mean since the last factor,
        including the price of the factor: renewing the factor is then cheaper than keeping it.
        """
        taken = self.taken.with_slab(iterations)
        recent = 0.5 * sum(taken.last)
        mean = (taken.total + self.price) / taken.slabs
        dear = taken.slabs > 1 and recent > max(mean, WORN * max(taken.least, USUAL))
        return replace(self, taken=taken, stale=self.stale or dear)

    def bare(self) -> "OperatorMemory":
        """Memory without its operator, which can be made again with the same bits."""
        light = replace(
            self,
            skin=None if self.skin is None else replace(self.skin, factor=None),
            near=None if self.near is None else replace(self.near, layer=None),
            others=tuple(other.bare() for other in self.others),
        )
        if self.frozen is None:
            return light
        return replace(
            light,
            frozen=None,
            analysis=None,
            turning=None,
            mixed=self.frozen.basis.place is None,
            batches=self.frozen.table.batches,
        )
