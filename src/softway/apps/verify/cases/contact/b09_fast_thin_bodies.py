"""B09: thin bodies, so fast that one slab of the given length would carry one of them through the other.

The step is 0.01 s, the speed 100 m/s, the distance 0.3 m and the thickness 0.01 m. The bodies are compressed to half
their thickness (E = 10 kPa); bodies that collide with corners and edges are stiffer.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import linprog

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.scenes.overlap import overlap
from softway.arrays import Array
from softway.marching.results.step import Step
from softway.meshes.generators.recipes import MeshSource
from softway.model.model import Model
from softway.record.view.plots.curves import Curve, Panel

SPEED, GAP, THICKNESS, STEP = 100.0, 0.3, 0.01, 1e-2
Method = sw.contact.DualMortar | sw.contact.NodeToSurface | None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shot:
    """March up to a time after the impact."""

    model: Model
    steps: tuple[Step, ...]

    def instants(self, kind: str) -> list[float]:
        """Times of the touches or releases."""
        return [e.time for s in self.steps for e in s.events if e.kind == kind]

    @property
    def velocity(self) -> Array:
        """Velocities (2, d) of the centres of mass at the end."""
        mass = np.asarray(self.model.mass.sum(axis=1))
        v = self.model.join(self.steps[-1].after.velocity)
        return np.array([mass[p.nodes] @ v[p.nodes] / mass[p.nodes].sum() for p in self.model.parts])

    def places(self, step: Step) -> list[tuple[sw.Mesh, Array]]:
        """Mesh and positions of both bodies at the end of a slab."""
        return [(p.mesh, p.mesh.points + step.after.displacement[p.name]) for p in self.model.parts]

    @property
    def depth(self) -> float:
        """Greatest overlap of the bodies at the ends of the slabs [m]."""
        return max(overlap(*self.places(s)) for s in self.steps)

    @property
    def inverted(self) -> bool:
        """True if the centres of the bodies are ever in the wrong order."""
        return any(np.diff([x[:, 0].mean() for _, x in self.places(s)])[0] <= 0.0 for s in self.steps)

    @property
    def error(self) -> float:
        """Greatest error of the energy balance, relative to the energy."""
        start = self.steps[0].ledger
        return max(abs(s.ledger.energy_error) for s in self.steps) / (start.energy_kinetic + start.energy_strain)


def shot(
    bodies: Mapping[str, sw.Solid], until: float, tags: tuple[str, str] = ("left", "right"), method: Method = None
) -> Shot:
    """March with the step of the case until a time is passed."""
    contact = sw.Contact(between=tags, name="middle", method=method)
    model = sw.build(sw.Scene(bodies=bodies, contacts=(contact,)))
    steps: list[Step] = []
    for step in sw.march(model, until=STEP, step=STEP):
        steps.append(step)
        if step.after.time > until:
            break
    return Shot(model=model, steps=tuple(steps))


def pair(meshes: Sequence[MeshSource], youngs: float, places: Sequence[sw.bodies.Placement]) -> dict[str, sw.Solid]:
    """Two bodies in their places; the left one moves along x."""
    made = [place.applied(mesh.build()) for mesh, place in zip(meshes, places, strict=True)]
    material = sw.LinearElastic(E=youngs)
    speed = sw.bodies.Uniform(value=(SPEED, 0.0, 0.0)[: made[0].dim])
    left = sw.Solid(mesh=made[0], material=material, density=1.0, velocity=speed)
    return {"left": left, "right": sw.Solid(mesh=made[1], material=material, density=1.0)}


def away(*aside: float) -> sw.bodies.Placement:
    """Placement of the right body, with a lateral offset."""
    return sw.bodies.Placement(translation=(THICKNESS + GAP, *aside))


EDGE_ON_EDGE = (
    (sw.bodies.Rotation(angle=0.5, axis=(0.0, 1.0, 0.0)),),
    (sw.bodies.Rotation(angle=0.4, axis=(0.0, 0.0, 1.0)),),
)
CORNER_ON_FACE = (*EDGE_ON_EDGE[0], *EDGE_ON_EDGE[1]), ()


def meeting(one: Array, two: Array) -> tuple[float, tuple[int, int]]:
    """Time of the first contact of two convex hulls, by a linear program for their first common point.

    The hull of the points ``one`` (n, d) moves along x towards that of ``two``. Also returned: the number of points of
    each hull that define the contact point.
    """
    n, m = len(one), len(two)
    place = np.hstack([one.T, -two.T, np.eye(one.shape[1])[:, :1]]) / THICKNESS
    sums = np.zeros((2, n + m + 1))
    sums[0, :n], sums[1, n : n + m] = 1.0, 1.0
    found = linprog(
        np.eye(n + m + 1)[-1], A_eq=np.vstack([place, sums]), b_eq=np.concatenate([np.zeros(one.shape[1]), [1.0, 1.0]])
    )
    weights = found.x[:-1] > 1e-9
    return float(found.x[-1] / SPEED), (int(weights[:n].sum()), int(weights[n:].sum()))


@cache
def aligned(name: str) -> Shot:
    """March parallel faces: 50 elements in 1D, 20 x 3 and 20 x 4 in 2D."""
    meshes: Sequence[MeshSource]
    if name == "1D":
        meshes = [sw.meshes.Interval(length=THICKNESS, cells=50)] * 2
    else:
        meshes = [sw.meshes.Rectangle(size=(THICKNESS, 2.0 * THICKNESS), cells=(20, k)) for k in (3, 4)]
    aside = (0.0,) * (int(name[0]) - 1)
    bodies = pair(meshes, 1e4, (sw.bodies.Placement(), away(*aside)))
    return shot(bodies, 3.4e-3, ("left.right", "right.left"))


PLATES: dict[str, tuple[Any, tuple[float, float], tuple[int, int], Method]] = {
    "edge on edge": (EDGE_ON_EDGE, (-0.01, 0.010), (2, 2), sw.contact.DualMortar()),
    "corner on face": (CORNER_ON_FACE, (0.002, 0.001), (1, 3), sw.contact.NodeToSurface()),
}
"""Rotations, lateral offset, number of points of each plate at the contact, and the method."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Plates:
    """Collision of two plates: march, time and kind of the touch of the same rigid plates, overlap [m]."""

    march: Shot
    instant: float
    points: tuple[int, int]
    depth: float


@cache
def plates(name: str) -> Plates:
    """March two plates of :data:`PLATES`."""
    turns, aside, _, method = PLATES[name]
    wide = 3.0 * THICKNESS
    sources = [sw.meshes.Box(size=(THICKNESS, wide, wide), cells=(4, k, k)) for k in (4, 5)]
    places = [sw.bodies.Placement(rotations=turns[0]), replace(away(*aside), rotations=turns[1])]
    march = shot(pair(sources, 1e6, places), 3.1e-3, method=method)
    corners = [p.applied(replace(b, cells=(1, 1, 1)).build()).points for p, b in zip(places, sources, strict=True)]
    instant, points = meeting(*corners)
    return Plates(march=march, instant=instant, points=points, depth=march.depth)


def compute() -> Outcome:
    """Compute faces in 1D and 2D, edges and corners of plates in 3D."""
    found: dict[str, Any] = {}
    for name, tail in (("1D", ""), ("2D", ", 2D")):
        march = aligned(name)
        found["contact detected" + tail] = float(bool(march.instants("touch")))
        found["contact time" + tail] = min(march.instants("touch"), default=np.nan)
        found["order of bodies never inverted" + tail] = float(not march.inverted)
        found["v_com after" + tail] = march.velocity[:, 0].tolist()
    for name in PLATES:
        met = plates(name)
        found[f"contact time, plates {name}"] = min(met.march.instants("touch"), default=np.nan) - met.instant
        found[f"order of bodies never inverted, plates {name}"] = float(not met.march.inverted)
        found[f"overlap over thickness, plates {name}"] = met.depth / THICKNESS
    return Outcome(values=found, panels=(_panel(),))


def _panel() -> Panel:
    march = aligned("1D")
    t = np.array([0.0, *(s.after.time for s in march.steps)])
    places = [march.places(s) for s in march.steps]
    first = [p.mesh.points[:, 0] for p in march.model.parts]
    ends = (("right end of the left body", 0, np.max), ("left end of the right body", 1, np.min))
    curves = tuple(
        Curve(x=1e3 * t, y=1e3 * np.array([end(first[k]), *(end(p[k][1][:, 0]) for p in places)]), label=name)
        for name, k, end in ends
    )
    return Panel(title="The ends that meet, 1D", x="t [ms]", y="place [mm]", curves=curves)
