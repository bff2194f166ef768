"""Step control: limits of slabs (time steps) and growth of their length."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.contact.contact_rows import ContactRows
from softway.contact.contact_set import SlabContacts
from softway.errors import TooFast, positive
from softway.kernels.geometry.shortest_edge import shortest
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.solve.methods.central_difference import Explicit

CRAWL = 1e-2
"""Fraction of the requested length below which rejections in a march are counted."""
ENDLESS = 1e6
"""Number of slabs of the present length up to the end of the march, above which slabs far below the requested length
lead nowhere."""
SMALL_STRAIN = 1.0
"""Least limit of the approach, in edges, for bodies of small strain: their cells cannot be crushed."""
SLOW = 6.0
"""Bound of the change of a gap between solids, in greatest motions of a node: of the node, of the facet, and of the
foot as the facet turns, twice."""
EARLY = 0.25
"""Least time from the end of a slab above the lowest rung to an event, in lowest rungs."""
ROUNDING = 1e-6
"""Relative difference of slab lengths that is rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """Limits of a slab besides the requested length.

    A slab that exceeds a limit is rejected and tried again at half the length.  The length doubles again, up to the
    requested one, if the motion is smooth: the displacement error by a jump of the acceleration,
    ``h^2 |a1 - a0| / 12``, would be below ``growth`` edges at the double length (docs/theory/time/control.md).

    Parameters
    ----------
    approach
        Greatest overlap of bodies, in edges of the mesh, if they moved through the slab without contact: a greater
        approach would crush or miss surface cells.
    scalar
        Scalar of the Energy rule above which the next slab is halved, in slabs without touches and releases.
    growth
        Displacement error of a slab, in edges of the mesh, below which a shortened slab grows again.
    least
        Shortest slab, as a fraction of the requested length; below it the march ends with the reason.
    patience
        Number of rejections among slabs shorter than ``CRAWL`` of the requested length, less a quarter of such slabs
        without rejection, after which the march ends with the reason: it would continue for hours by halving slabs.
        Slabs so short that more than ``ENDLESS`` of them are left count as rejections.
    knots
        True for slabs that end where loads and prescribed motions bend: at knots of their tables that are half a slab
        or more apart.
    longest
        Longest slab under a tolerance, in requested lengths; every power of two up to it has an operator of its own.

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
    knots: bool = True
    longest: float = 32.0

    def __post_init__(self) -> None:
        positive(
            approach=self.approach,
            scalar=self.scalar,
            growth=self.growth,
            least=self.least,
            patience=self.patience,
            longest=self.longest,
        )


def above(span: float, lowest: float) -> bool:
    """True if a slab of the length ``span`` is longer than the lowest rung [s]."""
    return span > lowest * (1.0 + ROUNDING)


def require_slow(model: Model, pairs: SlabContacts, start: Array, coasting: Array, limit: float) -> None:
    """Refuse a slab in which a node would overlap by more than ``limit`` edges at the free displacement ``coasting``.

    Its overlap at the displacement ``start`` of the slab does not count: mean gaps allow it, and no shorter slab
    avoids it.

    Raises
    ------
    TooFast
        With the contact and the approach beyond the touch.
    """
    of_tools = _creeps(model, start, coasting, limit)
    rows = pairs.overlap_rows(coasting, of_tools)
    depth = _in_edges(model, rows, -rows.gap(coasting))
    crushable = np.array([not p.internal.linear for p in model.parts])[model.part_of[rows.node]]
    allowed = (1.0 + 1e-6) * np.where(crushable, limit, max(limit, SMALL_STRAIN))
    if (depth <= allowed).all():
        return
    first = pairs.overlap_rows(start, of_tools)
    depth = depth - np.maximum(_in_edges(model, first, -first.gap(start) - first.tool_motion), 0.0)
    if (depth > allowed).any():
        worst = int(np.argmax(depth / allowed))
        label = rows.labels[rows.contact[worst]]
        raise TooFast(f"in {label} a node approaches by {depth[worst]:.3g} edges beyond the touch")


def _creeps(model: Model, start: Array, coasting: Array, limit: float) -> bool:
    """True if all nodes move so little that no gap between solids changes by more than ``limit`` edges.

    A gap changes at most by the motion of its node, of the facet and of the foot on it as the facet turns.
    """
    motion = model.space.greatest(coasting - start) * np.sqrt(start.shape[1])
    return bool(SLOW * motion <= limit * model.space.least(model.edge))


def require_open(
    model: Model, pairs: SlabContacts, now: ModelState, coasting: Array, length: float, later: float
) -> None:
    """Refuse a slab at whose end, or ``later`` [s] after it, an open row would be closed.

    ``coasting`` (n, d) is the free displacement at its end.

    Raises
    ------
    TooFast
        With the contact.
    """
    first, rows = pairs.start(now.start.displacement), pairs.at(coasting)
    open_rows = first.near & rows.near & ~now.closed
    before, gap = (np.where(open_rows, g, 0.0) for g in (first.gap(now.start.displacement), rows.gap(coasting)))
    closes = open_rows & (gap < before) & (gap < (before - gap) * later / length)
    if closes.any():
        label = rows.labels[rows.contact[int(np.argmax(closes))]]
        raise TooFast(f"in {label} a node would touch inside a time step above the lowest rung")


def _in_edges(model: Model, rows: ContactRows, overlap: Array) -> Array:
    """Overlap (m,) of rows [m] in edges; -inf where nothing is near."""
    return np.where(rows.near, overlap, -np.inf) / model.edge[rows.node]


def may_grow(model: Model, control: StepControl, length: float, before: ModelState, after: ModelState) -> bool:
    """True if the motion is smooth enough for a slab of twice the length."""
    moving = model.massive
    jump = after.acceleration - before.acceleration
    factor, allowed = 8.0 * length**2 / 12.0, control.growth * model.edge
    if factor * model.space.greatest(jump) <= model.space.least(allowed):
        return True
    error = factor * np.abs(jump)
    return model.space.every(error[moving] <= allowed[moving, None])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Crushing:
    """Crushing of cells under central differences: edges (e, 2) of each solid, and its shortest edge at rest [m]."""

    edges: tuple[tuple[DiscreteSolid, IntArray, float], ...]

    def shortest_ratio(self, u: Array) -> float:
        """Ratio of the shortest present to the shortest initial edge at the displacement u (n, d); at most 1."""
        ratios = [shortest(p.mesh.points, u[p.nodes], ends) / first for p, ends, first in self.edges]
        return min([1.0, *ratios])


def crushing(model: Model, method: object) -> Crushing:
    """:class:`Crushing` of a march; empty for small strain and for methods other than central differences."""
    if not isinstance(method, Explicit) or model.linear:
        return Crushing(edges=())
    return Crushing(edges=tuple((p, p.mesh.edge_ends(), p.mesh.edge()) for p in model.parts))
