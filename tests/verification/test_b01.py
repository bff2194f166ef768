"""B01: a static patch of two blocks with irregular meshes that do not match, 4 and 7 elements along the interface.

The lower block rests on rollers, the upper one lies on it, held by contact alone, under a uniform pressure.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pytest

import softway as sw
from softway.march.begin import begin
from softway.typing import Array
from softway.verify.exact.contact import Patch

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


def pressed(dim: Literal[2, 3], *, ratio: float = 1.0, pressure: float = 1.0, method: Method | None = None) -> Pressed:
    """The patch; ``ratio`` is the modulus of the upper block over that of the lower one."""
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
    scene = sw.Scene(
        bodies={"lower": lower, "upper": upper},
        contacts=(sw.Contact(between=("lower.high", "upper.low"), name="middle", method=method),),
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


@pytest.mark.parametrize("dim", [2, 3])
def test_the_stress_is_uniform(dim):
    """With mortar the case allows 1e-9; what is left is rounding of positions over the displacement."""
    patch = pressed(dim)
    assert patch.missed <= 1e-9
    others = patch.stress.copy()
    others[:, 1, 1] = 0.0
    if dim == 2:
        others[:, 2, 2] += POISSON
    assert np.abs(others).max() <= 1e-9
    exact = Patch(
        pressure=1.0, layers=((HEIGHT, YOUNGS),) * 2, poisson=POISSON, plane="strain" if dim == 2 else "stress"
    )
    assert patch.settlement == pytest.approx(np.full(len(patch.settlement), exact.settlement), rel=1e-9)


@pytest.mark.parametrize(
    ("method", "tilted"), [(sw.DualMortar(), 1e-9), (sw.NodeToSurface(), 1e-5)], ids=["mortar", "nodes"]
)
@pytest.mark.parametrize("dim", [2, 3])
def test_the_forces_on_both_sides_balance(dim, method, tilted):
    """The case allows 1e-12; and they carry the load, along y but for the ripple that single nodes leave."""
    patch = pressed(dim, method=method)
    assert np.abs(patch.sides.sum(axis=0)).max() <= 1e-12
    assert patch.sides[1] == pytest.approx(patch.force * np.eye(dim)[1], abs=tilted)
    assert patch.force == pytest.approx(1.0, abs=1e-8)


@pytest.mark.parametrize("dim", [2, 3])
def test_nodes_of_one_side_against_the_faces_of_the_other(dim):
    """The case allows 0.05 for a single pass."""
    assert pressed(dim, method=sw.NodeToSurface()).missed <= 0.05


def test_nodes_of_both_sides_pass_in_the_plane():
    assert pressed(2, method=sw.NodeToSurface(nodes="both")).missed <= 1e-9


@pytest.mark.parametrize("dim", [2, 3])
def test_a_stiffer_block_on_a_softer_one(dim):
    """The softer block widens more, and its border of the width nu (1 + nu) p/E comes to lie beside the upper block.

    Contact is that of the deformed surfaces, so this border bears nothing: the stress there misses 1 by a share of p/E.
    In the limit of no load, extrapolated from two small ones, the patch is passed.
    """
    loads = (1e-5 * YOUNGS, 2e-5 * YOUNGS)
    one, two = (pressed(dim, ratio=10.0, pressure=p) for p in loads)
    for patch, load in zip((one, two), loads, strict=True):
        assert 1.0 * load / YOUNGS <= patch.missed <= 2.0 * load / YOUNGS
    limit = 2.0 * one.stress - two.stress
    assert np.abs(limit[:, 1, 1] + 1.0).max() <= 5e-9
