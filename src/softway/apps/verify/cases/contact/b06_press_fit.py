"""B06: press fit of two rings in plane stress, compared with Lame; the overlap is removed before the march.

The meshes do not match: with 40 and 32 facets on a quarter, chords of one circle differ by more than the interference.
Gaps are those of the curved surfaces.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.apps.verify.exact.contact import PressFit, Tube
from softway.arrays import Array
from softway.bodies.setup.loads import traction_force
from softway.marching.start.initial_state import initial_state
from softway.marching.state.model_state import ModelState
from softway.meshes.generators.recipes import Ring
from softway.model.model import Model
from softway.record.view.plots.curves import Curve, Panel

INNER, MIDDLE, OUTER, INTERFERENCE = 0.01, 0.02, 0.04, 1e-5
YOUNGS, POISSON = 210e9, 0.3
LAYERS, FACETS, QUARTER = 8, 32, 0.5 * np.pi
EXACT = PressFit(
    radii=(INNER, MIDDLE, OUTER), interference=INTERFERENCE, youngs=(YOUNGS, YOUNGS), poisson=(POISSON, POISSON)
)
SIDES = {"inner": "outer", "outer": "inner"}


def rings(
    facets: tuple[int, int], cell: str = "quad4", angle: float = QUARTER, fit: float = INTERFERENCE
) -> tuple[sw.Mesh, ...]:
    """Meshes of both rings with the given numbers of facets."""
    radii = ((INNER, MIDDLE + fit), (MIDDLE, OUTER))
    return tuple(
        Ring(inner=a, outer=b, cells=(LAYERS, n), angle=angle, cell=cell).build()
        for (a, b), n in zip(radii, facets, strict=True)
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fitted:
    """Equilibrium of two rings pressed into each other."""

    model: Model
    start: ModelState

    @classmethod
    def of(cls, meshes: tuple[sw.Mesh, ...], method: sw.contact.NodeToSurface | None = None) -> "Fitted":
        """Solve quarters with symmetric sides, or whole rings that are held only by contact; by default with mortar.

        Whole rings need a law for finite rotations: a small-strain law widens a rotating ring and releases it.
        """
        whole = "start" not in meshes[0].tags
        supports = () if whole else (sw.Fixed(on="start", components="y"), sw.Fixed(on="end", components="x"))
        law = sw.laws.StVenantKirchhoff(E=YOUNGS, nu=POISSON) if whole else sw.LinearElastic(E=YOUNGS, nu=POISSON)
        bodies = {
            name: sw.Solid(
                mesh=mesh,
                material=law,
                density=7850.0,
                section=sw.bodies.PlaneStress(),
                supports=supports,
            )
            for name, mesh in zip(SIDES, meshes, strict=True)
        }
        contact = sw.Contact(between=("inner.outer", "outer.inner"), name="fit", start="fit", method=method)
        model = sw.build(sw.Scene(bodies=bodies, contacts=(contact,)))
        return cls(model=model, start=initial_state(model))

    def _outward(self, name: str, field: Array) -> tuple[Array, Array]:
        """Radial component (k,) of a nodal field on the contact side of a ring, and the nodal lengths (k,)."""
        part = next(p for p in self.model.parts if p.name == name)
        nodes = part.mesh.nodes(SIDES[name])
        x = part.mesh.points[nodes]
        length = traction_force(part.mesh, sw.bodies.PlaneStress(), SIDES[name], (1.0, 0.0))[nodes, 0]
        return (field[part.nodes][nodes] * x).sum(axis=1) / np.hypot(*x.T), length

    def force(self, name: str) -> tuple[Array, Array]:
        """Nodal forces (k,) on a ring, and the nodal lengths (k,)."""
        rows = self.model.rows(self.start.start.displacement)
        force, length = self._outward(name, rows.spread(self.start.pressure, self.model.shape))
        return np.abs(force), length

    def pressure(self, name: str) -> Array:
        """Nodal pressure (k,) on a ring."""
        force, length = self.force(name)
        return force / length

    def displacement(self, name: str) -> Array:
        """Radial displacement (k,) of a ring at the contact."""
        return self._outward(name, self.start.start.displacement)[0]

    def stress(self, name: str) -> tuple[Array, Array, Array]:
        """Radii of the cell centres, with radial and hoop stress."""
        part = next(p for p in self.model.parts if p.name == name)
        middle = part.mesh.points[next(iter(part.mesh.blocks.values()))].mean(axis=1)
        stress = self.model.stress(name, self.start.start.displacement[part.nodes])[:, :2, :2]
        along = middle / np.hypot(*middle.T)[:, None]
        radial = np.einsum("ci,cij,cj->c", along, stress, along)
        return np.hypot(*middle.T), radial, np.trace(stress, axis1=1, axis2=2) - radial


def tube(name: str) -> Tube:
    """Exact solution of a ring."""
    return EXACT.inner if name == "inner" else EXACT.outer


FITS: dict[str, Callable[[], tuple[sw.Mesh, ...]]] = {
    "matching": lambda: rings((FACETS, FACETS)),
    "matching, quadratic": lambda: rings((FACETS, FACETS), "quad9"),
    "40 and 32": lambda: rings((40, FACETS)),
    "40 and 32, quadratic": lambda: rings((40, FACETS), "quad9"),
    "whole rings": lambda: rings((4 * FACETS, 4 * FACETS), angle=2.0 * np.pi),
}


@cache
def fitted(name: str) -> Fitted:
    """Solution for two rings of :data:`FITS`."""
    return Fitted.of(FITS[name]())


def compute() -> Outcome:
    """Compute with 40 against 32 facets per quarter, linear and quadratic, and with 32 that match; the larger error of
    both rings is given.
    """
    found: dict[str, float] = {}
    for name, tail in (("40 and 32", ""), ("40 and 32, quadratic", ", quadratic"), ("matching", ", matching")):
        pressures = [fitted(name).pressure(ring) for ring in SIDES]
        means = [float(p.mean()) for p in pressures]
        found["p" + tail] = max(means, key=lambda p: abs(p - EXACT.pressure))
        found["p uniformity" + tail] = float(max(np.ptp(p) for p in pressures)) / EXACT.pressure
    return Outcome(values=found, panels=(_panel(),))


def _panel() -> Panel:
    curves = []
    for name in SIDES:
        radius, _, hoop = fitted("40 and 32").stress(name)
        inside = np.linspace(radius.min(), radius.max(), 50)
        label = "softway" if name == "inner" else ""
        curves.append(Curve(x=1e3 * radius, y=1e-6 * hoop, kind="dots", label=label))
        lame = tube(name).stress(inside)[1]
        curves.append(Curve(x=1e3 * inside, y=1e-6 * lame, kind="exact", label=label and "Lame"))
    return Panel(title="Hoop stress in both rings", x="radius [mm]", y="stress [MPa]", curves=tuple(curves))
