"""Reader of docstrings: the summary of a class and the descriptions of its fields."""

import inspect
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

REFERRED = re.compile(r",\s+see :func:`([\w.]+)\.(\w+)`")
"""Reference in a summary to the function whose parameters are the fields of the class."""


@dataclass(frozen=True, slots=True)
class Described:
    """Parts of a docstring in NumPy style.

    Parameters
    ----------
    summary
        Text before the first heading, without that reference.
    fields
        Description of each parameter by name, including those of the function that the summary refers to.
    sections
        Text of the other sections by heading.
    """

    summary: str
    fields: Mapping[str, str]
    sections: Mapping[str, str]


def described(thing: Any) -> Described:
    """Parse the docstring of a class or a function.

    Examples
    --------
    >>> from softway.bodies.elements.section import Bar
    >>> list(described(Bar).fields)
    ['area']
    >>> from softway.meshes.generators.recipes import Disc
    >>> described(Disc).fields["centre"]
    '[m]; zero by default.'
    """
    lines = (inspect.getdoc(thing) or "").splitlines()
    heads = [k - 1 for k, line in enumerate(lines) if k and line and set(line) == {"-"}]
    ends = [*heads[1:], len(lines)]
    texts = {lines[h].strip(): lines[h + 2 : end] for h, end in zip(heads, ends[: len(heads)], strict=True)}
    summary = "\n".join(lines[: heads[0] if heads else len(lines)]).strip()
    given = {**_referred(summary), **_fields(texts.pop("Parameters", []))}
    return Described(REFERRED.sub("", summary), given, {head: "\n".join(text).strip() for head, text in texts.items()})


def _referred(summary: str) -> Mapping[str, str]:
    """Parameters of the function that a summary refers to."""
    found = REFERRED.search(summary)
    return described(getattr(import_module(found[1]), found[2])).fields if found else {}


def _fields(lines: list[str]) -> dict[str, str]:
    """Parameter names with the indented text below them."""
    found: dict[str, str] = {}
    names: list[str] = []
    for line in lines:
        if line and not line[0].isspace():
            names = [name.strip() for name in line.partition(":")[0].split(",")]
        else:
            found |= {name: f"{found.get(name, '')} {line.strip()}".strip() for name in names}
    return found
