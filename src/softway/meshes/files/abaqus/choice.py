"""Elements of the instances, parts and element sets that a body consists of."""

from collections.abc import Iterable, Mapping, Sequence

from softway.errors import InputError
from softway.meshes.files.abaqus.deck import Deck
from softway.meshes.files.abaqus.scope import Known, Members, Scope


def chosen_elements(
    deck: Deck, scopes: Mapping[str, tuple[Scope, str]], only: Sequence[str]
) -> Mapping[str, Iterable[int]]:
    """Labels of the elements by piece (name of the instance in capitals); without names all of them.

    Raises
    ------
    InputError
        If a name is no instance, no part and no element set.
    """
    pieces = {name: scope for name, (scope, _) in scopes.items()}
    if not only:
        return {name: scope.elements for name, scope in pieces.items()}
    found: dict[str, dict[int, None]] = {}
    for name in only:
        for piece, labels in _named(scopes, pieces, name).items():
            found.setdefault(piece, {}).update(dict.fromkeys(labels))
    return found


def _named(scopes: Mapping[str, tuple[Scope, str]], pieces: Mapping[str, Scope], name: str) -> Members:
    """Labels of the elements that a name stands for."""
    key, root = name.upper(), pieces[""]
    if key in root.element_sets:
        return root.members(key, Known(root, pieces), nodes=False)
    whole = [piece for piece, (_, part) in scopes.items() if piece and key in (piece, part)]
    if whole:
        return {piece: list(pieces[piece].elements) for piece in whole}
    found: Members = {}
    for piece, (scope, part) in scopes.items():
        for prefix in (piece, part) if piece else ():
            inner = key.removeprefix(f"{prefix}.")
            if inner != key and inner in scope.element_sets:
                found[piece] = scope.members(inner, Known(scope), nodes=False).get("", [])
    if not found:
        known = [scope.name for scope, _ in scopes.values() if scope.name]
        known += [own.name for own in root.element_sets.values()]
        known += [f"{scope.name}.{own.name}" for scope, _ in scopes.values() for own in scope.element_sets.values()]
        shown = ", ".join(dict.fromkeys(one.removeprefix(".") for one in known[:40])) or "no instances and element sets"
        raise InputError("only", f"{name!r:.60} is no instance, part or element set of the deck", f"one of: {shown}")
    return found
