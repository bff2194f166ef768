"""Runs for the page: a computed one of a falling square, and one of a bar."""

from collections.abc import Callable

import pytest

import softway as sw


def scenario(mesh: object, down: object) -> sw.Scenario:
    """A body that falls on a floor at a tenth of its wave speed."""
    d = 1 if isinstance(mesh, sw.meshes.Interval) else 2
    body = sw.Solid(
        mesh=mesh, material=sw.LinearElastic(E=1.0), density=1.0, velocity=sw.bodies.Uniform(value=down),
    )  # fmt: skip
    up = 1.0 if d == 1 else (0.0, 1.0)
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=-0.1 if d == 1 else (0.0, -0.1), normal=up))
    contact = sw.Contact(between=("body.left" if d == 1 else "body.bottom", "floor"))
    return sw.Scenario(
        bodies={"body": body, "floor": floor}, contacts=(contact,), time=sw.Time(end=4.0, step=0.1), title="A fall",
        output=sw.Output(fields_every=0.4),
    )  # fmt: skip


@pytest.fixture(scope="package")
def square(tmp_path_factory: pytest.TempPathFactory) -> sw.Run:
    """A square, eleven frames."""
    made = scenario(sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3)), (0.0, -0.1))
    return sw.run(made, tmp_path_factory.mktemp("page") / "square")


@pytest.fixture(scope="package")
def bar(tmp_path_factory: pytest.TempPathFactory) -> sw.Run:
    """A bar."""
    return sw.run(scenario(sw.meshes.Interval(length=1.0, cells=5), -0.1), tmp_path_factory.mktemp("page") / "bar")


@pytest.fixture(scope="package")
def fall() -> Callable[..., sw.Scenario]:
    """Maker of scenarios of a fall."""
    return scenario
