"""Walk through the cards of a deck: parts, instances and what they hold."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np

from softway.meshes.files.abaqus.cards.elements import copy_elements, generate_elements, read_elements
from softway.meshes.files.abaqus.cards.nodes import copy_nodes, fill_nodes, generate_nodes, read_nodes, read_system
from softway.meshes.files.abaqus.cards.sets import read_element_set, read_node_set, read_surface
from softway.meshes.files.abaqus.cards.ties import DeckTie, read_ties
from softway.meshes.files.abaqus.cards.transforms import rotated
from softway.meshes.files.abaqus.entries import padded, point, real
from softway.meshes.files.abaqus.left_out import Register
from softway.meshes.files.abaqus.lexer import Card, cards
from softway.meshes.files.abaqus.scope import Scope

Handler = Callable[[Scope, Card, Register], None]
_HANDLERS: Mapping[str, tuple[Handler, frozenset[str]]] = MappingProxyType(
    {
        "NODE": (read_nodes, frozenset({"NSET", "SYSTEM", "INPUT"})),
        "SYSTEM": (read_system, frozenset()),
        "NGEN": (generate_nodes, frozenset({"LINE", "NSET", "SYSTEM"})),
        "NFILL": (fill_nodes, frozenset({"NSET", "BIAS"})),
        "NCOPY": (
            copy_nodes,
            frozenset({"CHANGENUMBER", "OLDSET", "NEWSET", "SHIFT", "MULTIPLE", "REFLECT", "POLE"}),
        ),
        "ELEMENT": (read_elements, frozenset({"TYPE", "ELSET", "INPUT"})),
        "ELGEN": (generate_elements, frozenset({"ELSET", "ALLNODES"})),
        "ELCOPY": (copy_elements, frozenset({"ELEMENTSHIFT", "OLDSET", "NEWSET", "SHIFTNODES", "REFLECT"})),
        "NSET": (read_node_set, frozenset({"NSET", "ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "INPUT"})),
        "ELSET": (read_element_set, frozenset({"ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "INPUT"})),
        "SURFACE": (read_surface, frozenset({"NAME", "TYPE", "INTERNAL", "COMBINE", "CROP", "INPUT"})),
    }
)
_GENERATORS = {"NGEN", "NFILL", "NCOPY", "ELGEN", "ELCOPY"}


@dataclass(frozen=True, slots=True)
class DeckSection:
    """DeckSection of a deck: its keyword, line, element set, the part that it is in, and its material."""

    title: str
    place: str
    of: str
    material: str


@dataclass(frozen=True, slots=True)
class Instance:
    """Instance of a part as written: its names, its card with the lines of its position, and nodes of its own."""

    name: str
    part: str
    card: Card
    own: Scope


@dataclass(frozen=True, slots=True)
class Deck:
    """Contents of a deck before its instances are placed.

    Parameters
    ----------
    root
        Scope of all that is in no part and no instance.
    parts
        Scopes of the parts by name in capitals.
    instances
        Instances in their order, by name in capitals.
    sections
        Sections, which give materials to element sets.
    ties
        Pairs of surfaces that are glued.
    left_out
        Cards that are not honoured.
    """

    root: Scope = field(default_factory=Scope)
    parts: dict[str, Scope] = field(default_factory=dict)
    instances: dict[str, Instance] = field(default_factory=dict)
    sections: list[DeckSection] = field(default_factory=list)
    ties: list[DeckTie] = field(default_factory=list)
    left_out: Register = field(default_factory=Register)


def read_deck(path: Path) -> Deck:
    """Read all cards of a deck.

    Raises
    ------
    InputError
        For a card that cannot be read, with its line.
    """
    deck = Deck()
    here = deck.root
    for card in cards(path):
        match card.name:
            case "PART":
                here = _part(deck, card)
            case "INSTANCE":
                here = _instance(deck, card)
            case "ENDPART" | "ENDINSTANCE":
                here = deck.root
            case name if name in _HANDLERS:
                _honoured(deck, here, card)
            case "TIE":
                deck.ties.extend(read_ties(here, card, deck.left_out))
            case name if name.endswith("SECTION") and card.option("ELSET"):
                of = f"{here.name}.{card.option('ELSET')}" if here.name else card.option("ELSET")
                deck.sections.append(DeckSection(card.title, card.place, of, card.option("MATERIAL")))
            case name if name != "ASSEMBLY" and not name.startswith("END"):
                deck.left_out.card(card)
    return deck


def placed(deck: Deck) -> dict[str, tuple[Scope, str]]:
    """Scopes of all instances at their places with the names of their parts in capitals, by name in capitals.

    Without any instance each part is taken as it is; the deck itself has the empty name.
    """
    found: dict[str, tuple[Scope, str]] = {"": (deck.root, "")}
    if not deck.instances:
        return found | {name: (part, name) for name, part in deck.parts.items()}
    for name, instance in deck.instances.items():
        if instance.part.upper() not in deck.parts:
            known = ", ".join(part.name for part in deck.parts.values()) or "no parts"
            raise instance.card.wrong(f"part {instance.part!r:.60} is not in the deck", f"one of: {known}")
        found[name] = _moved(deck.parts[instance.part.upper()], instance), instance.part.upper()
    used = {instance.part.upper() for instance in deck.instances.values()}
    for name, part in deck.parts.items():
        if name not in used:
            deck.left_out.add("*PART", [part.place], f"part {part.name} has no instance in the assembly")
    return found


def _honoured(deck: Deck, here: Scope, card: Card) -> None:
    """Read a card; parameters that are not honoured are listed, with the whole card if it generates."""
    handler, known = _HANDLERS[card.name]
    strange = [option for option in card.options if option not in known]
    for option in strange:
        skipped = "the card generates nothing" if card.name in _GENERATORS else ""
        deck.left_out.add(f"{card.title}, {option:.40}", [card.place], skipped)
    if not strange or card.name not in _GENERATORS:
        handler(here, card, deck.left_out)


def _part(deck: Deck, card: Card) -> Scope:
    """Scope of a new part."""
    name = card.option("NAME")
    if not name or name.upper() in deck.parts:
        problem = f"part {name:.60} is defined twice" if name else "no NAME"
        raise card.wrong(problem, "a name of its own for each part: *PART, NAME=NAME")
    deck.parts[name.upper()] = Scope(name, card.place)
    return deck.parts[name.upper()]


def _instance(deck: Deck, card: Card) -> Scope:
    """Scope of the nodes and elements that an instance has besides those of its part."""
    name, part = card.option("NAME"), card.option("PART")
    own = Scope(name)
    if not part or not name:
        deck.left_out.add("*INSTANCE", [card.place], f"{name or 'it'} names no part of this deck")
        return own
    if name.upper() in deck.instances:
        raise card.wrong(f"instance {name:.60} is defined twice", "a name of its own for each instance")
    deck.instances[name.upper()] = Instance(name, part, card, own)
    return own


def _moved(part: Scope, instance: Instance) -> Scope:
    """Nodes, elements and sets of a part, moved by the lines of its instance, with those of the instance itself."""
    own, card = instance.own, instance.card
    rows = [padded(row, 7) for row in card.rows]
    places = np.array(list(part.nodes.values()), dtype=float).reshape(-1, 3)
    if rows:
        places = places + np.array(point(card, rows[0]))
    if len(rows) > 1:
        a, b = np.array(point(card, rows[1])), np.array(point(card, rows[1][3:]))
        if not np.linalg.norm(b - a) > 0.0 and real(card, rows[1][6]) != 0.0:
            raise card.wrong("the axis of rotation has no length", "two distinct points on the axis, and an angle")
        places = rotated(places, a, b, real(card, rows[1][6]))
    nodes = {label: (x, y, z) for label, (x, y, z) in zip(part.nodes, places.tolist(), strict=True)}
    pairs = [(getattr(part, name), getattr(own, name)) for name in ("nodes", "elements", "node_sets", "element_sets")]
    both = [str(key) for one, other in pairs for key in one.keys() & other.keys()]
    if both:
        raise card.wrong(f"{min(both):.60} occurs in the part and in the instance", "numbers and names of their own")
    return Scope(
        instance.name,
        card.place,
        nodes=nodes | own.nodes,
        elements=part.elements | own.elements,
        node_sets=part.node_sets | own.node_sets,
        element_sets=part.element_sets | own.element_sets,
        surfaces=part.surfaces | own.surfaces,
        of_elements=part.of_elements + own.of_elements,
        types=part.types | own.types,
    )
