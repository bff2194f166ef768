"""The trapezoid and the triangle of Fig. 4, against integration of their velocity gradients and the product form."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from single import single
from softway.contact.slab_motion.trajectory import ContactEvents, Trajectory
from softway.contact.slab_motion.trapezoid_triangle import TrapezoidTriangle, mean_growth

speed = st.floats(-2.0, 2.0)
instant = st.floats(0.0, 0.95)


def product_growth(touch: float, inner: tuple[float, float], outer: tuple[float, float]) -> float:
    """Mean over the slab of the elongation when each node moves with its own velocity: int (1 - tau) (v_c - v_i)."""
    x, w = np.polynomial.legendre.leggauss(4)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    inside = inner[0] + (inner[1] - inner[0]) * x
    before = touch * x
    outside = outer[0] + (outer[1] - outer[0]) * x
    return float(touch * w @ ((1.0 - before) * outside) - w @ ((1.0 - x) * inside))


@given(touch=instant, inner0=speed, inner1=speed, outer0=speed, outer1=speed)
def test_the_split_adds_a_third_of_what_the_node_had_left(
    touch: float, inner0: float, inner1: float, outer0: float, outer1: float
) -> None:
    more = mean_growth(touch, inner0, inner1, outer0, outer1) - product_growth(
        touch, (inner0, inner1), (outer0, outer1)
    )
    assert more == pytest.approx(outer1 * (1.0 - touch) ** 2 / 3.0, abs=1e-9)


@given(touch=instant, inner0=speed, inner1=speed, outer0=speed, outer1=speed)
def test_the_mean_growth_is_the_integral_of_the_velocity_gradient(
    touch: float, inner0: float, inner1: float, outer0: float, outer1: float
) -> None:
    """Midpoint sums over columns of the slab: finite differences of the velocity along the bar."""
    n, small = 40, 1e-5
    total = 0.0
    for xi in (np.arange(n) + 0.5) / n:
        line = 1.0 - xi * (1.0 - touch)
        tau = (np.arange(4 * n) + 0.5) / (4 * n)
        slopes = [velocity(xi + e, tau, touch, inner0, inner1, outer0, outer1, tau < line) for e in (-small, small)]
        total += float(np.mean((1.0 - tau) * (slopes[1] - slopes[0]) / (2.0 * small))) / n
    assert mean_growth(touch, inner0, inner1, outer0, outer1) == pytest.approx(total, abs=0.02)


def velocity(
    xi: float, tau: np.ndarray, touch: float, inner0: float, inner1: float, outer0: float, outer1: float,
    below: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Velocity at xi: bilinear under the line from (1, touch) to (0, 1), above it linear and zero on the obstacle."""
    sigma = tau / (1.0 - xi * (1.0 - touch))
    inner, outer = inner0 + sigma * (inner1 - inner0), outer0 + sigma * (outer1 - outer0)
    return np.where(below, (1.0 - xi) * inner + xi * outer, (1.0 - xi) * inner1)


def test_a_touch_at_the_end_leaves_the_product_form() -> None:
    ends = (0.3, -0.2, 1.1, 0.7)
    assert mean_growth(1.0 - 1e-12, *ends) == pytest.approx(product_growth(1.0, ends[:2], ends[2:]), abs=1e-11)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("touch", [0.0, 0.3, 0.9])
def test_the_split_pulls_back_the_node_and_pushes_the_inner_one_alike(touch: float, side: float) -> None:
    """A bar on either side of a wall: E A / L times h v (1 - tau)^2 / 3, and no force on the bar as a whole."""
    h, stiffness, speed = 0.7, 5.0, 0.4
    rows = single([1], [[-side]], 0.0, 2)
    start, velocity, q = (side * np.array(v)[:, None] for v in ([-1.0, 0.0], [0.3, speed], [0.1, 0.0]))
    rows = replace(rows, offset=np.array([h * speed * touch]) - rows.normal_component(start))
    way = ContactEvents(
        closed=np.ones(1, bool), touch=np.array([touch]), speed=np.array([-speed]), slope=np.zeros(1),
        release=np.full(1, np.nan),
    )  # fmt: skip
    path = Trajectory(
        span=h,
        start=start,
        velocity=velocity,
        massive=np.ones(2, bool),
        free=np.ones((2, 1), bool),
        rows=rows,
        events=way,
    )
    split = TrapezoidTriangle(inner=np.array([0]), stiffness=np.array([stiffness]))
    more = split.difference(path, q, path.mean(q))
    expected = side * stiffness * h * speed * (1.0 - touch) ** 2 / 3.0
    assert more.ravel() == pytest.approx([-expected, expected], abs=1e-12)
