"""Which solids may get new meshes: refusals, and solids with ``auto`` whose meshes stay."""

import logging
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from softway.adaptivity.new_cells.mmg import mmg
from softway.adaptivity.unrelated.control_volumes import require_cells
from softway.adaptivity.unrelated.heat import require_simplices
from softway.adaptivity.unrelated.memory import require_recast
from softway.bodies.conductor import Thermal
from softway.bodies.setup.loads import Traction
from softway.bodies.setup.supports import Carried, Guided
from softway.bodies.solid import Solid
from softway.errors import InputError, within
from softway.heat.coupled.solid_temperature import TEMPERATURE
from softway.marching.remeshing.admitted import adaptions
from softway.marching.rules.slab_rule import Method
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remesh import SIMPLICES, Remesh, remesh_of
from softway.model.model import Model
from softway.model.scene import Scene
from softway.solve.methods.central_difference import Explicit

log = logging.getLogger(__name__)


def replacements(scene: Scene) -> dict[str, Remesh]:
    """Replacements of the meshes of the solids that have any, by name."""
    solids = {name: body for name, body in scene.bodies.items() if isinstance(body, Solid)}
    return {name: how for name, solid in solids.items() if (how := remesh_of(solid.remesh)) is not None}


def formable(model: Model, method: Method) -> tuple[Model, dict[str, InputError]]:
    """Model whose solids with ``auto`` get new meshes where they can, and why each of the others keeps its mesh.

    Raises
    ------
    InputError
        For a solid with numbers of its own, :class:`~softway.meshes.remeshed.remesh.Remesh`, whose mesh cannot be
        replaced.
    """
    stay: dict[str, InputError] = {}
    for name in replacements(model.scene):
        try:
            require_formable(model, name, method)
        except InputError as error:
            if _solid(model, name).remesh != "auto":
                raise
            stay[name] = error
            log.info("the mesh of '%s' stays: %s, %s", name, error.where, error.problem)
    if not stay:
        return model, {}
    bodies = {name: replace(_solid(model, name), remesh=None) for name in stay}
    return replace(model, scene=replace(model.scene, bodies={**model.scene.bodies, **bodies})), stay


def require_formable(model: Model, name: str, method: Method) -> None:
    """Refuse a solid whose mesh cannot be replaced.

    Raises
    ------
    InputError
        With the place in the scene: laws that know the undeformed shape, several materials, plane stress, other cells,
        melting strain, expansion beside a stiffness by temperature, several laws of heat, bulk viscosity, ties,
        tractions, supports that measure from the undeformed shape, new cells of other shapes or around supports inside,
        Mmg that is not installed, rigid bodies, solids that adapt, or central differences.
    """
    part = next(p for p in model.parts if p.name == name)
    with within(f"bodies.{name}"):
        require_recast(part)
        require_cells(part.mesh.blocks)
        _require_new_cells(part.mesh, _solid(model, name))
        _require_plain(_solid(model, name), part.mesh.blocks)
    _require_alone(model, name, method)


def _require_plain(solid: Solid, blocks: Iterable[str]) -> None:
    """Refuse parts of a solid of some types of cells that do not pass to a new mesh."""
    if solid.shock is not None:
        raise InputError("shock", "bulk viscosity, which does not pass to a new mesh", "no shock, or a mesh that stays")
    if solid.thermal is not None:
        with within("thermal"):
            require_simplices(blocks)
            _require_passing(solid.thermal)
    if any(isinstance(support, Guided | Carried) for support in solid.supports):
        problem = "Guided or Carried, which measure from the shape at the start"
        raise InputError("supports", problem, "Fixed or Driven, or a mesh that stays")


def _require_passing(thermal: Thermal) -> None:
    """Refuse heat that does not pass to a new mesh."""
    if thermal.melting_strain:
        problem = "a free strain of the liquid, whose latent heat knows the deformation since the start"
        raise InputError("melting_strain", problem, "no melting_strain, or a mesh that stays")
    if thermal.expansion and thermal.stiffness is not None:
        problem = "expansion of a stiffness by temperature, whose heat knows the deformation since the start"
        raise InputError("expansion", problem, "no expansion, no stiffness, or a mesh that stays")
    if isinstance(thermal.law, Mapping):
        problem = "several laws, whose regions have other capacities on a new mesh"
        raise InputError("law", problem, "one law, or a mesh that stays")


def makes_cells(how: Remesh, mesh: Mesh, solid: Solid) -> bool:
    """Whether a solid may get new cells: its cells are triangles or tetrahedra, and no support is on nodes inside."""
    return how.by != "rezone" and _simplices(mesh) and _held_inside(mesh, solid) is None


def _require_new_cells(mesh: Mesh, solid: Solid) -> None:
    """Refuse new cells for a solid that cannot have them, where nothing else is allowed."""
    how = remesh_of(solid.remesh)
    if how is None or how.by == "rezone":
        return
    if how.generator == "mmg":
        with within("remesh"):
            mmg()
    inside = _held_inside(mesh, solid)
    if how.by == "new cells" and not _simplices(mesh):
        names = " or ".join(SIMPLICES[mesh.dim - 2])
        remedy = f'a mesh of {names}, with dilatation = "corner" where the volume stays; or by = "rezone"'
        raise InputError("remesh.by", f"new cells for {', '.join(mesh.blocks)}", remedy)
    if how.by == "new cells" and inside is not None:
        raise InputError("remesh.by", f"new cells with a support on nodes inside, {inside!r}", 'by = "rezone"')


def _simplices(mesh: Mesh) -> bool:
    """Whether all cells are triangles or tetrahedra."""
    return any(tuple(mesh.blocks) == (cell,) for cell in SIMPLICES[mesh.dim - 2])


def _held_inside(mesh: Mesh, solid: Solid) -> str | None:
    """Tag of a support on nodes inside a body; None if there is none."""
    surface = np.isin(np.arange(mesh.n_nodes), mesh.nodes("surface"))
    return next((held.on for held in solid.supports if not surface[mesh.nodes(held.on)].all()), None)


def _require_alone(model: Model, name: str, method: Method) -> None:
    """Refuse what else in a scene does not go together with new meshes of a solid."""
    scene, place = model.scene, f"bodies.{name}.remesh"
    if isinstance(method, Explicit):
        problem = "Explicit, whose stable step new cells change"
        raise InputError("solver", problem, "FixedPoint or Newton, or a mesh that stays")
    for k, load in enumerate(scene.loads):
        if isinstance(load, Traction) and load.body == name:
            problem = f"a traction on {name!r}, per area of the shape at the start"
            raise InputError(f"loads[{k}]", problem, "a tool that presses, or a mesh that stays")
    if adapting := adaptions(scene):
        problem = f"in a scene in which the mesh of {next(iter(adapting))!r} adapts"
        raise InputError(place, problem, "a scene whose solids either adapt or remesh")
    if model.rigid is not None:
        raise InputError(place, "in a scene with rigid bodies", "tools in place of rigid bodies, or a mesh that stays")
    tied = int((model.linked == model.linked[list(model.meshes).index(name)]).sum()) > 1
    others = any(companion.field != TEMPERATURE for companion in model.companions)
    if tied or model.bonds or others:
        raise InputError(place, "in a scene with ties or other fields", "a scene without, or a mesh that stays")


def _solid(model: Model, name: str) -> Solid:
    """A solid of the scene."""
    solid = model.scene.bodies[name]
    assert isinstance(solid, Solid)
    return solid
