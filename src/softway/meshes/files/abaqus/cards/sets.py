"""Sets and surfaces of a deck."""

from softway.meshes.files.abaqus.entries import fields, label_or_name, padded, whole
from softway.meshes.files.abaqus.left_out import Register
from softway.meshes.files.abaqus.lexer import Card
from softway.meshes.files.abaqus.scope import NamedSet, Scope, Surface


def read_node_set(scope: Scope, card: Card, left_out: Register) -> None:
    """Add the entries of ``*NSET``; with ELSET the nodes of the elements of this set."""
    if card.option("ELSET"):
        name = _name(card, "NSET")
        scope.grow(scope.node_sets, name, card)
        scope.of_elements.append((name.upper(), card.option("ELSET")))
    else:
        _read_set(scope, scope.node_sets, card, "NSET")


def read_element_set(scope: Scope, card: Card, left_out: Register) -> None:
    """Add the entries of ``*ELSET``."""
    _read_set(scope, scope.element_sets, card, "ELSET")


def read_surface(scope: Scope, card: Card, left_out: Register) -> None:
    """Add the faces or nodes of ``*SURFACE``; analytical and combined surfaces are left out."""
    kind = card.option("TYPE").upper() or "ELEMENT"
    name = _name(card, "NAME")
    if kind not in ("ELEMENT", "NODE") or card.option("COMBINE") or "CROP" in card.options:
        what = f"TYPE={kind}" if kind not in ("ELEMENT", "NODE") else "COMBINE"
        left_out.add(f"*SURFACE, {what}", [card.place], f"surface {name} becomes no tag; a tag by nodes can replace it")
        return
    nodes = kind == "NODE"
    made = scope.surfaces.setdefault((name.upper(), nodes), Surface(name, card.place, nodes))
    for row in card.rows:
        item, face, *_ = padded(row, 2)
        made.items.append((item, face.upper()))


def _read_set(scope: Scope, sets: dict[str, NamedSet], card: Card, option: str) -> None:
    """Add the labels, names or ranges of the data lines to a set."""
    made = scope.grow(sets, _name(card, option), card)
    owner = card.option("INSTANCE").upper()
    for row in card.rows:
        entries = [entry for entry in fields(row) if entry]
        if "GENERATE" in card.options:
            made.items.extend((owner, item) for item in _ranges(card, entries))
        else:
            made.items.extend((owner, label_or_name(entry)) for entry in entries)


def _ranges(card: Card, entries: list[str]) -> list[range]:
    """Range of a line of first label, last label and increment; without an increment it is one."""
    if not 1 <= len(entries) <= 3:
        raise card.wrong(f"{', '.join(entries)!r:.60} is no range", "first label, last label, increment")
    first = whole(card, entries[0])
    last = whole(card, entries[1]) if len(entries) > 1 else first
    by = whole(card, entries[2]) if len(entries) > 2 else 1
    if by <= 0 or last < first:
        raise card.wrong(f"the range from {first} to {last} by {by} is empty", "first label, last label, increment > 0")
    return [range(first, last + 1, by)]


def _name(card: Card, option: str) -> str:
    """Name that a card must have."""
    found = card.option(option)
    if not found:
        raise card.wrong(f"no {option}=NAME", f"a name: {card.title}, {option}=NAME")
    return found
