"""The margin of the search: surfaces that are apart, and what the end of a slab asks for."""

import numpy as np
import pytest

from softway.contact.surfaces.boundary import ContactSurface
from softway.contact.surfaces.broad_phase import near, sweep
from softway.contact.surfaces.search_margin import FEW, SearchMargin
from softway.meshes.generators.shapes import box, rectangle

EACH = ~np.eye(2, dtype=bool)


def _squares(count: int) -> tuple[np.ndarray, tuple[ContactSurface, ...]]:
    """Unit squares in a row, half a side apart."""
    mesh = rectangle((1.0, 1.0), (2, 2))
    n = mesh.n_nodes
    sides = [{kind: f + k * n for kind, f in mesh.boundary().items()} for k in range(count)]
    points = np.concatenate([mesh.points + [1.5 * k, 0.0] for k in range(count)])
    return points, tuple(ContactSurface(facets=facets) for facets in sides)


def test_a_body_inside_of_another_is_apart_from_it() -> None:
    """Their boxes overlap, their facets do not come within the distance between them."""
    outer, inner = box((3.0, 3.0, 3.0), (6, 6, 6)), box((1.0, 1.0, 1.0), (2, 2, 2))
    sides = outer.boundary(), {kind: f + outer.n_nodes for kind, f in inner.boundary().items()}
    x = np.concatenate([outer.points, inner.points + 1.0])
    margin = SearchMargin(distance=0.1, sides=tuple(ContactSurface(facets=f) for f in sides), meet=EACH)
    assert margin.apart(x, x, 0.99)
    assert not margin.apart(x, x, 1.01)
    thrown = x.copy()
    thrown[outer.n_nodes :] += [0.0, 0.0, 0.5]
    assert margin.apart(x, thrown, 0.49)
    assert not margin.apart(x, thrown, 0.51)


def test_bodies_that_fly_together_are_apart() -> None:
    x, sides = _squares(2)
    margin = SearchMargin(distance=0.1, sides=sides, meet=EACH)
    assert margin.apart(x, x + [300.0, -100.0], 0.49)
    assert not margin.apart(x, x + [300.0, -100.0], 0.51)


@pytest.mark.parametrize("seed", range(20))
def test_what_is_apart_has_no_pairs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, sides = _squares(2)
    n = len(x) // 2
    x0, x1 = (np.concatenate([y[:n], y[n:] + rng.normal(size=2)]) for y in (x, x + 0.2 * rng.normal(size=x.shape)))
    margin = SearchMargin(distance=0.1, sides=sides, meet=EACH)
    found = near(*(sweep(x0, x1, side.table) for side in sides), 0.2)[0]
    assert margin.apart(x0, x1, 0.2) == (not len(found))


def test_many_pairs_and_surfaces_that_touch_themselves_are_left_to_the_search() -> None:
    x, sides = _squares(FEW + 2)
    every = ~np.eye(len(sides), dtype=bool)
    assert SearchMargin(distance=0.1, sides=sides, meet=every).apart(x, x, 0.4)
    assert not SearchMargin(distance=0.1, sides=sides, meet=every).apart(x, x, 0.6)
    assert not SearchMargin(distance=0.1, sides=sides[:1], meet=np.ones((1, 1), bool)).apart(x, x, 0.1)


def test_the_two_bodies_that_leave_the_expected_motion_most_count_where_they_may_meet() -> None:
    x, sides = _squares(3)
    of = np.repeat([0.5, 0.1, 0.3], len(x) // 3)
    every = ~np.eye(3, dtype=bool)
    assert SearchMargin(distance=0.1, sides=sides, meet=every).needed(of) == pytest.approx(0.8)
    every[0, 2] = every[2, 0] = False
    assert SearchMargin(distance=0.1, sides=sides, meet=every).needed(of) == pytest.approx(0.6)
    alone = SearchMargin(distance=0.1, sides=sides[:1], meet=np.ones((1, 1), bool))
    assert alone.needed(of) == pytest.approx(1.0), "a surface that may touch itself"
