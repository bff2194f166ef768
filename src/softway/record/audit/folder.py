"""Audit of a stored run."""

from collections.abc import Iterator

from softway.record.audit.auditor import Auditor, Depths
from softway.record.audit.geometry.solids import solids
from softway.record.read.frames import Cells, Fields


def auditor_of(cells: Cells) -> Auditor:
    """Auditor of the bodies and tools of a run folder."""
    blocks = cells.blocks()
    bodies = {name: cells.body[cells.numbers(name)] for name in blocks}
    reference = cells.reference[:, : cells.dimension]
    return Auditor(solids=solids(cells.bodies, reference, blocks, bodies), tools=cells.tools)


def frames_audited(fields: Fields) -> Iterator[Depths]:
    """Depths and findings of each stored frame after the first."""
    cells = fields.cells
    auditor = auditor_of(cells)
    for k in range(1, len(fields)):
        frame = fields[k]
        yield auditor.look(frame.time, frame.points[:, : cells.dimension])
