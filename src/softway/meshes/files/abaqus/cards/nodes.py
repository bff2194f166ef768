"""Nodes of a deck: given in a system of coordinates, generated along lines and between sets, and copied."""

import numpy as np

from softway.arrays import Array
from softway.meshes.files.abaqus.cards.transforms import cartesian, frame, mirrored, rotated
from softway.meshes.files.abaqus.entries import fields, padded, point, real, whole
from softway.meshes.files.abaqus.left_out import Register
from softway.meshes.files.abaqus.lexer import Card
from softway.meshes.files.abaqus.scope import MOST, Known, Point, Scope


def read_nodes(scope: Scope, card: Card, left_out: Register) -> None:
    """Add the nodes of ``*NODE``, given in rectangular, cylindrical or spherical coordinates."""
    system = _system(card)
    plain = system == "R" and not scope.origin.any() and (scope.axes == np.eye(3)).all()
    labels = []
    for row in card.rows:
        entries = fields(row)
        label, place = whole(card, entries[0]), point(card, entries[1:])
        scope.add_node(card, label, place if plain else _placed(scope, place, system))
        labels.append(label)
    _into(scope, card, "NSET", labels)


def read_system(scope: Scope, card: Card, left_out: Register) -> None:
    """Set the system of coordinates of the nodes that follow: ``*SYSTEM``."""
    if not card.rows:
        scope.origin[:], scope.axes[:] = 0.0, np.eye(3)
        return
    first = fields(card.rows[0])
    origin = np.array(point(card, first))
    b = np.array(point(card, first[3:])) if len(first) > 3 else None
    c = np.array(point(card, fields(card.rows[1]))) if len(card.rows) > 1 else None
    try:
        scope.origin[:], scope.axes[:] = origin, frame(origin, b, c)
    except ValueError as error:
        raise card.wrong(str(error), "three points that are not on one line") from None


def generate_nodes(scope: Scope, card: Card, left_out: Register) -> None:
    """Add nodes between pairs of nodes, on a line, an arc or a parabola: ``*NGEN``."""
    line = card.option("LINE").upper()[:1]
    labels: list[int] = []
    for row in card.rows:
        entries = padded(row, 10)
        first, last, by = (whole(card, entries[k], None if k < 2 else 1) for k in range(3))
        a, b = (np.array(_node(scope, card, label)) for label in (first, last))
        count = _count(card, first, last, by)
        by = by if last >= first else -abs(by)
        s = np.arange(1, count) / count
        places = a + s[:, None] * (b - a) if not line else _curve(scope, card, line, entries, a, b, s)
        inner = [first + by * k for k in range(1, count)]
        for label, place in zip(inner, places.tolist(), strict=True):
            scope.add_node(card, label, _tuple(place), made=True)
        labels += [first, *inner, last]
    _into(scope, card, "NSET", labels)


def fill_nodes(scope: Scope, card: Card, left_out: Register) -> None:
    """Add nodes between those of two sets: ``*NFILL``."""
    bias = real(card, card.option("BIAS")) if card.option("BIAS") else 1.0
    if not 0.0 < bias < np.inf:
        raise card.wrong(f"BIAS={bias:g}", "a positive ratio of neighbouring distances")
    made: list[int] = []
    for row in card.rows:
        entries = padded(row, 4)
        starts, ends = (_set(scope, card, entries[k]) for k in (0, 1))
        count, by = whole(card, entries[2]), whole(card, entries[3], 1)
        if len(starts) != len(ends):
            problem = f"{entries[0]} has {len(starts)} nodes, {entries[1]} has {len(ends)}"
            raise card.wrong(problem, "two sets with the same number of nodes")
        if not 1 <= count <= MOST // max(1, len(starts)):
            raise card.wrong(f"{count} intervals", f"at least one interval, and at most {MOST:,} nodes")
        lengths = bias ** -np.arange(count, dtype=float)
        s = (np.cumsum(lengths) / lengths.sum())[:-1]
        for one, other in zip(starts, ends, strict=True):
            a, b = np.array(scope.nodes[one]), np.array(scope.nodes[other])
            for k, place in enumerate((a + s[:, None] * (b - a)).tolist(), start=1):
                scope.add_node(card, one + k * by, _tuple(place), made=True)
                made.append(one + k * by)
        made += [*starts, *ends]
    _into(scope, card, "NSET", made)


def copy_nodes(scope: Scope, card: Card, left_out: Register) -> None:
    """Add shifted, turned or mirrored copies of the nodes of a set: ``*NCOPY``."""
    by, times = whole(card, card.option("CHANGENUMBER")), whole(card, card.option("MULTIPLE"), 1)
    old = _set(scope, card, card.option("OLDSET"))
    if not 1 <= times <= MOST // max(1, len(old)):
        raise card.wrong(f"MULTIPLE={times}", f"at least one copy, and at most {MOST:,} nodes")
    places = np.array([scope.nodes[label] for label in old], dtype=float).reshape(-1, 3)
    made: list[int] = []
    for k in range(1, times + 1):
        places = _copied(scope, card, places)
        for label, place in zip(old, places.tolist(), strict=True):
            scope.add_node(card, label + k * by, _tuple(place), made=True)
            made.append(label + k * by)
    _into(scope, card, "NEWSET", made)


def _copied(scope: Scope, card: Card, places: Array) -> Array:
    """Places (n, 3) moved as the parameters and the data lines of the copy say."""
    rows = [padded(row, 7) for row in card.rows] + [[""] * 7] * 2
    if "REFLECT" in card.options:
        points = [*_points(card, rows[0]), np.array(point(card, rows[1]))]
        try:
            return mirrored(places, card.option("REFLECT").upper(), points)
        except ValueError as error:
            raise card.wrong(str(error), "REFLECT=POINT, LINE or MIRROR, with distinct points") from None
    if "POLE" in card.options:
        one_node = rows[0][0] and not any(rows[0][1:])
        pole = _node(scope, card, whole(card, rows[0][0])) if one_node else point(card, rows[0][1:])
        return 2.0 * places - np.array(pole)
    if "SHIFT" not in card.options:
        raise card.wrong("no SHIFT, REFLECT or POLE", "one of these parameters")
    a, b = _points(card, rows[1])
    return rotated(places + np.array(point(card, rows[0])), a, b, real(card, rows[1][6]))


def _curve(scope: Scope, card: Card, line: str, entries: list[str], a: Array, b: Array, s: Array) -> Array:
    """Places (n, 3) at the fractions ``s`` (n,) of an arc about the extra point, or of a parabola through it."""
    system = _system(card)
    third = whole(card, entries[3], 0)
    extra = np.array(
        _node(scope, card, third) if third else _placed(scope, point(card, entries[4:7]), system), dtype=float
    )
    if line == "P":
        t = s[:, None]
        return (1 - t) * (1 - 2 * t) * a + 4 * t * (1 - t) * extra + t * (2 * t - 1) * b
    if line != "C":
        raise card.wrong(f"LINE={card.option('LINE')}", "LINE=C for an arc, LINE=P for a parabola")
    normal = np.array(point(card, entries[7:10])) @ scope.axes.T
    ra, rb = a - extra, b - extra
    axis = normal if normal.any() else np.cross(ra, rb)
    size, least = np.linalg.norm(axis), np.linalg.norm(ra) * np.linalg.norm(rb)
    if not size > 1e-12 * least or not least > 0.0:
        raise card.wrong("the arc has no normal", "a centre off the line of the two nodes, or the normal of the arc")
    axis = axis / size
    angle = np.arctan2(axis @ np.cross(ra, rb), ra @ rb)
    angle = angle + 2 * np.pi if normal.any() and angle <= 0.0 else angle
    radii = 1.0 + s * (np.linalg.norm(rb) / np.linalg.norm(ra) - 1.0)
    turned = [rotated(ra[None], np.zeros(3), axis, float(np.degrees(f * angle)))[0] for f in s]
    found: Array = np.array(turned).reshape(-1, 3) * radii[:, None] + extra
    return found


def _system(card: Card) -> str:
    """System of coordinates of a card: R, C or S."""
    found = card.option("SYSTEM").upper() or "R"
    if found not in ("R", "RC", "C", "S"):
        raise card.wrong(f"SYSTEM={found:.20}", "SYSTEM=R, C or S")
    return found[0] if found != "RC" else "R"


def _placed(scope: Scope, place: Point, system: str) -> Point:
    """Coordinates in the system of the deck."""
    return _tuple((scope.origin + scope.axes @ cartesian(place, system)).tolist())


def _tuple(place: list[float]) -> Point:
    return place[0], place[1], place[2]


def _points(card: Card, row: list[str]) -> tuple[Array, Array]:
    """Two points of a data line."""
    return np.array(point(card, row)), np.array(point(card, row[3:]))


def _count(card: Card, first: int, last: int, by: int) -> int:
    """Number of intervals between two labels."""
    if by == 0 or (last - first) % by or first == last:
        raise card.wrong(f"no steps of {by} lead from node {first} to node {last}", "an increment that divides evenly")
    count = abs((last - first) // by)
    if count > MOST:
        raise card.wrong(f"{count:,} nodes", f"at most {MOST:,}")
    return count


def _node(scope: Scope, card: Card, label: int) -> Point:
    """Coordinates of a node that must exist."""
    if label not in scope.nodes:
        raise card.wrong(f"node {label} is not defined before", "a node of an earlier *NODE card")
    return scope.nodes[label]


def _set(scope: Scope, card: Card, name: str) -> list[int]:
    """Sorted labels of a node set, or of one node."""
    if name.isdecimal() and name not in scope.node_sets:
        return [label for label in (whole(card, name),) if _node(scope, card, label)]
    if name.upper() not in scope.node_sets:
        raise card.wrong(f"node set {name!r:.60} is not defined before", "a set of an earlier card")
    return sorted(scope.members(name, Known(scope), nodes=True).get("", []))


def _into(scope: Scope, card: Card, option: str, labels: list[int]) -> None:
    """Put labels into the set that a parameter names, if there is one."""
    if card.option(option):
        scope.grow(scope.node_sets, card.option(option), card).items.extend(("", label) for label in labels)
