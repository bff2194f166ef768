"""From declared contacts to methods: which side is the slave, and what has rows of its own."""

import numpy as np
import pytest

import softway as sw

NODES, MORTAR = sw.contact.NodeToSurface(), sw.contact.DualMortar()


def stacked(cells: tuple[int, int], height: float, method: object, angle: float = 0.0, first: str = "low") -> sw.Scene:
    """A square block over another one, so many cells to a side each; the upper one may be turned."""
    place = sw.bodies.Placement(
        rotations=(sw.bodies.Rotation(angle=angle),) if angle else (), translation=(0.93, 0.0), bottom=2.0 + height
    )
    low, high = (
        sw.Solid(
            mesh=sw.meshes.Rectangle(size=(size, size), cells=(n, n)), material=sw.LinearElastic(E=1.0), density=1.0,
            place=where,
        )
        for size, n, where in ((2.0, cells[0], sw.bodies.Placement()), (1.0, cells[1], place))
    )  # fmt: skip
    between = ("low", "high") if first == "low" else ("high", "low")
    return sw.Scene(bodies={"low": low, "high": high}, contacts=(sw.Contact(between=between, name="c", method=method),))


@pytest.mark.parametrize("first", ["low", "high"])
@pytest.mark.parametrize("method", [NODES, MORTAR], ids=repr)
@pytest.mark.parametrize("fine", ["low", "high"])
def test_the_finer_surface_is_the_slave_whichever_comes_first(fine: str, method: object, first: str) -> None:
    """Edges of 0.2 against 0.25; every node of the finer side has rows, of the other one its four sharp corners."""
    model = sw.build(stacked((10, 4) if fine == "low" else (8, 5), 0.1, method, first=first))
    parts = {p.name: p for p in model.parts}
    nodes = {name: np.unique(p.mesh.nodes("surface")) + p.nodes.start for name, p in parts.items()}
    coarse = nodes["high" if fine == "low" else "low"]
    assert set(nodes[fine]) <= set(model.contacts.node)
    assert len(set(coarse) & set(model.contacts.node)) == 4


@pytest.mark.parametrize("method", [NODES, MORTAR], ids=repr)
@pytest.mark.parametrize("cells", [(20, 3), (8, 8)], ids=["coarse on fine", "fine on coarse"])
def test_a_corner_that_points_at_a_face_is_not_overlooked(cells: tuple[int, int], method: object) -> None:
    """A block stands on its corner over the middle of a face, where mean gaps would be far greater."""
    height = 1e-3
    model = sw.build(stacked(cells, height, method, angle=0.25 * np.pi))
    rows = model.rows(model.displacement)
    gap = rows.gap(model.displacement)
    assert gap[rows.near].min() == pytest.approx(height, abs=1e-12)
    nearest = np.argmin(gap)
    part = next(p for p in model.parts if p.name == "high")
    tip = part.nodes.start + np.argmin(model.points[part.nodes, 1])
    assert rows.node[nearest] == tip
