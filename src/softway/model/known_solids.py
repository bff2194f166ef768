"""Solids of a model that another model may take over: those that are the very same in both scenes."""

from collections.abc import Mapping, Sequence

import numpy as np

from softway.bodies.assembled.nodal_masses import KnownInertia
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.solid import Solid
from softway.model.layout import Known
from softway.model.model import Model
from softway.model.scene import Scene


def known_parts(model: Model | None) -> Known:
    """Solids of a model with their arrays; without those that a temperature has changed."""
    if model is None:
        return {}
    solids = {part.name: (model.scene.bodies[part.name], part) for part in model.parts}
    return {
        name: (solid, part)
        for name, (solid, part) in solids.items()
        if isinstance(solid, Solid) and solid.thermal is None and part.factor is None
    }


def kept_slaves(model: Model | None) -> Mapping[int, str]:
    """Solids whose surfaces are the slaves in the contacts of a model whose meshes are replaced, by the number of the
    contact: the present shape of a new mesh may make the other surface the finer one, with gaps of other rows.
    """
    if model is None or not model.remeshed:
        return {}
    numbers, first = np.unique(model.contacts.contact, return_index=True)
    names = [part.name for part in model.parts]
    return {int(k): names[model.part_of[model.contacts.node[row]]] for k, row in zip(numbers, first, strict=True)}


def known_inertias(model: Model | None, scene: Scene, parts: Sequence[DiscreteSolid]) -> Mapping[str, KnownInertia]:
    """Inertia of the ``parts`` of a scene that have the arrays of a model; none with other impact rules, scaled masses
    or rigid bodies, which carry massless nodes.
    """
    if model is None or scene.mechanism is not None or model.scene.mechanism is not None:
        return {}
    rules = {contact.timing for contact in scene.contacts} or {model.timing}
    if rules != {model.timing} or (scene.inertia.factor, model.scene.inertia.factor) != (1.0, 1.0):
        return {}
    before, found = {part.name: part for part in model.parts}, {}
    for part in parts:
        if part.name in before and before[part.name].internal is part.internal:
            nodes = before[part.name].nodes
            found[part.name] = KnownInertia(
                light=np.flatnonzero(~model.massive[nodes]),
                mass=model.mass[nodes][:, nodes],
                follow=model.follow[nodes][:, nodes],
            )
    return found
