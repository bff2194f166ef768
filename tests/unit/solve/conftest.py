"""Small scenes for the solvers."""

from collections.abc import Callable

import pytest

from softway.bodies.setup.initial_fields import Uniform
from softway.bodies.solid import Fixed, Solid, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, ImpactRule
from softway.laws.bulk import LinearElastic, NeoHookean
from softway.meshes.generators.shapes import interval, rectangle
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.obstacles.half_space import HalfSpace

NEO = NeoHookean(E=1.0, nu=0.3)
ENERGY = Energy()
FLOOR = Tool(shape=HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))


@pytest.fixture
def bar() -> Callable[..., Model]:
    """A bar of unit data along x, by default free, with a wall at ``wall`` before its right end."""

    def make(
        cells: int = 4, wall: float | None = None, timing: ImpactRule = ENERGY, held: str = "", **changes
    ) -> Model:
        solid = {
            "mesh": interval(1.0, cells), "material": LinearElastic(E=1.0), "density": 1.0,
            "supports": (Fixed(on=held),) if held else (), **changes,
        }  # fmt: skip
        bodies: dict[str, Solid | Tool] = {"bar": Solid(**solid)}
        contacts: tuple[Contact, ...] = ()
        if wall is not None:
            bodies["wall"] = Tool(shape=HalfSpace(point=wall, normal=-1.0))
            contacts = (Contact(between=("bar.right", "wall"), timing=timing),)
        return build(Scene(bodies=bodies, contacts=contacts))

    return make


@pytest.fixture
def block() -> Callable[..., Model]:
    """A square of side one, its bottom above the floor, by default y = 0."""

    def make(
        cells: int = 3, timing: ImpactRule = ENERGY, tag: str = "bottom", floor: Tool = FLOOR, **changes
    ) -> Model:  # fmt: skip
        solid = {
            "mesh": rectangle((1.0, 1.0), (cells, cells)), "material": NEO, "density": 1.0,
            "velocity": Uniform(value=(0.0, -0.1)), **changes,
        }  # fmt: skip
        contact = Contact(between=(f"block.{tag}", "floor"), timing=timing)
        return build(Scene(bodies={"block": Solid(**solid), "floor": floor}, contacts=(contact,)))

    return make
