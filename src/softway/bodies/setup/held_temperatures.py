"""Nodes of prescribed temperatures, of which each belongs to one load."""

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from softway.arrays import IntArray
from softway.bodies.setup.heat_loads import HeatLoad, Temperature
from softway.errors import InputError

Held = tuple[Temperature, IntArray]
"""Prescribed temperature, and its nodes."""


def held_temperatures(loads: Mapping[int, HeatLoad], nodes: Mapping[int, IntArray]) -> tuple[Held, ...]:
    """Prescribed temperatures among ``loads`` with those of their ``nodes`` that belong to them, by numbers of loads.

    At nodes at which surfaces meet, such as those of an edge, the load that is declared last holds.

    Raises
    ------
    InputError
        If all nodes of a load are among those of another one with a different temperature.

    Examples
    --------
    >>> left, bottom = Temperature(on="b.left", value=300.0), Temperature(on="b.bottom", value=400.0)
    >>> held = held_temperatures({0: left, 1: bottom}, {0: np.array([0, 2]), 1: np.array([0, 1])})
    >>> [nodes.tolist() for _, nodes in held]
    [[2], [0, 1]]
    """
    found = [(k, load) for k, load in loads.items() if isinstance(load, Temperature)]
    for (one, first), (other, second) in combinations(found, 2):
        common = len(np.intersect1d(nodes[one], nodes[other]))
        differ = (first.value, first.ramp) != (second.value, second.ramp)
        if differ and common and common == min(len(nodes[one]), len(nodes[other])):
            problem = f"{_told(second)} of {second.on!r}, but {_told(first)} of {first.on!r} in loads[{one}]"
            remedy = "one temperature for each surface; surfaces that meet in an edge may have two"
            raise InputError(f"loads[{other}].on", f"{problem}: two temperatures of the same nodes", remedy)
    return tuple(_owned(found, nodes))


def _owned(found: list[tuple[int, Temperature]], nodes: Mapping[int, IntArray]) -> Iterator[Held]:
    """Loads with the nodes that no later load has."""
    for place, (k, load) in enumerate(found):
        later = [nodes[number] for number, _ in found[place + 1 :]]
        yield load, np.setdiff1d(nodes[k], np.concatenate(later)) if later else np.unique(nodes[k])


def _told(load: Temperature) -> str:
    """Temperatures of a load [K]."""
    values = sorted({load.value * factor for factor in load.ramp.factors})
    return f"{values[0]:g} K" if len(values) == 1 else f"{values[0]:g} to {values[-1]:g} K"
