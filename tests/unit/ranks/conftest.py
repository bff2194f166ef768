"""The scenario that processes and one process run."""

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
