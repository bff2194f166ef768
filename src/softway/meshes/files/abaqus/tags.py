"""Tags of a deck: nodes of its node sets, surfaces, element sets and instances."""

from collections import Counter
from collections.abc import Iterable, Mapping

import numpy as np

from softway.arrays import IntArray
from softway.meshes.cells import CELLS, FACETS
from softway.meshes.files.abaqus.cell_types import cell_type, face_number
from softway.meshes.files.abaqus.entries import label_or_name
from softway.meshes.files.abaqus.left_out import Register
from softway.meshes.files.abaqus.scope import Known, Members, NamedSet, Scope, Surface

_BUILT_IN = ("all", "surface")

Numbers = Mapping[str, Mapping[int, int]]


def tags_of(pieces: Mapping[str, Scope], numbers: Numbers, left_out: Register) -> dict[str, IntArray]:
    """Numbers of the nodes by tag.

    A set of an instance is called ``instance.set``; without the name of the instance too if there is only one.  If sets
    of different kinds have the same name, the tag is the node set, then the surface; the others are called
    ``SURFACE=name`` and ``ELSET=name``.
    """
    found: dict[str, IntArray] = {}
    for piece, scope in pieces.items():
        instances = pieces if piece == "" else {}
        known = Known(scope, {name: of for name, of in instances.items() if name})
        reader = _Tags(known, piece, numbers, left_out)
        own = reader.all()
        prefix = f"{scope.name}." if piece else ""
        found |= {f"{prefix}{name}": nodes for name, nodes in own.items()}
        if piece and len(pieces) == 2:
            found = own | found
        if piece:
            used = (node for _, nodes in scope.elements.values() for node in nodes if node in numbers[piece])
            found.setdefault(scope.name, _array(numbers[piece][node] for node in dict.fromkeys(used)))
    for name in list(found):
        if name not in _BUILT_IN and name.lower() in _BUILT_IN:
            found.setdefault(name.lower(), found[name])
    return {name: nodes for name, nodes in found.items() if len(nodes)}


class _Tags:
    """Tags of one scope; ``piece`` is its name in capitals."""

    def __init__(self, known: Known, piece: str, numbers: Numbers, left_out: Register) -> None:
        self.known, self.piece, self.numbers, self.left_out = known, piece, numbers, left_out
        self.scope = known.scope
        self.shared: dict[str, Counter[frozenset[int]]] = {}

    def all(self) -> dict[str, IntArray]:
        """Numbers of the nodes by the names of the sets."""
        found: dict[str, IntArray] = {}
        scope = self.scope
        for key, one in scope.node_sets.items():
            nodes = self._nodes(key)
            self._require(one, nodes=True, empty=not len(nodes))
            _put(found, one.name, "NSET", nodes)
        for surface in scope.surfaces.values():
            _put(found, surface.name, "SURFACE", self._surface(surface))
        for key, one in scope.element_sets.items():
            members = scope.members(key, self.known, nodes=False)
            self._require(one, nodes=False, empty=not any(members.values()))
            _put(found, one.name, "ELSET", self._of_elements(members))
        return found

    def _nodes(self, key: str) -> IntArray:
        """Nodes of a node set."""
        scope = self.scope
        members = scope.members(key, self.known, nodes=True)
        parts = [self._number(owner, labels) for owner, labels in members.items()]
        for name, source in scope.of_elements:
            if name == key:
                parts.append(self._of_elements(scope.members(source, self.known, nodes=False)))
        return np.unique(np.concatenate(parts)) if parts else _array(())

    def _of_elements(self, members: Members) -> IntArray:
        """Nodes of elements."""
        parts = []
        for owner, labels in members.items():
            elements = self.known.of(owner).elements
            parts.append(self._number(owner, dict.fromkeys(n for label in labels for n in elements[label][1])))
        return np.unique(np.concatenate(parts)) if parts else _array(())

    def _number(self, owner: str, labels: Iterable[int]) -> IntArray:
        """Numbers of nodes by their labels, as far as they exist."""
        number = self.numbers[owner or self.piece]
        return _array(number[label] for label in labels if label in number)

    def _surface(self, surface: Surface) -> IntArray:
        """Nodes of the faces of a surface."""
        parts = [_array(())]
        if not surface.items:
            self._lost(surface, "it is empty")
        for item, face in surface.items:
            members = self.scope.members(label_or_name(item), self.known, nodes=surface.nodes)
            if not members or not any(members.values()):
                self._lost(surface, f"{item:.60} does not exist")
            elif surface.nodes:
                parts += [self._number(owner, labels) for owner, labels in members.items()]
            else:
                parts += [self._faces(surface, owner, labels, face) for owner, labels in members.items()]
        return np.unique(np.concatenate(parts))

    def _faces(self, surface: Surface, owner: str, labels: Iterable[int], face: str) -> IntArray:
        """Nodes of a face of elements; of the free faces without a label, of all nodes for shells."""
        elements = self.known.of(owner).elements
        found: dict[int, None] = {}
        for label in labels:
            kind, nodes = elements[label]
            meant = cell_type(kind)
            number = face_number(meant.cell, face)
            if meant.place == "marker" and nodes:
                found |= dict.fromkeys(nodes)
            elif meant.cell not in FACETS or meant.place == "other":
                self._lost(surface, f"faces of {kind:.40} are not known")
            elif number is not None:
                found |= dict.fromkeys(nodes[k] for k in FACETS[meant.cell][number][1])
            elif not face:
                found |= dict.fromkeys(node for nodes in self._free(owner, label) for node in nodes)
            else:
                self._lost(surface, f"face {face:.20} of {kind:.40} is not known")
        return self._number(owner, found)

    def _free(self, owner: str, label: int) -> list[tuple[int, ...]]:
        """Faces of an element that no other element of its scope has."""
        elements = self.known.of(owner).elements
        if owner not in self.shared:
            self.shared[owner] = Counter(key for kind, nodes in elements.values() for key, _ in _facets(kind, nodes))
        kind, nodes = elements[label]
        return [face for key, face in _facets(kind, nodes) if self.shared[owner][key] == 1]

    def _require(self, one: NamedSet, *, nodes: bool, empty: bool) -> None:
        """List the entries of a set that do not exist, and a set that is empty."""
        lost, title = 0, "*NSET" if nodes else "*ELSET"
        for owner, item in one.items:
            of, target = self.known.target(owner, item, nodes)
            if isinstance(target, str):
                lost += target not in self.known.sets(of, nodes)
            elif isinstance(target, int):
                lost += target not in self.known.labels(of, nodes)
        if lost or empty:
            why = f"{lost} entries do not exist" if lost else "it is empty"
            self.left_out.add(f"{title}, {title[1:]}={one.name:.60}", one.places, why)

    def _lost(self, surface: Surface, why: str) -> None:
        """List an entry of a surface that is not honoured."""
        self.left_out.add(f"*SURFACE, NAME={surface.name:.60}", [surface.place], why)


def _facets(kind: str, nodes: tuple[int, ...]) -> list[tuple[frozenset[int], tuple[int, ...]]]:
    """Corners and nodes of the facets of an element."""
    cell = cell_type(kind).cell
    if cell not in FACETS or not nodes:
        return []
    sides = [(tuple(nodes[k] for k in local), CELLS[facet].corners) for facet, local in FACETS[cell]]
    return [(frozenset(side[:corners]), side) for side, corners in sides]


def _put(found: dict[str, IntArray], name: str, kind: str, nodes: IntArray) -> None:
    """Add a tag; under its kind and name if the name stands for other nodes already."""
    old = next((key for key in found if key.upper() == name.upper()), None)
    if old is None:
        found[name] = nodes
    elif not np.array_equal(found[old], nodes):
        found[f"{kind}={name}"] = nodes


def _array(values: Iterable[int]) -> IntArray:
    return np.fromiter(values, dtype=np.int64)
