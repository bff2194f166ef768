"""I03: the dropped bar of A09 on a mesh that adapts in space and time, against the uniform one."""

from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.meshes.adaptive.adapt import Adapt
from softway.record.view.plots.curves import Curve, Panel

CELLS, LEVELS = 10, 5
LENGTH, SPEED, HEIGHT, GRAVITY = 10.0, 30.0, 5.0, 10.0
TOUCH, RELEASE, END = 1.0, 5.0 / 3.0, 2.0
ENERGY = 500.0
"""Energy of the bar, the greatest of its potential energy [J]."""
TOLERANCE = 0.02
"""Tolerance by which slabs grow."""


def scene(cells: int, adapt: Adapt | None = None) -> sw.Scene:
    """The bar of A09 above its floor."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=LENGTH, cells=cells, origin=HEIGHT),
        material=sw.LinearElastic(E=SPEED**2),
        density=1.0,
        adapt=adapt,
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=0.0, normal=1.0))
    return sw.Scene(
        bodies={"bar": bar, "floor": floor},
        contacts=(sw.Contact(between=("bar.left", "floor"), name="floor"),),
        loads=(sw.Gravity(acceleration=-GRAVITY),),
    )


def exact(time: Array) -> Array:
    """Force of the floor until t = 2."""
    push = SPEED * (np.sqrt(2.0 * GRAVITY * HEIGHT) + GRAVITY * (time - TOUCH))
    return np.where((time > TOUCH) & (time < RELEASE), push, 0.0)


@cache
def uniform() -> tuple[sw.Step, ...]:
    """Slabs with equal cells and equal slabs, of the finest length."""
    return tuple(sw.march(scene(CELLS * 2**LEVELS), until=END, tolerance="off"))


@cache
def adapted() -> tuple[sw.Step, ...]:
    """Slabs on cells and with lengths that adapt."""
    return tuple(sw.march(scene(CELLS, Adapt(levels=LEVELS)), until=END, tolerance=TOLERANCE))


def force_error(steps: tuple[sw.Step, ...]) -> float:
    """Error of the mean forces of the slabs in L2 over time, relative to the exact ones."""
    apart, whole = 0.0, 0.0
    for step in steps:
        mean = float(exact(np.linspace(step.slab.start, step.slab.end, 41)).mean())
        apart += (step.ledger.contacts["floor"].force_n - mean) ** 2 * step.slab.span
        whole += mean**2 * step.slab.span
    return float(np.sqrt(apart / whole))


def unknowns(steps: tuple[sw.Step, ...]) -> int:
    """Sum of the degrees of freedom over the slabs."""
    return sum(step.model.dofs.size for step in steps)


def jumps(steps: tuple[sw.Step, ...]) -> tuple[float, float]:
    """Greatest relative jump of the momentum, and greatest relative increase of the energy, at changes of the mesh."""
    momentum = energy = 0.0
    for last, step in zip(steps[:-1], steps[1:], strict=True):
        momenta = step.model.mass @ step.model.join(step.before.velocity)
        apart = abs(float(momenta.sum()) - float(last.ledger.momentum[0]))
        momentum = max(momentum, apart / float(np.abs(momenta).sum()))
        energy = max(energy, (last.ledger.remeshing - step.ledger.remeshing) / ENERGY)
    return momentum, energy


def compute() -> Outcome:
    """Compute until t = 2, with the first contact, cells of 1/32 at the finest and slabs of their transit time."""
    plain, fitted = uniform(), adapted()
    momentum, energy = jumps(fitted)
    values = {
        "degrees of freedom times slabs, relative to uniform": unknowns(fitted) / unknowns(plain),
        "error of the force, relative to uniform": force_error(fitted) / force_error(plain),
        "jump of the momentum at a remeshing": momentum,
        "increase of the energy at a remeshing": energy,
        "error of the energy balance": fitted[-1].ledger.energy_error / ENERGY,
    }
    return Outcome(values=values, panels=_panels(plain, fitted))


def _panels(plain: tuple[sw.Step, ...], fitted: tuple[sw.Step, ...]) -> tuple[Panel, ...]:
    def ends(steps: tuple[sw.Step, ...]) -> list[float]:
        return [step.slab.end for step in steps]

    time = np.linspace(0.0, END, 801)
    forces = (
        Curve(x=ends(fitted), y=[step.ledger.contacts["floor"].force_n for step in fitted], label="adapted"),
        Curve(x=time, y=exact(time), kind="exact", label="d'Alembert"),
    )
    sizes = tuple(
        Curve(x=ends(steps), y=[step.model.dofs.size for step in steps], label=name)
        for name, steps in (("adapted", fitted), ("uniform", plain))
    )
    return (
        Panel(title="Force of the floor", x="t [s]", y="force [N]", curves=forces),
        Panel(title="Degrees of freedom", x="t [s]", y="number", log="y", curves=sizes),
    )
