"""Scope of numbers and names in a deck: the deck itself, a part, or an instance."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.meshes.files.abaqus.lexer import Card

MOST = 10_000_000
"""Greatest number of nodes, and of elements, that a deck may define or generate."""

Point = tuple[float, float, float]
Members = dict[str, list[int]]
"""Labels of nodes or elements by the name of the instance in capitals; the empty name is the scope itself."""


@dataclass(frozen=True, slots=True)
class NamedSet:
    """Set of nodes or elements as written.

    Parameters
    ----------
    name
        Name in its first spelling.
    places
        Lines that define it.
    items
        Labels, ranges of labels, names of other sets, each with the instance (in capitals) that it belongs to.
    """

    name: str
    places: list[str] = field(default_factory=list)
    items: list[tuple[str, int | range | str]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Surface:
    """Surface as written: label or name of a set, with the label of the face; ``nodes`` for a surface of nodes."""

    name: str
    place: str
    nodes: bool
    items: list[tuple[str, str]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Scope:
    """Nodes, elements and sets that share their numbers and names.

    Parameters
    ----------
    name
        Name of the part or instance; empty for the deck itself.
    place
        Line of its card.
    nodes
        Coordinates by label.
    elements
        Element type and labels of nodes, by label.
    node_sets, element_sets
        By name in capitals.
    surfaces
        By name in capitals, and true for surfaces of nodes.
    of_elements
        Node set, in capitals, and the element set whose nodes it has.
    types
        Lines of the cards with elements, by type.
    origin, axes
        System of coordinates in which nodes are given: its origin (3,) and its axes as columns (3, 3).
    """

    name: str = ""
    place: str = ""
    nodes: dict[int, Point] = field(default_factory=dict)
    elements: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    node_sets: dict[str, NamedSet] = field(default_factory=dict)
    element_sets: dict[str, NamedSet] = field(default_factory=dict)
    surfaces: dict[tuple[str, bool], Surface] = field(default_factory=dict)
    of_elements: list[tuple[str, str]] = field(default_factory=list)
    types: dict[str, list[str]] = field(default_factory=dict)
    origin: Array = field(default_factory=lambda: np.zeros(3))
    axes: Array = field(default_factory=lambda: np.eye(3))

    def add_node(self, card: Card, label: int, place: Point, *, made: bool = False) -> None:
        """Add a node; the same one again is admitted, one at another place is refused."""
        old = self.nodes.get(label)
        if old is not None and old != place and not (made and np.allclose(old, place, rtol=1e-9, atol=1e-12)):
            problem = f"node {label} lies at {_text(place)}, but an earlier line puts it at {_text(old)}"
            raise card.wrong(problem, "number the nodes of the parts apart, or put each part into a *PART of its own")
        if len(self.nodes) >= MOST:
            raise card.wrong(f"more than {MOST:,} nodes", "a coarser mesh")
        if old is None:
            self.nodes[label] = place

    def add_element(self, card: Card, label: int, kind: str, nodes: tuple[int, ...]) -> None:
        """Add an element; the same one again is admitted, a different one of the same label is refused."""
        old = self.elements.get(label)
        if old is not None and old != (kind, nodes):
            problem = f"element {label} is defined twice, with different nodes or types"
            raise card.wrong(problem, "number the elements of the parts apart, or put each part into a *PART")
        if len(self.elements) >= MOST:
            raise card.wrong(f"more than {MOST:,} elements", "a coarser mesh")
        self.elements[label] = kind, nodes

    def grow(self, sets: dict[str, NamedSet], name: str, card: Card) -> NamedSet:
        """Set of a name, made if it is new."""
        found = sets.setdefault(name.upper(), NamedSet(name))
        found.places.append(card.place)
        return found

    def members(self, item: int | str, known: "Known", *, nodes: bool) -> Members:
        """Labels that a label or the name of a set stands for, with the sets in it, as far as they exist, each once."""
        found: Members = {}
        todo, seen = [known.target("", item, nodes)], set()
        while todo:
            owner, target = todo.pop()
            if not isinstance(target, str):
                found.setdefault(owner, []).extend(_existing(target, known.labels(owner, nodes)))
            elif (owner, target) not in seen:
                seen.add((owner, target))
                chosen = known.sets(owner, nodes).get(target)
                todo += [known.target(of or owner, entry, nodes) for of, entry in chosen.items] if chosen else []
        return {owner: list(dict.fromkeys(labels)) for owner, labels in found.items()}


@dataclass(frozen=True, slots=True)
class Known:
    """Scope with the instances that its names may refer to, by name in capitals."""

    scope: Scope
    instances: Mapping[str, Scope] = field(default_factory=dict)

    def of(self, owner: str) -> Scope:
        """Scope of an instance; the scope itself for the empty name."""
        if not owner:
            return self.scope
        if owner not in self.instances:
            there = ", ".join(scope.name for scope in self.instances.values()) or "no instances"
            raise InputError("path", f"instance {owner!r:.60} is not in the deck", f"one of: {there}")
        return self.instances[owner]

    def sets(self, owner: str, nodes: bool) -> Mapping[str, NamedSet]:
        """Node sets or element sets of an instance."""
        return self.of(owner).node_sets if nodes else self.of(owner).element_sets

    def target(self, owner: str, item: int | range | str, nodes: bool) -> tuple[str, int | range | str]:
        """Owner and entry that an entry of a set stands for, such as the set or the label in ``instance.set``."""
        if not isinstance(item, str) or item.upper() in self.sets(owner, nodes):
            return owner, item.upper() if isinstance(item, str) else item
        head, dot, rest = item.upper().partition(".")
        while dot and head not in self.instances and "." in rest:
            more, _, rest = rest.partition(".")
            head = f"{head}.{more}"
        if owner or not dot or head not in self.instances:
            return owner, item.upper()
        return head, int(rest) if rest.isdecimal() and len(rest) < 20 else rest

    def labels(self, owner: str, nodes: bool) -> Collection[int]:
        """Labels of the nodes or elements of an instance."""
        return self.of(owner).nodes if nodes else self.of(owner).elements


def _existing(item: int | range, labels: Collection[int]) -> list[int]:
    """Labels of an entry of a set that exist; a long range costs no more than the labels do."""
    if isinstance(item, int):
        return [item] if item in labels else []
    if len(item) <= len(labels):
        return [label for label in item if label in labels]
    return sorted(label for label in labels if label in item)


def _text(place: Point) -> str:
    return "(" + ", ".join(f"{x:g}" for x in place) + ")"
