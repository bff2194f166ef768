"""The scenario that processes and one process run."""

from collections.abc import Callable
from pathlib import Path

import pytest

SCENE = """
[bodies.block]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1.0, 1.0], cells = [4, 4] }
material = { kind = "NeoHookean", E = 100.0, nu = 0.3 }
density = 1.0
velocity = { kind = "Uniform", value = [0.0, -1.0] }
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0.0, -0.05], normal = [0.1, 1.0] }
[[contacts]]
between = ["block.bottom", "floor"]
[time]
end = 0.2
step = 0.01
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Scenario of a block thrown at a wall."""
    out = tmp_path / "block.toml"
    out.write_text(SCENE)
    return out


ROUGH = """
[bodies.block]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1.0, 0.6], cells = [4, 3], origin = [0.1, 0.62] }
material = { kind = "J2", E = 1e4, nu = 0.3, yield_stress = 40.0 }
density = 1.0
velocity = { kind = "Uniform", value = [0.5, -5.0] }
[bodies.bed]
kind = "Solid"
mesh = { kind = "Rectangle", size = [1.3, 0.6], cells = [5, 3] }
material = { kind = "NeoHookean", E = 2e4, nu = 0.3 }
density = 1.0
[bodies.floor]
kind = "Tool"
shape = { kind = "HalfSpace", point = [0.0, -0.01], normal = [0.05, 1.0] }
[[contacts]]
between = ["block.bottom", "bed.top"]
friction = { kind = "Coulomb", mu = 0.2 }
[[contacts]]
between = ["bed.bottom", "floor"]
friction = { kind = "Coulomb", mu = 0.3 }
[time]
end = 0.007
step = 5e-4
[output]
checkpoints = { every = 0.0 }
"""


HEAT = "thermal = { temperature = %g, law = { kind = 'Conduction', conductivity = 50.0, capacity = 5.0 } }"
HOT = (
    ROUGH.replace("velocity = ", f"{HEAT % 500.0}\nvelocity = ")
    .replace("[bodies.floor]", f"{HEAT % 300.0}\n[bodies.floor]")
    .replace("mu = 0.2 }", "mu = 0.2 }\nheat = { conductance = 100.0 }")
    + """[[loads]]
kind = "Convection"
on = "block.top"
coefficient = 30.0
ambient = 290.0
[[loads]]
kind = "Temperature"
on = "bed.left"
value = 310.0
"""
)


@pytest.fixture
def hot(tmp_path: Path) -> Path:
    """Scenario of the rough one with temperatures: a film, a prescribed temperature, and heat across the contact."""
    out = tmp_path / "hot.toml"
    out.write_text(HOT)
    return out


@pytest.fixture
def rough(tmp_path: Path) -> Path:
    """Scenario of a plastic block thrown at a bed, both with friction."""
    out = tmp_path / "rough.toml"
    out.write_text(ROUGH)
    return out


@pytest.fixture(scope="session")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, Callable[[Path], object]], Path]:
    """Folder of a name, made once by the first test that asks for it."""
    found: dict[str, Path] = {}

    def folder(name: str, make: Callable[[Path], object]) -> Path:
        if name not in found:
            out = tmp_path_factory.mktemp("kept") / name
            make(out)
            found[name] = out
        return found[name]

    return folder
