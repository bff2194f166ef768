"""B01: a static patch of two blocks with irregular meshes that do not match, 4 and 7 elements along the interface.

The lower block rests on rollers, the upper one lies on it, held by contact alone, under a uniform pressure.
"""

from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

import softway as sw
from softway.march.begin import begin
from softway.record.view_curves import Curve, Panel
from softway.typing import Array
from softway.verify.case import Outcome

YOUNGS, POISSON = 1e3, 0.3
Method = sw.DualMortar | sw.NodeToSurface
HEIGHT = 0.5


def irregular(dim: Literal[2, 3], cells: int, layers: int, seed: int) -> sw.Mesh:
    """A block [0, 1] x [0, 0.5] (x [0, 1]) whose nodes are moved at random, but for its sides and edges as a whole.

    Tags: ``low`` and ``high``, and nodes of the lower side that hold it in its plane, ``corner`` and ``end``.
    """
    if dim == 2:
        even = sw.Rectangle(size=(1.0, HEIGHT), cells=(cells, layers)).build()
    else:
        even = sw.Box(size=(1.0, HEIGHT, 1.0), cells=(cells, layers, cells)).build()
    x = even.points
    low, high = x.min(axis=0), x.max(axis=0)
    shift = np.random.default_rng(seed).uniform(-0.15, 0.15, x.shape) / cells
    mesh = sw.Mesh(points=x + np.where((x == low) | (x == high), 0.0, shift), blocks=even.blocks)
    mesh = mesh.with_tag("low", lambda p: p[:, 1] == 0.0).with_tag("high", lambda p: p[:, 1] == HEIGHT)
    mesh = mesh.with_tag("corner", lambda p: (p == low).all(axis=1))
    return mesh.with_tag("end", lambda p: (p == np.eye(dim)[0]).all(axis=1))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pressed:
    """The two blocks in equilibrium; stresses over the pressure, settlement times E over it.

    ``stress`` (cells, 3, 3) of both blocks, ``settlement`` (k,) of the nodes of the top, ``force`` the contact force,
    ``sides`` (2, d) what contact does to either block.
    """

    stress: Array
    settlement: Array
    force: float
    sides: Array

    @property
    def missed(self) -> float:
        """Greatest |sigma_yy + 1|."""
        return float(np.abs(self.stress[:, 1, 1] + 1.0).max())

    @property
    def unbalanced(self) -> float:
        """What contact does to both blocks together."""
        return float(np.abs(self.sides.sum(axis=0)).max())


@cache
def pressed(
    dim: Literal[2, 3], *, ratio: float = 1.0, pressure: float = 1.0, method: Method | None = None, mu: float = 0.0
) -> Pressed:
    """The patch; ``ratio`` is the modulus of the upper block over that of the lower one, ``mu`` the friction."""
    plane = "x" if dim == 2 else "xz"
    held = [sw.Fixed(on="corner", components=plane), *([sw.Fixed(on="end", components="z")] if dim == 3 else [])]
    meshes = {"lower": irregular(dim, 4, 2, seed=1), "upper": irregular(dim, 7, 3, seed=2)}
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
        place=sw.Placement(translation=(0.0, HEIGHT, 0.0)[:dim]),
    )
    friction = sw.Coulomb(mu=mu) if mu else sw.Frictionless()
    contact = sw.Contact(between=("lower.high", "upper.low"), name="middle", method=method, friction=friction)
    scene = sw.Scene(
        bodies={"lower": lower, "upper": upper},
        contacts=(contact,),
        loads=(sw.Traction(on="upper.high", value=(0.0, -pressure, 0.0)[:dim]),),
        start=sw.StaticStart(),
    )
    model = sw.build(scene)
    first = begin(model)
    u, force = first.start.displacement, first.pressure / pressure
    push = model.rows(u).spread(force, model.shape)
    own = model.split(u)
    return Pressed(
        stress=np.concatenate([model.stress(n, own[n]) for n in meshes]) / pressure,
        settlement=-own["upper"][meshes["upper"].nodes("high"), 1] / pressure,
        force=float(force.sum()),
        sides=np.array([push[p.rows].sum(axis=0) for p in model.parts]),
    )


def compute() -> Outcome:
    """In the plane and in space; the stiffer upper block in the limit of no load, from two small loads."""
    found: dict[str, float] = {}
    spaces: tuple[tuple[Literal[2, 3], str], ...] = ((2, ""), (3, ", 3D"))
    for dim, tail in spaces:
        mortar, nodes = pressed(dim), pressed(dim, method=sw.NodeToSurface())
        found["max |sigma_yy+1|" + tail] = mortar.missed
        found["same, node-to-segment single pass" + tail] = nodes.missed
        found["force balance of both sides" + tail] = max(mortar.unbalanced, nodes.unbalanced)
        found["max |sigma_yy+1|, mu = 0.3" + tail] = pressed(dim, mu=0.3).missed
        found["max |sigma_yy+1|, E2 = 10 E1" + tail] = pressed(dim, ratio=10.0).missed
        found["max |sigma_yy+1|, E2 = 10 E1, limit of small loads" + tail] = stiffer(dim)
    both = pressed(2, method=sw.NodeToSurface(nodes="both"))
    found["same, node-to-segment two passes"] = both.missed
    return Outcome(values=found, panels=(_panel(both),))


def stiffer(dim: Literal[2, 3]) -> float:
    """Greatest miss of the stress in the limit of no load, from two small ones, with the upper block ten times stiffer.

    The softer block widens more, and its border of the width nu (1 + nu) p/E comes to lie beside the upper block.
    Contact is that of the deformed surfaces, so this border bears nothing: the stress there misses 1 by a share of p/E.
    """
    one, two = (pressed(dim, ratio=10.0, pressure=p).stress for p in (1e-5 * YOUNGS, 2e-5 * YOUNGS))
    return float(np.abs(2.0 * one[:, 1, 1] - two[:, 1, 1] + 1.0).max())


def _panel(both: Pressed) -> Panel:
    """Miss of the stress in all cells, in order of their stress."""
    one = pressed(2, method=sw.NodeToSurface())
    curves = []
    for patch, label in ((pressed(2), "mortar"), (one, "nodes, one pass"), (both, "nodes, two passes")):
        missed = np.maximum(np.abs(np.sort(patch.stress[:, 1, 1]) + 1.0), 1e-17)
        curves.append(Curve(x=np.arange(float(len(missed))), y=missed, label=label))
    return Panel(title="Miss of the stress, plane strain", x="cell", y="|sigma_yy + 1|", log="y", curves=tuple(curves))
