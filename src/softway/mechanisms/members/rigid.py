"""Rigid bodies of a mechanism: mass, inertia, and motion at the start."""

from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.conductor import RigidThermal
from softway.errors import InputError, within
from softway.mechanisms.members.moments import shape_moments
from softway.obstacles.primitives import Shape
from softway.units import Kilogram, KilogramPerCubicMetre, KilogramSquareMetre, Metre, MetrePerSecond, RadianPerSecond

FAR = 1e100
"""Coordinate beyond which nothing can be computed [m]."""
ROUNDING = 1e-9
"""Relative error of an inertia that is rounding."""

Inertia = KilogramSquareMetre | tuple[KilogramSquareMetre, ...] | tuple[tuple[KilogramSquareMetre, ...], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rigid:
    """Rigid body, in the plane or in space by the length of ``centre``.

    Parameters
    ----------
    mass
        Mass, positive [kg].
    centre
        Centre of mass at the start [m].  Mass, centre and inertia are computed if a shape and a density are given.
    inertia
        Moments of inertia about the centre along the axes of the scene at the start [kg m^2]: one in the plane, and in
        space three principal ones or the tensor.  Zero about all axes is a point mass, which does not turn.
    velocity
        Velocity of the centre at the start [m/s].
    spin
        Angular velocity at the start [rad/s]: one component in the plane, three in space.
    shape
        Surface at its place at the start, for contact with solids; none by default.
    density
        Density of the material inside the shape [kg/m^3].
    thickness
        Thickness of a body in the plane, for its density [m].
    thermal
        Heat of a body beside solids with heat; without, it has no temperature.

    Raises
    ------
    InputError
        If the mass is not positive, a shape does not fit, or no matter has these moments of inertia.

    Examples
    --------
    >>> rod = Rigid(mass=2.0, centre=(0.5, 0.0), inertia=2.0 / 12.0)
    >>> rod.dim, rod.tensor[2, 2].round(4).item()
    (2, 0.1667)
    >>> from softway.obstacles.primitives import Block
    >>> Rigid(shape=Block(low=(0.0, 0.0), high=(2.0, 1.0)), density=3.0).mass
    6.0
    """

    mass: Kilogram = 0.0
    centre: tuple[Metre, ...] = ()
    inertia: Inertia = 0.0
    velocity: tuple[MetrePerSecond, ...] | None = None
    spin: RadianPerSecond | tuple[RadianPerSecond, ...] = 0.0
    shape: Shape | None = None
    density: KilogramPerCubicMetre | None = None
    thickness: Metre = 1.0
    thermal: RigidThermal | None = None

    def __post_init__(self) -> None:
        if self.density is not None:
            self._fill(self.density)
        if not (np.isfinite(self.mass) and self.mass > 0.0):
            raise InputError("mass", f"{self.mass:g} kg is not positive", "the mass of the body, or shape and density")
        if len(self.centre) not in (2, 3) or not (np.abs(np.asarray(self.centre, float)) < FAR).all():
            raise InputError("centre", f"{self.centre} is no place", "two coordinates in the plane, three in space")
        if self.velocity is not None and np.shape(self.velocity) != (self.dim,):
            raise InputError("velocity", f"{self.velocity} for a body in {self.dim}D", f"{self.dim} components")
        shapes: tuple[tuple[int, ...], ...] = ((),) if self.dim == 2 else ((), (3,))
        if np.shape(self.spin) not in shapes or (self.dim == 3 and np.shape(self.spin) == () and self.spin != 0.0):
            what = "one component, about the normal of the plane" if self.dim == 2 else "three components"
            raise InputError("spin", f"{self.spin} for a body in {self.dim}D", what)
        if not max(float(np.abs(part).max()) for part in self.motion) < FAR:
            raise InputError("velocity", f"{self.velocity} with the spin {self.spin}", "velocities of a motion")
        if self.shape is not None and self.shape.dim != self.dim:
            raise InputError("shape", f"in {self.shape.dim}D for a body in {self.dim}D", f"a shape in {self.dim}D")
        if self.thermal is not None and self.thermal.conductivity is not None and self.density is None:
            problem = f"{self.thermal.conductivity:g} W/(m K) without a density, by which friction would share its heat"
            remedy = "density and shape of the body, or no conductivity: a share of the contact or of the heat link"
            raise InputError("thermal.conductivity", problem, remedy)
        _require_inertia(self.tensor)

    def _fill(self, density: float) -> None:
        """Compute mass, centre and inertia from the shape and the density."""
        if self.shape is None:
            raise InputError("density", f"{density:g} kg/m^3 without a shape", "a shape, or mass, centre and inertia")
        for name in ("density", "thickness"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0.0):
                raise InputError(name, f"{getattr(self, name):g} is not positive", "a positive number")
        with within("shape"):
            found = shape_moments(self.shape)
        density *= self.thickness if self.shape.dim == 2 else 1.0
        computed = {"mass": density * found.volume, "centre": found.centre, "inertia": found.inertia(density)}
        for name, value in computed.items():
            given, exact = np.asarray(getattr(self, name), float), np.asarray(value, float)
            same = given.shape == exact.shape and np.abs(given - exact).max() <= ROUNDING * np.abs(exact).max()
            if given.any() and not same:
                raise InputError(name, f"{getattr(self, name)} beside a density", f"either {name} or density")
            object.__setattr__(self, name, value)

    @property
    def dim(self) -> int:
        """2 in the plane, 3 in space."""
        return len(self.centre)

    @property
    def tensor(self) -> Array:
        """Inertia (3, 3) about the centre [kg m^2]; in the plane only about its normal."""
        given = np.asarray(self.inertia, float)
        if self.dim == 2:
            if given.shape != ():
                raise InputError("inertia", f"{self.inertia} for a body in the plane", "one moment of inertia")
            return np.diag([0.0, 0.0, float(given)])
        if given.shape == () and not given.any():
            return np.zeros((3, 3))
        if given.shape not in ((3,), (3, 3)):
            raise InputError("inertia", f"{self.inertia} for a body in space", "three principal moments, or the tensor")
        return np.diag(given) if given.shape == (3,) else given

    @property
    def motion(self) -> tuple[Array, Array]:
        """Velocity of the centre (3,) and angular velocity (3,) at the start, in space."""
        velocity, spin = np.zeros(3), np.zeros(3)
        velocity[: self.dim] = 0.0 if self.velocity is None else self.velocity
        if self.dim == 2:
            spin[2] = np.asarray(self.spin, float)
        else:
            spin[:] = self.spin
        return velocity, spin


def _require_inertia(tensor: Array) -> None:
    """Refuse an inertia that no distribution of matter has."""
    if not np.isfinite(tensor).all() or np.abs(tensor - tensor.T).max() > ROUNDING * np.abs(tensor).max():
        raise InputError("inertia", "is not symmetric, or not finite", "a symmetric tensor of finite numbers")
    a, b, c = np.linalg.eigvalsh(tensor)
    if a < -ROUNDING * c:
        raise InputError("inertia", f"the moment of inertia {a:g} kg m^2 is negative", "moments of zero or more")
    if (tensor[0, 0] or tensor[1, 1]) and c > (a + b) * (1.0 + ROUNDING):
        problem = f"principal moments {a:g}, {b:g}, {c:g} kg m^2: the greatest is more than the sum of the others"
        raise InputError("inertia", problem, "moments of a distribution of matter")


def inverse(tensor: Array) -> Array:
    """Inverse (3, 3) of an inertia, zero about axes without inertia."""
    values, axes = np.linalg.eigh(tensor)
    there = values > ROUNDING * max(float(values.max()), 1e-300)
    turned: Array = (axes * np.where(there, 1.0 / np.where(there, values, 1.0), 0.0)) @ axes.T
    return turned
