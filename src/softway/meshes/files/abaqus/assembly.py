"""Mesh of a deck: cells of the instances, tags of their sets, and the list of what the mesh does not hold."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from softway.arrays import Array, IntArray
from softway.errors import InputError
from softway.meshes.cells import FACETS
from softway.meshes.files.abaqus.cards.ties import ties_of
from softway.meshes.files.abaqus.cell_types import cell_type
from softway.meshes.files.abaqus.choice import chosen_elements
from softway.meshes.files.abaqus.deck import Deck, placed, read_deck
from softway.meshes.files.abaqus.regions import regions_of
from softway.meshes.files.abaqus.scope import Scope
from softway.meshes.files.abaqus.tags import tags_of
from softway.meshes.files.listed_mesh import ListedMesh

_DIMS = {"bar": 1, "tri": 2, "quad": 2, "tet": 3, "hex": 3, "wedge": 3, "pyramid": 3}


def deck_mesh(path: Path, cells: Sequence[str] | None = None, only: Sequence[str] = ()) -> ListedMesh:
    r"""Read the mesh of an input deck.

    Parameters
    ----------
    path
        Path of the deck.
    cells
        Names of the cells to keep; by default all cells of the highest dimension.
    only
        Names of the instances, parts or element sets to keep; by default all.

    Raises
    ------
    InputError
        For a deck that cannot be read, or that has no cells of a body.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "a.inp"
    >>> text = "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT, TYPE=CPE3, ELSET=E\n1, 1,2,3\n*BOUNDARY\n1,1,2\n"
    >>> _ = path.write_text(text)
    >>> mesh = deck_mesh(path)
    >>> mesh.blocks["tri3"].tolist(), mesh.tags["E"].tolist(), [str(card) for card in mesh.left_out]
    ([[0, 1, 2]], [0, 1, 2], ['*BOUNDARY (1; line 7)'])
    """
    deck = read_deck(path)
    scopes = placed(deck)
    pieces = {name: scope for name, (scope, _) in scopes.items()}
    numbers, points = _numbered(pieces)
    wanted = chosen_elements(deck, scopes, only)
    kept = _kept(pieces, wanted, cells, path)
    blocks = {cell: _block(pieces, numbers, members, deck) for cell, members in kept.items()}
    _list_elements(deck, pieces, set(kept))
    _list_materials(deck)
    tags = tags_of(pieces, numbers, deck.left_out)
    if cells is None and not only:
        _list_unused(deck, blocks, tags, len(points))
    ties = ties_of(deck.ties, scopes, tags, deck.left_out)
    return ListedMesh(points, blocks, tags, deck.left_out.listed(), regions_of(deck, scopes, kept), ties)


def _numbered(pieces: Mapping[str, Scope]) -> tuple[dict[str, dict[int, int]], Array]:
    """Number of each node by piece and label, and all coordinates (n, 3)."""
    numbers: dict[str, dict[int, int]] = {}
    points: list[Array] = [np.empty((0, 3))]
    start = 0
    for name, scope in pieces.items():
        numbers[name] = dict(zip(scope.nodes, range(start, start + len(scope.nodes)), strict=True))
        points.append(np.array(list(scope.nodes.values()), dtype=float).reshape(-1, 3))
        start += len(scope.nodes)
    return numbers, np.concatenate(points)


def _kept(
    pieces: Mapping[str, Scope], wanted: Mapping[str, Iterable[int]], cells: Sequence[str] | None, path: Path
) -> dict[str, dict[str, list[int]]]:
    """Labels of the elements to keep, by cell and piece."""
    found: dict[str, dict[str, list[int]]] = {}
    kinds: Counter[str] = Counter()
    for name, labels in wanted.items():
        elements = pieces[name].elements
        for label in labels:
            kind = elements[label][0]
            kinds[kind] += 1
            meant = cell_type(kind)
            if meant.cell in cells if cells is not None else meant.place == "body":
                found.setdefault(meant.cell, {}).setdefault(name, []).append(label)
    dim = max((_dim(cell) for cell in found), default=0)
    found = {cell: parts for cell, parts in found.items() if _dim(cell) == dim or cells is not None}
    there = ", ".join(f"{kind} ({count})" for kind, count in kinds.items())
    if not found:
        problem = f"{path.name} has no cells of a body{': ' if there else ''}{there:.300}"
        if cells is not None:
            raise InputError("cells", f"none of the wanted cells among {there or 'no cells'}", f"one of: {_known()}")
        raise InputError("path", problem, "solid elements such as C3D8 or C3D4, or plane ones such as CPE4")
    unknown = [cell for cell in found if cell not in FACETS]
    if unknown:
        types = ", ".join(f"{kind} ({count})" for kind, count in kinds.items() if cell_type(kind).cell in unknown)
        raise InputError("path", f"elements of type {types} are not supported", f"mesh with: {_known()}")
    return found


def _known() -> str:
    return ", ".join(FACETS)


def _dim(cell: str) -> int:
    """Topological dimension of a cell by its name."""
    return _DIMS.get(cell.rstrip("0123456789"), 0)


def _block(
    pieces: Mapping[str, Scope], numbers: Mapping[str, Mapping[int, int]], members: Mapping[str, list[int]], deck: Deck
) -> IntArray:
    """Numbers of the nodes (e, a) of the elements of one cell."""
    rows = []
    for name, labels in members.items():
        elements, number = pieces[name].elements, numbers[name]
        for label in labels:
            try:
                rows.append([number[node] for node in elements[label][1]])
            except KeyError as error:
                of = f" of {pieces[name].name}" if name else ""
                missed = [entry.card for entry in deck.left_out.listed() if entry.meaning.endswith("generates nothing")]
                hint = f"; the deck has {', '.join(missed)}, which is not honoured" if missed else ""
                problem = f"element {label}{of} names node {error.args[0]}, which is not defined"
                raise InputError("path", problem, f"define the node by *NODE{hint}") from None
    return np.array(rows, dtype=np.int64)


def _list_elements(deck: Deck, pieces: Mapping[str, Scope], kept: set[str]) -> None:
    """List the element types that are no cells of the mesh, with their numbers of elements."""
    counts = Counter(kind for scope in pieces.values() for kind, _ in scope.elements.values())
    for kind, count in counts.items():
        meant = cell_type(kind)
        if meant.cell in kept and meant.place == "body":
            if kind.startswith(("CAX", "DCAX")):
                _list_type(deck, kind, count, 'the body is axially symmetric only with section = "Axisymmetric"')
            continue
        if meant.place == "other":
            _list_type(deck, kind, count, "no cells of a body")
        elif meant.place == "marker":
            _list_type(deck, kind, count, "no cells of a body; their sets are tags")
        else:
            _list_type(deck, kind, count, "cells of lower dimension; their sets are tags", matters=False)


def _list_unused(deck: Deck, blocks: Mapping[str, IntArray], tags: Mapping[str, IntArray], count: int) -> None:
    """List the nodes that belong to no cell, and the sets of such nodes alone."""
    used = np.zeros(count, dtype=bool)
    for nodes in blocks.values():
        used[nodes] = True
    if not used.all():
        deck.left_out.add("*NODE", [], "nodes that belong to no cell", count=int((~used).sum()), matters=False)
    for name, nodes in tags.items():
        if not used[nodes].any():
            deck.left_out.add(f"set {name:.60}", [], "none of its nodes belongs to a cell", count=1, matters=False)


def _list_type(deck: Deck, kind: str, count: int, meaning: str, *, matters: bool = True) -> None:
    scopes = (deck.root, *deck.parts.values(), *(instance.own for instance in deck.instances.values()))
    places = [place for scope in scopes for place in scope.types.get(kind, ())]
    deck.left_out.add(f"*ELEMENT, TYPE={kind:.40}", places, meaning, count=count, matters=matters)


def _list_materials(deck: Deck) -> None:
    """List the sections; several materials with their element sets and the way to give their laws."""
    materials: dict[str, str] = {}
    for section in deck.sections:
        if section.material:
            materials.setdefault(section.material.upper(), section.material)
    for title in dict.fromkeys(section.title for section in deck.sections):
        of = [section for section in deck.sections if section.title == title]
        named = ", ".join(f"{s.of} of {s.material}" for s in of if s.material)
        meaning = f"{named:.400}; the body has one material" if named else ""
        if len(materials) > 1 and named:
            laws = ", ".join(f'"{name:.60}" = ...' for name in list(materials.values())[:6])
            meaning = f"{named:.400}; give a law to each region, material = {{ {laws} }}; or "
            meaning += f'make one body of each: mesh = {{ ..., only = "{of[0].of:.60}" }}'
        deck.left_out.add(title, [section.place for section in of], meaning)
