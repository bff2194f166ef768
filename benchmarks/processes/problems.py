"""The problems that are marched, and what is noted of a march."""

from collections.abc import Iterable
from time import perf_counter, process_time
from typing import Any

import numpy as np

import softway as sw
from softway.marching.results.step import Step
from softway.solve.stable_step import stable_step


def ball(cells: int) -> sw.Scene:
    """A neo-Hookean ball of diameter 1 that meets a plane with a twentieth of the speed of waves."""
    body = sw.Solid(
        mesh=sw.meshes.Ball(radius=0.5, cells=cells),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -0.06)),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.5001), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"ball": body, "floor": floor}, contacts=(sw.Contact(between=("ball.surface", "floor")),))


def beam(cells: int) -> sw.Scene:
    """A clamped beam, twenty times as long as thick, that a load bends by most of its length."""
    thick = 0.05
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, thick, thick), cells=(10 * cells, cells, cells)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    return sw.Scene(bodies={"beam": body}, loads=(sw.Gravity(acceleration=(0.0, 1.8e-3, 0.0)),))


def glued(cells: int, nu: float) -> sw.Scene:
    """A nearly incompressible block, glued to the ground, whose top starts sideways."""
    body = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells)),
        material=sw.NeoHookean(E=1.0, nu=nu),
        density=1.0,
        supports=(sw.Fixed(on="bottom"),),
        velocity=sw.bodies.Profile(axis="z", at=(0.0, 1.0), values=((0.0, 0.0, 0.0), (0.15, 0.0, 0.0))),
    )
    return sw.Scene(bodies={"block": body})


def compact(cells: int, touching: bool = True) -> sw.Scene:
    """A neo-Hookean ball of quadratic tetrahedra that is thrown at a floor, which all of its surface may touch.

    18 cells make 50,653 nodes.  Without a floor all nodes keep their mass.
    """
    body = sw.Solid(
        mesh=sw.meshes.Ball(radius=0.02, cells=cells, cell="tet10"),
        material=sw.NeoHookean(E=1e8, nu=0.4),
        density=1150.0,
        velocity=sw.bodies.Uniform(value=(0.0, 0.0, -20.0)),
        mass=sw.bodies.Lumped(),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.0201), normal=(0.0, 0.0, 1.0)))
    met = (sw.Contact(between=("ball.surface", "floor")),) if touching else ()
    return sw.Scene(bodies={"ball": body, "floor": floor}, contacts=met)


def bare(scene: sw.Scene, until: float, most: int) -> dict[str, float]:
    """Processor time [s] of central differences with the same kernel and nothing else: the mean of ``most`` slabs, and
    that of all slabs up to ``until`` at 0.8 of the stability limit.
    """
    model = sw.build(scene)
    slabs = int(np.ceil(until / (0.8 * stable_step(model, model.displacement, sw.Explicit()))))
    h, mass = until / slabs, model.mass.diagonal()[:, None]
    u, v = model.displacement.copy(), model.velocity.copy()
    a = -model.force(u) / mass
    start = process_time()
    for _ in range(most):
        v += 0.5 * h * a
        u += h * v
        _, force = model.energy_and_force(u)
        a = -force / mass
        v += 0.5 * h * a
    slab = (process_time() - start) / most
    return {"slab": slab, "run": slab * slabs}


def now() -> tuple[float, float]:
    """Time by the clock, and that of the processors [s]."""
    return perf_counter(), process_time()


def noted(
    steps: Iterable[Step], start: tuple[float, float], energy: float, most: int | None = None
) -> tuple[dict[str, Any], Step]:
    """What a march costs and keeps, and its last slab.

    ``start`` is when the work began; the first of ``seconds``, and of ``used`` ones of the processors, holds all that
    was done before.  ``energy`` is the unit of the greatest departure from the balance.
    """
    times, touching, iterations, drift, spans, rejected = [start], [], [], [], [], 0
    instants, momentum = [], []
    step = None
    for step in steps:
        times.append(now())
        touching.append(any(c.count or c.force_n for c in step.ledger.contacts.values()))
        iterations.append(step.report.iterations)
        drift.append(abs(step.ledger.energy_error) / energy)
        spans.append(step.slab.span)
        instants.append(step.after.time)
        momentum.append(float(step.ledger.momentum[-1]))
        rejected += len(step.report.rejections)
        if len(spans) == most:
            break
    assert step is not None
    seconds, used = np.diff(times, axis=0).T.tolist()
    facts = {
        "wall": sum(seconds),
        "cpu": sum(used),
        "seconds": seconds,
        "used": used,
        "touching": touching,
        "iterations": float(np.mean(iterations)),
        "drift": max(drift),
        "rejected": rejected,
        "factors": step.report.factorisations,
        "span": min(spans),
        "unknowns": sum(v.size for v in step.after.velocity.values()),
        "velocity": momentum[-1],
        "time": instants,
        "momentum": momentum,
    }
    return facts, step
