"""Rows that keep their faces and edges, and gather those that turn out to be missing."""

import numpy as np
import pytest

from softway.contact.node_to_surface.edge_to_edge import EdgeToEdge
from softway.contact.node_to_surface.kept_facets import keep_facets
from softway.contact.node_to_surface.node_to_facet import NodeToFacet
from softway.contact.surfaces.boundary import ContactSurface, Edges


def test_a_node_that_comes_to_a_second_wall_has_a_row_for_each() -> None:
    """A groove of two walls at right angles: the node is over the left one, later over the right one."""
    x = np.array([[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [-0.6, 0.7]])
    nodes = NodeToFacet(slaves=np.array([3]), side=ContactSurface(facets={"bar2": np.array([[1, 0], [2, 1]])}))
    beside = x.copy()
    beside[3] = (0.6, 0.7)
    left, right = np.array([1.0, 1.0]) / np.sqrt(2.0), np.array([-1.0, 1.0]) / np.sqrt(2.0)
    near = nodes.meet(x, x, 0.1)  # only the left wall is in reach
    every = nodes.meet(x, beside, 2.0)
    first = keep_facets(near, x, None)
    assert first.at(x).gap == pytest.approx([0.1 / np.sqrt(2.0), np.inf], abs=1e-15)
    both = keep_facets(every, beside, first)
    rows = both.at(beside)
    assert rows.gap == pytest.approx([1.3 / np.sqrt(2.0), 0.1 / np.sqrt(2.0)], abs=1e-15)
    assert rows.normal == pytest.approx(np.array([left, right]), abs=1e-15)
    again = keep_facets(every, x, both)
    assert again.found == both.found == 2


def test_an_edge_that_comes_over_another_one_is_added_to_those_that_are_kept() -> None:
    """Two pieces of a ridge along x over a ridge along y, which passes from the first piece to the second."""
    ridge = np.array([[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [2.0, 0.0, 0.1], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0]])
    across = np.array([[0.5, 1.0, 0.0], [0.5, -1.0, 0.0], [1.5, 0.0, -1.0], [-0.5, 0.0, -1.0]])
    x = np.concatenate([ridge, across])
    upper = Edges(ends=np.array([[0, 1], [1, 2]]), wings=np.array([[3, 4], [3, 4]]))
    lower = Edges(ends=np.array([[5, 6]]), wings=np.array([[7, 8]]))
    later = x.copy()
    later[5:, 0] += 1.0
    pairing = EdgeToEdge(first=upper, second=lower).meet(x, later, 0.5)
    first = keep_facets(pairing, x, None)
    assert first.at(x).gap == pytest.approx([0.1, np.inf], abs=1e-15)
    both = keep_facets(pairing, later, first)
    rows = both.at(later)
    assert both.found == 2
    assert rows.gap == pytest.approx([0.1, 0.1], abs=1e-15)  # the first as an endless line
    assert rows.normal == pytest.approx(np.tile([0.0, 0.0, 1.0], (2, 1)), abs=1e-15)
    assert rows.weights[[1]].toarray()[0, [0, 1, 2]] == pytest.approx([0.0, 0.5, 0.5], abs=1e-15)
    assert keep_facets(pairing, x, both).found == 2
