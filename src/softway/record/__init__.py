"""Recording of runs: writers that take the accepted time steps, and readers of the files that they write."""

from softway.record.run import Run as Run
from softway.record.storage.checkpoint import Checkpoints as Checkpoints
from softway.record.write.progress import Progress as Progress

__all__ = [
    "Checkpoints",
    "Progress",
    "Run",
]
