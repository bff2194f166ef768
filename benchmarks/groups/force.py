"""The contact force of a run, and how far it is from another: means over windows of time.

The mean force over a window is what the momentum of the cube along z changes by in it, over its length.  That is the
force that the cube feels, whatever a code calls its contact force; the force at an instant is none of a penalty that
chatters, nor of a shock on a mesh.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from softway.arrays import Array

WINDOW, WIDE = 5e-4, 2e-3
"""A step of the peers' problem, and four of them [s]: a wave of pressure goes through half a cell at 3k, and two."""
SPEED = 5.0
LEAST = 1.0
"""Force below which there is no contact [N]."""


def means(time: Sequence[float], momentum: Sequence[float], window: float, end: float) -> Array:
    """Mean contact forces (n,) over windows from 0 to ``end`` [N]."""
    edges = window * np.arange(round(end / window) + 1)
    return np.diff(np.interp(edges, [0.0, *time], [-SPEED, *momentum])) / window


def apart(run: dict[str, Any], reference: dict[str, Any], window: float = WINDOW) -> float:
    """Root mean square of the difference of two forces in contact, over that of the reference [%]."""
    end = min(run["time"][-1], reference["time"][-1])
    ours, theirs = (means(r["time"], r["momentum"], window, end) for r in (run, reference))
    contact = theirs > LEAST
    return float(100.0 * np.linalg.norm((ours - theirs)[contact]) / np.linalg.norm(theirs[contact]))
