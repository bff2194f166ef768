"""A companion field of one's own, the temperature of an elastic bar: one file, no change of the package."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import splu

import softway as sw
from softway.model import with_field
from softway.model.build import build
from softway.model.field import Field, FieldSlab, FieldSolution, FieldState
from softway.model.model import Model

pytestmark = pytest.mark.slow

E, CAPACITY, CELLS, LENGTH = 1.0, 2.0, 20, 1.0


@dataclass(frozen=True, eq=False)
class BarTemperature:
    """Rise of temperature of a bar with the free energy ``-coupling theta strain`` and reference temperature 1 K.

    Heat: ``capacity dtheta/dt + coupling dstrain/dt = conductivity theta''``, insulated ends, lumped capacity, mean of
    the two ends of the slab.
    """

    points: np.ndarray
    coupling: float = 0.0
    conductivity: float = 0.0
    first: np.ndarray | float = 0.0
    field = Field(name="temperature", unit="K", components=1)

    @property
    def slope(self) -> sp.csr_array:
        """Strain of the cells from the displacement of the nodes."""
        n, h = len(self.points), np.diff(self.points[:, 0])
        return sp.csr_array(sp.diags_array([-1.0 / h, 1.0 / h], offsets=[0, 1], shape=(n - 1, n)))

    @property
    def mean(self) -> sp.csr_array:
        """Mean over the cells of the values at the nodes."""
        n = len(self.points)
        return sp.csr_array(sp.diags_array([0.5, 0.5], offsets=[0, 1], shape=(n - 1, n)))

    def initial(self) -> np.ndarray:
        return np.zeros((len(self.points), 1)) + self.first

    def at(self, values: np.ndarray, u: np.ndarray) -> FieldState:
        h = np.diff(self.points[:, 0])[:, None]
        theta, strain = self.mean @ values, self.slope @ u
        force = -self.coupling * (self.slope.T @ (h * theta))
        return FieldState(values=values, energy=np.array([-self.coupling * np.sum(h * theta * strain)]), force=force)

    def solve(self, slab: FieldSlab) -> FieldSolution:
        h = np.diff(self.points[:, 0])[:, None]
        capacity = sp.diags_array(CAPACITY * (self.mean.T @ h).ravel())
        flux = self.conductivity * (self.slope.T @ sp.diags_array(h.ravel()) @ self.slope)
        change = self.slope @ (slab.u1 - slab.u0)
        old = slab.start.values
        source = -self.coupling * (self.mean.T @ (h * change)) - slab.span * (flux @ old)
        matrix = sp.csc_array(capacity + 0.5 * slab.span * flux)
        end = self.at(old + splu(matrix).solve(source), slab.u1)
        middle = self.mean @ (0.5 * (old + end.values))
        work = -self.coupling * np.sum(h * middle * change)
        lost = work - (end.energy - slab.start.energy)
        return FieldSolution(end=end, mean_force=0.5 * (slab.start.force + end.force), lost=lost)


def bar(wall: bool = False, speed: float = 0.0, cells: int = CELLS, shape: Callable | None = None) -> sw.Scene:
    """A bar, supported on the left or thrown at a wall."""
    solid = sw.Solid(
        mesh=sw.meshes.Interval(length=LENGTH, cells=cells),
        material=sw.LinearElastic(E=E, nu=0.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=speed),
        displacement=shape or sw.bodies.Uniform(value=0.0),
        supports=() if wall else (sw.Fixed(on="left"),),
    )
    bodies: dict[str, object] = {"bar": solid}
    if not wall:
        return sw.Scene(bodies=bodies)
    bodies["wall"] = sw.Tool(shape=sw.obstacles.HalfSpace(point=LENGTH + 0.01, normal=-1.0))
    return sw.Scene(bodies=bodies, contacts=(sw.Contact(between=("bar.right", "wall")),))


def warm(scene: sw.Scene, **given: object) -> Model:
    """Model of a bar with a temperature."""
    model = build(scene)
    return with_field(model, BarTemperature(points=model.points, **given))


def test_a_field_has_its_own_equations() -> None:
    """A cosine of temperature in a bar at rest decays by the exact factor of its scheme in every slab."""
    x = np.linspace(0.0, LENGTH, CELLS + 1)[:, None]
    first = np.cos(np.pi * x)
    steps = list(sw.march(warm(bar(), conductivity=0.3, first=first), until=0.5, step=0.05))
    width = LENGTH / CELLS
    rate = 0.3 / CAPACITY * (2.0 - 2.0 * np.cos(np.pi * width)) / width**2
    factor = (1.0 - 0.025 * rate) / (1.0 + 0.025 * rate)
    for k, step in enumerate(steps, 1):
        np.testing.assert_allclose(step.after.fields["temperature"]["bar"], first * factor**k, atol=1e-12)
        assert not step.after.displacement["bar"].any()


def vibration(cells: int) -> float:
    """Error of the free end of a bar in its first adiabatic mode, relative to the amplitude."""
    coupling, size = 0.4, 0.01
    scene = bar(cells=cells, shape=lambda x: size * np.sin(0.5 * np.pi * x / LENGTH))
    x = np.linspace(0.0, LENGTH, cells + 1)[:, None]
    strain = size * 0.5 * np.pi / LENGTH * np.cos(0.5 * np.pi * x / LENGTH)
    model = warm(scene, coupling=coupling, first=-coupling / CAPACITY * strain)
    steps = list(sw.march(model, until=4.0, step=0.2 / cells))
    frequency = 0.5 * np.pi / LENGTH * np.sqrt(E + coupling**2 / CAPACITY)
    found = np.array([s.after.displacement["bar"][-1, 0] for s in steps])
    exact = size * np.cos(frequency * np.array([s.after.time for s in steps]))
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-14
    return float(np.abs(found - exact).max()) / size


def test_heat_stiffens_a_bar_without_conduction() -> None:
    """The first mode has the adiabatic modulus ``E + coupling^2 / capacity``, to second order in the mesh."""
    coarse, fine = vibration(8), vibration(16)
    assert fine < 4e-3
    assert np.log2(coarse / fine) == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("method", [sw.FixedPoint(), sw.Newton()], ids=["fixed-point", "newton"])
def test_motion_contact_and_field_close_one_balance(method: sw.FixedPoint | sw.Newton) -> None:
    """A bar thrown at a wall warms up; what motion loses is the work of its thermal stress."""
    model = warm(bar(wall=True, speed=0.1), coupling=0.4, conductivity=0.05)
    steps = list(sw.march(model, until=3.0, step=0.02, method=method))
    assert any(e.kind == "touch" for s in steps for e in s.events) and steps[-1].ledger.momentum[0] < 0.0
    assert max(abs(s.ledger.energy_error) for s in steps) < 1e-13
    last = steps[-1]
    content = (
        CAPACITY * LENGTH / CELLS * np.sum(BarTemperature(model.points).mean @ last.after.fields["temperature"]["bar"])
    )
    pushed = 0.4 * (last.after.displacement["bar"][-1, 0] - last.after.displacement["bar"][0, 0])
    assert content + pushed == pytest.approx(0.0, abs=1e-13), "heat content and entropy of the strain balance"
    assert last.ledger.dissipation > 0.0, "conduction turns energy of the motion into heat"


def test_a_march_goes_on_with_the_same_bits() -> None:
    model = warm(bar(wall=True, speed=0.1), coupling=0.4, conductivity=0.05)
    steps = list(sw.march(model, until=1.0, step=0.02))
    again = list(sw.march(model, until=1.0, step=0.02, state=steps[24].march_state))
    other = list(sw.march(model, until=1.0, step=0.02, state=steps[24].after))
    mine, same, near = (found[-1].after.fields["temperature"]["bar"] for found in (steps, again, other))
    np.testing.assert_array_equal(same, mine)
    np.testing.assert_allclose(near, mine, atol=1e-9)


def test_what_cannot_carry_a_field_refuses() -> None:
    scene = bar(wall=True, speed=0.1)
    with pytest.raises(sw.InputError, match="temperature with Explicit"):
        sw.march(warm(scene), until=1.0, step=0.01, method=sw.Explicit())
    located = replace(scene, contacts=(replace(scene.contacts[0], timing=sw.contact.Energy(located=True)),))
    with pytest.raises(sw.InputError, match="temperature with the located"):
        sw.march(warm(located), until=1.0, step=0.01)
    model = warm(scene)
    with pytest.raises(sw.InputError, match="a second field"):
        with_field(model, BarTemperature(points=model.points))
    with pytest.raises(sw.InputError, match="initial values"):
        with_field(build(scene), BarTemperature(points=model.points[:3]))
    state = next(iter(sw.march(scene, until=0.1, step=0.1))).after
    with pytest.raises(sw.InputError, match="a state with the fields"):
        sw.march(model, until=1.0, step=0.1, state=state)
