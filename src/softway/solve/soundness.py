"""Whether an iterate on kept faces leaves no overlap with others."""

import numpy as np

from softway.solve.system import SlabSystem
from softway.typing import Array

NEARLY = 1e-7
"""Relative change of velocity below which kept faces are compared with the surface."""


def looked_at(system: SlabSystem, q: Array, change: float) -> tuple[bool, SlabSystem]:
    """Whether an iterate leaves no overlap, and the equations to go on with: overlapped faces are added."""
    if system.pairs is system.searched:
        return True, system
    if change > NEARLY * np.abs(q).max(initial=0.0):
        return False, system
    u1 = system.path.end(q)
    sound = system.sound(u1)
    return sound, system if sound else system.completed(u1)
