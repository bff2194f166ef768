"""Piles of balls: the time of a slab, and how it grows with their number."""

from collections.abc import Iterator

import numpy as np
from processes.apart import alone
from record.figures import Figure

from groups.asked import Asked

COUNTS = ((5, 5, 10), (5, 10, 10), (10, 10, 10), (10, 20, 10), (20, 20, 10))
"""Spheres along the sides of the box."""
SMALL = ((2, 2, 4), (2, 4, 4))
NAMED = 1000
"""Number of spheres whose slab has a target."""


def pile(asked: Asked) -> Iterator[Figure]:
    """Spheres with friction .3 fall into a box, ten layers high: processor time of a slab of 1 ms, the mean of 1 s."""
    counts = SMALL if asked.smoke else asked.pick(COUNTS[:3], COUNTS)
    costs = [alone("pile", count=list(count), until=0.3 if asked.smoke else 1.0)["result"] for count in counts]
    for cost in costs:
        name, target = f"pile/{cost['balls']} spheres", "<= 15" if cost["balls"] == NAMED else "lower"
        yield Figure(name=f"{name}, slab", value=cost["slab"], unit="ms", target=target)
        yield Figure(name=f"{name}, sweeps", value=cost["sweeps"], unit="a slab")
        yield Figure(name=f"{name}, overlap", value=cost["overlap"], unit="of the radius", target="<= 1e-10")
        yield Figure(name=f"{name}, friction off its law", value=cost["slip"], unit="m/s")
        yield Figure(name=f"{name}, energy", value=cost["energy"], unit="of that at the start", target="<= 1e-10")
    numbers, times = (np.log([cost[key] for cost in costs]) for key in ("balls", "slab"))
    yield Figure(name="pile/exponent", value=float(np.polyfit(numbers, times, 1)[0]), target="<= 1.15")
