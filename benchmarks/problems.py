"""The problems that are marched, and what is noted of a march."""

from collections.abc import Iterable
from time import perf_counter
from typing import Any

import numpy as np

import softway as sw
from softway.march.step import Step

END, STEP, ENERGY = 0.05, 5e-4, 12.5
"""Of the thrown cube: end of the run, slab, energy at the start."""


def drop(cells: int, cell: str = "hex8", mass: Any = None) -> sw.Scene:
    """The peers' problem: a neo-Hookean cube thrown at a plane 0.05 below it."""
    cube = sw.Solid(
        mesh=sw.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells), cell=cell),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        velocity=sw.Uniform(value=(0.0, 0.0, -5.0)),
        **({} if mass is None else {"mass": mass}),
    )
    floor = sw.Tool(shape=sw.HalfSpace(point=(0.0, 0.0, -0.05), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"cube": cube, "floor": floor}, contacts=(sw.Contact(between=("cube.bottom", "floor")),))


def ball(cells: int) -> sw.Scene:
    """A neo-Hookean ball of diameter 1 that meets a plane with a twentieth of the speed of waves."""
    body = sw.Solid(
        mesh=sw.Ball(radius=0.5, cells=cells),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        velocity=sw.Uniform(value=(0.0, 0.0, -0.06)),
    )
    floor = sw.Tool(shape=sw.HalfSpace(point=(0.0, 0.0, -0.5001), normal=(0.0, 0.0, 1.0)))
    return sw.Scene(bodies={"ball": body, "floor": floor}, contacts=(sw.Contact(between=("ball.surface", "floor")),))


def beam(cells: int) -> sw.Scene:
    """A clamped beam, twenty times as long as thick, that a load bends by most of its length."""
    thick = 0.05
    body = sw.Solid(
        mesh=sw.Box(size=(1.0, thick, thick), cells=(10 * cells, cells, cells)),
        material=sw.NeoHookean(E=1.0, nu=0.3),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    return sw.Scene(bodies={"beam": body}, loads=(sw.Gravity(acceleration=(0.0, 1.8e-3, 0.0)),))


def glued(cells: int, nu: float) -> sw.Scene:
    """A nearly incompressible block, glued to the ground, whose top starts sideways."""
    body = sw.Solid(
        mesh=sw.Box(size=(1.0, 1.0, 1.0), cells=(cells, cells, cells)),
        material=sw.NeoHookean(E=1.0, nu=nu),
        density=1.0,
        supports=(sw.Fixed(on="bottom"),),
        velocity=sw.Profile(axis="z", at=(0.0, 1.0), values=((0.0, 0.0, 0.0), (0.15, 0.0, 0.0))),
    )
    return sw.Scene(bodies={"block": body})


def noted(steps: Iterable[Step], start: float, energy: float, most: int | None = None) -> tuple[dict[str, Any], Step]:
    """What a march costs and keeps, and its last slab.

    ``start`` is when the work began; the first of ``seconds`` holds all that was done before.  ``energy`` is the unit
    of the greatest departure from the balance.
    """
    seconds, touching, iterations, drift, spans, rejected = [], [], [], [], [], 0
    before, step = start, None
    for step in steps:
        now = perf_counter()
        seconds.append(now - before)
        touching.append(any(c.count or c.force_n for c in step.ledger.contacts.values()))
        iterations.append(step.report.iterations)
        drift.append(abs(step.ledger.energy_error) / energy)
        spans.append(step.slab.span)
        rejected += len(step.report.rejections)
        before = perf_counter()
        if len(seconds) == most:
            break
    assert step is not None
    facts = {
        "wall": before - start,
        "seconds": seconds,
        "touching": touching,
        "iterations": float(np.mean(iterations)),
        "drift": max(drift),
        "rejected": rejected,
        "factors": step.report.factorisations,
        "span": min(spans),
        "unknowns": sum(v.size for v in step.after.velocity.values()),
        "velocity": float(step.ledger.momentum[-1]),
    }
    return facts, step
