"""Surfaces that ties glue: how the nodes of one follow the other, and which facets are covered by glue."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.contact.assembly.body_surface import BodySurface, body_surface, finer_first
from softway.contact.assembly.tie import Tie
from softway.contact.mortar.following import Following, following
from softway.errors import InputError, within

COMPLETE = 0.95
"""Least covered fraction of every facet of a surface that follows: rims of curved surfaces do not match completely."""
SEALED = 0.5
"""Covered fraction from which a facet can meet nothing else."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TiedSurfaces:
    """Two surfaces glued to each other.

    Parameters
    ----------
    tie, number
        Its declaration, and its number among the ties of the scene.
    surfaces
        The surfaces in the order of the declaration.
    ways
        One or two ways in which the nodes of one surface follow the other; the better one first.
    sealed
        Covered facets of both surfaces.
    """

    tie: Tie
    number: int
    surfaces: tuple[BodySurface, BodySurface]
    ways: tuple[Following, ...]
    sealed: Mapping[str, IntArray]

    @property
    def ordered(self) -> tuple[BodySurface, BodySurface]:
        """The surface whose nodes follow by the better way, and the other one."""
        one, two = self.surfaces
        return (one, two) if np.isin(self.ways[0].node, one.side.nodes).all() else (two, one)


def tied_surfaces(ties: Sequence[Tie], parts: Sequence[DiscreteSolid], points: Array) -> tuple[TiedSurfaces, ...]:
    """Surfaces of all ties at the reference positions ``points`` (n, d).

    Raises
    ------
    InputError
        If a body or tag is unknown, or the surfaces do not lie on each other; the place begins with ``ties[k]``.
    """
    found = []
    for k, tie in enumerate(ties):
        with within(f"ties[{k}]"):
            found.append(_of_tie(tie, k, parts, points))
    return tuple(found)


def _of_tie(tie: Tie, number: int, parts: Sequence[DiscreteSolid], points: Array) -> TiedSurfaces:
    """Surfaces of one tie."""
    one, two = (body_surface(parts, *place, points) for place in zip(tie.bodies, tie.tags, strict=True))
    edge = max(one.edge, two.edge)
    ways = _ways(one, two, points, edge)
    found = [way for way in ways if _least(way) >= COMPLETE]
    if not found:
        far = float(np.linalg.norm(np.ptp(points[np.concatenate([one.side.nodes, two.side.nodes])], axis=0)))
        apart = [way for way in _ways(one, two, points, far) if _least(way) >= COMPLETE]
        _require_close(tie, apart, points, edge)
        raise _not_facing(tie, ways if finer_first(one, two)[0] is one else ways[::-1])
    _require_close(tie, found, points, edge)
    sealed: dict[str, list[IntArray]] = {}
    fine, coarse = finer_first(one, two)
    way = ways[0]
    for surface, share in ((fine, way.covered), (coarse, way.facing)):
        for kind, facets in surface.side.facets.items():
            sealed.setdefault(kind, []).append(facets[share[kind] >= SEALED])
    return TiedSurfaces(
        tie=tie,
        number=number,
        surfaces=(one, two),
        ways=tuple(found),
        sealed={kind: np.concatenate(facets) for kind, facets in sealed.items()},
    )


def _ways(one: BodySurface, two: BodySurface, points: Array, reach: float) -> list[Following]:
    """The finer surface follows the coarser one, and the other way round."""
    fine, coarse = finer_first(one, two)
    if fine.side.dim == 1:
        return [_ends(fine, coarse, points, reach), _ends(coarse, fine, points, reach)]
    return [following(a.side.facets, b.side.facets, points, reach) for a, b in ((fine, coarse), (coarse, fine))]


def _ends(one: BodySurface, two: BodySurface, points: Array, reach: float) -> Following:
    """The end of a bar follows that of another one."""
    (a,), (b,) = one.side.nodes[:1], two.side.nodes[:1]
    near = one.side.ends[0] * two.side.ends[0] < 0.0 and abs(points[a, 0] - points[b, 0]) <= reach
    share = {"point1": np.array([float(near)])}
    weights = sp.csr_array((np.ones(1), (np.zeros(1, int), np.array([b]))), shape=(1, len(points)))
    return Following(node=np.array([a]), weights=weights, covered=share, facing=share)


def _least(way: Following) -> float:
    """Least covered fraction of a facet that follows."""
    return min(float(share.min()) for share in way.covered.values())


def _require_close(tie: Tie, ways: Sequence[Following], points: Array, edge: float) -> None:
    """Refuse surfaces with a gap or an overlap beyond the tolerance."""
    for way in ways[:1]:
        gap = float(np.linalg.norm(points[way.node] - way.weights @ points, axis=1).max())
        if gap > tie.tolerance * edge:
            problem = f"{tie.between[0]!r} and {tie.between[1]!r} are {gap:.3g} m apart at rest, {gap / edge:.2g} edges"
            remedy = f"bodies that touch there, or tolerance = {_above(gap / edge)}"
            raise InputError("between", problem, remedy)


def _above(value: float) -> str:
    """Short number that is not below a value."""
    return f"{1.01 * value:.3g}"


def _not_facing(tie: Tie, ways: Sequence[Following]) -> InputError:
    """Surfaces of which neither lies on the other completely; ``ways`` in the order of the declaration."""
    shares = [float(np.mean(np.concatenate([*way.covered.values()]))) for way in ways]
    told = " and ".join(f"{100.0 * s:.0f} % of {n!r}" for s, n in zip(shares, tie.between, strict=True))
    remedy = "tags of which one lies on the other completely"
    return InputError("between", f"{told} face the other surface", remedy)
