"""Step control: how long the next slab may be, and what is tried when one fails."""

from dataclasses import dataclass

import numpy as np

from softway.bodies.part import Part
from softway.contact.encounters import Pairs
from softway.errors import InputError, TooFast
from softway.kernels.shortest import shortest
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.explicit import Explicit
from softway.solve.normal import greatest
from softway.typing import Array, IntArray

CRAWL = 1e-2
"""Fraction of the length asked for below which a march that goes on by rejections crawls."""
SMALL_STRAIN = 1.0
"""Approach in edges that bodies of small strain may have at least: their cells cannot be crushed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """Limits of a slab besides the length asked for.

    A slab that breaks one is dropped without trace and tried again at half the length.  The length doubles again, up to
    the one asked for, when the motion is smooth: the error that a jump of acceleration leaves in the displacement,
    ``h^2 |a1 - a0| / 12``, would stay below ``growth`` edges at the double length (docs/theory/control.md).

    Parameters
    ----------
    approach
        Depth, in edges of the mesh, by which bodies may overlap if they coasted through a slab without contact: a
        greater approach would crush or miss surface cells.
    scalar
        Scalar of the Energy rule above which the next slab is halved, away from touches and releases.
    growth
        Error of the displacement in a slab, in edges of the mesh, up to which a shortened slab grows again.
    least
        Shortest slab, as a fraction of the length asked for; below it the march ends with the reason.
    patience
        Rejections among slabs shorter than ``CRAWL`` of the length asked for, less a quarter of such slabs without any,
        after which the march ends with the reason: it would go on for hours, by halving slab after slab.

    References
    ----------
    Zienkiewicz, Xie (1991), A simple error estimator and adaptive time stepping procedure for dynamic analysis,
    Earthq. Eng. Struct. Dyn. 20, 871-887.

    Examples
    --------
    >>> StepControl().approach
    0.25
    """

    approach: float = 0.25
    scalar: float = 0.2
    growth: float = 0.01
    least: float = 1e-7
    patience: int = 300

    def __post_init__(self) -> None:
        for name in ("approach", "scalar", "growth", "least", "patience"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(name, f"{getattr(self, name):g} is not positive", "a positive number")


def require_slow(model: Model, pairs: Pairs, coasting: Array, limit: float) -> None:
    """Refuse a slab in which a contact node would overlap by more than ``limit`` edges if it coasted to ``coasting``.

    Raises
    ------
    TooFast
        With the contact and the depth.
    """
    rows = pairs.watch(coasting)
    edges = np.where(rows.near, -rows.gap(coasting), -np.inf) / model.edge[rows.node]
    crushable = np.array([not p.internal.linear for p in model.parts])[model.part_of[rows.node]]
    depth = edges * np.where(crushable, 1.0, min(limit / SMALL_STRAIN, 1.0))
    if len(depth) and depth.max() > limit * (1.0 + 1e-6):
        worst = int(np.argmax(depth))
        label = rows.labels[rows.contact[worst]]
        raise TooFast(f"in {label} a node approaches by {edges[worst]:.3g} edges beyond the touch")


def may_grow(model: Model, control: StepControl, length: float, before: Situation, after: Situation) -> bool:
    """Whether the motion is smooth enough for a slab of twice the length."""
    moving = model.massive
    jump = after.acceleration - before.acceleration
    share, allowed = 8.0 * length**2 / 12.0, control.growth * model.edge
    if share * greatest(jump) <= allowed.min():
        return True
    error = share * np.abs(jump)
    return bool((error[moving] <= allowed[moving, None]).all())


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Crushing:
    """What central differences watch: the edges (e, 2) of each solid whose cells may get shorter, and its shortest one
    at rest [m].
    """

    edges: tuple[tuple[Part, IntArray, float], ...]

    def share(self, u: Array) -> float:
        """Share of the slab's length that is left at the displacement u (n, d), as waves cross shorter edges sooner."""
        ratios = [shortest(p.mesh.points, u[p.rows], ends) / first for p, ends, first in self.edges]
        return min([1.0, *ratios])


def crushing(model: Model, method: object) -> Crushing:
    """The :class:`Crushing` of a march; empty for methods other than central differences, and small strain."""
    if not isinstance(method, Explicit) or model.linear:
        return Crushing(edges=())
    return Crushing(edges=tuple((p, p.mesh.edge_ends(), p.mesh.edge()) for p in model.parts))
