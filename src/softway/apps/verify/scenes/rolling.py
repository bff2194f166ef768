"""Stiff round bodies that roll or slide on a rough plane, or slide until they roll: C05, C06.

Gravity is rotated instead of the plane. A faceted body rolls over its edges: velocities fluctuate, but accelerations
averaged over several facets and the friction torque agree with a round body. Quantities that depend on the radius of
gyration are compared for the ``beta`` of the mesh.
"""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.arrays import Array, BoolArray, IntArray
from softway.meshes.generators.recipes import MeshSource
from softway.model.model import Model

GRAVITY = 9.81
DENSITY = 1000.0
TREAD = 0.3
"""Half width of the tread of a ball relative to its radius; nodes elsewhere keep their mass."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """Motion of a round body, with values at the ends of the slabs.

    ``time``; ``place`` of the centre along the plane; mean ``velocity`` along the plane; ``spin`` about the centre
    (angular momentum / moment of inertia); ``creep``, the greatest velocity of sticking contact nodes; ``slides``, true
    for slabs with slipping nodes. ``beta`` is the moment of inertia / (mass radius^2), ``error`` the greatest error of
    the energy [J], ``gap`` the smallest gap [m].
    """

    time: Array
    place: Array
    velocity: Array
    spin: Array
    creep: Array
    slides: BoolArray
    beta: float
    error: float
    gap: float


def rolled(
    *,
    source: MeshSource,
    radius: float,
    slope: float,
    mu: float,
    until: float,
    step: float,
    speed: float = 0.0,
    youngs: float = 1e8,
) -> Course:
    """March a round body, centred at the origin, on a plane that falls along x with the ``slope`` [rad]."""
    mesh = source.build().with_tag("tread", lambda x: _tread(x, radius))
    dim = mesh.dim
    down, up = np.zeros(dim), np.zeros(dim)
    down[0], down[-1], up[-1] = np.sin(slope), -np.cos(slope), 1.0
    lowest = np.zeros(dim)
    lowest[-1] = mesh.points[:, -1].min()
    body = sw.Solid(
        mesh=mesh,
        material=sw.NeoHookean(E=youngs, nu=0.3),
        density=DENSITY,
        velocity=sw.bodies.Uniform(value=(speed, *(0.0,) * (dim - 1))),
    )
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=tuple(lowest.tolist()), normal=tuple(up.tolist())))
    contact = sw.Contact(between=("b.tread", "plane"), name="plane", friction=sw.Coulomb(mu=mu))
    fall = sw.Gravity(acceleration=tuple((GRAVITY * down).tolist()))
    model = sw.build(sw.Scene(bodies={"b": body, "plane": plane}, contacts=(contact,), loads=(fall,)))
    return _course(model, list(sw.march(model, until=until, step=step)), radius)


def _tread(x: Array, radius: float) -> BoolArray:
    """True for points (n,) on the rim near the plane of rolling, from coordinates (n, d)."""
    rim = np.linalg.norm(x, axis=1) > (1.0 - 1e-6) * radius
    return rim if x.shape[1] == 2 else rim & (np.abs(x[:, 1]) < TREAD * radius)


def _course(model: Model, steps: list[sw.Step], radius: float) -> Course:
    mass = model.weight
    total = float(mass.sum())
    arm = model.points - mass @ model.points / total
    moment = float(np.sum((model.mass @ arm)[:, [0, -1]] * arm[:, [0, -1]]))
    centres = np.array([mass @ s.after.displacement["b"] for s in steps]) / total
    nodes = model.touchable
    return Course(
        time=np.array([s.after.time for s in steps]),
        place=centres[:, 0],
        velocity=np.array([s.ledger.momentum[0] for s in steps]) / total,
        spin=np.array([_spin(model, s) for s in steps]) / moment,
        creep=np.array([_creep(s, nodes) for s in steps]),
        slides=np.array([bool((s.after.sliding["plane"] & s.after.closed["plane"]).any()) for s in steps]),
        beta=moment / (total * radius**2),
        error=max(abs(s.ledger.energy_error) for s in steps),
        gap=min(s.certificate.min_gap for s in steps),
    )


def _spin(model: Model, step: sw.Step) -> float:
    """Angular momentum about the centre; rolling in the direction x is positive."""
    x, v = model.points + step.after.displacement["b"], step.after.velocity["b"]
    own = x - model.weight @ x / model.weight.sum()
    p = model.mass @ v
    return float(np.sum(own[:, -1] * p[:, 0] - own[:, 0] * p[:, -1]))


def _creep(step: sw.Step, nodes: IntArray) -> float:
    """Greatest velocity along the plane of a node that is in contact at both ends of a slab and sticks [m/s]."""
    here = step.before.closed["plane"] & step.after.closed["plane"] & ~step.after.sliding["plane"]
    moved = (step.after.displacement["b"] - step.before.displacement["b"])[nodes[here], :-1]
    return float(np.abs(moved).max(initial=0.0)) / step.slab.span
