"""Stiff round bodies on a rough plane that roll, slide, or slide until they roll: C05, C06.

Gravity is turned instead of the plane.  A body of facets rolls over its edges: velocities waver, while accelerations
over several facets and the torque of friction are those of a round body.  What depends on the radius of gyration is
compared for the ``beta`` that the mesh has.
"""

from dataclasses import dataclass

import numpy as np

import softway as sw
from softway.model import Model
from softway.space.sources import MeshSource
from softway.typing import Array, BoolArray, IntArray

GRAVITY = 9.81
DENSITY = 1000.0
TREAD = 0.3
"""Half the width of the tread of a ball, over its radius: nodes elsewhere keep their inertia."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """What a round body did: at the ends of the slabs the ``time``, the ``place`` of its centre along the plane, its
    mean ``velocity`` along it, the ``spin`` about its centre (angular momentum over moment of inertia), the greatest
    velocity ``creep`` of nodes that touch and do not slip, and which slabs have nodes that slip (``slides``).

    ``beta`` is the moment of inertia over mass and radius squared; ``error`` the greatest error of the energy [J] and
    ``gap`` the least gap [m].
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
    """A body of revolution about its centre, the origin, on a plane that falls along x with the ``slope`` [rad]."""
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
        velocity=sw.Uniform(value=(speed, *(0.0,) * (dim - 1))),
    )
    plane = sw.Tool(shape=sw.HalfSpace(point=tuple(lowest.tolist()), normal=tuple(up.tolist())))
    contact = sw.Contact(between=("b.tread", "plane"), name="plane", friction=sw.Coulomb(mu=mu))
    fall = sw.Gravity(acceleration=tuple((GRAVITY * down).tolist()))
    model = sw.build(sw.Scene(bodies={"b": body, "plane": plane}, contacts=(contact,), loads=(fall,)))
    return _course(model, list(sw.march(model, until=until, step=step)), radius)


def _tread(x: Array, radius: float) -> BoolArray:
    """Which points (n,) at coordinates (n, d) lie on the rim, near the plane in which the body rolls."""
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
    """Angular momentum about the centre, clockwise seen along the axis: rolling down x is positive."""
    x, v = model.points + step.after.displacement["b"], step.after.velocity["b"]
    own = x - model.weight @ x / model.weight.sum()
    p = model.mass @ v
    return float(np.sum(own[:, -1] * p[:, 0] - own[:, 0] * p[:, -1]))


def _creep(step: sw.Step, nodes: IntArray) -> float:
    """Greatest velocity along the plane of a node that touches at both ends of a slab and does not slip [m/s]."""
    here = step.before.closed["plane"] & step.after.closed["plane"] & ~step.after.sliding["plane"]
    moved = (step.after.displacement["b"] - step.before.displacement["b"])[nodes[here], :-1]
    return float(np.abs(moved).max(initial=0.0)) / step.slab.span
