"""What is kept between slabs besides the situation: the frozen operator, and when it is worth a new one.

The operator itself is a cache: :class:`Origin` says how it came about, and :func:`softway.solve.prepared.restored`
makes it again with the same bits.
"""

from dataclasses import dataclass, replace

from softway.bodies.layer import Layer
from softway.bodies.past import Memories
from softway.model import Model
from softway.solve.frozen import Frozen
from softway.solve.linear import Analysis, Factor
from softway.solve.operators import Choice, Operator
from softway.solve.stiffness import Stiffness
from softway.solve.system import SlabSystem
from softway.solve.turning import Turning
from softway.typing import Array, IntArray

USUAL = 6
"""Iterations of a slab with a fresh factor, where the slabs since the last one were easier."""
WORN = 1.5
"""Multiple of the least iterations since the factor below which it never counts as worn."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Origin:
    """Where an operator was made.

    Parameters
    ----------
    operator, analyst
        What made it, and the symbolic work that it uses; None for the operator of central differences, and for one
        without symbolic work.
    at
        (n, d) displacement [m].
    memory, span
        Past of the matter, and length of the slab [s].
    share, again
        How stiffness counts, see :class:`~softway.solve.stiffness.Stiffness`.
    """

    operator: Operator | None
    analyst: Operator | None
    at: Array
    memory: Memories
    span: float
    share: float
    again: float

    @classmethod
    def of(
        cls, system: SlabSystem, at: Array, operator: Operator | None = None, analyst: Operator | None = None
    ) -> "Origin":
        """The origin of an operator of this slab."""
        matrix = system.stiffness
        return cls(
            operator=operator,
            analyst=analyst,
            at=at,
            memory=system.start.memory,
            span=system.path.span,
            share=matrix.share,
            again=matrix.again,
        )

    def stiffness(self, model: Model) -> Stiffness:
        """The matrix that was inverted."""
        return Stiffness(model=model.during(self.memory, self.span), share=self.share, again=self.again)


@dataclass(frozen=True, slots=True, kw_only=True)
class Taken:
    """Iterations of some slabs in a row: how many slabs, all iterations, the fewest of a slab, those of the last two.

    Examples
    --------
    >>> Taken().with_slab(7).with_slab(5).with_slab(6)
    Taken(slabs=3, total=18, least=5, last=(5, 6))
    """

    slabs: int = 0
    total: int = 0
    least: int = 0
    last: tuple[int, ...] = ()

    def with_slab(self, iterations: int) -> "Taken":
        """The same with one more slab."""
        least = min(self.least, iterations) if self.slabs else iterations
        last = (*self.last[-1:], iterations)
        return Taken(slabs=self.slabs + 1, total=self.total + iterations, least=least, last=last)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Skin:
    """The stiffness of all nodes without inertia, of central differences.

    Parameters
    ----------
    origin
        Where it was made.
    share
        Share of the unbalanced forces that its last correction left.
    before
        Greatest unbalanced force that a single correction met, away from touches [N]; zero between slabs.
    worn
        Whether it is to be made anew.
    factor
        Its factor.
    """

    origin: Origin
    share: float = 1.0
    before: float = 0.0
    worn: bool = False
    factor: Factor | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Near:
    """The nodes (k,) without inertia near a touch, of central differences, and the cells around them."""

    nodes: IntArray
    layer: Layer | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Carry:
    """All of it disposable: without it the next slab makes its own, which differs in the last digits.

    Parameters
    ----------
    frozen
        The operator.
    origin
        Where it was made; None before the first.
    mixed, batches
        Of :meth:`bare` carries, what the operator knows by now: whether contact directions are components, and which
        columns of the compliance were made together, in order.
    choice
        How operators are made, and why so.
    span
        The length of the slabs that ``frozen`` serves, of the default weight [s].
    analysis
        Symbolic work of the factor, the same for all lengths.
    turning
        What the turning of nodes is measured with.
    stale
        Whether the next slab asks for a new factor.
    factorisations
        Factors made so far.
    taken
        Iterations of the slabs since the last factor.
    price
        What a factor costs, in iterations.
    skin, near
        Of central differences, whose ``frozen`` operator is that of the nodes near a touch.
    """

    frozen: Frozen | None = None
    origin: Origin | None = None
    mixed: bool = False
    batches: tuple[IntArray, ...] = ()
    choice: Choice | None = None
    span: float = 0.0
    analysis: Analysis | None = None
    turning: Turning | None = None
    stale: bool = False
    factorisations: int = 0
    taken: Taken = Taken()
    price: float = 0.0
    skin: Skin | None = None
    near: Near | None = None

    def failed(self) -> "Carry":
        """The carry after a slab that found no solution: everything is made anew."""
        return replace(self, stale=True, skin=None, near=None)

    def after(self, iterations: int) -> "Carry":
        """The carry after a slab of so many iterations; a factor is ordered where it pays.

        A slab is dear when the last two slabs took more than the slabs since the factor took on average, the price of
        the factor included: to go on with the factor then costs more than to renew it as often as was done.
        """
        taken = self.taken.with_slab(iterations)
        recent = 0.5 * sum(taken.last)
        mean = (taken.total + self.price) / taken.slabs
        dear = taken.slabs > 1 and recent > max(mean, WORN * max(taken.least, USUAL))
        return replace(self, taken=taken, stale=self.stale or dear)

    def bare(self) -> "Carry":
        """What is light of it: all but the operator, which can be made again as it is now."""
        light = replace(
            self,
            skin=None if self.skin is None else replace(self.skin, factor=None),
            near=None if self.near is None else replace(self.near, layer=None),
        )
        if self.frozen is None:
            return light
        return replace(
            light,
            frozen=None,
            analysis=None,
            turning=None,
            mixed=self.frozen.basis.component is not None,
            batches=self.frozen.table.batches,
        )
