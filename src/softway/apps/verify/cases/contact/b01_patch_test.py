"""B01: static patch test of two blocks with irregular non-matching meshes, 4 and 7 elements along the interface.

The lower block rests on rollers. The upper block lies on it under a uniform pressure, supported only by contact.
"""

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

import softway as sw
from softway.apps.verify.case import Outcome
from softway.arrays import Array
from softway.marching.start.initial_state import initial_state
from softway.meshes.cells import CELLS, linear
from softway.meshes.element import tabulate
from softway.record.view.plots.curves import Curve, Panel

YOUNGS, POISSON = 1e3, 0.3
Method = sw.contact.DualMortar | sw.contact.NodeToSurface
HEIGHT = 0.5


def irregular(dim: Literal[2, 3], cells: int, layers: int, seed: int, cell: str) -> sw.Mesh:
    """Block [0, 1] x [0, 0.5] (x [0, 1]) with randomly moved corners of its cells; sides and edges stay straight.

    Tags: ``low`` and ``high``, and the nodes ``corner`` and ``end`` of the lower side, which support it in its plane.
    """
    if dim == 2:
        even = sw.meshes.Rectangle(size=(1.0, HEIGHT), cells=(cells, layers), cell=cell).build()
    else:
        even = sw.meshes.Box(size=(1.0, HEIGHT, 1.0), cells=(cells, layers, cells), cell=cell).build()
    x = even.points
    low, high = x.min(axis=0), x.max(axis=0)
    shift = np.random.default_rng(seed).uniform(-0.15, 0.15, x.shape) / cells
    sides, corners = (x == low) | (x == high), even.blocks[cell][:, : CELLS[cell].corners]
    points, middles = x + np.where(sides, 0.0, shift), even.blocks[cell][:, CELLS[cell].corners :]
    points[middles] = tabulate(linear(cell), CELLS[cell].nodes[CELLS[cell].corners :])[0] @ points[corners]
    mesh = sw.Mesh(points=np.where(sides, x, points), blocks=even.blocks)
    mesh = mesh.with_tag("low", lambda p: p[:, 1] == 0.0).with_tag("high", lambda p: p[:, 1] == HEIGHT)
    mesh = mesh.with_tag("corner", lambda p: (p == low).all(axis=1))
    return mesh.with_tag("end", lambda p: (p == np.eye(dim)[0]).all(axis=1))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pressed:
    """Equilibrium of the two blocks; stress / pressure, and settlement E / pressure.

    ``stress`` (cells, 3, 3) of both blocks, ``settlement`` (k,) of the top nodes, contact ``force``, and ``sides``
    (2, d), the contact force on each block.
    """

    stress: Array
    settlement: Array
    force: float
    sides: Array

    @property
    def missed(self) -> float:
        """Greatest stress error |sigma_yy + 1|."""
        return float(np.abs(self.stress[:, 1, 1] + 1.0).max())

    @property
    def unbalanced(self) -> float:
        """Sum of the contact forces on both blocks."""
        return float(np.abs(self.sides.sum(axis=0)).max())


def blocks(dim: Literal[2, 3], ratio: float, cell: str) -> dict[str, sw.Solid]:
    """Both blocks; ``ratio`` is the modulus of the upper block / lower block, ``cell`` the type of their cells."""
    plane = "x" if dim == 2 else "xz"
    held = [sw.Fixed(on="corner", components=plane), *([sw.Fixed(on="end", components="z")] if dim == 3 else [])]
    meshes = {"lower": irregular(dim, 4, 2, seed=1, cell=cell), "upper": irregular(dim, 7, 3, seed=2, cell=cell)}
    lower = sw.Solid(
        mesh=meshes["lower"],
        material=sw.LinearElastic(E=YOUNGS, nu=POISSON),
        density=1.0,
        supports=(sw.Fixed(on="low", components="y"), *held),
    )
    upper = sw.Solid(
        mesh=meshes["upper"],
        material=sw.LinearElastic(E=ratio * YOUNGS, nu=POISSON),
        density=1.0,
        supports=tuple(held),
        place=sw.bodies.Placement(translation=(0.0, HEIGHT, 0.0)[:dim]),
    )
    return {"lower": lower, "upper": upper}


@cache
def pressed(
    dim: Literal[2, 3],
    *,
    ratio: float = 1.0,
    pressure: float = 1.0,
    method: Method | None = None,
    mu: float = 0.0,
    cell: str = "",
) -> Pressed:
    """Solve the patch; ``ratio`` is the modulus of the upper block / lower block, ``mu`` the friction coefficient.

    ``cell`` is the type of the cells: squares or cubes, by default linear.
    """
    bodies = blocks(dim, ratio, cell or ("quad4" if dim == 2 else "hex8"))
    friction = sw.Coulomb(mu=mu) if mu else sw.laws.Frictionless()
    contact = sw.Contact(between=("lower.high", "upper.low"), name="middle", method=method, friction=friction)
    scene = sw.Scene(
        bodies=bodies,
        contacts=(contact,),
        loads=(sw.Traction(on="upper.high", value=(0.0, -pressure, 0.0)[:dim]),),
        start=sw.model.StaticStart(),
    )
    model = sw.build(scene)
    first = initial_state(model)
    u, force = first.start.displacement, first.pressure / pressure
    push = model.rows(u).spread(force, model.shape)
    own = model.split(u)
    return Pressed(
        stress=np.concatenate([model.stress(n, own[n]) for n in bodies]) / pressure,
        settlement=-own["upper"][model.meshes["upper"].nodes("high"), 1] / pressure,
        force=float(force.sum()),
        sides=np.array([push[p.nodes].sum(axis=0) for p in model.parts]),
    )


def compute() -> Outcome:
    """Compute the case in 2D and 3D; the limit of small loads is extrapolated from two small loads."""
    found: dict[str, float] = {}
    spaces: tuple[tuple[Literal[2, 3], str], ...] = ((2, ""), (3, ", 3D"))
    for dim, tail in spaces:
        mortar, nodes = pressed(dim), pressed(dim, method=sw.contact.NodeToSurface())
        found["max |sigma_yy+1|" + tail] = mortar.missed
        found["same, node-to-segment single pass" + tail] = nodes.missed
        found["force balance of both sides" + tail] = max(mortar.unbalanced, nodes.unbalanced)
        found["max |sigma_yy+1|, mu = 0.3" + tail] = pressed(dim, mu=0.3).missed
        found["max |sigma_yy+1|, E2 = 10 E1" + tail] = pressed(dim, ratio=10.0).missed
        found["max |sigma_yy+1|, E2 = 10 E1, limit of small loads" + tail] = stiffer(dim)
    both = pressed(2, method=sw.contact.NodeToSurface(nodes="both"))
    found["same, node-to-segment two passes"] = both.missed
    return Outcome(values=found, panels=(_panel(both),))


def stiffer(dim: Literal[2, 3]) -> float:
    """Greatest stress error in the limit of small loads, with the upper block ten times stiffer.

    The softer block widens more, so a strip of width nu (1 + nu) p/E lies beyond the edge of the upper block. Contact
    acts on the deformed surfaces, so this strip carries no load: the stress error there is proportional to p/E.
    """
    one, two = (pressed(dim, ratio=10.0, pressure=p).stress for p in (1e-5 * YOUNGS, 2e-5 * YOUNGS))
    return float(np.abs(2.0 * one[:, 1, 1] - two[:, 1, 1] + 1.0).max())


def _panel(both: Pressed) -> Panel:
    """Stress error in all cells, in order of their stress."""
    one = pressed(2, method=sw.contact.NodeToSurface())
    curves = []
    for patch, label in ((pressed(2), "mortar"), (one, "nodes, one pass"), (both, "nodes, two passes")):
        missed = np.maximum(np.abs(np.sort(patch.stress[:, 1, 1]) + 1.0), 1e-17)
        curves.append(Curve(x=np.arange(float(len(missed))), y=missed, label=label))
    return Panel(title="Stress error, plane strain", x="cell", y="|sigma_yy + 1|", log="y", curves=tuple(curves))
