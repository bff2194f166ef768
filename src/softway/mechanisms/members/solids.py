"""Rigid bodies of simple shapes: mass, inertia and surface from sizes and density."""

import numpy as np

from softway.arrays import Array
from softway.errors import InputError, positive
from softway.mechanisms.members.rigid import Rigid
from softway.mechanisms.members.rows import Direction, axes, perpendicular
from softway.mechanisms.members.volumes import Spin, Velocity
from softway.obstacles.primitives import Block, Cylinder, Sphere
from softway.units import KilogramPerCubicMetre, Metre


def rigid_ball(
    *,
    radius: Metre,
    density: KilogramPerCubicMetre,
    centre: tuple[Metre, Metre, Metre],
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Ball in space of this ``radius`` [m] and ``density`` [kg/m^3].

    Examples
    --------
    >>> ball = rigid_ball(radius=0.1, density=7800.0, centre=(0.0, 0.0, 0.0))
    >>> round(ball.mass, 4), round(ball.inertia[0], 6)
    (32.6726, 0.13069)
    """
    positive(radius=radius, density=density)
    mass = density * 4.0 / 3.0 * np.pi * radius**3
    inertia, shape = (0.4 * mass * radius**2,) * 3, Sphere(centre=centre, radius=radius)
    return Rigid(mass=mass, centre=centre, inertia=inertia, velocity=velocity, spin=spin, shape=shape)


def rigid_cylinder(
    *,
    radius: Metre,
    length: Metre,
    density: KilogramPerCubicMetre,
    centre: tuple[Metre, Metre, Metre],
    axis: Direction = (0.0, 0.0, 1.0),
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Circular cylinder in space about an ``axis``, of this ``radius`` and ``length`` [m] and ``density`` [kg/m^3].

    Examples
    --------
    >>> shaft = rigid_cylinder(radius=0.5, length=1.0, density=1.0, centre=(0.0, 0.0, 0.0))
    >>> round(shaft.mass, 4), round(shaft.tensor[2, 2].item(), 4)
    (0.7854, 0.0982)
    """
    positive(radius=radius, length=length, density=density)
    mass = density * np.pi * radius**2 * length
    along, across = 0.5 * mass * radius**2, mass * (radius**2 / 4.0 + length**2 / 12.0)
    half = 0.5 * length * axes(axis, rigid_cylinder)[0]
    start, end = np.asarray(centre) - half, np.asarray(centre) + half
    shape, inertia = Cylinder(start=_point(start), end=_point(end), radius=radius), _about(axis, along, across)
    return Rigid(mass=mass, centre=centre, inertia=inertia, velocity=velocity, spin=spin, shape=shape)


def rigid_box(
    *,
    size: tuple[Metre, Metre, Metre],
    density: KilogramPerCubicMetre,
    centre: tuple[Metre, Metre, Metre],
    edges: tuple[Direction, Direction] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Box in space of this ``size`` [m] and ``density`` [kg/m^3]; ``edges`` are the directions of the first two edges.

    Examples
    --------
    >>> rigid_box(size=(1.0, 2.0, 3.0), density=2.0, centre=(0.0, 0.0, 0.0)).tensor.diagonal().tolist()
    [13.0, 10.0, 5.0]
    """
    positive(size=min(size), density=density)
    first, second = perpendicular(edges, "edges")
    mass, turn = density * float(np.prod(size)), np.stack([first, second, np.cross(first, second)], axis=1)
    square = mass / 12.0 * np.square(size)
    tensor = (turn * (square.sum() - square)) @ turn.T
    tensor = 0.5 * (tensor + tensor.T)
    return Rigid(mass=mass, centre=centre, inertia=tuple(map(tuple, tensor.tolist())), velocity=velocity, spin=spin)


def rigid_rod(
    *,
    ends: tuple[tuple[Metre, ...], tuple[Metre, ...]],
    line_density: float,
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Thin uniform rod between two ``ends`` [m], in the plane or in space, of this ``line_density`` [kg/m].

    In space it has no inertia about its axis.

    Examples
    --------
    >>> rod = rigid_rod(ends=((0.0, 0.0), (2.0, 0.0)), line_density=1.5)
    >>> rod.mass, rod.centre, rod.inertia
    (3.0, (1.0, 0.0), 1.0)
    """
    start, end = (np.asarray(one, float) for one in ends)
    length = float(np.linalg.norm(end - start)) if start.shape == end.shape else 0.0
    if not length > 0.0:
        raise InputError("ends", f"{ends} are no two places", "two different places of as many coordinates")
    positive(line_density=line_density)
    mass, across = line_density * length, line_density * length**3 / 12.0
    inertia = across if len(start) == 2 else _about(tuple((end - start).tolist()), 0.0, across)
    centre = tuple((0.5 * (start + end)).tolist())
    return Rigid(mass=mass, centre=centre, inertia=inertia, velocity=velocity, spin=spin)


def rigid_disc(
    *,
    radius: Metre,
    density: KilogramPerCubicMetre,
    centre: tuple[Metre, Metre],
    thickness: Metre = 1.0,
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Disc in the plane of this ``radius`` and ``thickness`` [m] and ``density`` [kg/m^3].

    Examples
    --------
    >>> round(rigid_disc(radius=1.0, density=2.0, centre=(0.0, 0.0)).inertia, 6)
    3.141593
    """
    positive(radius=radius, density=density, thickness=thickness)
    mass = density * thickness * np.pi * radius**2
    inertia, shape = 0.5 * mass * radius**2, Sphere(centre=centre, radius=radius)
    return Rigid(mass=mass, centre=centre, inertia=inertia, velocity=velocity, spin=spin, shape=shape)


def rigid_rectangle(
    *,
    size: tuple[Metre, Metre],
    density: KilogramPerCubicMetre,
    centre: tuple[Metre, Metre],
    thickness: Metre = 1.0,
    velocity: Velocity = None,
    spin: Spin = 0.0,
) -> Rigid:
    """Rectangle in the plane of this ``size`` and ``thickness`` [m] and ``density`` [kg/m^3].

    Examples
    --------
    >>> rigid_rectangle(size=(2.0, 1.0), density=6.0, centre=(0.0, 0.0)).inertia
    5.0
    """
    positive(size=min(size), density=density, thickness=thickness)
    mass = density * thickness * size[0] * size[1]
    inertia = mass / 12.0 * (size[0] ** 2 + size[1] ** 2)
    low, high = (tuple((np.asarray(centre) + sign * np.asarray(size)).tolist()) for sign in (-0.5, 0.5))
    shape = Block(low=low, high=high)
    return Rigid(mass=mass, centre=centre, inertia=inertia, velocity=velocity, spin=spin, shape=shape)


def _point(place: Array) -> tuple[float, float, float]:
    return float(place[0]), float(place[1]), float(place[2])


def _about(axis: Direction, along: float, across: float) -> tuple[tuple[float, ...], ...]:
    """Inertia of a body that is round about an axis."""
    one = axes(axis, rigid_cylinder)[0]
    tensor = across * np.eye(3) + (along - across) * np.outer(one, one)
    return tuple(map(tuple, tensor.tolist()))
