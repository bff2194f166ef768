"""Material points under prescribed deformations, and bodies through equilibrium states, slab by slab."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

import softway as sw
from softway.arrays import Array
from softway.bodies.assembled import material_states
from softway.bodies.internal_force.inelastic.inelastic_force import InelasticForce, inelastic_force
from softway.bodies.internal_force.material_state import MaterialState
from softway.laws.law import RateLaw
from softway.laws.objective_rates import Rate
from softway.model.model import Model
from softway.solve.static.static_equilibrium import equilibrium

RATES: dict[str, Rate] = {
    "jaumann": sw.laws.Jaumann(),
    "jaumann, polar": sw.laws.Jaumann(increment="polar"),
    "green_naghdi": sw.laws.GreenNaghdi(),
    "truesdell": sw.laws.Truesdell(),
    "log": sw.laws.Logarithmic(),
}
"""Objective rates by their names in the cases."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Element:
    """Single cell whose nodes follow a homogeneous deformation."""

    mesh: sw.Mesh
    internal: InelasticForce

    def history(self, path: Iterable[Array], stress: Array | None = None, span: float = 1.0) -> list[MaterialState]:
        """History variables at the start and after each deformation F (d, d), one slab of length ``span`` for each.

        ``stress`` (3, 3) is the initial stress of the cell.
        """
        memory = self.internal.state
        if stress is not None:
            memory = replace(memory, stress=np.broadcast_to(stress, memory.stress.shape).copy())
        found = [memory]
        for F in path:
            u = self.mesh.points @ (F - np.eye(self.mesh.dim)).T
            found.append(self.internal.during(found[-1], span).committed(u))
        return found

    def volume_ratio(self, memory: MaterialState) -> Array:
        """Determinant (p,) of the deformation gradient at the quadrature points."""
        H = self.internal.sampling.derivatives(memory.displacement)
        return np.asarray(np.linalg.det(self.internal.points.gradient(H, memory.lateral)))


def square(law: RateLaw) -> Element:
    """Unit square in plane strain."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)).build()
    return Element(mesh=mesh, internal=inelastic_force(mesh, law, sw.bodies.PlaneStrain()))


def cube(law: RateLaw) -> Element:
    """Unit cube."""
    mesh = sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(1, 1, 1)).build()
    return Element(mesh=mesh, internal=inelastic_force(mesh, law, sw.bodies.Volume()))


def sheared(gamma: float, steps: int) -> list[Array]:
    """Deformations of simple shear up to gamma in equal steps."""
    return [np.array([[1.0, g], [0.0, 1.0]]) for g in gamma * np.arange(1, steps + 1) / steps]


def cycle(height: float, shift: float, steps: int) -> list[Array]:
    """Closed cycle: stretch in y, shear, then both reversed; ``steps`` for each of the four legs."""
    corners = np.array([(0.0, 1.0), (0.0, 1.0 + height), (shift, 1.0 + height), (shift, 1.0), (0.0, 1.0)])
    along = np.arange(1, steps + 1)[:, None] / steps
    legs = [a + along * (b - a) for a, b in zip(corners[:-1], corners[1:], strict=True)]
    return [np.array([[1.0, s], [0.0, l]]) for s, l in np.concatenate(legs)]


def equilibria(
    model: Model, path: Iterable[tuple[Array | None, float]], span: float = 1.0
) -> Iterator[tuple[Array, material_states.MaterialStates]]:
    """Displacement (n, d) and history variables of each equilibrium state on a path.

    The path gives the initial displacement of the iteration (None: the previous one), whose supported components are
    kept, and the fraction of the loads.
    """
    u, memories = model.displacement, material_states.initial_states(model.parts)
    for guess, share in path:
        now = model.during(memories, span)
        u = equilibrium(now, u if guess is None else guess, model.dofs, share * model.load).displacement
        memories = material_states.committed(now.parts, u)
        yield u, memories
