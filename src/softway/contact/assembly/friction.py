"""Friction laws of the rows of all contacts."""

from collections.abc import Sequence

import numpy as np

from softway.arrays import IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.contact.contact import Contact
from softway.contact.friction_rows import AreaPatch, FrictionRows, surfaces_of
from softway.contact.mortar.mortar import Mortar
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.contact.stencils import SurfacePair
from softway.errors import InputError


def assemble_friction(
    contacts: Sequence[Contact],
    methods: Sequence[NodeToTool | SurfacePair],
    number: Sequence[IntArray],
    parts: Sequence[DiscreteSolid],
) -> FrictionRows:
    """Assemble the friction laws of all rows.

    Arguments: the methods of all contacts in order, and the number ``k`` of each contact, repeated for its rows.

    Raises
    ------
    InputError
        If a contact of bars has friction: their ends have no tangential direction.
    """
    contact = np.concatenate([np.zeros(0, int), *number])
    laws = tuple(c.friction for c in contacts)
    if all(law.frictionless for law in laws):
        return FrictionRows(laws=laws, contact=contact, area=np.ones(len(contact)))
    if parts[0].mesh.dim == 1:
        raise InputError("contacts[0].friction", "friction in 1D", "a mesh of two or three dimensions")
    patches, start = [], 0
    for method in methods:
        rows = np.arange(start, start + len(method.node))
        k = int(contact[start]) if len(method.node) else 0
        beside = any(isinstance(m, Mortar) for m in _of(contact, methods, k)) and not isinstance(method, Mortar)
        if not beside and len(rows):
            patches.append(AreaPatch(rows=rows, node=method.node, surfaces=surfaces_of(contacts[k], parts)))
        start += len(rows)
    none = np.zeros(sum(p.mesh.n_nodes for p in parts) * parts[0].mesh.dim).reshape(-1, parts[0].mesh.dim)
    rough = FrictionRows(laws=laws, contact=contact, area=np.ones(len(contact)), patches=tuple(patches))
    return rough.at(none)


def _of(contact: IntArray, methods: Sequence[NodeToTool | SurfacePair], k: int) -> list[NodeToTool | SurfacePair]:
    """Methods of a contact."""
    starts = np.cumsum([0, *(len(m.node) for m in methods)])[:-1]
    return [m for m, s in zip(methods, starts, strict=True) if len(m.node) and contact[s] == k]
