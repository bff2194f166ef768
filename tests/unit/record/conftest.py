"""Steps made by hand: a body falls on a floor, is squeezed, and leaves; nothing is computed."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact
from softway.laws.bulk.linear_elastic import LinearElastic
from softway.marching.results.step import Certificate, ContactLedger, Event, Ledger, Report, Step
from softway.marching.results.step_states import KnownStates
from softway.meshes.generators import shapes
from softway.meshes.mesh import Mesh
from softway.model.scene import Scene, State
from softway.model.slab import Slab
from softway.obstacles.half_space import HalfSpace
from softway.record.write.probes import readings
from softway.record.write.recorder import RunStart

LABEL = "part.surface-floor"


@dataclass(frozen=True)
class FakeProbe:
    """A probe as the scenario declares it."""

    name: str
    of: str = "part"
    tag: str | None = None
    at: tuple[float, ...] | None = None
    quantity: str = "displacement"
    component: str = "x"


@dataclass(frozen=True)
class Fake:
    """A made-up run of ``slabs`` slabs over one second; contact lasts from 0.4 to 0.6 s."""

    mesh: Mesh
    slabs: int = 20
    probes: tuple[FakeProbe, ...] = ()

    @property
    def scene(self) -> Scene:
        zero, up = (0.0,) * self.mesh.dim, (0.0,) * (self.mesh.dim - 1) + (1.0,)
        part = Solid(mesh=self.mesh, material=LinearElastic(E=1e6), density=1000.0)
        floor = Tool(shape=HalfSpace(point=zero, normal=up))
        return Scene(bodies={"part": part, "floor": floor}, contacts=(Contact(between=("part.surface", "floor")),))

    def state(self, time: float) -> State:
        x, nodes = self.mesh.points, self.mesh.nodes("surface")
        u, v = np.zeros_like(x), np.zeros_like(x)
        squeeze = max(0.0, 0.01 - (time - 0.5) ** 2)
        u[:, -1] = max(0.0, abs(time - 0.5) - 0.1) - 5.0 * squeeze * x[:, -1]
        v[:, -1] = np.sign(time - 0.5)
        closed = (x[nodes, -1] < 1e-12) & (squeeze > 0.0)
        return State(
            time=time, displacement={"part": u}, velocity={"part": v}, acceleration={"part": 0.0 * v},
            closed={LABEL: closed}, pressure={LABEL: 100.0 * squeeze * closed},
        )  # fmt: skip

    def ledger(self, state: State) -> Ledger:
        force = float(state.pressure[LABEL].sum())
        gap = float((self.mesh.points + state.displacement["part"])[:, -1].min())
        contact = ContactLedger(
            force_n=force, force_t=0.0, min_gap=gap - 1e-15, power_residual=1e-16, count=int(state.closed[LABEL].sum())
        )
        return Ledger(
            energy_kinetic=1.0 / 3.0, energy_strain=force**2, work_external=0.0, dissipation=0.0,
            energy_error=-1e-12, momentum=np.array([0.0, 0.0, 2.0]), spin=np.array([0.0, 3.0, 0.0]),
            contacts={LABEL: contact},
        )  # fmt: skip

    def opening(self) -> RunStart:
        start, meshes = self.state(0.0), {"part": self.mesh}
        return RunStart(
            scene=self.scene, meshes=meshes, stresses={"part": self.stress}, initial=start, ledger=self.ledger(start),
            touching={LABEL: self.mesh.nodes("surface")}, until=1.0, fields_every=0.1,
            readings=readings(self.probes, meshes),
        )  # fmt: skip

    def stress(self, state: State) -> np.ndarray:
        out = np.zeros((self.mesh.n_cells, 3, 3))
        out[:, 0, 0], out[:, 0, 1], out[:, 1, 0] = 1e6 * np.ptp(state.displacement["part"]), 2.0, 2.0
        return out

    def steps(self) -> Iterator[Step]:
        times = np.linspace(0.0, 1.0, self.slabs + 1)
        return (self.step(float(a), float(b)) for a, b in zip(times[:-1], times[1:], strict=True))

    def step(self, begin: float, end: float) -> Step:
        before, after = self.state(begin), self.state(end)
        events = tuple(
            Event(
                time=t, contact=LABEL, kind=kind, node=0, position=self.mesh.points[0], velocity_before=-1.0,
                velocity_after=0.0, impulse=0.25,
            )
            for t, kind in ((0.4, "touch"), (0.6, "release"))
            if begin < t <= end
        )  # fmt: skip
        certificate = Certificate(
            min_gap=0.5, min_force=1.5, complementarity=2.5, power_residual=3.5, momentum_error=4.5, energy_error=5.5
        )
        return Step(
            model=None, certificate=certificate, slab=Slab(start=begin, end=end),
            ledger=self.ledger(after), events=events,
            report=Report(iterations=3, pairs=4, factorisations=1, passes=1),
            states=KnownStates(
                before=before, after=after, reactions={"part": np.ones_like(self.mesh.points)}, march_state=None
            ),
        )  # fmt: skip


MESHES: dict[str, Callable[[], Mesh]] = {
    "bar2": lambda: shapes.interval(1.0, 4),
    "bar3": lambda: shapes.interval(1.0, 4, cell="bar3", direction=(0.0, 1.0), dim=2),
    "tri6": lambda: shapes.rectangle((1.0, 1.0), (2, 2), cell="tri6"),
    "quad8": lambda: shapes.rectangle((1.0, 1.0), (2, 2), cell="quad8"),
    "quad9": lambda: shapes.rectangle((1.0, 1.0), (2, 2), cell="quad9"),
    "tet10": lambda: shapes.box((1.0, 1.0, 1.0), (2, 2, 2), cell="tet10"),
    "hex20": lambda: shapes.box((1.0, 1.0, 1.0), (2, 2, 2), cell="hex20"),
    "hex27": lambda: shapes.box((1.0, 1.0, 1.0), (2, 2, 2), cell="hex27"),
}


@pytest.fixture(params=MESHES)
def fake(request: pytest.FixtureRequest) -> Fake:
    """A made-up run with each kind of cell."""
    return Fake(MESHES[request.param]())


@pytest.fixture
def bar() -> Fake:
    """A made-up run of a bar, with probes."""
    return Fake(
        MESHES["bar2"](),
        probes=(
            FakeProbe("tip", tag="right"),
            FakeProbe("middle", at=(0.45,), quantity="position"),
            FakeProbe("speed", tag="all", quantity="velocity", component="norm"),
            FakeProbe("support", tag="all", quantity="reaction"),
        ),
    )


@pytest.fixture
def probe() -> type[FakeProbe]:
    """Maker of probe declarations."""
    return FakeProbe


@pytest.fixture
def square() -> Fake:
    """A made-up run of a square."""
    return Fake(MESHES["quad9"]())
