"""Oblique impacts of two free bodies on meshes that do not match: what is kept to rounding, and what converges.

The bodies are neo-Hookean with E = rho = 1, nu = 0.3 and size 1, turned against each other, and thrown obliquely.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import softway as sw
from orders import order
from softway.bodies.internal_force.slab_average import SlabForce, Weighted
from softway.marching.audit.ledger import initial_ledger
from softway.marching.results.step import Step
from softway.marching.start.initial_state import initial_state
from softway.meshes.generators.recipes import MeshSource

pytestmark = pytest.mark.slow

RUBBER = sw.NeoHookean(E=1.0, nu=0.3)
Method = sw.contact.DualMortar | sw.contact.NodeToSurface
METHODS = {
    "mortar": sw.contact.DualMortar(),
    "nodes": sw.contact.NodeToSurface(),
    "nodes of both": sw.contact.NodeToSurface(nodes="both"),
}
MET = [
    ("squares", "mortar"),
    ("squares", "nodes"),
    ("squares", "nodes of both"),
    ("cubes", "mortar"),
    ("cubes", "nodes"),
    ("balls", "mortar"),
]


@dataclass(frozen=True, slots=True, kw_only=True)
class Pair:
    """Two meshes, the turns, the shift and the velocity of the second; when the march ends, and its step."""

    meshes: tuple[MeshSource, MeshSource]
    turns: tuple[sw.bodies.Rotation, ...]
    shift: tuple[float, ...]
    velocity: tuple[float, ...]
    until: float
    step: float

    def scene(self, method: Method, force: SlabForce) -> sw.Scene:
        """The whole surfaces may touch."""
        place = sw.bodies.Placement(rotations=self.turns, translation=self.shift)
        still = sw.Solid(mesh=self.meshes[0], material=RUBBER, density=1.0, force=force)
        thrown = replace(still, mesh=self.meshes[1], place=place, velocity=sw.bodies.Uniform(value=self.velocity))
        contact = sw.Contact(between=("still", "thrown"), name="middle", method=method)
        return sw.Scene(bodies={"still": still, "thrown": thrown}, contacts=(contact,))


PAIRS = {
    "squares": Pair(
        meshes=(sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4)), sw.meshes.Rectangle(size=(1.0, 1.0), cells=(5, 5))),
        turns=(sw.bodies.Rotation(angle=0.4),),
        shift=(0.25, 1.2),
        velocity=(0.1, -0.15),
        until=2.0,
        step=0.1,
    ),
    "cubes": Pair(
        meshes=(
            sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(3, 3, 3)),
            sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(4, 4, 4)),
        ),
        turns=(
            sw.bodies.Rotation(angle=0.3, axis=(1.0, 0.0, 0.0)),
            sw.bodies.Rotation(angle=0.5, axis=(0.0, 1.0, 0.0)),
        ),
        shift=(0.2, 0.15, 1.35),
        velocity=(0.05, 0.1, -0.15),
        until=1.5,
        step=0.1,
    ),
    "balls": Pair(
        meshes=(sw.meshes.Ball(radius=0.5, cells=4), sw.meshes.Ball(radius=0.5, cells=6)),
        turns=(sw.bodies.Rotation(angle=0.5, axis=(1.0, 1.0, 0.0)),),
        shift=(0.2, 0.1, 1.0),
        velocity=(0.05, 0.1, -0.15),
        until=2.0,
        step=0.2,
    ),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Impact:
    """A march."""

    steps: tuple[Step, ...]
    start: sw.Ledger

    @property
    def energy(self) -> float:
        """Greatest error of the energy, over the energy."""
        energies = np.array([s.ledger.energy_kinetic + s.ledger.energy_strain for s in self.steps])
        return float(np.abs(energies / (self.start.energy_kinetic + self.start.energy_strain) - 1.0).max())

    @property
    def momentum(self) -> float:
        """Greatest change of the momentum, over the momentum."""
        change = np.array([s.ledger.momentum for s in self.steps]) - self.start.momentum
        return float(np.abs(change).max() / np.linalg.norm(self.start.momentum))

    @property
    def spin(self) -> float:
        """Greatest change of the angular momentum, over that of the bodies about the middle of the first."""
        change = np.array([s.ledger.spin for s in self.steps]) - self.start.spin
        return float(np.abs(change).max() / np.linalg.norm(self.start.spin))

    @property
    def gap(self) -> float:
        """Least gap."""
        return min(s.certificate.min_gap for s in self.steps)

    @property
    def push(self) -> float:
        """Greatest force."""
        return max(s.ledger.contacts["middle"].force_n for s in self.steps)


def impact(pair: Pair, method: Method, force: SlabForce) -> Impact:
    """March a pair."""
    model = sw.build(pair.scene(method, force))
    steps = tuple(sw.march(model, until=pair.until, step=pair.step))
    return Impact(steps=steps, start=initial_ledger(model, initial_state(model)))


def require_kept(march: Impact) -> None:
    """Energy and momentum are kept, and nothing overlaps."""
    assert march.energy <= 1e-9
    assert march.momentum <= 1e-11
    assert march.gap >= -1e-12


@pytest.mark.few(3)
@pytest.mark.parametrize(("pair", "method"), MET)
def test_energy_momentum_and_spin_are_kept(pair, method):
    """With the force that closes the balance of angular momentum."""
    march = impact(PAIRS[pair], METHODS[method], sw.bodies.EnergyMomentum())
    assert march.push > 0.01
    assert march.spin <= 1e-9
    require_kept(march)


@pytest.mark.parametrize("method", METHODS)
def test_in_steps_a_thousandth_as_long(method):
    """No quotient of small increments: the same is kept in slabs in which hardly anything happens."""
    pair = PAIRS["squares"]
    above = pair.shift[1] + 0.298 * pair.velocity[1]
    close = replace(pair, shift=(pair.shift[0], above), until=5e-3, step=1e-3 * pair.step)
    march = impact(close, METHODS[method], sw.bodies.EnergyMomentum())
    assert march.push > 1e-4
    assert march.energy <= 1e-12
    assert march.momentum <= 1e-12
    assert march.spin <= 1e-12
    assert march.gap >= -1e-12


@pytest.mark.few(1)
@pytest.mark.parametrize("method", ["mortar", "nodes"])
@pytest.mark.parametrize("pair", ["squares", "cubes"])
def test_by_default_the_spin_converges(pair, method):
    """Energy and momentum are kept, the angular momentum to second order, between one step and a quarter of it: the
    rows have no moment.
    """
    steps = [0.1, 0.05, 0.025]
    marches = [impact(replace(PAIRS[pair], step=h, until=1.2), METHODS[method], Weighted()) for h in steps]
    assert order([marches[0].spin, marches[-1].spin], [steps[0], steps[-1]]) >= 1.8
    assert marches[-1].spin <= 3e-6
    for march in marches:
        require_kept(march)
