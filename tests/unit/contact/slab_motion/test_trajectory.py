"""The kinked motion of nodes inside a slab: continuity, speeds, and averages."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from single import single
from softway.contact.slab_motion.trajectory import ContactEvents, Trajectory, contact_events

NODES, DIM = 4, 2
GAUSS = np.polynomial.legendre.leggauss(4)


@st.composite
def motions(draw: st.DrawFn) -> tuple[Trajectory, np.ndarray]:
    """Four nodes with one row each: open, closed, touching, and closed or touching and then released."""
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    touch, let_go, first = draw(st.floats(0.05, 0.5)), draw(st.floats(0.55, 0.95)), draw(st.booleans())
    normal = rng.normal(size=(NODES, DIM))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    h = draw(st.floats(0.1, 3.0))
    speed, slope = rng.normal(size=(2, NODES))
    start, velocity, q, jump = rng.normal(size=(4, NODES, DIM))
    touches = np.array([np.nan, np.nan, touch, touch if first else np.nan])
    release = np.array([np.nan, np.nan, np.nan, let_go])
    closed = np.array([False, True, True, False])
    drive = rng.normal(size=NODES) * draw(st.booleans())
    begin = np.nan_to_num(touches)
    gap = -h * (speed * begin + slope * begin**2 / 2) - drive * (1.0 - begin)  # closes at the touch
    rows = single(rng.permutation(NODES), normal, 0.0, NODES, tool_motion=drive)
    rows = replace(rows, offset=np.where(closed | np.isfinite(release), gap - rows.normal_component(start), 1.0))
    path = Trajectory(
        span=h, start=start, velocity=velocity, massive=rng.random(NODES) < 0.7,
        free=np.ones(start.shape, bool), rows=rows,
        events=ContactEvents(closed=closed, touch=touches, speed=speed, slope=slope, release=release),
        jumps=((draw(st.floats(0.0, 1.0)), jump),) if draw(st.booleans()) else (),
    )  # fmt: skip
    return path, q


def kinks(path: Trajectory) -> np.ndarray:
    inner = [*path.events.touch, *path.events.release, *(t for t, _ in path.jumps)]
    return np.unique([0.0, 1.0, *(t for t in inner if np.isfinite(t))])


@given(motions())
def test_positions_are_continuous(motion: tuple[Trajectory, np.ndarray]) -> None:
    path, q = motion
    np.testing.assert_allclose(path.at(0.0, q), path.start, atol=1e-13)
    np.testing.assert_array_equal(path.at(1.0, q), path.end(q))
    for t in kinks(path)[1:-1]:
        np.testing.assert_allclose(path.at(t - 1e-10, q), path.at(t + 1e-10, q), atol=1e-7)


@given(motions())
def test_the_mean_is_the_integral_of_the_motion(motion: tuple[Trajectory, np.ndarray]) -> None:
    path, q = motion
    total = np.zeros((NODES, DIM))
    for a, b in pairwise(kinks(path)):
        for x, w in zip(*GAUSS, strict=True):
            total += 0.5 * (b - a) * w * path.at(0.5 * (a + b) + 0.5 * (b - a) * x, q)
    np.testing.assert_allclose(path.mean(q), total, atol=1e-12)


@given(motions())
def test_a_node_stays_on_the_obstacle_between_touch_and_release(motion: tuple[Trajectory, np.ndarray]) -> None:
    path, q = motion
    way = path.events
    kinked = np.flatnonzero(way.kinked)
    begin, end = np.nan_to_num(way.touch), np.nan_to_num(way.release, nan=1.0)
    for r in kinked:
        for t in np.linspace(begin[r] + 1e-9, end[r], 5):
            assert path.rows.gap(path.at(t, q))[r] + path.rows.tool_motion[r] * (1.0 - t) == pytest.approx(
                0.0, abs=1e-12
            )
    before = way.speed + way.slope * 0.03
    step = 1e-4
    for r in np.flatnonzero(np.isfinite(way.touch)):
        rate = path.rows.normal_component(path.at(0.03 + step, q) - path.at(0.03 - step, q))[r] / (2 * step * path.span)
        assert rate == pytest.approx(before[r], abs=1e-8)


@given(motions())
def test_a_released_row_leaves_its_opponent_from_rest_with_its_final_velocity(
    motion: tuple[Trajectory, np.ndarray],
) -> None:
    path, q = motion
    r, h = 3, path.span
    after = 1.0 - path.events.release[r]
    gap = path.rows.gap(path.end(q))[r]
    away = path.rows.normal_component(q)[r] - path.rows.tool_motion[r] / h
    assert gap == pytest.approx(after * h / 2 * away, abs=1e-12)
    step = 1e-6
    late = path.events.release[r] + step
    rate = path.rows.normal_component(path.at(late, q) - path.at(late - step, q))[r] / (step * h)
    assert rate == pytest.approx(path.rows.tool_motion[r] / h, abs=1e-4)
    rate = path.rows.normal_component(path.at(1.0, q) - path.at(1.0 - step, q))[r] / (step * h)
    assert rate == pytest.approx(path.rows.normal_component(q)[r], abs=1e-4)


@given(motions())
def test_only_the_normal_component_is_kinked(motion: tuple[Trajectory, np.ndarray]) -> None:
    path, q = motion
    smooth = replace(path, events=contact_events(np.zeros(NODES, bool)))
    for t in (0.3, 1.0):
        moved = (path.at(t, q) - smooth.at(t, q))[path.rows.node]
        across = moved - np.einsum("mi,mi->m", moved, path.rows.normal)[:, None] * path.rows.normal
        np.testing.assert_allclose(across, 0.0, atol=1e-12)
        assert np.abs(moved[~path.events.kinked]).max() == 0.0


@given(motions(), st.floats(0.0, 1.0))
def test_the_motion_is_affine_in_the_unknown(motion: tuple[Trajectory, np.ndarray], t: float) -> None:
    path, q = motion
    none = np.zeros_like(q)
    double = path.at(t, 2.0 * q) - path.at(t, none)
    np.testing.assert_allclose(double, 2.0 * (path.at(t, q) - path.at(t, none)), atol=1e-11)


def test_without_events_velocity_is_linear_and_massless_nodes_move_steadily() -> None:
    rows = single([], np.zeros((0, 1)), 0.0, 2)
    path = Trajectory(
        span=2.0, start=np.array([[1.0], [1.0]]), velocity=np.array([[3.0], [3.0]]),
        massive=np.array([True, False]), free=np.ones((2, 1), bool), rows=rows,
        events=contact_events(np.zeros(0, bool)),
    )  # fmt: skip
    q = np.array([[5.0], [5.0]])
    assert path.at(0.5, q).ravel().tolist() == [1.0 + 3.0 + 0.5, 1.0 + 2.5]
    assert path.end(q).ravel().tolist() == [1.0 + 2.0 * 4.0, 1.0 + 5.0]
    assert path.mean(q).ravel() == pytest.approx([1.0 + 3.0 + 2.0 * 2.0 / 6.0, 1.0 + 2.5])


def test_a_jump_enters_from_its_instant_on() -> None:
    rows = single([], np.zeros((0, 1)), 0.0, 1)
    zero = np.zeros((1, 1))
    path = Trajectory(
        span=1.0, start=zero, velocity=zero, massive=np.array([True]), free=np.ones((1, 1), bool),
        rows=rows, events=contact_events(np.zeros(0, bool)),
        jumps=((0.25, np.array([[1.0]])),),
    )  # fmt: skip
    q = np.array([[1.0]])  # the jump and nothing else: v = 0 before, 1 after
    assert path.at(0.25, q)[0, 0] == pytest.approx(0.0, abs=1e-15)
    assert path.at(0.75, q)[0, 0] == pytest.approx(0.5)
    assert path.end(q)[0, 0] == pytest.approx(0.75)
    assert path.mean(q)[0, 0] == pytest.approx(0.75**2 / 2)


@pytest.mark.parametrize("second", [(0.0, 1.0), (0.6, 0.8)], ids=["square", "oblique"])
def test_a_node_in_a_corner_keeps_both_gaps(second: tuple[float, float]) -> None:
    rows = single([0, 0], [(1.0, 0.0), second], [0.1, 0.2], 2, contact=[0, 1], labels=("a", "b"))
    rng = np.random.default_rng(1)
    start, v, q = rng.normal(size=(3, 2, 2))
    path = Trajectory(
        span=0.3,
        start=start,
        velocity=v,
        massive=np.ones(2, bool),
        free=np.ones(start.shape, bool),
        rows=rows,
        events=contact_events(np.array([True, True])),
    )
    np.testing.assert_allclose(rows.gap(path.end(q)), 0.0, atol=1e-14)
    np.testing.assert_allclose(rows.gap(path.at(0.4, q)), 0.0, atol=1e-14)
    assert path.end(q)[1] == pytest.approx(start[1] + 0.15 * (v[1] + q[1]))
