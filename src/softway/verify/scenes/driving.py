"""Matter driven through given deformations, and bodies through states of equilibrium, slab by slab."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

import softway as sw
from softway.bodies import past
from softway.bodies.memory import Memory
from softway.bodies.rate_force import RateForce, rate_force
from softway.laws.law import RateLaw
from softway.laws.rates import Rate
from softway.model import Model
from softway.solve.equilibrium import equilibrium
from softway.typing import Array

RATES: dict[str, Rate] = {
    "jaumann": sw.Jaumann(),
    "jaumann, polar": sw.Jaumann(increment="polar"),
    "green_naghdi": sw.GreenNaghdi(),
    "truesdell": sw.Truesdell(),
    "log": sw.Logarithmic(),
}
"""All rates, by their names in the cases."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Element:
    """One cell whose nodes follow a homogeneous deformation."""

    mesh: sw.Mesh
    internal: RateForce

    def history(self, path: Iterable[Array], stress: Array | None = None, span: float = 1.0) -> list[Memory]:
        """Memories at the start and after each of the deformations F (d, d), one slab of length ``span`` for each;
        ``stress`` (3, 3) is what the cell starts with.
        """
        memory = self.internal.memory
        if stress is not None:
            memory = replace(memory, stress=np.broadcast_to(stress, memory.stress.shape).copy())
        found = [memory]
        for F in path:
            u = self.mesh.points @ (F - np.eye(self.mesh.dim)).T
            found.append(self.internal.during(found[-1], span).settled(u))
        return found

    def volume_ratio(self, memory: Memory) -> Array:
        """Determinant (p,) of the deformation gradient at the points."""
        H = self.internal.sampling.derivatives(memory.displacement)
        return np.asarray(np.linalg.det(self.internal.points.gradient(H, memory.lateral)))


def square(law: RateLaw) -> Element:
    """A unit square in plane strain."""
    mesh = sw.Rectangle(size=(1.0, 1.0), cells=(1, 1)).build()
    return Element(mesh=mesh, internal=rate_force(mesh, law, sw.PlaneStrain()))


def cube(law: RateLaw) -> Element:
    """A unit cube."""
    mesh = sw.Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 1)).build()
    return Element(mesh=mesh, internal=rate_force(mesh, law, sw.Volume()))


def sheared(gamma: float, steps: int) -> list[Array]:
    """Simple shear up to gamma in equal steps."""
    return [np.array([[1.0, g], [0.0, 1.0]]) for g in gamma * np.arange(1, steps + 1) / steps]


def cycle(height: float, shift: float, steps: int) -> list[Array]:
    """Stretched in y, sheared, and both taken back: ``steps`` for each of the four legs."""
    corners = np.array([(0.0, 1.0), (0.0, 1.0 + height), (shift, 1.0 + height), (shift, 1.0), (0.0, 1.0)])
    along = np.arange(1, steps + 1)[:, None] / steps
    legs = [a + along * (b - a) for a, b in zip(corners[:-1], corners[1:], strict=True)]
    return [np.array([[1.0, s], [0.0, l]]) for s, l in np.concatenate(legs)]


def equilibria(
    model: Model, path: Iterable[tuple[Array | None, float]], span: float = 1.0
) -> Iterator[tuple[Array, past.Memories]]:
    """Displacement (n, d) and memories in each state of equilibrium on a path: displacements to start from (those
    before, if None), whose supported components stay, and the share of the loads.
    """
    u, memories = model.displacement, past.known(model.parts, ())
    for guess, share in path:
        now = model.during(memories, span)
        u = equilibrium(now, u if guess is None else guess, model.free, share * model.load).displacement
        memories = past.settled(now.parts, u)
        yield u, memories
