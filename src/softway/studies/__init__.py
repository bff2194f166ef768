"""Studies of several runs: sweeps over parameters and comparisons of methods."""

from softway.studies.sweep import Sweep as Sweep
from softway.studies.sweep import sweep as sweep

__all__ = [
    "Sweep",
    "sweep",
]
