"""Small bodies that fly, fall and bounce, and what must hold of every march."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pytest

from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.setup.loads import Load
from softway.bodies.setup.placement import Placement, Rotation
from softway.bodies.solid import Solid, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.marching.march import march
from softway.marching.results.step import Event, Step
from softway.meshes.generators.shapes import box, interval, rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import AsGiven, Scene, StaticStart
from softway.obstacles.half_space import HalfSpace

ENERGY, AS_GIVEN = Energy(), AsGiven()
NEO, LINEAR = NeoHookean(E=1.0, nu=0.3), LinearElastic(E=1.0, nu=0.3)


@dataclass(frozen=True)
class Motion:
    """A march that was carried out."""

    model: Model
    steps: list[Step]

    @property
    def last(self) -> Step:
        return self.steps[-1]

    @property
    def start_energy(self) -> float:
        before = self.steps[0].before
        strain = self.model.energy_and_force(self.model.join(before.displacement))[0].sum()
        return float(self.model.kinetic(self.model.join(before.velocity)).sum() + strain)

    @property
    def energy_scale(self) -> float:
        """Greatest energy of the march."""
        ledgers = [s.ledger for s in self.steps]
        return max(self.start_energy, *(x.energy_kinetic + x.energy_strain + abs(x.work_external) for x in ledgers))

    @property
    def energy_error(self) -> float:
        """Greatest error of the energy balance, relative to the greatest energy."""
        return max(abs(s.ledger.energy_error) for s in self.steps) / self.energy_scale

    @property
    def least_gap(self) -> float:
        return min(c.min_gap for s in self.steps for c in s.ledger.contacts.values())

    @property
    def events(self) -> list[Event]:
        return [e for s in self.steps for e in s.events]

    @property
    def impulse(self) -> float:
        """Impulse of all contacts [N s]."""
        return sum(s.slab.span * c.force_n for s in self.steps for c in s.ledger.contacts.values())

    @property
    def momentum_error(self) -> float:
        """Greatest error of d(momentum)/dt = loads + supports + contacts, relative to the greatest of the forces.

        The least that counts as force is the one that gives the body its speed over the whole march.
        """
        speed = max(float(np.abs(v).max()) for s in self.steps for v in s.before.velocity.values())
        worst, size = 0.0, float(self.model.mass.sum()) * speed / self.last.slab.end
        rows = self.model.rows(self.model.displacement)
        for s in self.steps:
            v0, v1 = (self.model.join(x.velocity) for x in (s.before, s.after))
            change = (self.model.mass @ (v1 - v0)).sum(axis=0) / s.slab.span
            forces = [self.model.load.sum(axis=0), *(r.sum(axis=0) for r in s.reactions.values())]
            for k, contact in enumerate(s.ledger.contacts.values()):
                forces.append(contact.force_n * rows.normal[rows.of_contact(k)][0])
            worst = max(worst, float(np.abs(change - np.sum(forces, axis=0)).max()))
            size = max(size, float(np.abs(forces).max()), float(np.abs(change).max()))
        return worst / size

    def history(self, name: str) -> np.ndarray:
        """Velocity (steps, n, d) of a body."""
        return np.array([s.after.velocity[name] for s in self.steps])


def distance(a: Motion, b: Motion) -> float:
    """Greatest difference of displacements and velocities at the end."""
    x, y = a.last.after, b.last.after
    return max(
        float(np.abs(x.displacement[n] - y.displacement[n]).max() + np.abs(x.velocity[n] - y.velocity[n]).max())
        for n in x.velocity
    )


def move(
    solid: Solid, tools: Mapping[str, Tool] | None = None, *, timing: ImpactRule = ENERGY,
    tag: str | Mapping[str, str] = "bottom", loads: tuple[Load, ...] = (), start: AsGiven | StaticStart = AS_GIVEN,
    until: float = 2.0, step: float = 0.05, **options: object,
) -> Motion:  # fmt: skip
    """March of one body, named ``body``, that may touch every tool with the nodes of a tag, or of one tag for each."""
    tools = tools or {}
    tags = {name: tag if isinstance(tag, str) else tag[name] for name in tools}
    contacts = tuple(Contact(between=(f"body.{tags[name]}", name), timing=timing) for name in tools)
    model = build(Scene(bodies={"body": solid, **tools}, contacts=contacts, loads=loads, start=start))
    return Motion(model, list(march(model, until=until, step=step, **options)))


def plane(point: float | tuple[float, ...], normal: float | tuple[float, ...]) -> Tool:
    return Tool(shape=HalfSpace(point=point, normal=normal))


def bar(cells: int = 4, v: float = 1.0, **changes: object) -> Solid:
    """A bar of unit data from 0 to 1, with velocity v."""
    return Solid(**{
        "mesh": interval(1.0, cells), "material": LinearElastic(E=1.0), "density": 1.0,
        "velocity": Uniform(value=v), **changes,
    })  # fmt: skip


def block(
    v: tuple[float, float] = (0.0, -0.1), *, cells: int = 3, cell: str = "quad4", height: float = 0.02,
    angle: float = 0.0, **changes: object,
) -> Solid:  # fmt: skip
    """A square of side one, turned, its lowest point at a height."""
    turns = (Rotation(angle=angle),) if angle else ()
    return Solid(**{
        "mesh": rectangle((1.0, 1.0), (cells, cells), cell=cell), "material": NEO, "density": 1.0,
        "velocity": Uniform(value=v), "place": Placement(rotations=turns, bottom=height), **changes,
    })  # fmt: skip


def cube(v: tuple[float, float, float], *, cells: tuple[int, int, int] = (2, 2, 3), cell: str = "hex8",
         height: float = 0.01, angle: float = 0.0, **changes: object) -> Solid:  # fmt: skip
    """A cube of side one, turned about (1, 1, 0), its lowest point at a height."""
    turns = (Rotation(angle=angle, axis=(1.0, 1.0, 0.0)),) if angle else ()
    return Solid(**{
        "mesh": box((1.0, 1.0, 1.0), cells, cell=cell), "material": NEO, "density": 1.0,
        "velocity": Uniform(value=v), "place": Placement(rotations=turns, bottom=height), **changes,
    })  # fmt: skip


@dataclass(frozen=True)
class Workshop:
    """What the tests of a march are made of."""

    move: Callable[..., Motion] = staticmethod(move)
    distance: Callable[[Motion, Motion], float] = staticmethod(distance)
    plane: Callable[..., Tool] = staticmethod(plane)
    bar: Callable[..., Solid] = staticmethod(bar)
    block: Callable[..., Solid] = staticmethod(block)
    cube: Callable[..., Solid] = staticmethod(cube)
    neo: NeoHookean = NEO
    linear: LinearElastic = LINEAR

    @property
    def floor(self) -> dict[str, Tool]:
        return {"floor": plane((0.0, 0.0), (0.0, 1.0))}

    @property
    def ground(self) -> dict[str, Tool]:
        return {"floor": plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))}


@pytest.fixture(scope="session")
def shop() -> Workshop:
    return Workshop()
