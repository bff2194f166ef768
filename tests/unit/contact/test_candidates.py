"""Contact rows: gap, normal component, and its adjoint."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from softway.contact.candidates import Candidates


@st.composite
def cases(draw: st.DrawFn) -> tuple[Candidates, np.ndarray, np.random.Generator]:
    """Rows on random nodes, several on one node, and random supports."""
    d, n, m = draw(st.integers(1, 3)), draw(st.integers(1, 6)), draw(st.integers(0, 8))
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    normal = rng.normal(size=(m, d))
    rows = Candidates(
        node=rng.integers(0, n, m),
        contact=rng.integers(0, 2, m),
        normal=normal / np.linalg.norm(normal, axis=1, keepdims=True),
        offset=rng.normal(size=m),
        labels=("a", "b"),
    )
    return rows, rng.random((n, d)) < 0.7, rng


@given(cases())
def test_the_matrix_gives_the_normal_component_of_supported_fields(case) -> None:
    rows, free, rng = case
    field = rng.normal(size=free.shape) * free
    np.testing.assert_allclose(rows.matrix(free) @ field[free], rows.along(field), atol=1e-14)


@given(cases())
def test_spreading_is_the_adjoint_of_the_normal_component(case) -> None:
    rows, free, rng = case
    field, force = rng.normal(size=free.shape), rng.normal(size=len(rows.node))
    spread = rows.spread(force, free.shape)
    np.testing.assert_allclose(np.sum(spread * field), force @ rows.along(field), atol=1e-13)
    np.testing.assert_allclose(rows.matrix(free).T @ force, spread[free], atol=1e-14)


@given(cases())
def test_the_gap_is_affine(case) -> None:
    rows, free, rng = case
    u, w = rng.normal(size=(2, *free.shape))
    np.testing.assert_allclose(rows.gap(u + w) - rows.gap(u), rows.along(w), atol=1e-14)
    np.testing.assert_array_equal(rows.gap(np.zeros(free.shape)), rows.offset)


@given(cases())
def test_every_row_belongs_to_one_contact(case) -> None:
    rows, _, _ = case
    assert (rows.of(0) ^ rows.of(1)).all()
