"""Which solids may get new meshes: refusals, and solids with ``auto`` whose meshes stay."""

import logging
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from softway.adaptivity.new_cells.mmg import mmg
from softway.adaptivity.unrelated.control_volumes import require_cells
from softway.adaptivity.unrelated.heat import require_simplices
from softway.adaptivity.unrelated.memory import require_recast
from softway.bodies.conductor import Thermal
from softway.bodies.discretised import DiscreteSolid
from softway.bodies.internal_force.materials import owners
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
        With the place in the scene: laws that know the undeformed shape, plane stress, other cells, melting strain,
        expansion beside a stiffness by temperature, laws of heat that depend on the temperature or divide a material,
        bulk viscosity, ties, tractions, supports that measure from the undeformed shape, new cells of other shapes, of
        several materials or around supports inside, Mmg that is not installed, rigid bodies, solids that adapt, or
        central differences.
    """
    part = next(p for p in model.parts if p.name == name)
    with within(f"bodies.{name}"):
        require_recast(part)
        require_cells(part.mesh.blocks)
        _require_new_cells(part.mesh, _solid(model, name))
        _require_plain(_solid(model, name), part)
    _require_alone(model, name, method)


def _require_plain(solid: Solid, part: DiscreteSolid) -> None:
    """Refuse what of a solid does not pass to a new mesh."""
    if solid.shock is not None:
        raise InputError("shock", "bulk viscosity, which does not pass to a new mesh", "no shock, or a mesh that stays")
    if solid.thermal is not None:
        with within("thermal"):
            require_simplices(part.mesh.blocks)
            _require_passing(solid.thermal)
            _require_heat_of_materials(solid.thermal, part)
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


def _require_heat_of_materials(thermal: Thermal, part: DiscreteSolid) -> None:
    """Refuse several laws of heat in one material, whose volumes are not kept apart, and those of which a node has no
    temperature from its content alone.
    """
    if not isinstance(thermal.law, Mapping):
        return
    for region, law in thermal.law.items():
        if not law.constant:
            problem = f"several laws, one of which depends on the temperature, in {region!r}"
            raise InputError("law", problem, "laws that are constant, or one law, or a mesh that stays")
    laws = owners(part.mesh, tuple(thermal.law), "law")
    materials = np.zeros_like(laws) if part.materials.owner is None else part.materials.owner
    for number, region in enumerate(part.materials.regions):
        found = np.unique(laws[materials == number])
        if len(found) > 1:
            names = ", ".join(list(thermal.law)[k] for k in found)
            remedy = f"materials by the same regions, material = {{ {names} }}, or a mesh that stays"
            raise InputError("law", f"several laws in one material{f' {region!r}' * bool(region)}: {names}", remedy)


def makes_cells(how: Remesh, mesh: Mesh, solid: Solid) -> bool:
    """Whether a solid may get new cells: its cells are triangles or tetrahedra of one material, and no support is on
    nodes inside.
    """
    several = isinstance(solid.material, Mapping)
    return how.by != "rezone" and _simplices(mesh) and not several and _held_inside(mesh, solid) is None


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
    if how.by == "new cells" and isinstance(solid.material, Mapping):
        raise InputError("remesh.by", "new cells of several materials, whose nodes slide only", 'by = "rezone"')
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
