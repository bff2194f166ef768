"""Elements of a deck: given, generated row by row, and copied."""

import numpy as np

from softway.meshes.cells import CELLS
from softway.meshes.files.abaqus.cell_types import cell_type
from softway.meshes.files.abaqus.entries import padded, whole
from softway.meshes.files.abaqus.left_out import Register
from softway.meshes.files.abaqus.lexer import Card
from softway.meshes.files.abaqus.scope import MOST, Known, Scope


def read_elements(scope: Scope, card: Card, left_out: Register) -> None:
    """Add the elements of ``*ELEMENT``; their nodes may continue on further lines."""
    kind = card.option("TYPE").upper()
    if not kind:
        raise card.wrong("no TYPE", "the type of the elements: *ELEMENT, TYPE=C3D8")
    meant = cell_type(kind)
    scope.types.setdefault(kind, []).append(card.place)
    labels: list[int] = []
    pending: list[int] = []
    for row in card.rows:
        entries = [part for part in row.split(",") if part.strip()]
        if meant.place == "other":
            labels += _foreign(scope, card, kind, entries, fresh=not pending)
            pending = [0] if row.endswith(",") else []
            continue
        pending += [whole(card, part.strip()) for part in entries]
        if len(pending) > (meant.nodes or 0):
            if len(pending) > 1 + (meant.nodes or 0) and meant.place == "body":
                problem = f"element {pending[0]} of type {kind:.20} has {len(pending) - 1} nodes"
                raise card.wrong(problem, f"{meant.nodes} nodes")
            scope.add_element(card, pending[0], kind, tuple(pending[1 : 1 + (meant.nodes or 0)]))
            labels.append(pending[0])
            pending = []
    if pending and meant.place != "other":
        raise card.wrong(f"element {pending[0]} has {len(pending) - 1} nodes", f"{meant.nodes} nodes")
    into(scope, card, "ELSET", labels)


def _foreign(scope: Scope, card: Card, kind: str, entries: list[str], *, fresh: bool) -> list[int]:
    """Label of an element that is no cell, whose nodes do not matter; nothing for a further line of its nodes."""
    if not fresh or not entries or not entries[0].strip().isdecimal() or len(entries[0]) > 20:
        return []
    scope.add_element(card, int(entries[0]), kind, ())
    return [int(entries[0])]


def generate_elements(scope: Scope, card: Card, left_out: Register) -> None:
    """Add rows, columns and layers of elements like a given one: ``*ELGEN``."""
    labels: list[int] = []
    for row in card.rows:
        entries = padded(row, 10)
        master = whole(card, entries[0])
        if master not in scope.elements:
            raise card.wrong(f"element {master} is not defined before", "an element of an earlier *ELEMENT card")
        kind, nodes = scope.elements[master]
        steps = [tuple(whole(card, entries[k + j], 1) for j in range(3)) for k in (1, 4, 7)]
        counts = [count for count, _, _ in steps]
        if min(counts) < 1 or counts[0] * counts[1] * counts[2] > MOST:
            raise card.wrong(f"{' x '.join(map(str, counts))} elements", f"positive numbers, at most {MOST:,} elements")
        for k, j, i in np.ndindex(counts[2], counts[1], counts[0]):
            shift, up = (sum(n * step[which] for n, step in zip((i, j, k), steps, strict=True)) for which in (1, 2))
            label = master + up
            scope.add_element(card, label, kind, tuple(node + shift for node in nodes))
            labels.append(label)
    into(scope, card, "ELSET", labels)


def copy_elements(scope: Scope, card: Card, left_out: Register) -> None:
    """Add copies of the elements of a set with shifted numbers: ``*ELCOPY``."""
    up, shift = (whole(card, card.option(name)) for name in ("ELEMENTSHIFT", "SHIFTNODES"))
    name = card.option("OLDSET")
    if name.upper() not in scope.element_sets:
        raise card.wrong(f"element set {name!r:.60} is not defined before", "a set of an earlier card")
    old = scope.members(name, Known(scope), nodes=False).get("", [])
    for label in old:
        kind, nodes = scope.elements[label]
        order = _mirror(cell_type(kind).cell, len(nodes)) if "REFLECT" in card.options else range(len(nodes))
        scope.add_element(card, label + up, kind, tuple(nodes[k] + shift for k in order))
    into(scope, card, "NEWSET", [label + up for label in old])


def into(scope: Scope, card: Card, option: str, labels: list[int]) -> None:
    """Put labels into the element set that a parameter names, if there is one."""
    if card.option(option):
        scope.grow(scope.element_sets, card.option(option), card).items.extend(("", label) for label in labels)


def _mirror(cell: str, count: int) -> list[int]:
    """Order of the nodes that keeps the volume of a mirrored cell positive: the first two axes change places."""
    if cell not in CELLS or CELLS[cell].dim < 2:
        return list(range(count))
    nodes = CELLS[cell].nodes
    swapped = nodes[:, [1, 0, *range(2, nodes.shape[1])]]
    return [int(np.argmin(np.abs(nodes - place).sum(axis=1))) for place in swapped]
