"""A tilted square and a tilted cube fall on a plane, at a tenth of the speed of waves: order in the step.

The reference takes mass and stiffness of the mesh from the model, and nothing else: the nodes with inertia follow
``M u'' = -f`` by an integration of eighth order, those without solve a linear complementarity problem at each instant.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import nnls

import softway as sw
from orders import order
from softway.arrays import Array
from softway.model.model import Model

pytestmark = pytest.mark.slow

ELASTIC = sw.LinearElastic(E=1.0, nu=0.3)
SPEED = 0.1 * np.sqrt(0.7 / (1.3 * 0.4))
HEIGHT = 0.01
SQUARE = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)), (sw.bodies.Rotation(angle=0.05),)
CUBE = (
    sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(4, 4, 4)),
    (sw.bodies.Rotation(angle=0.05, axis=(1.0, 0.0, 0.0)), sw.bodies.Rotation(angle=0.08, axis=(0.0, 1.0, 0.0))),
)
BODIES = {"square": SQUARE, "cube": CUBE}
UNTIL = 1.6
STEPS = (0.04, 0.02, 0.01, 0.005)
"""A wave crosses 0.19 cells of the mesh in the longest."""


def falling(body: str) -> sw.Scene:
    """The lowest corner is a little above the plane; the lower face may touch it."""
    mesh, turns = BODIES[body]
    d = len(mesh.size)
    up = np.eye(d)[-1]
    solid = sw.Solid(
        mesh=mesh,
        material=ELASTIC,
        density=1.0,
        velocity=sw.bodies.Uniform(value=tuple(-SPEED * up)),
        place=sw.bodies.Placement(rotations=turns, bottom=HEIGHT),
    )
    plane = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0,) * d, normal=tuple(up)))
    contact = sw.Contact(between=("body.bottom", "plane"), name="plane")
    return sw.Scene(bodies={"body": solid, "plane": plane}, contacts=(contact,))


@dataclass(frozen=True, kw_only=True, eq=False)
class SemiDiscrete:
    """The mesh with massless nodes on its lower face, exact but for the integration in time.

    ``heavy`` and ``light`` are numbers of components; ``below`` picks the vertical ones of the light nodes.
    """

    mass: Array
    stiffness: Array
    heavy: Array
    light: Array
    below: Array
    height: Array

    @cached_property
    def inner(self) -> Array:
        """Stiffness (k, k) among the heavy components."""
        return self.stiffness[np.ix_(self.heavy, self.heavy)]

    @cached_property
    def across(self) -> Array:
        """Stiffness (k, l) between heavy and light components."""
        return self.stiffness[np.ix_(self.heavy, self.light)]

    @cached_property
    def own(self) -> tuple[Array, bool]:
        """Factor of the stiffness among the light components."""
        return cho_factor(self.stiffness[np.ix_(self.light, self.light)])

    @cached_property
    def give(self) -> Array:
        """Displacements (l, c) of the light components under unit forces of the plane."""
        return cho_solve(self.own, np.eye(len(self.light))[:, self.below])

    @cached_property
    def root(self) -> Array:
        """Cholesky factor (c, c) of the compliance at the plane."""
        return np.linalg.cholesky(self.give[self.below])

    def rest(self, u: Array) -> tuple[Array, Array]:
        """Displacement (l,) of the light components and forces (c,) of the plane where the heavy ones are at u (k,):
        0 <= force, gap >= 0, one of them zero, by least squares with non-negative unknowns.
        """
        free = -cho_solve(self.own, self.across.T @ u)
        gap = self.height + free[self.below]
        if gap.min() >= 0.0:
            return free, np.zeros(len(gap))
        force = nnls(self.root.T, -solve_triangular(self.root, gap, lower=True))[0]
        return free + self.give @ force, force

    def energy(self, u: Array, v: Array) -> float:
        """Kinetic and stored energy."""
        x = np.zeros(len(self.stiffness))
        x[self.heavy], x[self.light] = u, self.rest(u)[0]
        w = v.reshape(len(self.mass), -1)
        return float(0.5 * np.sum(w * (self.mass @ w)) + 0.5 * x @ self.stiffness @ x)

    @classmethod
    def of(cls, model: Model) -> "SemiDiscrete":
        n, d = model.shape
        components = np.arange(n * d).reshape(n, d)
        light = model.parts[0].mesh.nodes("bottom")
        heavy = np.setdiff1d(np.arange(n), light)
        return cls(
            mass=model.mass.toarray()[np.ix_(heavy, heavy)],
            stiffness=model.tangent(np.zeros((n, d))).toarray(),
            heavy=components[heavy].ravel(),
            light=components[light].ravel(),
            below=np.arange(len(light)) * d + d - 1,
            height=model.points[light, -1],
        )

    def motion(self, v: Array, until: float) -> tuple[Array, Array, int]:
        """Displacement and velocity (k,) of the heavy components at a time, and how many nodes have touched.

        The start is undeformed, with the velocity v (d,).
        """
        inertia, d = cho_factor(self.mass), len(v)
        touched: set[int] = set()

        def rate(_: float, y: Array) -> Array:
            u, velocity = np.split(y, 2)
            light, force = self.rest(u)
            touched.update(np.flatnonzero(force > 0.0).tolist())
            pull = (self.inner @ u + self.across @ light).reshape(-1, d)
            return np.concatenate([velocity, -cho_solve(inertia, pull).ravel()])

        start = np.concatenate([np.zeros(len(self.heavy)), np.tile(v, len(self.mass))])
        end = solve_ivp(rate, (0.0, until), start, method="DOP853", rtol=1e-9, atol=1e-11, max_step=0.02)
        return (*np.split(end.y[:, -1], 2), len(touched))


@cache
def reference(body: str) -> tuple[Array, Array, int]:
    """Displacement and velocity of the nodes with inertia, and how many nodes have touched."""
    model = sw.build(falling(body))
    return SemiDiscrete.of(model).motion(model.velocity[0], UNTIL)


@cache
def errors(body: str) -> Array:
    """Greatest errors (steps, 2) of displacement and velocity of the nodes with inertia."""
    u, v, _ = reference(body)
    found = []
    for step in STEPS:
        model = sw.build(falling(body))
        *_, last = sw.march(model, until=UNTIL, step=step)
        ends = (f["body"][model.massive].ravel() for f in (last.after.displacement, last.after.velocity))
        found.append([np.abs(end - exact).max() for end, exact in zip(ends, (u, v), strict=True)])
    return np.array(found)


@pytest.mark.few(1)
@pytest.mark.parametrize("body", BODIES)
def test_second_order_through_touches(body):
    """Node after node of the lower face touches, five and 25 of them."""
    displacement, velocity = errors(body).T
    assert order(displacement, STEPS) >= 1.9
    assert order(velocity, STEPS) >= 1.8
    assert displacement[-1] <= 1e-5


@pytest.mark.parametrize(("body", "nodes"), [("square", 5), ("cube", 25)])
def test_all_nodes_of_the_lower_face_touch(body, nodes):
    assert reference(body)[2] == nodes


@pytest.mark.parametrize("body", BODIES)
def test_the_reference_keeps_the_energy(body):
    """Kinetic and stored energy, the latter the least that the nodes without inertia can have above the plane."""
    model = sw.build(falling(body))
    system = SemiDiscrete.of(model)
    u, v, _ = reference(body)
    start = 0.5 * model.mass.sum() * SPEED**2
    assert system.energy(u, v) == pytest.approx(start, rel=1e-7)
