"""Refusals of scenes, laws and solvers that come from Python only."""

from collections.abc import Callable
from math import inf

import numpy as np
from try_it import PLANE, Call, Table, Try

import softway as sw
from softway.bodies.dof_map import NodalDofs
from softway.bodies.prescribed_motion import Turning
from softway.bodies.setup.amplitude import Ramp
from softway.bodies.setup.initial_fields import Uniform, sample
from softway.laws.friction.coulomb import Coulomb
from softway.meshes.generators.shapes import rectangle
from softway.model.build import with_dofs
from softway.model.model import Model
from softway.solve.linear.backends.choice import require_solver
from softway.solve.linear.interface import counted, number_type


def body(**given: object) -> sw.Solid:
    """A square of two layers."""
    parts = {"mesh": rectangle((1.0, 1.0), (2, 2)), "material": sw.LinearElastic(E=1.0), "density": 1.0, **given}
    return sw.Solid(**parts)  # type: ignore[arg-type]


def scene(*contacts: sw.Contact, loads: tuple[object, ...] = (), **bodies: object) -> Model:
    """Model of a square and other bodies."""
    return sw.build(sw.Scene(bodies={"b": body(), **bodies}, contacts=contacts, loads=loads))  # type: ignore[arg-type]


def pair(**given: object) -> sw.Contact:
    """Contact with the square below."""
    return sw.Contact(**{"between": ("b.bottom", "c.top"), **given})  # type: ignore[arg-type]


def call(wrong: Callable[[], object], remedy: str, right: Callable[[], object]) -> Call:
    """Call that is wrong, and one that is right."""
    return Call(lambda _: wrong(), remedy, lambda _: right())


WALL = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
BELOW = body(mesh=rectangle((1.0, 1.0), (2, 2), origin=(0.0, -1.0)))
MESH = rectangle((1.0, 1.0), (2, 2))
CORNER = MESH.with_tag("corner", lambda x: (x < 0.1).all(axis=1))
DRIVEN = body(supports=(sw.bodies.Driven(on="left", velocity=0.0),))
TABLE: Table = {
    "no solid": call(lambda: sw.build(sw.Scene(bodies={})), "at least one body of kind Solid", scene),
    "dimensions": call(
        lambda: scene(c=body(mesh=sw.meshes.Interval(length=1.0, cells=2))), "of one dimension", lambda: scene(c=BELOW)
    ),
    "rules": call(
        lambda: scene(pair(timing=sw.contact.Impulse()), pair(name="d", between=("b.left", "c.top")), c=BELOW),
        "the same timing for all",
        lambda: scene(pair(), pair(name="d", between=("b.left", "c.top")), c=BELOW),
    ),
    "names": call(
        lambda: scene(pair(name="d"), pair(name="d", between=("b.left", "c.top")), c=BELOW),
        "another name",
        lambda: scene(pair(name="d"), pair(name="e", between=("b.left", "c.top")), c=BELOW),
    ),
    "tools alone": call(
        lambda: scene(pair(between=("w", "w", "w")), w=WALL),
        "at least one solid",
        lambda: scene(pair(between=("b.top", "b.bottom", "w")), b=body(mesh=rectangle((1.0, 1.0), (4, 4))), w=WALL),
    ),
    "nobody": call(lambda: scene(pair(between=("d.top", "c.top")), c=BELOW), "'b'", lambda: scene(pair(), c=BELOW)),
    "load on nobody": call(
        lambda: scene(loads=(sw.bodies.Traction(on="c.top", value=(0.0, 1.0)),)),
        "'b'",
        lambda: scene(loads=(sw.bodies.Traction(on="b.top", value=(0.0, 1.0)),)),
    ),
    "load on a corner": call(
        lambda: scene(b=body(mesh=CORNER), loads=(sw.bodies.Traction(on="b.corner", value=(0.0, 1.0)),)),
        "a tag of a side",
        lambda: scene(loads=(sw.bodies.Traction(on="b.left", value=(0.0, 1.0)),)),
    ),
    "density": call(lambda: scene(b=body(density=-1.0)), "1000 kg/m^3", scene),
    "rate of turning": call(
        lambda: Turning(point=(0.0, 0.0), rate=inf), "an angular velocity", lambda: Turning(point=(0.0, 0.0), rate=1.0)
    ),
    "endless ramp": call(
        lambda: Ramp(times=(0.0, inf), factors=(0.0, 1.0)),
        "finite numbers",
        lambda: Ramp(times=(0.0, 1.0), factors=(0.0, 1.0)),
    ),
    "field of another shape": call(
        lambda: sample(np.zeros(3), MESH), "finite numbers of shape (9, 2)", lambda: sample(np.zeros((9, 2)), MESH)
    ),
    "infinite field": call(
        lambda: sample(Uniform(value=(inf, 0.0)), MESH),
        "finite numbers",
        lambda: sample(Uniform(value=(1.0, 0.0)), MESH),
    ),
    "endless friction": call(lambda: Coulomb(mu=inf), "a finite number", lambda: Coulomb(mu=1.0)),
    "backend": call(lambda: require_solver("super"), "superlu", lambda: require_solver("superlu")),
    "precision": call(lambda: number_type("half"), "double or single", lambda: number_type("double")),  # type: ignore[arg-type]
    "threads": call(lambda: counted(0), "1 or more", lambda: counted(1)),
    "single CHOLMOD": Try(
        PLANE,
        "solver={kind='FixedPoint', operator={kind='Factored', backend='cholmod', precision='single'}}",
        "another backend",
        "solver.operator.backend=superlu",
    ),
    "map of another model": call(
        lambda: with_dofs(scene(), NodalDofs(np.ones((3, 2), bool))),
        "a map for (9, 2)",
        lambda: with_dofs(scene(), NodalDofs(np.ones((9, 2), bool))),
    ),
    "map of driven nodes": call(
        lambda: with_dofs(scene(b=DRIVEN), NodalDofs(np.ones((9, 2), bool))),
        "empty rows",
        lambda: with_dofs(scene(b=DRIVEN), scene(b=DRIVEN).dofs),
    ),
    "map without the fields": call(
        lambda: with_dofs(scene(b=body(velocity=Uniform(value=(1.0, 0.0)))), NodalDofs(np.zeros((9, 2), bool))),
        "another velocity",
        lambda: with_dofs(scene(), NodalDofs(np.zeros((9, 2), bool))),
    ),
}
