"""One method for many surfaces: which of them meet, and the same rows as the contacts of two."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.setup.placement import Placement
from softway.contact.contact import Contact, NodeToSurface
from softway.meshes.generators.shapes import rectangle
from softway.model.build import build
from softway.model.model import Model


def block(x: float, y: float, size: tuple[float, float] = (1.0, 1.0), cells: tuple[int, int] = (3, 3)) -> sw.Solid:
    place = Placement(translation=(x, y))
    return sw.Solid(mesh=rectangle(size, cells), material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0, place=place)


def built(*contacts: Contact, **bodies: sw.Solid) -> Model:
    return build(sw.Scene(bodies=bodies, contacts=contacts))


def met(model: Model) -> set[tuple[str, str]]:
    """Names of the bodies of the slave and of the opponent of each row with an opponent in reach."""
    rows, d = model.rows(model.displacement), model.shape[1]
    found = set()
    for row in np.flatnonzero(rows.near):
        one = model.part_of[rows.node[row]]
        others = {int(k) for k in model.part_of[rows.gradient[[row]].indices // d]} - {int(one)}
        found |= {(model.parts[one].name, model.parts[k].name) for k in others or {int(one)}}
    return found


ROW = {"a": block(0.0, 0.0), "b": block(1.01, 0.0), "c": block(2.02, 0.0)}


def test_neighbours_meet_both_ways_and_nobody_meets_itself() -> None:
    """A block cannot meet its own sides: they are neighbours, or the block is in the way."""
    pairs = {("a", "b"), ("b", "a"), ("b", "c"), ("c", "b")}
    assert met(built(Contact(between=("a", "b", "c")), **ROW)) == pairs
    assert met(built(Contact(between="all"), **ROW)) == pairs


def test_surfaces_with_a_contact_of_their_own_are_left_out() -> None:
    model = built(Contact(between="all"), Contact(between=("a", "b")), **ROW)
    rows = model.rows(model.displacement)
    assert met(model) >= {("b", "c"), ("c", "b")}
    own = rows.near & rows.of_contact(0)
    assert set(model.part_of[rows.node[own]].tolist()) == {1, 2}


def test_only_the_named_sides_meet() -> None:
    assert met(built(Contact(between=("a.right", "b.left", "c.right")), **ROW)) == {("a", "b"), ("b", "a")}


@pytest.mark.parametrize("thick", [0.2, 0.05, 0.02])
def test_the_back_of_a_wall_is_no_opponent(thick: float) -> None:
    """Two cells thick, facets up to fifty times as long: at rest no node is paired with its own wall."""
    wall = block(0.0, 0.0, size=(4.0, thick), cells=(4, 2))
    assert met(built(Contact(between=("a", "a")), a=wall)) == set()


def test_rows_are_those_of_the_pairs() -> None:
    """Nodes of three blocks on facets: the same gaps and normals as from a contact of two solids for each pair."""
    both = NodeToSurface(nodes="both")
    one = built(Contact(between=("a", "b", "c")), **ROW)
    two = built(Contact(between=("a", "b"), method=both), Contact(between=("b", "c"), method=both), **ROW)
    found = []
    for model in (one, two):
        rows = model.rows(model.displacement)
        near = np.flatnonzero(rows.near)
        keys = zip(rows.node[near].tolist(), rows.normal[near].round(9).tolist(), strict=True)
        gaps = rows.gap(model.displacement)[near]
        found.append({(n, tuple(v)): g for (n, v), g in zip(keys, gaps, strict=True)})
    assert found[0] == pytest.approx(found[1], abs=1e-14)
    assert len(found[0]) > 10


def test_groups_follow_the_rows() -> None:
    """Bodies of one contact that do not touch are groups of their own: a pulse in one leaves the others alone."""
    from softway.solve.equations.energy_balance import body_groups

    model = built(Contact(between="all"), **ROW)
    rows = model.rows(model.displacement)
    touching = rows.near & (model.part_of[rows.node] == 0)
    assert body_groups(model, (rows, touching)).tolist() == [0, 0, 1]


def test_rows_of_many_bodies_are_d_for_each_surface_node() -> None:
    """Not for each pair: thirty discs in a grid have 435 pairs."""
    disc = sw.meshes.Disc(radius=0.5, cells=4)
    places = [(1.02 * i, 1.02 * j) for i in range(6) for j in range(5)]
    bodies = {
        f"disc{k}": sw.Solid(
            mesh=disc, material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0, place=Placement(translation=place)
        )
        for k, place in enumerate(places)
    }
    model = built(Contact(between="all"), **bodies)
    on_surface = sum(len(part.mesh.nodes("surface")) for part in model.parts)
    assert len(model.contacts.node) == 2 * on_surface == 480


@pytest.mark.parametrize("cell", ["hex8", "hex20"])
def test_neighbours_across_a_tie_never_meet_in_space(cell: str) -> None:
    """Nodes of the upper block at the rim of the glue, and the facets of the lower one there."""
    shapes = (((2.0, 1.0, 1.0), (4, 4, 3), (0.0, 0.0, 0.0)), ((1.0, 1.0, 1.0), (4, 5, 4), (0.5, 0.0, 1.0)))
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Box(size=size, cells=cells, origin=origin, cell=cell),
            material=sw.NeoHookean(E=1.0, nu=0.3),
            density=1.0,
        )
        for name, (size, cells, origin) in zip("ab", shapes, strict=True)
    }
    ties = (sw.Tie(between=("a.top", "b.bottom")),)
    model = build(sw.Scene(bodies=bodies, contacts=(Contact(between="all"),), ties=ties))
    may, count = model.contacts.methods[0].method.admissible, len(model.points)
    glue = may.glue.tocoo()
    across = (glue.row < count) & (glue.col < count) & (may.body[glue.row] == 1) & (may.body[glue.col] == 0)
    found = 0
    for node, other in zip(glue.row[across], glue.col[across], strict=True):
        facets = np.flatnonzero((may.side.table == other).any(axis=1))
        assert not may.nodes_and_facets(np.full(len(facets), node), facets).any()
        found += len(facets)
    assert found > 10
