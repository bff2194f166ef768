"""fields.vtkhdf: deformed solids with their fields at a series of instants, in the format of grid_series.py."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from softway.arrays import Array
from softway.bodies.solid import Tool
from softway.marching.results.step import Step
from softway.marching.slab.step_group import StepGroup
from softway.model.scene import Scene, State
from softway.record.write.grid.grid_layout import Layout, components, layout, von_mises
from softway.record.write.grid.grid_series import GridFrame, GridSeries, continue_series, create_series
from softway.record.write.recorder import RunStart
from softway.record.write.shapes.tool_shapes import stored

FILE = "fields.vtkhdf"
POINT_DATA = {"displacement": "m", "velocity": "m/s", "contact_force": "N"}
CELL_DATA = {"stress": "Pa", "von_mises": "Pa"}
"""Names and units of the fields in every frame."""
MORE = {"contact_pressure": "Pa", "tangential_traction": "Pa", "dissipation": "J/m^3", "heat_flux": "W/m^2"}
"""Units of the further fields of a run with contact, friction or a history-dependent law; other fields have none."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Frames:
    """Open file ``fields.vtkhdf``; a frame is written when the time passes a multiple of ``fields_every``, and at the
    end.

    ``layout`` holds the solids of ``opening``; frames on other meshes have their own.
    """

    series: GridSeries
    layout: Layout
    opening: RunStart

    def take(self, step: Step) -> None:
        """Write a frame if one is due at the end of the slab."""
        if not self.opening.frame_due(step.slab.start, step.slab.end):
            return
        now = self.opening.of(step)
        cells = self.layout if now is self.opening else layout(now.meshes, now.touching)
        self.series.write(_frame(cells, now, step.after), cells)

    def take_group(self, group: StepGroup) -> None:
        """Nothing: no frame is due at the ends of these slabs."""

    @property
    def mark(self) -> int:
        """Number of frames."""
        return self.series.mark

    def sync(self) -> None:
        """Flush the frames to the disk."""
        self.series.sync()

    def close(self) -> None:
        """Close the file and remove an incomplete frame."""
        self.series.close()


def open_fields(folder: Path, opening: RunStart, mark: int | None = None) -> Frames:
    """Create ``fields.vtkhdf`` with the cells and the frame of the initial state, or continue it after ``mark`` frames.

    Raises
    ------
    InputError
        If the file has fewer frames.
    """
    path, cells = folder / FILE, layout(opening.meshes, opening.touching)
    if mark is not None:
        return Frames(series=continue_series(path, mark), layout=cells, opening=opening)
    units = {**MORE, **POINT_DATA, **CELL_DATA, **{f.name: f.unit for f in opening.fields}}
    shapes = _shapes(opening.scene, cells)
    series = create_series(path, cells, _frame(cells, opening, opening.initial), units, shapes, opening.adapts)
    return Frames(series=series, layout=cells, opening=opening)


def _shapes(scene: Scene, cells: Layout) -> dict[str, dict[str, Any]]:
    """Shapes of tools and of rigid bodies as plain data."""
    points = cells.reference[:, : cells.dimension]
    tools = {name: stored(body, points) for name, body in scene.bodies.items() if isinstance(body, Tool)}
    rigid = {} if scene.mechanism is None else scene.mechanism.bodies
    shapes = {name: stored(Tool(shape=body.shape), points) for name, body in rigid.items() if body.shape is not None}
    return {"tools": tools, "rigid": shapes}


def _frame(cells: Layout, opening: RunStart, state: State) -> GridFrame:
    stress = np.concatenate([opening.stresses[name](state) for name in cells.bodies])
    force = cells.forces(state.pressure)
    return GridFrame(
        time=state.time,
        points=cells.reference + cells.nodal(state.displacement),
        at_points={
            **_tractions(cells, opening, state, force),
            "displacement": cells.nodal(_since_start(opening, state)),
            "velocity": cells.nodal(state.velocity),
            "contact_force": force,
            **{name: _at_nodes([values[body] for body in cells.bodies]) for name, values in state.fields.items()},
        },
        in_cells={**_past(cells, opening, state), "stress": components(stress), "von_mises": von_mises(stress)},
    )


def _since_start(opening: RunStart, state: State) -> dict[str, Array]:
    """Displacements (n, d) of the matter in the nodes of each solid since the start of the march [m]."""
    found = dict(state.displacement)
    for name, mesh in ({} if opening.model is None else opening.model.remeshed).items():
        found[name] = found[name] + (mesh.mesh.points - mesh.origin)
    return found


def _tractions(cells: Layout, opening: RunStart, state: State, force: Array) -> dict[str, Array]:
    """Contact pressure (n,) and, with friction, tangential traction (n, 3) [Pa]."""
    if opening.spread is None:
        return {}
    if not state.traction:
        return {"contact_pressure": opening.spread(state, force[:, None])[:, 0]}
    found = opening.spread(state, np.column_stack([force, cells.tangential(state.traction)]))
    return {"contact_pressure": found[:, 0], "tangential_traction": found[:, 1:]}


def _past(cells: Layout, opening: RunStart, state: State) -> dict[str, Array]:
    """History variables (e, ...) of the cells by name; zero in solids without history."""
    found = [opening.remembered[name](state) if name in opening.remembered else {} for name in cells.bodies]
    counts = [mesh.n_cells for mesh in opening.meshes.values()]
    shapes = {name: values.shape[1:] for one in found for name, values in one.items() if name.isidentifier()}
    return {
        name: np.concatenate([one.get(name, np.zeros((n, *shape))) for one, n in zip(found, counts, strict=True)])
        for name, shape in shapes.items()
    }


def _at_nodes(values: Sequence[Array]) -> Array:
    """Values (n, k) of a field at the nodes of all bodies; (n,) of a scalar."""
    whole = np.concatenate(values)
    return whole[:, 0] if whole.shape[1] == 1 else whole
