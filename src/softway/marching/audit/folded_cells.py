"""Shapes of the cells at the end of a slab (time step): the number of the certificate, and findings on bad cells."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from softway.adaptivity.unrelated.control_volumes import require_cells
from softway.adaptivity.unrelated.memory import require_recast
from softway.arrays import Array, IntArray
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.marching.results.finding import FLAT_CELL, INVERTED, finding
from softway.marching.results.step import Certificate, Event
from softway.marching.state.model_state import ModelState
from softway.meshes.cell_shapes import FLAT, ROUNDING, CellShapes, cell_shapes, flat
from softway.meshes.cells import CELLS
from softway.meshes.remeshed.remesh import SIMPLICES
from softway.model.model import Model

_OTHER_CELLS = {
    2: 'cells "tri3" with dilatation = "corner" and remesh = "auto"',
    3: 'cells "tet4" with dilatation = "corner" and remesh = "auto"',
}
"""Cells that may be replaced, by the dimension of space."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Block:
    """Cells (e, a) of one type of a solid, the number of the first one, and their shapes (e,) at rest."""

    part: DiscreteSolid
    nodes: IntArray
    first: int
    table: CellShapes
    rest: Array

    def shapes(self, state: ModelState) -> Array:
        """Shapes (e,) of the cells in a state."""
        return self.at(state.start.displacement)

    def at(self, u: Array) -> Array:
        """Shapes (e,) of the cells at the displacement ``u`` (n, d)."""
        return self.table.of(self.nodes, self.part.mesh.points, u[self.part.nodes])


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WatchedCells:
    """Cells of the solids of large strain that fill the plane or space, by type."""

    model: Model
    blocks: tuple[_Block, ...]

    def seen(self, certificate: Certificate, after: ModelState) -> Certificate:
        """The certificate with the shape of the worst cell."""
        return replace(certificate, shape=self.least(after.start.displacement)) if self.blocks else certificate

    def least(self, u: Array) -> float:
        """Least shape of all cells at the displacement ``u`` (n, d)."""
        return min(self.model.space.least(block.at(u)) for block in self.blocks)

    def findings(self, certificate: Certificate, before: ModelState, after: ModelState) -> Iterator[Event]:
        """One finding on each solid in which the first cell has folded, or become flat, in a slab."""
        if not self.blocks or certificate.shape > FLAT:
            return
        for part in self.model.parts:
            mine = [block for block in self.blocks if block.part is part]
            if mine and _rank(mine, after) > _rank(mine, before):
                yield _told(self.model, mine, after)


def watched_cells(model: Model) -> WatchedCells:
    """Cells of a model whose shapes are looked at: those of linear bodies cannot fold, their energy is quadratic."""
    blocks = list[_Block]()
    for part in model.parts:
        first = 0
        for cell, nodes in part.mesh.blocks.items():
            if not part.internal.linear and 1 < CELLS[cell].dim == part.mesh.dim:
                table = cell_shapes(cell)
                rest = table.of(nodes, part.mesh.points, np.zeros_like(part.mesh.points))
                blocks.append(_Block(part=part, nodes=nodes, first=first, table=table, rest=rest))
            first += len(nodes)
    return WatchedCells(model=model, blocks=tuple(blocks))


def _rank(blocks: list[_Block], state: ModelState) -> int:
    """Two where a cell of a solid is folded, one where one is flat, zero where all are good."""
    found = [(block.shapes(state), block.rest) for block in blocks]
    if any((now <= ROUNDING).any() for now, _ in found):
        return 2
    return int(any(flat(now, rest).any() for now, rest in found))


def _told(model: Model, blocks: list[_Block], after: ModelState) -> Event:
    """Finding on the worst cell of a solid."""
    shapes = [np.where(flat(now := block.shapes(after), block.rest), now, np.inf) for block in blocks]
    block, now = min(zip(blocks, shapes, strict=True), key=lambda pair: float(pair[1].min()))
    k, part = int(now.argmin()), block.part
    nodes, folded = block.nodes[k], now[k] <= ROUNDING
    what = "has folded" if folded else "has become flat"
    text = (
        f"cell {block.first + k} of '{part.name}', at its node {nodes[0]}, {what}: scaled Jacobian {now[k]:.3g}; "
        f"from here on stresses and forces are wrong there. Remedy: {remedy(model, part)}"
    )
    place = (part.mesh.points[nodes] + after.start.displacement[part.nodes][nodes]).mean(axis=0)
    kind = INVERTED if folded else FLAT_CELL
    return finding(after.time, kind, (part.name,), text, node=int(nodes[0]), place=place)


def remedy(model: Model, part: DiscreteSolid) -> str:
    """What keeps the cells of a solid from folding."""
    solid = model.scene.bodies[part.name]
    simplices = any(tuple(part.mesh.blocks) == (cell,) for cell in SIMPLICES[part.mesh.dim - 2])
    if isinstance(solid, Solid) and solid.remesh is not None:
        return "smaller cells" if simplices else _OTHER_CELLS[part.mesh.dim]
    try:
        require_recast(part)
        require_cells(part.mesh.blocks)
    except InputError as error:
        return f'smaller cells; remesh = "auto" is not for {error.problem}'
    return 'remesh = "auto"' if simplices else _OTHER_CELLS[part.mesh.dim]
