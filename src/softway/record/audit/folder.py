"""Audit of a stored run."""

from collections.abc import Iterator

from softway.record.audit.auditor import Depths, auditor
from softway.record.read.frames import Fields


def frames_audited(fields: Fields) -> Iterator[Depths]:
    """Depths and findings of each stored frame after the first."""
    cells = fields.cells
    judge = auditor(cells, cells.tools)
    for k in range(1, len(fields)):
        frame = fields[k]
        yield judge.look(frame.time, frame.points[:, : cells.dimension])
