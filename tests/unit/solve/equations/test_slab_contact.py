"""Contact of a slab with nodes that are kept on their facets."""

import numpy as np
import pytest

import softway as sw
from softway.model.build import build
from softway.model.model import Model
from softway.solve.constraints.normal_active_set import RowConditions
from softway.solve.equations.slab_contact import InitialContact, TurningContact


def above_a_slope() -> tuple[Model, np.ndarray, np.ndarray]:
    """A small block 0.01 above the even half of another one, and the same above its half that rises by 0.3."""
    law = sw.NeoHookean(E=1.0, nu=0.3)
    bodies = {
        "a": sw.Solid(
            mesh=sw.meshes.Rectangle(size=(0.2, 0.2), cells=(1, 1), origin=(0.1, 1.01)), material=law, density=1.0
        ),
        "b": sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), material=law, density=1.0),
    }
    contact = sw.Contact(between=("a.bottom", "b.top"), method=sw.contact.NodeToSurface())
    model = build(sw.Scene(bodies=bodies, contacts=(contact,)))
    u0 = np.zeros(model.shape)
    u0[np.abs(model.points - [1.0, 1.0]).max(axis=1) < 1e-9, 1] = 0.3
    u1 = u0.copy()
    u1[model.parts[0].nodes, 0] += 0.4
    return model, u0, u1


def test_kept_facets_are_incomplete_where_a_node_is_inside_of_another_one() -> None:
    """The node that moves to x = 0.7 is 0.01 above its old facet, continued, and below the slope of 0.6."""
    model, u0, u1 = above_a_slope()
    pairs, none = model.contacts.meet(u0, u1, 0.0, 0.1), np.zeros(len(model.contacts.node), bool)
    rows = pairs.at(u0)
    free = TurningContact(
        pairs=pairs,
        facets=pairs,
        conditions=RowConditions(target=np.zeros(len(none)), equal=none, unilateral=~none),
        initial=InitialContact(rows=rows, pressure=np.zeros(len(none)), traction=np.zeros_like(rows.normal)),
    )
    depth = (0.6 * 0.2 - 0.01) / np.hypot(1.0, 0.6)
    kept = free.with_kept_facets(u0, none)
    assert kept.facets_complete(u0) and not kept.facets_complete(u1) and free.facets_complete(u1)
    assert kept.at(u1).gap(u1).min() == pytest.approx(0.01, abs=1e-12)
    assert kept.nearest_rows(u1).gap(u1).min() == pytest.approx(-depth, abs=1e-12)
    assert kept.with_added_facets(u1).at(u1).gap(u1).min() == pytest.approx(-depth, abs=1e-12)
