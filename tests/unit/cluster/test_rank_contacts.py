"""Contacts of a rank: rows on local nodes are those of the whole model."""

import numpy as np
import pytest

import softway as sw
from softway.cluster.rank_contacts import rank_contacts, served
from softway.cluster.rank_model import held_by, rank_space
from softway.contact.node_to_surface.split_facets import OnSplitSurface
from softway.model.build import build
from softway.model.model import Model
from softway.ranks.threads import Threads, in_threads


def stacked(cell: str) -> Model:
    """Three blocks on and beside each other, any of which may touch any other."""
    places = {"bed": (0.0, 0.0, 0.0), "lid": (0.2, 0.15, 0.61), "side": (1.02, 0.1, 0.05)}
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Box(size=(1.0, 0.8, 0.6), cells=(6, 6, 6), origin=at, cell=cell),
            material=sw.NeoHookean(E=1e4, nu=0.3),
            density=1.0,
        )
        for name, at in places.items()
    }
    return build(sw.Scene(bodies=bodies, contacts=(sw.Contact(between="all"),)))


@pytest.mark.parametrize("cell", ["hex8", "tet4"])
def test_rows_of_split_facets_on_local_nodes_are_those_of_the_model(cell: str) -> None:
    """Gaps, normals and weights of nodes and edges have the same bits on each of three ranks."""
    model = stacked(cell)
    x = model.points + 0.02 * np.sin(7.0 * model.points[:, ::-1])
    methods = model.contacts.methods
    assert all(isinstance(m, OnSplitSurface) and served(m) for m in methods)
    whole = [m.meet(model.points, x, 0.05).at(x) for m in methods]
    assert sum(int(np.isfinite(rows.gap).sum()) for rows in whole) > 30

    def compare(ranks: Threads) -> int:
        held = held_by(model, ranks)
        assert len(held.nodes) < len(model.points)
        mine = rank_contacts(model.contacts, held, rank_space(model, held, ranks)).methods
        for of_all, of_rank, rows in zip(methods, mine, whole, strict=True):
            found = of_rank.meet(model.points[held.nodes], x[held.nodes], 0.05).at(x[held.nodes])
            assert np.array_equal(held.nodes[of_rank.node], of_all.node)
            assert np.array_equal(found.gap, rows.gap)
            assert np.array_equal(found.normal, rows.normal)
            assert np.array_equal(found.weights.toarray(), rows.weights.toarray()[:, held.nodes])
        return len(held.own)

    assert sum(in_threads(3, compare)) == len(model.points)
