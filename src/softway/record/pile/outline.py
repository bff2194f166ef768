"""pile.json: groups, radii and walls of a pile, for pictures."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from softway.piles.pile import Pile

FILE = "pile.json"
ENTRIES: Mapping[str, type] = MappingProxyType({"dim": int, "groups": dict, "radii": list, "walls": list})
"""Entries of every file, and their types."""


def outline(pile: Pile, groups: Mapping[str, int]) -> dict[str, Any]:
    """Parts of a pile as plain data; ``groups`` are the numbers of balls by name, in their order.

    Examples
    --------
    >>> from softway.piles import Balls
    >>> outline(Pile(balls=Balls(centres=[[0.0, 0.0]], radius=0.1, density=1.0)), {"one": 1})
    {'dim': 2, 'groups': {'one': 1}, 'radii': [0.1], 'walls': []}
    """
    walls = [
        {"point": [float(x) for x in wall.point], "normal": [float(x) for x in wall.normal]} for wall in pile.walls
    ]
    return {"dim": pile.balls.dim, "groups": dict(groups), "radii": pile.balls.radii.tolist(), "walls": walls}


def sound(parts: Mapping[str, Any]) -> bool:
    """True if what a file says has the form that :func:`outline` writes.

    Examples
    --------
    >>> sound({"dim": 2, "groups": {"a": 1}, "radii": [0.1], "walls": []}), sound({"dim": 2, "groups": {"a": 2},
    ...                                                                           "radii": [0.1], "walls": []})
    (True, False)
    """
    try:
        dim, counts = parts["dim"], list(parts["groups"].values())
        radii, vectors = (
            np.array(parts["radii"], float),
            [w[key] for w in parts["walls"] for key in ("point", "normal")],
        )
        known = dim in (2, 3) and all(isinstance(count, int) and count > 0 for count in counts)
        known = known and 0 < sum(counts) == len(radii) and bool(np.isfinite(radii).all()) and radii.min() > 0.0
        known = known and all(len(vector) == dim and bool(np.isfinite(vector).all()) for vector in vectors)
        return bool(known and all(np.any(wall["normal"]) for wall in parts["walls"]))
    except (TypeError, ValueError, KeyError, AttributeError):
        return False
