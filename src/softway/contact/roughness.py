"""From the declared laws of friction to the friction of contact rows."""

from collections.abc import Sequence

import numpy as np

from softway.bodies.loads import traction_measure
from softway.bodies.part import Part
from softway.contact.contact import Contact
from softway.contact.encounters import Surfaces
from softway.contact.mortar import Mortar
from softway.contact.nodes_on_tool import NodesOnTool
from softway.contact.rubbing import Rubbing
from softway.errors import InputError
from softway.typing import Array, IntArray

POINT = 1e-9
"""Area of a row without a surface of its own, as a share of the greatest one: a corner beside a mortar surface."""


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
    area, start = np.zeros(len(contact)), 0
    around = [_measures(c, parts) for c in contacts]
    for method in methods:
        rows = slice(start, start + len(method.node))
        k = int(contact[start]) if len(method.node) else 0
        beside = any(isinstance(m, Mortar) for m, _ in _of(contact, methods, k)) and not isinstance(method, Mortar)
        area[rows] = 0.0 if beside else around[k][method.node]
        start = rows.stop
    return Rubbing(
        laws=tuple(c.friction for c in contacts),
        contact=contact,
        area=np.maximum(area, POINT * max(float(area.max(initial=0.0)), 1e-300)),
    )


def _of(
    contact: IntArray, methods: Sequence[NodesOnTool | Surfaces], k: int
) -> list[tuple[NodesOnTool | Surfaces, int]]:
    """The methods of a contact with their first rows."""
    starts = np.cumsum([0, *(len(m.node) for m in methods)])[:-1]
    return [(m, int(s)) for m, s in zip(methods, starts, strict=True) if len(m.node) and contact[s] == k]


def _measures(contact: Contact, parts: Sequence[Part]) -> Array:
    """Area (n,) of the declared surfaces around each node of the model, with thickness or circumference [m^2]."""
    out = np.zeros(sum(p.mesh.n_nodes for p in parts))
    for name, tag in ((contact.body, contact.tag), (contact.opponent, contact.opponent_tag)):
        for part in (p for p in parts if p.name == name):
            out[part.rows] += traction_measure(part.mesh, part.internal.section, tag)
    return out
