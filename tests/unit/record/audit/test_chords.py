"""What findings of overlaps say of facets that are chords of hollow bodies."""

import re

import numpy as np
import pytest

from softway.marching.results.step import Event
from softway.meshes.generators.graded import ring
from softway.meshes.generators.shapes import rectangle
from softway.meshes.mesh import Mesh
from softway.record.audit.auditor import Auditor
from softway.record.audit.geometry.chords import outside
from softway.record.audit.geometry.solids import Solids, solids

SAGITTA = 1.0 - np.cos(np.pi / 40)


def together(one: Mesh, other: Mesh) -> Solids:
    """Two bodies of the same kind of cells in one numbering."""
    ((cell, first),), (second,) = one.blocks.items(), other.blocks.values()
    nodes, owner = np.concatenate([first, second + one.n_nodes]), np.repeat([0, 1], [len(first), len(second)])
    return solids(("shaft", "bush"), np.concatenate([one.points, other.points]), {cell: nodes}, {cell: owner})


def shaft_in_bush(cell: str = "quad4") -> Solids:
    """Shaft of 30 facets in a bush of 40, on one circle of radius one."""
    return together(*(ring(a, b, (1, n), angle=2.0 * np.pi, cell=cell) for a, b, n in ((0.4, 1.0, 30), (1.0, 2.0, 40))))


def seen(bodies: Solids, by: tuple[float, float] = (0.0, 0.0)) -> tuple[Event, ...]:
    """Findings with the first body moved."""
    x = bodies.reference + np.where(bodies.owner[:, None] == 0, by, 0.0)
    return Auditor(solids=bodies, tools={}).look(0.0, x, {}).findings


def told(finding: Event) -> float:
    """Part of an overlap that the sentence gives to facets [m]; zero if it says nothing of them."""
    found = re.search(r"of this, up to (\S+) m is the sagitta", finding.finding)
    return float(found[1]) if found else 0.0


def test_only_the_hollow_surface_stands_out_of_its_curve() -> None:
    bodies = shaft_in_bush()
    radius = np.linalg.norm(bodies.reference, axis=1)
    found = outside(bodies)
    inner = (bodies.owner == 1) & (radius < 1.5)
    assert found[inner] == pytest.approx(SAGITTA, rel=1e-2)
    assert found[(bodies.owner == 0) & (radius < 0.5)] == pytest.approx(0.4 * (1.0 - np.cos(np.pi / 30)), rel=2e-2)
    assert found[(radius > 1.5) | ((bodies.owner == 0) & (radius > 0.5))].max() < 1e-15
    assert not outside(shaft_in_bush("quad9")).any()


def test_an_overlap_by_chords_alone_is_found_and_said_to_be_one() -> None:
    found = seen(shaft_in_bush())
    assert {f.kind for f in found} == {"overlap", "overlap between nodes"}
    for finding in found:
        assert finding.depth <= 1.01 * SAGITTA
        assert told(finding) == pytest.approx(finding.depth, rel=1e-2)


def test_of_a_deeper_overlap_only_the_sagitta_is_said_to_be_one() -> None:
    (node, _) = seen(shaft_in_bush(), by=(0.02, 0.0))
    assert node.depth > 0.02
    assert told(node) == pytest.approx(SAGITTA, rel=1e-2)
    (node, *_) = seen(shaft_in_bush(), by=(0.05, 0.0))
    assert node.depth > 0.05
    assert not told(node), "less than a tenth"


def test_nothing_is_said_of_flat_bodies_and_of_round_ones_beside_each_other() -> None:
    block = rectangle((1.0, 1.0), (4, 4))
    disc = ring(0.4, 1.0, (1, 40), angle=2.0 * np.pi)
    for body, by in ((block, (0.99, 0.13)), (disc, (1.99, 0.0))):
        found = seen(together(body, body), by)
        assert found
        assert not any(told(finding) for finding in found)
