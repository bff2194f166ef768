"""Local changes of tetrahedra within a boundary: swaps of faces and edges, halved and collapsed edges."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import dist

import numpy as np

from softway.arrays import Array, IntArray

Tet = tuple[int, int, int, int]
Point = tuple[float, float, float]
BETTER = 1e-3
"""Least gain of quality by a change."""
WORST = 0.5
"""Least quality of the tetrahedra around a collapsed edge, relative to the worst before."""
FACES = (1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)
"""Corners of the faces of a tetrahedron, anticlockwise from outside."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Tets:
    """Tetrahedra by number, and those around each point; changed in place by the functions of this module.

    Parameters
    ----------
    points
        Coordinates of the points by number [m].
    cells
        Corners of the tetrahedra.
    around
        Numbers of the tetrahedra around each point.
    """

    points: list[Point]
    cells: dict[int, Tet]
    around: dict[int, set[int]]

    @classmethod
    def of(cls, points: Array, cells: IntArray) -> "Tets":
        """Points (n, 3) and tetrahedra (t, 4)."""
        found = cls(
            points=[(x, y, z) for x, y, z in points.tolist()], cells={}, around={k: set() for k in range(len(points))}
        )
        found.replace((), [(a, b, c, d) for a, b, c, d in cells.tolist()])
        return found

    def replace(self, old: Iterable[int], new: Iterable[Tet]) -> None:
        """Take out tetrahedra and put in others."""
        for number in old:
            for corner in self.cells.pop(number):
                self.around[corner].discard(number)
        for cell in new:
            number = next(reversed(self.cells)) + 1 if self.cells else 0
            self.cells[number] = cell
            for corner in cell:
                self.around[corner].add(number)

    def at(self, corners: Iterable[int]) -> list[int]:
        """Numbers of the tetrahedra with all these corners, rising."""
        first, *others = corners
        found = self.around[first]
        for corner in others:
            found = found & self.around[corner]
        return sorted(found)

    def quality(self, cell: Sequence[int]) -> float:
        """Mean ratio ``12 (3 V)^(2/3) / sum l^2``: one in regular tetrahedra, negative in inverted ones."""
        (ax, ay, az), (bx, by, bz), (cx, cy, cz), (dx, dy, dz) = (self.points[k] for k in cell)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        wx, wy, wz = dx - ax, dy - ay, dz - az
        volume = (ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)) / 6.0
        edges = ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz + wx * wx + wy * wy + wz * wz
        edges += (cx - bx) ** 2 + (cy - by) ** 2 + (cz - bz) ** 2 + (dx - bx) ** 2 + (dy - by) ** 2 + (dz - bz) ** 2
        edges += (dx - cx) ** 2 + (dy - cy) ** 2 + (dz - cz) ** 2
        size = 12.0 * (3.0 * abs(volume)) ** (2.0 / 3.0) / edges
        return size if volume > 0.0 else -1.0 - size

    def length(self, a: int, b: int) -> float:
        """Distance of two points [m]."""
        return dist(self.points[a], self.points[b])

    def worst(self, cells: Iterable[Sequence[int]]) -> float:
        """Least quality."""
        return min(self.quality(cell) for cell in cells)

    def arrays(self) -> tuple[Array, IntArray]:
        """Points (n, 3) that belong to tetrahedra, in their order, and the tetrahedra (t, 4)."""
        cells = np.array([self.cells[k] for k in sorted(self.cells)], dtype=np.int64)
        used, numbers = np.unique(cells, return_inverse=True)
        return np.array(self.points)[used], numbers.reshape(cells.shape)


def faces_swapped(tets: Tets) -> int:
    """Replace pairs of tetrahedra by three around a new edge where that makes the worst better; number of swaps."""
    count = 0
    for number in sorted(tets.cells):
        for local in FACES:
            if number not in tets.cells:
                break
            cell = tets.cells[number]
            face = [cell[k] for k in local]
            pair = tets.at(face)
            if len(pair) != 2 or number != pair[0]:
                continue
            top, bottom = (next(k for k in tets.cells[one] if k not in face) for one in pair)
            a, b, c = face
            new = [(top, bottom, a, b), (top, bottom, b, c), (top, bottom, c, a)]
            if tets.quality(new[0]) < 0.0:
                new = [(bottom, top, *cell[2:]) for cell in new]
            if not tets.at((top, bottom)) and tets.worst(new) > tets.worst([tets.cells[k] for k in pair]) + BETTER:
                tets.replace(pair, new)
                count += 1
    return count


def edges_swapped(tets: Tets, surface: set[tuple[int, int]]) -> int:
    """Take away edges with three or four tetrahedra around them where that makes the worst better; number of swaps."""
    count = 0
    for a, b in _edges(tets):
        if (a, b) in surface:
            continue
        ring = tets.at((a, b))
        loop = _loop(tets, a, b, ring)
        if len(ring) not in (3, 4) or len(loop) != len(ring):
            continue
        now = tets.worst([tets.cells[k] for k in ring])
        cuts = [[tuple(loop)]] if len(loop) == 3 else [
            [(loop[0], loop[1], loop[2]), (loop[0], loop[2], loop[3])],
            [(loop[1], loop[2], loop[3]), (loop[1], loop[3], loop[0])],
        ]  # fmt: skip
        best: tuple[float, list[Tet]] = (now + BETTER, [])
        for cut in cuts:
            if len(loop) == 4 and tets.at((cut[0][0], cut[0][2])):
                continue
            new = [tet for x, y, z in cut for tet in ((x, y, z, b), (x, z, y, a))]
            if any(len(tets.at(triangle)) for triangle in cut):
                continue
            if tets.worst(new) > best[0] + 1e-9:
                best = tets.worst(new), new
        if best[1]:
            tets.replace(ring, best[1])
            count += 1
    return count


def _edges(tets: Tets) -> list[tuple[int, int]]:
    """Edges, rising."""
    return sorted({(min(e), max(e)) for cell in tets.cells.values() for e in combinations(cell, 2)})


def _loop(tets: Tets, a: int, b: int, ring: Sequence[int]) -> list[int]:
    """Corners around the edge from a to b, anticlockwise as seen from b."""
    following = {}
    for number in ring:
        cell = tets.cells[number]
        x, y = (k for k in cell if k not in (a, b))
        if _even(cell, (a, b, x, y)):
            following[x] = y
        else:
            following[y] = x
    if len(following) != len(ring):
        return []
    start = min(following)
    out, node = [start], following[start]
    while node != start and node in following and len(out) < len(ring):
        out.append(node)
        node = following[node]
    return out if node == start else []


def _even(one: Sequence[int], other: Sequence[int]) -> bool:
    """Whether two orders of the same four numbers differ by an even permutation."""
    order = [one.index(k) for k in other]
    return sum(order[i] > order[j] for i, j in combinations(range(4), 2)) % 2 == 0


def halved(tets: Tets, surface: set[tuple[int, int]], long: float, sizes: list[float]) -> int:
    """Put points into the middles of inner edges longer than ``long`` times the lengths asked for; their number."""
    count = 0
    for a, b in _edges(tets):
        ring = tets.at((a, b))
        if (a, b) in surface or not ring or tets.length(a, b) < long * 0.5 * (sizes[a] + sizes[b]):
            continue
        m = len(tets.points)
        (ax, ay, az), (bx, by, bz) = tets.points[a], tets.points[b]
        tets.points.append((0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz)))
        sizes.append(0.5 * (sizes[a] + sizes[b]))
        tets.around[m] = set()
        cells = [tets.cells[k] for k in ring]
        new = [_with(cell, end, m) for cell in cells for end in (a, b)]
        tets.replace(ring, new)
        count += 1
    return count


def collapsed(tets: Tets, fixed: set[int], short: float, sizes: list[float]) -> int:
    """Move inner points into their nearest neighbour where that is closer than ``short`` times the length asked for
    and no tetrahedron gets bad; their number.
    """
    count = 0
    for a, b in [e for pair in _edges(tets) for e in (pair, pair[::-1])]:
        if a in fixed or not tets.at((a, b)):
            continue
        if tets.length(a, b) > short * 0.5 * (sizes[a] + sizes[b]):
            continue
        ring = sorted(tets.around[a])
        old = [tets.cells[k] for k in ring]
        new = [_with(cell, a, b) for cell in old if b not in cell]
        if tets.worst(new) > WORST * max(tets.worst(old), 0.0) + BETTER:
            tets.replace(ring, new)
            count += 1
    return count


def _with(cell: Tet, old: int, new: int) -> Tet:
    """A tetrahedron with one corner replaced."""
    a, b, c, d = (new if k == old else k for k in cell)
    return a, b, c, d
