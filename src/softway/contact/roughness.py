"""From the declared laws of friction to the friction of contact rows."""

from collections.abc import Sequence

import numpy as np

from softway.bodies.part import Part
from softway.contact.contact import Contact
from softway.contact.encounters import Surfaces
from softway.contact.mortar import Mortar
from softway.contact.nodes_on_tool import NodesOnTool
from softway.contact.rubbing import Patch, Rubbing, Surface
from softway.errors import InputError
from softway.typing import IntArray


def rubbing(
    contacts: Sequence[Contact],
    methods: Sequence[NodesOnTool | Surfaces],
    number: Sequence[IntArray],
    parts: Sequence[Part],
) -> Rubbing | None:
    """The friction of all rows; None where no contact has any.

    Arguments: the methods of all contacts in order, and for each contact the numbers ``k`` of its rows.

    Raises
    ------
    InputError
        If a contact of bars has friction: there is no direction along their ends.
    """
    if all(c.friction.frictionless for c in contacts):
        return None
    contact = np.concatenate([np.zeros(0, int), *number])
    if parts[0].mesh.dim == 1:
        raise InputError("contacts[0].friction", "friction in 1D", "a mesh of two or three dimensions")
    patches, start = [], 0
    for method in methods:
        rows = np.arange(start, start + len(method.node))
        k = int(contact[start]) if len(method.node) else 0
        beside = any(isinstance(m, Mortar) for m in _of(contact, methods, k)) and not isinstance(method, Mortar)
        if not beside and len(rows):
            patches.append(Patch(rows=rows, node=method.node, surfaces=surfaces_of(contacts[k], parts)))
        start += len(rows)
    none = np.zeros(sum(p.mesh.n_nodes for p in parts) * parts[0].mesh.dim).reshape(-1, parts[0].mesh.dim)
    laws = tuple(c.friction for c in contacts)
    rough = Rubbing(laws=laws, contact=contact, area=np.ones(len(contact)), patches=tuple(patches))
    return rough.at(none)


def _of(contact: IntArray, methods: Sequence[NodesOnTool | Surfaces], k: int) -> list[NodesOnTool | Surfaces]:
    """The methods of a contact."""
    starts = np.cumsum([0, *(len(m.node) for m in methods)])[:-1]
    return [m for m, s in zip(methods, starts, strict=True) if len(m.node) and contact[s] == k]


def surfaces_of(contact: Contact, parts: Sequence[Part]) -> tuple[Surface, ...]:
    """The declared surfaces of a contact."""
    return tuple(
        Surface(
            nodes=part.rows, points=part.mesh.points, section=part.internal.section, facets=part.mesh.facets_on(tag)
        )
        for name, tag in ((contact.body, contact.tag), (contact.opponent, contact.opponent_tag))
        for part in parts
        if part.name == name
    )
