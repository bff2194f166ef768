"""Contact of elastic continua in closed form: Hertz line and point contact, impact, press fit, patch test.

Frictionless, small strain; a rigid opponent has an infinite modulus. References: H. Hertz, J. reine angew. Math. 92
(1882) 156; K. L. Johnson, Contact Mechanics, Cambridge University Press 1985, sections 4.2, 5.6 and 11.4; S. P.
Timoshenko and J. N. Goodier, Theory of Elasticity, section 28.
"""

from dataclasses import dataclass
from math import gamma, inf, log, pi, sqrt

import numpy as np

from softway.arrays import Array


def contact_modulus(youngs: float, poisson: float, other: float = inf, other_poisson: float = 0.0) -> float:
    """Contact modulus E*, with 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.

    >>> contact_modulus(2.0, 0.0), contact_modulus(2.0, 0.0, 2.0, 0.0)
    (2.0, 1.0)
    """
    return 1.0 / ((1.0 - poisson**2) / youngs + (1.0 - other_poisson**2) / other)


@dataclass(frozen=True, slots=True, kw_only=True)
class LineContact:
    """Line contact of parallel cylinders under a load per length P; ``radius`` is R in the gap x^2/(2 R).

    >>> line = LineContact(load=0.01, radius=1.0, modulus=contact_modulus(1.0, 0.3))
    >>> round(line.half_width, 9), round(line.peak, 9), round(line.mean, 9)
    (0.107640512, 0.059143139, 0.046450912)
    >>> shear, depth = line.greatest_shear
    >>> round(shear / line.peak, 4), round(depth / line.half_width, 4)
    (0.3003, 0.7862)
    """

    load: float
    radius: float
    modulus: float

    @property
    def half_width(self) -> float:
        """Half width b of the contact strip ``|x| < b``."""
        return sqrt(4.0 * self.load * self.radius / (pi * self.modulus))

    @property
    def peak(self) -> float:
        """Pressure in the middle."""
        return 2.0 * self.load / (pi * self.half_width)

    @property
    def mean(self) -> float:
        """Mean pressure over the strip."""
        return self.load / (2.0 * self.half_width)

    def pressure(self, x: float | Array) -> Array:
        """Pressure p0 sqrt(1 - x^2/b^2), zero outside."""
        return self.peak * np.sqrt(np.maximum(1.0 - (np.asarray(x) / self.half_width) ** 2, 0.0))

    def stress_below(self, depth: float | Array) -> tuple[Array, Array]:
        """Stresses parallel and normal to the surface, below the middle of the strip."""
        b, z = self.half_width, np.asarray(depth)
        root = np.sqrt(b**2 + z**2)
        return -self.peak / b * ((b**2 + 2.0 * z**2) / root - 2.0 * z), -self.peak * b / root

    @property
    def greatest_shear(self) -> tuple[float, float]:
        """Greatest shear stress p0 (s - s^2/sqrt(1 + s^2)) and its depth s b.

        Its derivative vanishes where (1 + s^2)^(3/2) = s (2 + s^2).
        """
        s = float(np.sqrt(_root_of_shear()))
        return self.peak * (s - s**2 / sqrt(1.0 + s**2)), s * self.half_width

    def compression(self, radius: float | None = None) -> float:
        """Approach of the centre of a cylinder, pressed on two opposite sides, to either of them.

        It is P/(pi E*) (2 log(4 R/b) - 1) for a rigid opponent (Johnson, section 5.6), to relative order (b/R)^2.
        """
        ratio = 4.0 * (radius or self.radius) / self.half_width
        return self.load / (pi * self.modulus) * (2.0 * log(ratio) - 1.0)


def _root_of_shear() -> float:
    """Root t = s^2 of (1 + t)^3 = t (2 + t)^2, that is of t^2 + t - 1 = 0.

    >>> t = _root_of_shear()
    >>> abs((1 + t) ** 3 - t * (2 + t) ** 2) < 1e-14
    True
    """
    return 0.5 * (sqrt(5.0) - 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class CircleContact:
    """Point contact of balls with the approach delta; ``radius`` is R in the gap r^2/(2 R).

    >>> ball = CircleContact(approach=0.01, radius=1.0, modulus=contact_modulus(1.0, 0.3))
    >>> round(ball.half_width, 9), round(ball.peak, 9), round(ball.force, 12), round(ball.stiffness, 9)
    (0.1, 0.069958217, 0.001465201465, 1.465201465)
    """

    approach: float
    radius: float
    modulus: float

    @property
    def half_width(self) -> float:
        """Radius a of the contact circle, a^2 = R delta."""
        return sqrt(self.radius * self.approach)

    @property
    def stiffness(self) -> float:
        """Stiffness k in F = k delta^(3/2)."""
        return 4.0 / 3.0 * self.modulus * sqrt(self.radius)

    @property
    def force(self) -> float:
        """Contact force F."""
        return self.stiffness * self.approach**1.5

    @property
    def peak(self) -> float:
        """Pressure in the middle."""
        return 1.5 * self.force / (pi * self.half_width**2)

    def pressure(self, r: float | Array) -> Array:
        """Pressure p0 sqrt(1 - r^2/a^2), zero outside."""
        return self.peak * np.sqrt(np.maximum(1.0 - (np.asarray(r) / self.half_width) ** 2, 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Impact:
    """Impact of a mass on a Hertzian spring, m x'' = -k x^(3/2).

    The contact lasts long compared with the travel time of waves in the body, which rebounds with its initial speed.

    >>> steel = Impact(mass=7850.0 * 4 / 3 * pi * 1e-6, speed=1.0, stiffness=4 / 3 * contact_modulus(210e9, 0.3) * 0.1)
    >>> print(f"{steel.approach:.6e} {steel.force:.4f} {steel.duration:.6e}")
    1.779511e-05 2309.7641 5.237590e-05
    """

    mass: float
    speed: float
    stiffness: float

    @property
    def approach(self) -> float:
        """Greatest approach x, where all energy is in the spring: m v^2/2 = 2/5 k x^(5/2)."""
        return (1.25 * self.mass * self.speed**2 / self.stiffness) ** 0.4

    @property
    def force(self) -> float:
        """Greatest force."""
        return self.stiffness * self.approach**1.5

    @property
    def duration(self) -> float:
        """Duration 2 (x/v) int_0^1 ds/sqrt(1 - s^(5/2)) = (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10) x/v."""
        return 0.8 * sqrt(pi) * gamma(0.4) / gamma(0.9) * self.approach / self.speed


@dataclass(frozen=True, slots=True, kw_only=True)
class Tube:
    """Ring a < r < b under inner and outer pressure, in plane stress (Lame).

    >>> tube = Tube(inner=1.0, outer=2.0, youngs=1.0, poisson=0.3, inside=3.0)
    >>> [float(s) for s in tube.stress(1.0)], [float(s) for s in tube.stress(2.0)]
    ([-3.0, 5.0], [0.0, 2.0])
    """

    inner: float
    outer: float
    youngs: float
    poisson: float
    inside: float = 0.0
    outside: float = 0.0

    def stress(self, r: float | Array) -> tuple[Array, Array]:
        """Radial and hoop stress A -+ B/r^2."""
        a2, b2 = self.inner**2, self.outer**2
        mean = (self.inside * a2 - self.outside * b2) / (b2 - a2)
        part = (self.inside - self.outside) * a2 * b2 / (b2 - a2) / np.asarray(r) ** 2
        return mean - part, mean + part

    def displacement(self, r: float | Array) -> Array:
        """Radial displacement, r times the hoop strain."""
        radial, hoop = self.stress(r)
        return np.asarray(r) / self.youngs * (hoop - self.poisson * radial)


@dataclass(frozen=True, slots=True, kw_only=True)
class PressFit:
    """Press fit of a ring a < r < b in a ring b < r < c; ``interference`` is the oversize of the inner radius.

    ``plane`` is ``stress`` or ``strain``; plane strain uses E/(1 - nu^2) and nu/(1 - nu).

    >>> fit = PressFit(radii=(0.01, 0.02, 0.04), interference=1e-5, youngs=(210e9, 210e9), poisson=(0.3, 0.3))
    >>> round(fit.pressure), round(float(fit.outer.stress(0.02)[1])), round(float(fit.inner.stress(0.02)[1]))
    (31500000, 52500000, -52500000)
    >>> print(f"{fit.outer.displacement(0.02):.2e} {fit.inner.displacement(0.02):.2e}")
    5.90e-06 -4.10e-06
    """

    radii: tuple[float, float, float]
    interference: float
    youngs: tuple[float, float]
    poisson: tuple[float, float]
    plane: str = "stress"

    def _rings(self, pressure: float) -> tuple[Tube, Tube]:
        a, b, c = self.radii
        law = [_in_plane(*pair, self.plane) for pair in zip(self.youngs, self.poisson, strict=True)]
        return (
            Tube(inner=a, outer=b, youngs=law[0][0], poisson=law[0][1], outside=pressure),
            Tube(inner=b, outer=c, youngs=law[1][0], poisson=law[1][1], inside=pressure),
        )

    @property
    def pressure(self) -> float:
        """Pressure between the rings, where their displacements differ by the interference."""
        inner, outer = self._rings(1.0)
        b = self.radii[1]
        return float(self.interference / (outer.displacement(b) - inner.displacement(b)))

    @property
    def inner(self) -> Tube:
        """Inner ring after assembly."""
        return self._rings(self.pressure)[0]

    @property
    def outer(self) -> Tube:
        """Outer ring after assembly."""
        return self._rings(self.pressure)[1]


def _in_plane(youngs: float, poisson: float, plane: str) -> tuple[float, float]:
    """Equivalent plane-stress constants for plane stress or plane strain."""
    return (youngs / (1.0 - poisson**2), poisson / (1.0 - poisson)) if plane == "strain" else (youngs, poisson)


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """Patch of layers under uniform pressure with free sides: the stress is -p along y, other components are zero.

    ``layers`` are pairs of height and Young's modulus, from below, all with one Poisson ratio (otherwise the sides
    would not match); ``plane`` is ``strain``, or ``stress`` for 3D blocks and plane stress.

    >>> layers = ((0.5, 1e3), (0.5, 1e3))
    >>> [round(Patch(pressure=1.0, layers=layers, poisson=0.3, plane=p).settlement, 9) for p in ("strain", "stress")]
    [0.00091, 0.001]
    """

    pressure: float
    layers: tuple[tuple[float, float], ...]
    poisson: float
    plane: str = "strain"

    @property
    def settlement(self) -> float:
        """Downward displacement of the top."""
        factor = 1.0 - self.poisson**2 if self.plane == "strain" else 1.0
        return factor * self.pressure * sum(height / youngs for height, youngs in self.layers)

    def spread(self, layer: int) -> float:
        """Lateral strain of a layer."""
        factor = self.poisson * (1.0 + self.poisson) if self.plane == "strain" else self.poisson
        return factor * self.pressure / self.layers[layer][1]
