"""Which solids may adapt: refusals, and solids with ``auto`` whose meshes stay."""

import logging
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from softway.bodies.solid import Solid
from softway.contact.impact_rule import Energy
from softway.errors import InputError
from softway.heat.coupled.solid_temperature import SolidTemperature
from softway.marching.remeshing.carried_heat import carries_heat
from softway.marching.rules.slab_rule import Method
from softway.meshes.adaptive.adapt import Adapt, adaption
from softway.meshes.adaptive.refinement import BISECTED
from softway.meshes.adaptive.squares.balanced import BALANCED
from softway.meshes.mesh import Mesh
from softway.model.cohesive_ties import CohesiveTies
from softway.model.model import Model
from softway.model.scene import Scene
from softway.solve.methods.central_difference import Explicit

log = logging.getLogger(__name__)
WHAT = f"solids of one type of cell, {', '.join(BISECTED)}"
"""What may adapt."""


def adaptions(scene: Scene) -> dict[str, Adapt]:
    """Adaptions of the solids whose meshes adapt, by name."""
    solids = {name: body for name, body in scene.bodies.items() if isinstance(body, Solid)}
    return {name: how for name, solid in solids.items() if (how := adaption(solid.adapt)) is not None}


def can_be_cut(mesh: Mesh) -> bool:
    """True for meshes whose cells can be cut into smaller ones."""
    return len(mesh.blocks) == 1 and next(iter(mesh.blocks)) in BISECTED


def require_admitted(model: Model) -> None:
    """Refuse solids that cannot adapt, and scenes of which something would not pass to other meshes.

    Raises
    ------
    InputError
        With the place in the scene.
    """
    for name in adaptions(model.scene):
        _require_own(model, name)
    _require_carried(model)


def admitted(model: Model, method: Method) -> tuple[Model, dict[str, InputError]]:
    """Model whose solids with ``auto`` adapt where they can, and why each of the others has a mesh that stays.

    Raises
    ------
    InputError
        For a solid with numbers of its own, :class:`~softway.meshes.adaptive.adapt.Adapt`, that cannot adapt.
    """
    asked = adaptions(model.scene)
    if not asked:
        return model, {}
    explicit, lost = _refusal(partial(_require_implicit, method)), _refusal(partial(_require_carried, model))
    found = {name: explicit or _refusal(partial(_require_own, model, name)) or lost for name in asked}
    stay = {name: error for name, error in found.items() if error is not None}
    for name, error in stay.items():
        if _solid(model, name).adapt != "auto":
            raise error
        log.info("the mesh of '%s' stays: %s, %s", name, error.where, error.problem)
    if not stay:
        return model, {}
    bodies = {name: replace(_solid(model, name), adapt=None) for name in stay}
    return replace(model, scene=replace(model.scene, bodies={**model.scene.bodies, **bodies})), stay


def _refusal(check: Callable[[], None]) -> InputError | None:
    """What a check refuses; None if nothing."""
    try:
        check()
    except InputError as error:
        return error
    return None


def _require_implicit(method: Method) -> None:
    """Refuse central differences."""
    if isinstance(method, Explicit):
        problem = "Explicit, whose stable step the finest cells determine, where meshes adapt"
        raise InputError("solver", problem, "FixedPoint or Newton, or meshes that stay")


def _solid(model: Model, name: str) -> Solid:
    """A solid of the scene."""
    solid = model.scene.bodies[name]
    assert isinstance(solid, Solid)
    return solid


def _require_own(model: Model, name: str) -> None:
    """Refuse a solid whose own mesh cannot change: by its cells, by those that ties join to it, or by the rule."""
    _require_cells(model, name)
    _require_linked(model, name)
    _require_rule(model, name)


def _require_cells(model: Model, name: str) -> None:
    """Refuse cells that are not cut into smaller ones."""
    mesh = model.meshes[name]
    if not can_be_cut(mesh):
        several = " of several types" if len(mesh.blocks) > 1 else ""
        problem = f"cells {', '.join(mesh.blocks)}{several}, which cannot adapt"
        remedy = f"{WHAT}; Gmsh makes quad4 or hex8 by Mesh.SubdivisionAlgorithm = {max(mesh.cell_dim - 1, 1)}"
        raise InputError(f"bodies.{name}.adapt", problem, remedy)


def _require_rule(model: Model, name: str) -> None:
    """Refuse nodes that hang with exact instants, whose nodes move by themselves."""
    (cell,) = model.meshes[name].blocks
    if isinstance(model.timing, Energy) and model.timing.located and cell in BALANCED and model.scene.contacts:
        problem = f"located = true, whose nodes cannot hang on larger cells, where {cell} adapt"
        raise InputError("contacts[0].timing.located", problem, "located = false, or triangles or tetrahedra")


def _require_carried(model: Model) -> None:
    """Refuse scenes of which something would not pass to other meshes."""
    scene, other = model.scene, "meshes that stay, or a scene without"
    for name in model.meshes:
        if not carries_heat(model, name):
            problem = "latent heat, or capacities that depend on the temperature, of several regions"
            remedy = "one law, constant capacities without latent heat, or meshes that stay"
            raise InputError(f"bodies.{name}.thermal.law", f"{problem}, where meshes adapt", remedy)
    for field in model.companions:
        if not isinstance(field, SolidTemperature | CohesiveTies):
            problem = f"the field {field.field.name!r}, which does not pass to other meshes"
            raise InputError(f"bodies.{next(iter(adaptions(scene)))}.adapt", problem, f"{other} this field")


def _require_linked(model: Model, name: str) -> None:
    """Refuse a solid that ties join to one whose cells cannot be cut."""
    groups = {part.name: group for part, group in zip(model.parts, model.linked.tolist(), strict=True)}
    for k, tie in enumerate(model.scene.ties):
        if groups[tie.bodies[0]] != groups[name]:
            continue
        for other in (one for one in groups if groups[one] == groups[name] and not can_be_cut(model.meshes[one])):
            found = ", ".join(model.meshes[other].blocks)
            problem = f"solids that adapt are glued to {other!r} of cells {found}, which cannot adapt"
            raise InputError(f"ties[{k}].between", problem, f"{WHAT} in all of them, or meshes that stay")
