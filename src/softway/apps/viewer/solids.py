"""3D view of the page: surfaces of bodies, their mesh lines and the obstacles, as VTK objects."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from softway.arrays import Array, IntArray
from softway.bodies.prescribed_motion import PlacedShape
from softway.errors import InputError
from softway.record.read.frames import Frame
from softway.record.run import Run
from softway.record.view.bodies.bodies import Shown, Stage, stage_of
from softway.record.view.bodies.colour_field import Colour
from softway.record.view.bodies.surroundings import plane, sides

ANGLE = 30.0
"""View angle of the camera [degrees], the default of the browser client."""
SAMPLES = 40
"""Number of frames that determine the colour range and the camera position."""
GRID = 56
"""Points along an edge of the grid on which curved obstacles are contoured."""
FINE = 30000
"""Number of triangles of the refined surface."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Solids:
    """3D window and its data; ``show`` changes the data."""

    plotter: Any
    skin: Any
    lines: Any
    tools: Any

    def show(self, stage: Stage, frame: Frame, enlarged: bool) -> None:
        """Show a frame, with deformations enlarged or to scale."""
        shown = (stage if enlarged else stage.to_scale()).shown(frame)
        points, triangles, values = _surface(shown)
        _fill(self.skin, points, faces=_padded(triangles))
        self.skin.point_data.clear()
        self.skin.point_data["field"] = values
        self.skin.set_active_scalars("field")
        _fill(self.lines, shown.place.points, lines=_padded(_edges(shown)))
        obstacles = [_obstacle(tool, stage.bounds) for tool in shown.tools.values()]
        seen = [o for o in obstacles if o.n_points] or [_dot(stage.bounds.mean(axis=0))]
        self.tools.copy_from(_library().merge(seen))

    def paint(self, stage: Stage) -> None:
        """Colour the bodies by the current field."""
        low, high = stage.range.low, stage.range.high
        self.plotter.add_mesh(
            self.skin,
            scalars="field",
            cmap=stage.range.map,
            clim=(low, high if high > low else low + 1.0),
            show_scalar_bar=False,
            name="bodies",
            ambient=0.5,
            diffuse=0.6,
            specular=0.0,
            reset_camera=False,
        )

    def look(self, stage: Stage) -> None:
        """Move the camera to the viewpoint of the pictures."""
        camera, centre = self.plotter.camera, stage.bounds.mean(axis=0)
        size = float(np.linalg.norm(np.ptp(stage.bounds, axis=0)))
        far = 0.62 * size / np.tan(np.radians(0.5 * ANGLE))
        camera.view_angle = ANGLE
        camera.focal_point = tuple(centre)
        camera.position = tuple(centre + far * stage.view.axes[2])
        camera.up = tuple(stage.view.axes[1])
        self.plotter.renderer.ResetCameraClippingRange()


def solids() -> Solids:
    """Create an empty window."""
    pyvista = _library()
    pyvista.vtk_verbosity("off")  # off-screen: warnings about the window do not matter
    plotter = pyvista.Plotter(off_screen=True, lighting="light kit")
    plotter.set_background("white")
    return Solids(plotter=plotter, skin=pyvista.PolyData(), lines=pyvista.PolyData(), tools=pyvista.PolyData())


def stage(run: Run, colour: Colour) -> Stage:
    """Colour range and camera position from some frames of a run."""
    count = len(run.fields)
    return stage_of(run, colour, sorted({round(k) for k in np.linspace(0, count - 1, min(count, SAMPLES))}), FINE)


def dress(made: Solids, stage: Stage) -> None:
    """Add bodies, mesh lines and obstacles to the window, once it has data."""
    made.paint(stage)
    add = made.plotter.add_mesh
    add(made.lines, color="#808080", line_width=1, opacity=0.6, name="lines", reset_camera=False, lighting=False)
    add(made.tools, color="#d2d2d2", name="tools", reset_camera=False, lighting=False)
    made.plotter.renderer.actors["bodies"].mapper.SetResolveCoincidentTopologyToPolygonOffset()


def _library():  # type: ignore[no-untyped-def]  # the module object
    try:
        import pyvista
    except ImportError:
        raise InputError("view", "PyVista is not installed", "pip install 'softway[view]'") from None
    return pyvista


def _fill(data: Any, points: Array, **cells: IntArray) -> None:
    """Replace points and cells of an existing object."""
    data.copy_from(_library().PolyData(points, **cells))


def _dot(place: Array) -> Any:
    """Degenerate triangle, drawn if there is nothing to see."""
    return _library().PolyData(np.repeat(place[None], 3, axis=0), faces=np.array([3, 0, 1, 2]))


def _padded(cells: IntArray) -> IntArray:
    """Cells (k, b) in VTK format: the number of points before each cell."""
    return np.insert(cells, 0, cells.shape[1], axis=1).ravel()


def _surface(shown: Shown) -> tuple[Array, IntArray, Array]:
    """Points (k, 3), triangles (t, 3) and values (k,) of surfaces; bars are ribbons."""
    cells, skin, points, values = shown.surface.cells, shown.surface.skin, shown.place.points, shown.values
    bars = [nodes for name, nodes in cells.blocks().items() if name.startswith("bar")]
    parts = [(skin.lattice(points), skin.triangles, skin.lattice(values))] if skin.patches else []
    for nodes in bars:
        ends = points[nodes[:, :2]]
        along = ends[:, 1] - ends[:, 0]
        across = np.cross([0.0, 0.0, 1.0], along)
        across[np.abs(across).max(axis=1) == 0.0] = [1.0, 0.0, 0.0]
        wide = 0.04 * float(np.linalg.norm(np.ptp(cells.reference, axis=0)))
        across *= wide / np.linalg.norm(across, axis=1, keepdims=True)
        corners = np.stack([ends + across[:, None], ends - across[:, None]], axis=2).reshape(-1, 3)
        first = 4 * np.arange(len(nodes))[:, None, None]
        triangles = (first + np.array([[0, 1, 2], [2, 1, 3]])).reshape(-1, 3)
        parts.append((corners, triangles, np.repeat(values[nodes[:, :2]].ravel(), 2)))
    starts = np.cumsum([0, *(len(part[0]) for part in parts)])
    joined = [part[1] + start for part, start in zip(parts, starts, strict=False)]
    return np.concatenate([p[0] for p in parts]), np.concatenate(joined), np.concatenate([p[2] for p in parts])


def _edges(shown: Shown) -> IntArray:
    """Edges (k, 3) of all visible cells: end, middle, end."""
    found = [np.zeros((1, 3), int)]
    for patch in shown.surface.skin.patches:
        width = patch.facets.shape[1]
        found.append(sides(patch.facets, 3 if width in (3, 6) else 4).reshape(-1, 3))
    return np.unique(np.concatenate(found), axis=0)


def _obstacle(tool: PlacedShape, bounds: Array) -> Any:
    """Part of an obstacle near the bodies."""
    pyvista, flat = _library(), plane(tool)
    size = float(np.linalg.norm(np.ptp(bounds, axis=0)))
    low, high = bounds[0] - 0.15 * size, bounds[1] + 0.15 * size
    if flat is not None:
        return _flat(tool, flat, bounds, size)
    axes = [np.linspace(a, b, GRID) for a, b in zip(low, high, strict=True)]
    axes[tool.dim :] = [np.zeros(1)] * (3 - tool.dim)
    spacing = [float(a[1] - a[0]) if len(a) > 1 else 1.0 for a in axes]
    grid = pyvista.ImageData(dimensions=[len(a) for a in axes], spacing=spacing, origin=[float(a[0]) for a in axes])
    grid["gap"] = tool.gap(np.asarray(grid.points)[:, : tool.dim])
    if tool.dim == 3:
        found = grid.contour([0.0], scalars="gap")
    else:
        found = grid.clip_scalar(scalars="gap", value=0.0, invert=True).extract_surface(algorithm="dataset_surface")
    found.clear_data()
    return found


def _flat(tool: PlacedShape, flat: tuple[Array, Array], bounds: Array, size: float) -> Any:
    """Flat obstacle: a plate in 3D, a band in 2D and 1D."""
    point, normal = flat
    centre = bounds.mean(axis=0)
    centre = centre - ((centre - point) @ normal) * normal
    if tool.dim == 3:
        found = _library().Plane(center=centre, direction=normal, i_size=1.3 * size, j_size=1.3 * size)
        found.clear_data()
        return found
    along = np.cross(normal, [0.0, 0.0, 1.0])
    reach = 0.7 * size if tool.dim == 2 else 0.2 * size
    deep = -0.06 * size * normal
    corners = np.array([centre - reach * along, centre + reach * along, centre + reach * along + deep])
    corners = np.concatenate([corners, [centre - reach * along + deep]])
    return _library().PolyData(corners, faces=np.array([4, 0, 1, 2, 3]))
