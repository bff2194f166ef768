"""The exact contacts hold against equilibrium, against the integrals of the half-space, and against each other."""

from collections.abc import Callable
from math import inf, pi

import numpy as np
import pytest
from numpy.polynomial.legendre import legval
from scipy.integrate import quad, solve_ivp

from softway.apps.verify.exact.ball import _amplitudes, pressed_ball
from softway.apps.verify.exact.contact import CircleContact, Impact, LineContact, Patch, PressFit, Tube, contact_modulus
from softway.arrays import Array

LINE = LineContact(load=0.3, radius=2.0, modulus=5.0)
CIRCLE = CircleContact(approach=0.02, radius=3.0, modulus=5.0)


def test_pressures_bear_the_load():
    b, a = LINE.half_width, CIRCLE.half_width
    assert quad(LINE.pressure, -b, b)[0] == pytest.approx(LINE.load, rel=1e-9)
    assert quad(lambda r: 2.0 * pi * r * CIRCLE.pressure(r), 0.0, a)[0] == pytest.approx(CIRCLE.force, rel=1e-9)
    assert LINE.mean * 2.0 * b == pytest.approx(LINE.load, rel=1e-14)


@pytest.mark.parametrize("fraction", [0.1, 0.5, 0.9])
def test_a_strip_under_the_pressure_follows_the_cylinder(fraction):
    """The slope of a half-plane, -2/(pi E*) times the principal value of int p(s)/(x - s) ds, is -x/R."""
    b = LINE.half_width
    x = fraction * b
    value = -quad(LINE.pressure, -b, b, weight="cauchy", wvar=x, epsabs=1e-12)[0]
    assert 2.0 / (pi * LINE.modulus) * value == pytest.approx(x / LINE.radius, rel=1e-6)


def test_a_circle_under_the_pressure_follows_the_ball():
    """Boussinesq: u = 1/(pi E*) int p/distance dA; in the middle the approach, at the edge half of it."""
    a = CIRCLE.half_width
    middle = quad(lambda r: 2.0 * pi * CIRCLE.pressure(r), 0.0, a)[0] / (pi * CIRCLE.modulus)
    assert middle == pytest.approx(CIRCLE.approach, rel=1e-9)

    def chord(angle: float) -> float:
        """Integral of the pressure along the line through a point of the edge."""
        return quad(
            lambda s: CIRCLE.pressure(np.sqrt(a**2 + s**2 - 2.0 * a * s * np.cos(angle))), 0.0, 2.0 * a * np.cos(angle)
        )[0]

    edge = 2.0 * quad(chord, 0.0, 0.5 * pi)[0] / (pi * CIRCLE.modulus)
    assert edge == pytest.approx(CIRCLE.approach - a**2 / (2.0 * CIRCLE.radius), rel=1e-6)


def test_stresses_below_the_line():
    shear, depth = LINE.greatest_shear
    z = np.linspace(0.0, 3.0 * LINE.half_width, 30001)
    along, across = LINE.stress_below(z)
    assert 0.5 * (along - across).max() == pytest.approx(shear, rel=1e-8)
    assert z[np.argmax(along - across)] == pytest.approx(depth, rel=1e-3)
    assert (along[0], across[0]) == pytest.approx((-LINE.peak, -LINE.peak))


def test_the_force_of_a_ball_is_the_derivative_of_its_energy():
    energy = quad(lambda d: CircleContact(approach=d, radius=3.0, modulus=5.0).force, 0.0, CIRCLE.approach, epsabs=0.0)[
        0
    ]
    assert energy == pytest.approx(0.4 * CIRCLE.force * CIRCLE.approach, rel=1e-9)


def test_the_impact_is_the_motion_of_the_mass():
    impact = Impact(mass=2.0, speed=0.7, stiffness=30.0)

    def rate(_: float, y: Array) -> list[float]:
        return [y[1], -impact.stiffness / impact.mass * max(y[0], 0.0) ** 1.5]

    def left(_: float, y: Array) -> float:
        return y[0]

    left.terminal, left.direction = True, -1.0  # type: ignore[attr-defined]
    motion = solve_ivp(rate, (0.0, 10.0), [0.0, 0.7], rtol=1e-11, atol=1e-13, events=left, dense_output=True)
    assert motion.t_events[0][-1] == pytest.approx(impact.duration, rel=1e-9)
    assert motion.y[1, -1] == pytest.approx(-0.7, rel=1e-9)
    assert motion.sol(0.5 * impact.duration)[0] == pytest.approx(impact.approach, rel=1e-9)


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_a_press_fit_is_in_equilibrium_and_fits(plane):
    fit = PressFit(radii=(1.0, 2.0, 5.0), interference=1e-3, youngs=(3.0, 7.0), poisson=(0.2, 0.35), plane=plane)
    for tube, pushed in ((fit.inner, 2.0), (fit.outer, 2.0)):
        r = np.linspace(tube.inner, tube.outer, 7)[1:-1]
        step = 1e-5
        slope = (tube.stress(r + step)[0] - tube.stress(r - step)[0]) / (2.0 * step)
        radial, hoop = tube.stress(r)
        assert slope + (radial - hoop) / r == pytest.approx(0.0, abs=1e-11)
        strain = (tube.displacement(r + step) - tube.displacement(r - step)) / (2.0 * step)
        assert strain == pytest.approx((radial - tube.poisson * hoop) / tube.youngs, abs=1e-11)
        assert tube.stress(pushed)[0] == pytest.approx(-fit.pressure, rel=1e-12)
    assert (fit.inner.stress(1.0)[0], fit.outer.stress(5.0)[0]) == pytest.approx((0.0, 0.0), abs=1e-16)
    assert fit.outer.displacement(2.0) - fit.inner.displacement(2.0) == pytest.approx(1e-3, rel=1e-12)


def test_a_thin_tube_is_a_membrane():
    tube = Tube(inner=1.0, outer=1.001, youngs=1.0, poisson=0.3, inside=1.0)
    assert tube.stress(1.0005)[1] == pytest.approx(1.0 / 0.001, rel=1e-3)


def test_patches():
    """Hooke's law with the stress -p along y alone, and no strain or no stress along z."""
    strain = Patch(pressure=2.0, layers=((0.5, 1e3), (0.25, 1e4)), poisson=0.3)
    for k, (_, youngs) in enumerate(strain.layers):
        beyond = 0.3 * -2.0
        assert strain.spread(k) == pytest.approx((0.0 - 0.3 * (-2.0 + beyond)) / youngs)
    assert strain.settlement == pytest.approx(0.91 * 2.0 * (0.5 / 1e3 + 0.25 / 1e4))
    assert Patch(pressure=2.0, layers=((1.0, 4.0),), poisson=0.3, plane="stress").spread(0) == pytest.approx(0.15)


def test_a_rigid_opponent():
    assert contact_modulus(1.0, 0.3) == contact_modulus(1.0, 0.3, inf, 0.2)


def test_a_ball_under_uniform_pressure():
    """The radius shrinks by p/(3 K), with K the bulk modulus."""
    lame, shear = 2.0, 3.0
    _, second, mix = _amplitudes(0, lame, shear, -1.0, 0.0)
    assert mix * second == pytest.approx(-1.0 / (3.0 * lame + 2.0 * shear), rel=1e-14)


def derivatives(field: Callable[[Array], Array], x: Array) -> Array:
    """Derivatives (3, ...) of a field along the axes, by differences of fourth order."""
    h = 0.01
    return np.array(
        [(8.0 * (field(x + s) - field(x - s)) - field(x + 2 * s) + field(x - 2 * s)) / (12 * h) for s in h * np.eye(3)]
    )


@pytest.mark.parametrize("n", [2, 4, 6])
def test_the_series_of_the_ball_is_in_equilibrium(n):
    """The divergence of the stress vanishes, against its other derivatives."""
    lame, shear = 2.0, 3.0
    first, second, mix = _amplitudes(n, lame, shear, 1.0, -0.2)

    def potential(x: Array) -> Array:
        r = np.linalg.norm(x)
        return np.asarray(r**n * legval(x[2] / r, np.eye(n + 1)[n]))

    def field(x: Array) -> Array:
        return (first + second * (x @ x)) * derivatives(potential, x) + second * mix * potential(x) * x

    def stress(x: Array) -> Array:
        slope = derivatives(field, x)
        return lame * np.trace(slope) * np.eye(3) + shear * (slope + slope.T)

    slopes = derivatives(stress, np.array([0.3, 0.4, 0.5]))
    assert np.abs(np.einsum("kki->i", slopes)).max() < 1e-4 * np.abs(slopes).max()


def test_a_ball_tends_to_the_half_space():
    """The force exceeds Hertz's by about 0.5 a/R, and Hertz's pressure leaves the cap flat to 3e-4 of the approach."""
    excess = []
    for a in (0.2, 0.1, 0.05):
        ball = pressed_ball(a, 1.0, 0.3)
        half_space = CircleContact(approach=ball.approach, radius=1.0, modulus=contact_modulus(1.0, 0.3))
        excess.append(ball.force / half_space.force - 1.0)
        assert ball.misfit < 6e-4
    assert excess[0] / excess[1] == pytest.approx(2.0, abs=0.25)
    assert excess[1] / excess[2] == pytest.approx(2.0, abs=0.25)
