"""Time against error, on uniform meshes and on meshes that follow waves and contacts.

``python benchmarks/processes/adapted.py NAME [--smallest]`` marches a problem with finer and finer cells and
prints one line of JSON: of each run its finest cell, the processor time of building and marching [s], its error, and
the sum of its nodes over its slabs.
"""

import argparse
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from time import process_time
from typing import Any

import numpy as np

import softway as sw
from softway.adaptivity.adapted_solid import adapted_solid
from softway.apps.verify.exact.thrown import Thrown
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.meshes.adaptive.overlay import embedding
from softway.meshes.adaptive.refinement import AdaptedMesh, refined
from softway.meshes.adaptive.surfaces.surface import rounded
from softway.meshes.generators.shapes import box, disc, interval, rectangle
from softway.meshes.mesh import Mesh


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """A scene with one solid, ``body``, on its base mesh.

    Parameters
    ----------
    scene
        The scene.
    until
        End [s].
    step
        Slab on cells that have not been cut [s]; half as long where edges are halved.
    levels
        Bisections of the finest cells of the runs.
    reference
        Bisections of the uniform mesh whose motion counts as exact, beyond those of the finest run: half of its cells'
        size would take an hour; None with an exact force.
    adapt
        How the mesh adapts.
    """

    scene: sw.Scene
    until: float
    step: float
    levels: tuple[int, ...]
    reference: int | None
    adapt: Adapt

    @property
    def base(self) -> Mesh:
        """Base mesh, with the smooth surface that its refinements follow."""
        return rounded(self.scene.bodies["body"].mesh)

    def march(self, level: int, adapts: bool) -> "Run":
        """A run with cells of a level at the finest, which ``adapts``, or has them everywhere."""
        fine = refined(self.base, np.full(self.base.n_cells, level))
        body = self.scene.bodies["body"]
        body = replace(body, adapt=replace(self.adapt, levels=level)) if adapts else replace(body, mesh=fine.mesh)
        scene = replace(self.scene, bodies={**self.scene.bodies, "body": body})
        step, start = self.step * 0.5 ** (level / self.base.cell_dim), process_time()
        nodes, forces = 0, []
        for last in sw.march(scene, until=self.until, step=step):
            nodes += last.model.shape[0]
            forces += [(last.before.time, last.after.time, c.force_n) for c in last.ledger.contacts.values()]
        taken = process_time() - start
        mesh = last.model.adapted["body"] if adapts else fine
        return Run(mesh=mesh, cpu=taken, nodes=nodes, forces=tuple(forces), last=last)


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Last mesh of a run, its processor time [s], nodes times slabs, forces in slabs (start, end, force), last slab."""

    mesh: AdaptedMesh
    cpu: float
    nodes: int
    forces: tuple[tuple[float, float, float], ...]
    last: sw.Step


def bar() -> Problem:
    """The bar of case A02, thrown at a wall with its speed of waves."""
    body = sw.Solid(mesh=interval(1.0, cells=10), material=sw.LinearElastic(E=1.0), density=1.0,
                    velocity=sw.bodies.Uniform(value=1.0))  # fmt: skip
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.3, normal=-1.0))
    scene = sw.Scene(bodies={"body": body, "wall": wall}, contacts=(sw.Contact(between=("body.right", "wall")),))
    return Problem(scene=scene, until=2.8, step=0.1 / np.sqrt(2.0), levels=(4, 6, 8), reference=None,
                   adapt=Adapt(every=8, buffer=8))  # fmt: skip


def wave() -> Problem:
    """A wave from a side of length 1/8 at a corner of a square, pushed for .1; linear, plane strain."""
    mesh = rectangle((1.0, 1.0), (8, 8), cell="tri3").with_tag("source", lambda x: (x[:, 0] == 0) & (x[:, 1] < 0.13))
    body = sw.Solid(mesh=mesh, material=sw.LinearElastic(E=1.0, nu=0.3), density=1.0)
    ramp = sw.bodies.Ramp(times=(0.0, 0.05, 0.1), factors=(0.0, 1.0, 0.0))
    scene = sw.Scene(bodies={"body": body}, loads=(sw.Traction(on="body.source", value=(1.0, 0.0), ramp=ramp),))
    return Problem(scene=scene, until=0.5, step=0.064, levels=(6, 8, 10), reference=0,
                   adapt=Adapt(tolerance=0.3, every=8, buffer=8))  # fmt: skip


def thrown(mesh: Mesh, up: Sequence[float]) -> sw.Scene:
    """A neo-Hookean body that is thrown at a floor just below it, with about a tenth of its speed of waves.

    The lowest tenth of its surface may touch, so that the nodes that lose their mass are all in fine cells.
    """
    way = np.array(up) / np.linalg.norm(up)
    height = mesh.points @ way
    low, high = float(height.min()), float(height.max())
    surface = mesh.nodes("surface")
    under = surface[height[surface] < low + 0.1 * (high - low)]
    mesh = replace(mesh, tags={**mesh.tags, "under": under})
    body = sw.Solid(mesh=mesh, material=sw.NeoHookean(E=1.0, nu=0.3), density=1.0,
                    velocity=sw.bodies.Uniform(value=tuple(-0.1 * way)))  # fmt: skip
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=tuple((low - 0.005) * way), normal=tuple(way)))
    return sw.Scene(bodies={"body": body, "floor": floor}, contacts=(sw.Contact(between=("body.under", "floor")),))


def ball() -> Problem:
    """A disc that meets a floor, until the wave has come to its centre."""
    return Problem(scene=thrown(disc(0.5, 8, cell="tri3"), (0.0, 1.0)), until=0.5, step=0.08,
                   levels=(4, 6, 8), reference=0, adapt=Adapt(every=8, buffer=8))  # fmt: skip


def corner() -> Problem:
    """A cube of tetrahedra that meets an inclined floor with a corner, until the wave has come to its centre."""
    return Problem(scene=thrown(box((1.0,) * 3, (6, 6, 6), cell="tet4"), (2.0, 1.0, 2.0)), until=0.6,
                   step=0.08, levels=(3, 6), reference=0,
                   adapt=Adapt(every=8, buffer=4, contact_cells=4))  # fmt: skip


PROBLEMS: dict[str, Callable[[], Problem]] = {f.__name__: f for f in (bar, wave, ball, corner)}


def force_error(run: Run) -> float:
    """Root mean square error of the force of the wall on the bar over its contact, of 2 s."""
    exact, total = Thrown(gap=0.3), 0.0
    for start, end, force in run.forces:
        total += (force - float(exact.push(np.linspace(start, end, 41)).mean())) ** 2 * (end - start)
    return float(np.sqrt(total / 2.0))


class Exact:
    """Motion that counts as exact: the norm of the energy on its mesh."""

    def __init__(self, problem: Problem, level: int) -> None:
        run = problem.march(level, False)
        self.mesh = run.mesh
        body = problem.scene.bodies["body"]
        self.on = adapted_solid("body", body, self.mesh, np.zeros(0, dtype=np.int64))
        self.stiffness = self.on.part.tangent(np.zeros(self.mesh.mesh.points.shape))
        self.motion = motion(run.last)

    def energy(self, u: Array, v: Array) -> float:
        """Energy [J] of a displacement and a velocity (n, d)."""
        return self.on.kinetic(v) + 0.5 * float(u.ravel() @ (self.stiffness @ u.ravel()))

    def error(self, run: Run) -> float:
        """Error of a motion relative to the strained and moving part of the exact one."""
        into = embedding(run.mesh, self.mesh)
        apart = (into @ field - whole for field, whole in zip(motion(run.last), self.motion, strict=True))
        u, v = self.motion
        middle = np.asarray(self.on.mass.sum(axis=1)).ravel()
        return float(np.sqrt(self.energy(*apart) / self.energy(u, v - middle @ v / middle.sum())))


def motion(step: sw.Step) -> tuple[Array, Array]:
    """Displacement and velocity (n, d) of the body; nodes without mass move with those behind them."""
    part = next(p for p in step.model.parts if p.name == "body")
    follow = step.model.follow[part.nodes][:, part.nodes]
    return step.after.displacement["body"], np.asarray(follow @ step.after.velocity["body"])


def runs(problem: Problem, levels: Sequence[int]) -> Iterator[dict[str, Any]]:
    """The runs, uniform and adapted."""
    for adapts in (False, True):
        problem.march(problem.base.cell_dim, adapts)  # compiles
    exact = Exact(problem, max(levels) + problem.reference) if problem.reference is not None else None
    for level in levels:
        for adapts in (False, True):
            run = problem.march(level, adapts)
            yield {
                "level": level,
                "finest": problem.base.edge() * 0.5 ** (level // problem.base.cell_dim),
                "adapts": adapts,
                "cpu": run.cpu,
                "error": force_error(run) if exact is None else exact.error(run),
                "nodes": run.nodes,
                "energy_error": abs(run.last.ledger.energy_error),
            }


def main() -> None:
    """Measure a problem and print its runs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", choices=PROBLEMS)
    parser.add_argument("--smallest", action="store_true", help="two levels on the base mesh")
    parser.add_argument("--levels", type=int, nargs="+", help="these levels")
    parser.add_argument("--reference", type=int, help="bisections of the reference beyond the finest run")
    given = parser.parse_args()
    problem = PROBLEMS[given.name]()
    if given.reference is not None:
        problem = replace(problem, reference=given.reference)
    levels = given.levels or ((problem.base.cell_dim,) if given.smallest else problem.levels)
    print(json.dumps({"runs": list(runs(problem, levels))}))


if __name__ == "__main__":
    main()
