"""Templates of scenarios for a first start."""

from collections.abc import Mapping
from importlib import resources


def templates() -> Mapping[str, str]:
    """TOML texts of the templates by name: a bar on a wall, a block on a floor, a part from a mesh file, a mechanism.

    Examples
    --------
    >>> list(templates())
    ['bar', 'block', 'part', 'mechanism']
    """
    folder = resources.files("softway.scenario.text") / "templates"
    names = ("bar", "block", "part", "mechanism")
    return {name: (folder / f"{name}.toml").read_text(encoding="utf-8") for name in names}


def headline(text: str) -> str:
    r"""First comment of a template, or its title.

    Examples
    --------
    >>> headline("# A bar bounces.\n[bodies.bar]\n")
    'A bar bounces.'
    """
    first = next((line for line in text.splitlines() if line.startswith(("#", "title"))), "")
    return first.lstrip("# ").removeprefix("title").strip(' ="')
