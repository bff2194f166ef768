"""Regions of a deck: cells of its element sets and instances, and of the materials of its sections."""

from collections.abc import Mapping, Sequence

import numpy as np

from softway.arrays import IntArray
from softway.errors import InputError
from softway.meshes.files.abaqus.choice import chosen_elements
from softway.meshes.files.abaqus.deck import Deck
from softway.meshes.files.abaqus.scope import Scope

Kept = Mapping[str, Mapping[str, Sequence[int]]]
"""Labels of the elements of the body, by cell and piece."""


def regions_of(deck: Deck, scopes: Mapping[str, tuple[Scope, str]], kept: Kept) -> dict[str, IntArray]:
    """Numbers of the cells by region, in the order of the blocks.

    An element set of an instance is called ``instance.set``; without the name of the instance too if there is only one.
    The elements of all sections of a material are the region of its name, or ``MATERIAL=name`` if other elements have
    that name.
    """
    number, start = dict[tuple[str, int], int](), 0
    for pieces in kept.values():
        for piece, labels in pieces.items():
            number.update({(piece, label): start + k for k, label in enumerate(labels)})
            start += len(labels)
    found = {name: _cells(deck, scopes, (of,), number) for name, of in _set_names(scopes).items()}
    for material in dict.fromkeys(section.material for section in deck.sections if section.material):
        same = [s.of for s in deck.sections if s.material.upper() == material.upper()]
        cells = _cells(deck, scopes, same, number)
        old = next((key for key in found if key.upper() == material.upper()), None)
        if old is None:
            found[material] = cells
        elif not np.array_equal(found[old], cells):
            found[f"MATERIAL={material}"] = cells
    return {name: cells for name, cells in found.items() if len(cells)}


def _set_names(scopes: Mapping[str, tuple[Scope, str]]) -> dict[str, str]:
    """Names of the regions of sets and instances, and the names by which the deck calls them."""
    names: dict[str, str] = {}
    for piece, (scope, _) in scopes.items():
        prefix = f"{scope.name}." if piece else ""
        names |= {f"{prefix}{one.name}": f"{prefix}{one.name}" for one in scope.element_sets.values()}
        if piece and len(scopes) == 2:
            names = {one.name: f"{prefix}{one.name}" for one in scope.element_sets.values()} | names
        if piece:
            names.setdefault(scope.name, scope.name)
    return names


def _cells(
    deck: Deck, scopes: Mapping[str, tuple[Scope, str]], of: Sequence[str], number: Mapping[tuple[str, int], int]
) -> IntArray:
    """Numbers of the cells of elements with given names; none for names that the deck does not have."""
    cells: set[int] = set()
    for name in of:
        try:
            chosen = chosen_elements(deck, scopes, (name,))
        except InputError:
            continue
        cells |= {
            number[piece, label] for piece, labels in chosen.items() for label in labels if (piece, label) in number
        }
    return np.array(sorted(cells), dtype=np.int64)
