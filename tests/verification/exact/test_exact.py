"""The exact solutions against conservation laws, closed forms, each other, and independent integrations."""

from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from softway.apps.verify.exact import bar as waves
from softway.apps.verify.exact import semidiscrete as discrete
from softway.apps.verify.exact.oscillator import CONSTANT, eigenvalue, frequency, limit, peak, radius
from softway.apps.verify.exact.thrown import Thrown

HAT = ((0.0, 0.5, 1.0, 0.0), (0.5, 1.0, 0.0, 0.0))
THROWN = waves.Bar(velocity=((0.0, 1.0, 1.0, 1.0),), gap=0.3)
STRUCK = waves.Bar(velocity=HAT, gap=0.2, far="fixed")
DROPPED = waves.Bar(
    length=10.0,
    youngs=900.0,
    acceleration=10.0,
    gap=5.0,
    velocity=((0.0, 10.0, 0.0, 0.0),),
    strain=((0.0, 10.0, 0.0, 0.0),),
)
PULLED = waves.Bar(strain=((0.0, 1.0, 0.5, 0.5),), tip=-0.5, gap=0.0, far="fixed")
BARS = {"A02": (THROWN, 4.0), "A06": (STRUCK, 10.0), "A09": (DROPPED, 30.0), "A11": (PULLED, 9.0)}
either = pytest.mark.parametrize("name", BARS)


# ------------------------------------------------------------------------------------------ the bar as a continuum


@either
def test_energy_of_the_bar_is_constant(name: str) -> None:
    bar, until = BARS[name]
    motion = waves.solve(bar, until)
    start = motion.energy(0.0)
    largest = bar.impedance * motion.arriving.square(0.0, until)  # of the energies that cancel in an accelerated frame
    for t in np.linspace(0.0, 0.99 * until, 41):
        assert motion.energy(t) == pytest.approx(start, abs=1e-12 * (start + largest))


@either
def test_energy_is_that_of_the_fields(name: str) -> None:
    bar, until = BARS[name]
    motion = waves.solve(bar, until)
    s = (np.arange(4000) + 0.5) * bar.length / 4000
    for t in (0.21 * until, 0.43 * until):
        v, e = motion.velocity(s, t), motion.strain(s, t)
        moved = motion.displacement(s, t) - motion.displacement(s, 0.0)
        stored = 0.5 * bar.density * v**2 + 0.5 * bar.youngs * e**2
        total = bar.area * bar.length * np.mean(stored - bar.density * bar.acceleration * moved)
        size = bar.area * bar.length * np.mean(stored)
        assert total == pytest.approx(motion.energy(t), abs=2e-3 * size)


@pytest.mark.parametrize("name", ["A02", "A09"])
def test_momentum_changes_by_the_impulses(name: str) -> None:
    bar, until = BARS[name]
    motion = waves.solve(bar, until)
    weight = bar.density * bar.area * bar.length * bar.acceleration
    for t in np.linspace(0.0, 0.99 * until, 41):
        assert motion.momentum(t) - motion.momentum(0.0) == pytest.approx(weight * t - motion.impulse(t), abs=1e-9)


@either
def test_the_stop_is_unilateral(name: str) -> None:
    bar, until = BARS[name]
    motion = waves.solve(bar, until)
    t = np.linspace(0.0, until, 2001)
    assert np.max(motion.tip(t)) <= bar.gap + 1e-11
    assert min(motion.force(x) for x in t) >= 0.0


@either
def test_displacement_is_the_integral_of_velocity(name: str) -> None:
    bar, until = BARS[name]
    motion = waves.solve(bar, until)
    step = 1e-7 * bar.trip
    for s in (0.0, 0.37 * bar.length, bar.length):
        for t in (0.1234 * until, 0.567 * until):
            slope = float(motion.displacement(s, t + step) - motion.displacement(s, t - step)) / (2.0 * step)
            assert slope == pytest.approx(motion.velocity(s, t), rel=1e-5, abs=1e-5)


@given(
    length=st.floats(0.1, 10.0),
    youngs=st.floats(0.1, 1e11),
    density=st.floats(0.1, 1e4),
    speed=st.floats(0.01, 100.0),
    flight=st.floats(0.0, 20.0),
)
def test_a_thrown_bar_follows_the_closed_form(
    length: float, youngs: float, density: float, speed: float, flight: float
) -> None:
    gap = flight * speed * length * sqrt(density / youngs)
    exact = Thrown(length=length, youngs=youngs, density=density, speed=speed, gap=gap)
    uniform, rest = ((0.0, length, speed, speed),), ((0.0, length, 0.0, 0.0),)
    bar = waves.Bar(length=length, youngs=youngs, density=density, gap=gap, velocity=uniform, strain=rest)
    until = exact.touch + 3.0 * exact.transit
    motion = waves.solve(bar, until)
    assert [(x.start, x.release) for x in motion.touches] == [pytest.approx((exact.touch, exact.release), rel=1e-9)]
    t = np.linspace(0.0, until, 57)
    size = gap + speed * exact.transit
    np.testing.assert_allclose(motion.tip(t), exact.tip(t), rtol=0.0, atol=1e-9 * size)
    np.testing.assert_allclose(motion.displacement(length, t), exact.rear(t), rtol=0.0, atol=1e-9 * size)
    assert motion.force(exact.touch + exact.transit) == pytest.approx(exact.force, rel=1e-9)
    assert motion.impulse(until) == pytest.approx(2.0 * exact.mass * speed, rel=1e-9)


@pytest.mark.parametrize("gap", [0.1, 0.2])
def test_the_struck_bar_touches_when_the_parabola_does(gap: float) -> None:
    """The tip starts with u = t - t^2 and, left to itself, is periodic with period 4 and amplitude 1/4."""
    motion = waves.solve(waves.Bar(velocity=HAT, gap=gap, far="fixed"), 10.0)
    first = motion.touches[0]
    root = sqrt(1.0 - 4.0 * gap)
    assert (first.start, first.release, first.speed) == pytest.approx((0.5 * (1.0 - root), 1.5, root), abs=1e-12)
    free = waves.solve(waves.Bar(velocity=HAT, far="fixed"), 10.0)
    t = np.linspace(0.0, 5.9, 60)
    np.testing.assert_allclose(free.tip(t + 4.0), free.tip(t), atol=1e-13)
    assert np.max(free.tip(np.linspace(0.0, 4.0, 401))) == pytest.approx(0.25, abs=1e-13)


def test_the_dropped_bar_is_periodic() -> None:
    """Touches at 1 + 8k/3 that last 2/3, with the force 300 + 300 s for even k and 500 - 300 s for odd k."""
    motion = waves.solve(DROPPED, 59.0)
    starts, releases = np.array([(x.start, x.release) for x in motion.touches]).T
    k = np.arange(len(starts))
    np.testing.assert_allclose(starts, 1.0 + 8.0 * k / 3.0, atol=1e-10)
    np.testing.assert_allclose(releases - starts, 2.0 / 3.0, atol=1e-10)
    for s in (0.1, 1.0 / 3.0, 0.6):
        assert motion.force(1.0 + s) == pytest.approx(300.0 + 300.0 * s, abs=1e-9)
        assert motion.force(11.0 / 3.0 + s) == pytest.approx(500.0 - 300.0 * s, abs=1e-9)


def test_the_pulled_bar_is_periodic() -> None:
    motion = waves.solve(PULLED, 12.5)
    assert [x.start for x in motion.touches] == pytest.approx([1.0, 4.0, 7.0, 10.0], abs=1e-12)
    assert [x.release for x in motion.touches] == pytest.approx([2.0, 5.0, 8.0, 11.0], abs=1e-12)
    assert motion.force(1.5) == pytest.approx(0.5, abs=1e-14)
    np.testing.assert_allclose(motion.tip(np.array([0.5, 1.5, 2.5, 3.5])), [-0.25, 0.0, -0.25, -0.25], atol=1e-13)


def test_a_leapfrog_of_unit_courant_number_agrees() -> None:
    """There u(x, t+h) = u(x-h, t) + u(x+h, t) - u(x, t-h) is exact; only the touches are rounded to the grid."""
    n = 1000
    h, x = 1.0 / n, np.linspace(0.0, 1.0, n + 1)  # fixed at x = 0, tip at x = 1
    v = np.maximum(0.0, 2.0 * x - 1.0)
    old, now, largest = np.zeros(n + 1), np.minimum(h * (v - 0.0), 0.2), 0.0
    now[1:-1] = 0.5 * h * (v[2:] + v[:-2]) * 0.5 + 0.25 * h * 2.0 * v[1:-1]
    motion = waves.solve(STRUCK, 10.0)
    exact = motion.tip(h * np.arange(10 * n + 1))
    for k in range(1, 10 * n):
        new = np.zeros(n + 1)
        new[1:-1] = now[2:] + now[:-2] - old[1:-1]
        new[-1] = min(2.0 * now[-2] - old[-1], 0.2)
        old, now = now, new
        largest = max(largest, abs(now[-1] - exact[k + 1]))
    assert largest < 5.0 * h


# ------------------------------------------------------------------------------------------ the bar of finite elements


def thrown(elements: int, rule: str = "impulse", *, lumped: bool = False) -> discrete.Motion:
    """The bar at the wall from t = 0 on."""
    mesh = discrete.bar(elements, lumped=lumped)
    return discrete.solve(mesh, np.zeros(elements + 1), np.ones(elements + 1), gap=0.0, until=6.0, rule=rule)


def struck(gap: float, rule: str = "impulse", *, lumped: bool = False, side: float = 1.0) -> discrete.Motion:
    """Two elements, one end fixed, the tip struck."""
    mesh = discrete.bar(2, lumped=lumped, fixed=True)
    return discrete.solve(mesh, np.zeros(2), np.array([0.0, 1.0]), gap=gap, until=10.0, rule=rule, side=side)


@pytest.mark.parametrize(
    ("rule", "lumped", "release", "lost"),
    [("literal", False, 1.88972, 1.0 / 3.0), ("impulse", False, 1.84115, 1.0 / 7.0), ("impulse", True, 2.09858, 0.25)],
)
def test_two_elements_at_the_wall(rule: str, lumped: bool, release: float, lost: float) -> None:
    motion = thrown(2, rule, lumped=lumped)
    assert motion.times("release") == [pytest.approx(release, abs=5e-6)]
    for t in (0.0, 1.0, 3.0, 6.0):
        assert motion.energy(t) / 0.5 == pytest.approx(1.0 - lost, abs=1e-12)


@pytest.mark.parametrize("elements", [2, 3, 5, 16, 40])
def test_energy_lost_at_a_touch(elements: int) -> None:
    """Of the kinetic energy: 2/(3N) literal, 1/(2N) lumped, 1/(m (M^-1)_tip) by the impulse, near sqrt(3)/(6N)."""
    energies = {k: motion.energy(0.0) / 0.5 for k, motion in every_rule(elements).items()}
    tip = np.linalg.inv(discrete.bar(elements).mass)[-1, -1]
    assert 1.0 - energies["literal"] == pytest.approx(2.0 / (3.0 * elements), rel=1e-12)
    assert 1.0 - energies["lumped"] == pytest.approx(1.0 / (2.0 * elements), rel=1e-12)
    assert 1.0 - energies["impulse"] == pytest.approx(1.0 / tip, rel=1e-12)
    if elements >= 16:
        assert 1.0 - energies["impulse"] == pytest.approx(sqrt(3.0) / 6.0 / elements, rel=1e-6)


def every_rule(elements: int) -> dict[str, discrete.Motion]:
    """The three ways to stop the tip."""
    return {
        "literal": thrown(elements, "literal"),
        "impulse": thrown(elements),
        "lumped": thrown(elements, lumped=True),
    }


@pytest.mark.parametrize(
    ("elements", "lumped", "least", "greatest"),
    [(8, True, 1.092, 1.093), (32, True, 1.092, 1.093), (8, False, 1.54, 1.66), (32, False, 1.54, 1.66)],
)
def test_the_force_overshoots_on_every_mesh(elements: int, lumped: bool, least: float, greatest: float) -> None:
    """The chain answers the jump with 1.092 rho c v A (lumped) or 1.54 to 1.66 (consistent), however fine it is."""
    motion = thrown(elements, lumped=lumped)
    largest = max(motion.at(t)[2] for t in np.linspace(0.0, motion.times("release")[0], 4001))
    assert least < largest < greatest


@pytest.mark.parametrize("gap", [0.1, 0.2, 0.3])
@pytest.mark.parametrize("lumped", [False, True])
def test_a_struck_bar_keeps_its_energy_between_touches(gap: float, lumped: bool) -> None:
    motion = struck(gap, lumped=lumped)
    tip = np.linalg.inv(motion.mesh.mass)[-1, -1]
    lost = sum(e.before[-1] ** 2 / (2.0 * tip) for e in motion.events if e.kind == "touch")
    assert motion.energy(0.0) - motion.energy(10.0) == pytest.approx(lost, abs=1e-14)
    t = np.linspace(0.0, 10.0, 501)
    assert max(motion.at(x)[0][-1] for x in t) <= gap + 1e-11
    assert min(motion.at(x)[2] for x in t) >= -1e-11


def test_momentum_of_the_thrown_mesh_changes_by_the_impulse() -> None:
    motion = thrown(4)
    touch, release = motion.events
    t = np.linspace(touch.time, release.time, 2001)
    push = np.array([motion.at(x)[2] for x in t])
    simpson = (t[1] - t[0]) / 3.0 * (push[0] + 4.0 * push[1::2].sum() + 2.0 * push[2:-1:2].sum() + push[-1])
    assert 1.0 - motion.mean_velocity(6.0) == pytest.approx(touch.impulse + simpson, abs=1e-10)


def test_an_integration_of_the_equations_agrees() -> None:
    """Runge-Kutta of order 8 with its own event location, through the second touch (gap 0.1) and its release."""
    motion = struck(0.1)
    touch, release = [e for e in motion.events if e.time > 0.5][:2]
    mass, stiffness = motion.mesh.mass, motion.mesh.stiffness

    def free(_: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate((y[2:], -np.linalg.solve(mass, stiffness @ y[:2])))

    def held(_: float, y: np.ndarray) -> np.ndarray:
        return np.array([y[2], 0.0, -(stiffness[0] @ y[:2]) / mass[0, 0], 0.0])

    reach = ending(lambda _, y: y[1] - 0.1, +1.0)
    pull = ending(lambda _, y: mass[1, 0] * -(stiffness[0] @ y[:2]) / mass[0, 0] + stiffness[1] @ y[:2], +1.0)
    start = next(e for e in motion.events if e.kind == "release")
    first = solve_ivp(
        free,
        (start.time + 1e-9, 2.0),
        shifted(motion, start.time + 1e-9),
        method="DOP853",
        events=reach,
        rtol=1e-13,
        atol=1e-14,
    )
    assert first.t[-1] == pytest.approx(touch.time, abs=1e-9)
    jump = np.concatenate((touch.displacement, touch.after))
    second = solve_ivp(held, (touch.time, 2.0), jump, method="DOP853", events=pull, rtol=1e-13, atol=1e-14)
    assert second.t[-1] == pytest.approx(release.time, abs=1e-9)


def ending(function, direction: float):
    """An event that ends the integration when the function passes zero in the given direction."""

    def event(t: float, y: np.ndarray) -> float:
        return function(t, y)

    event.terminal, event.direction = True, direction
    return event


def shifted(motion: discrete.Motion, t: float) -> np.ndarray:
    """Displacement and velocity at a time as one vector."""
    u, v, _ = motion.at(t)
    return np.concatenate((u, v))


def test_the_mesh_converges_to_the_bar() -> None:
    """Mean error of the tip's path in the struck bar with the stop, at first order in the element length."""
    exact = waves.solve(STRUCK, 5.0)
    t = np.linspace(0.0, 5.0, 501)
    errors = []
    for n in (10, 20, 40, 80):
        mesh = discrete.bar(n, lumped=True, fixed=True)
        start = np.maximum(0.0, 2.0 * np.arange(1, n + 1) / n - 1.0)
        motion = discrete.solve(mesh, np.zeros(n), start, gap=0.2, until=5.0)
        path = np.array([motion.at(x)[0][-1] for x in t])
        errors.append(sqrt(np.mean((path - exact.tip(t)) ** 2)))
    assert all(b < 0.75 * a for a, b in zip(errors[:-1], errors[1:], strict=True))
    assert errors[-1] < 0.004


def test_the_mesh_without_stop_is_two_oscillators() -> None:
    """Two elements, consistent: omega^2 = 24 (5 -+ 3 sqrt 2) / 7; lumped: 2 (2 -+ sqrt 2) * 2."""
    consistent, lumped = struck(np.inf), struck(np.inf, lumped=True)
    ways = np.array([-1.0, 1.0])
    np.testing.assert_allclose(
        consistent.phases[0][2].frequencies ** 2, 24.0 * (5.0 + 3.0 * sqrt(2.0) * ways) / 7.0, rtol=1e-13
    )
    np.testing.assert_allclose(lumped.phases[0][2].frequencies ** 2, 8.0 + 4.0 * sqrt(2.0) * ways, rtol=1e-13)


# ------------------------------------------------------------------------------------------ the oscillator


@given(alpha=st.floats(0.0, 1.0), z=st.floats(0.01, 20.0))
def test_a_peak_of_the_slab_is_the_equation_of_motion_there(alpha: float, z: float) -> None:
    """Build the slab's matrix from its definition: acceleration + z^2 x(alpha) = 0, in units of the slab."""
    columns = []
    for x, v in ((1.0, 0.0), (0.0, 1.0)):
        rise = -(z**2) * (x + alpha * v) / (1.0 + 0.5 * z**2 * alpha**2)
        columns.append([x + v + 0.5 * rise, v + rise])
    values = np.linalg.eigvals(np.array(columns).T)
    assert radius(peak(alpha), z) == pytest.approx(np.max(np.abs(values)), rel=1e-6)
    assert abs(np.prod(values)) == pytest.approx(
        (1.0 + 0.5 * z**2 * (1.0 - alpha) ** 2) / (1.0 + 0.5 * z**2 * alpha**2), rel=1e-9
    )


def test_limit_is_where_growth_begins() -> None:
    for moments in (CONSTANT, peak(0.5), peak(0.75)):
        z = limit(moments)
        assert radius(moments, 0.999 * z) <= 1.0 + 1e-12
        assert radius(moments, 1.001 * z) > 1.0 + 1e-3


def test_the_constant_weight_keeps_the_amplitude_and_lengthens_the_period() -> None:
    z = 1e-2
    assert abs(eigenvalue(CONSTANT, z)) == pytest.approx(1.0, abs=1e-15)
    assert 1.0 - frequency(CONSTANT, z) == pytest.approx(z**2 / 24.0, rel=1e-4)
