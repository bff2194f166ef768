"""Ties of a deck: pairs of surfaces that are glued."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from softway.meshes.files.abaqus.entries import padded
from softway.meshes.files.abaqus.left_out import Register
from softway.meshes.files.abaqus.lexer import Card
from softway.meshes.files.abaqus.scope import Scope
from softway.meshes.files.listed_mesh import FileTie

_KNOWN = {"NAME", "TYPE", "ADJUST", "POSITIONTOLERANCE", "NOROTATION", "NOTHICKNESS"}


@dataclass(frozen=True, slots=True)
class DeckTie:
    """Tie as written: its title, line, the part or instance that it is in, and the names of its surfaces."""

    title: str
    place: str
    of: str
    surfaces: tuple[str, str]


def read_ties(scope: Scope, card: Card, left_out: Register) -> list[DeckTie]:
    """Ties of ``*TIE``, one of each data line; with parameters of another meaning there is none."""
    title = f"{card.title}, NAME={card.option('NAME'):.60}" if card.option("NAME") else card.title
    strange = [option for option in card.options if option not in _KNOWN]
    if strange:
        left_out.add(title, [card.place], f"{', '.join(strange):.80} is not honoured: nothing is glued")
        return []
    if card.option("ADJUST").upper() == "NO":
        left_out.add(f"{title}, ADJUST=NO", [card.place], "the nodes that follow are moved onto the other surface")
    if card.option("POSITIONTOLERANCE"):
        meaning = "gaps up to 0.05 edges are closed; a tie of the scenario has a tolerance of its own"
        left_out.add(f"{title}, POSITION TOLERANCE", [card.place], meaning)
    found = []
    for row in card.rows:
        one, two, *_ = (entry.strip("\"'") for entry in padded(row, 2))
        if one and two:
            found.append(DeckTie(title, card.place, scope.name.upper(), (one, two)))
        else:
            left_out.add(title, [card.place], f"{row.strip()!r:.60} does not name two surfaces: nothing is glued")
    return found


def ties_of(
    ties: Iterable[DeckTie], scopes: Mapping[str, tuple[Scope, str]], tags: Iterable[str], left_out: Register
) -> tuple[FileTie, ...]:
    """Ties between tags; of a tie in a part one in each of its instances.

    ``scopes`` are the instances with their parts, by name in capitals. Ties of surfaces that are no tags are listed.
    """
    known = {tag.upper(): tag for tag in tags}
    found = []
    for tie in ties:
        inside = [f"{scope.name}." for name, (scope, part) in scopes.items() if name and tie.of in (name, part)]
        for prefix in inside if tie.of else [""]:
            pair = [_tag(known, prefix, surface) for surface in tie.surfaces]
            missing = [s for s, tag in zip(tie.surfaces, pair, strict=True) if not tag]
            if missing:
                left_out.add(tie.title, [tie.place], f"surface {missing[0]:.60} has no nodes: nothing is glued")
            else:
                found.append(FileTie(title=tie.title, between=(pair[0], pair[1]), line=tie.place))
    return tuple(found)


def _tag(known: Mapping[str, str], prefix: str, surface: str) -> str:
    """Tag of a surface, which has its kind before its name if a node set has the same name; empty without one."""
    head, dot, name = f"{prefix}{surface}".upper().rpartition(".")
    return known.get(f"{head}{dot}SURFACE={name}") or known.get(f"{head}{dot}{name}") or ""
