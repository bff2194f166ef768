"""Templates of scenarios for a first start."""

from collections.abc import Mapping
from importlib import resources


def templates() -> Mapping[str, str]:
    """TOML texts of the templates by name: a bar on a wall, a block on a floor, a part from a mesh file.

    Examples
    --------
    >>> list(templates())
    ['bar', 'block', 'part']
    """
    folder = resources.files("softway.scenario.text") / "templates"
    return {name: (folder / f"{name}.toml").read_text(encoding="utf-8") for name in ("bar", "block", "part")}
