"""Which solids may adapt: refusals, and solids with ``auto`` whose meshes stay."""

import logging
from dataclasses import replace

from softway.bodies.solid import Solid
from softway.errors import InputError
from softway.heat.coupled.solid_temperature import SolidTemperature
from softway.march.remeshing.carried_heat import carries_heat
from softway.march.rules.slab_rule import Method
from softway.meshes.adaptive.adapt import Adapt, adaption
from softway.meshes.adaptive.refinement import BISECTED
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
        _require_cells(model, name)
    _require_carried(model)


def admitted(model: Model, method: Method) -> tuple[Model, dict[str, InputError]]:
    """Model whose solids with ``auto`` adapt where they can, and why each of the others has a mesh that stays.

    Raises
    ------
    InputError
        For a solid with numbers of its own, :class:`~softway.meshes.adaptive.adapt.Adapt`, that cannot adapt.
    """
    stay: dict[str, InputError] = {}
    asked = adaptions(model.scene)
    for name in asked:
        try:
            _require_implicit(method)
            _require_cells(model, name)
            _require_carried(model)
        except InputError as error:
            if _solid(model, name).adapt != "auto":
                raise
            stay[name] = error
            log.info("the mesh of '%s' stays: %s, %s", name, error.where, error.problem)
    if not stay:
        return model, {}
    bodies = {name: replace(_solid(model, name), adapt=None) for name in stay}
    return replace(model, scene=replace(model.scene, bodies={**model.scene.bodies, **bodies})), stay


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


def _require_cells(model: Model, name: str) -> None:
    """Refuse cells that are not cut into smaller ones."""
    if not can_be_cut(model.meshes[name]):
        found = ", ".join(model.meshes[name].blocks)
        raise InputError(f"bodies.{name}.adapt", f"cells {found}, which cannot adapt", WHAT)


def _require_carried(model: Model) -> None:
    """Refuse scenes of which something would not pass to other meshes."""
    scene, other = model.scene, "meshes that stay, or a scene without"
    _require_linked(model)
    for k, contact in enumerate(scene.contacts if not model.timing.massless else ()):
        problem = f"{contact.label!r} whose nodes have inertia, where meshes adapt"
        raise InputError(f"contacts[{k}].timing", problem, "Energy, whose contact nodes are massless")
    for name in model.meshes:
        if not carries_heat(model, name):
            problem = "latent heat, or capacities that depend on the temperature, of several regions"
            remedy = "one law, constant capacities without latent heat, or meshes that stay"
            raise InputError(f"bodies.{name}.thermal.law", f"{problem}, where meshes adapt", remedy)
    for field in model.companions:
        if not isinstance(field, SolidTemperature | CohesiveTies):
            problem = f"the field {field.field.name!r}, which does not pass to other meshes"
            raise InputError(f"bodies.{next(iter(adaptions(scene)))}.adapt", problem, f"{other} this field")


def _require_linked(model: Model) -> None:
    """Refuse ties of solids that adapt with those whose cells cannot be cut."""
    adapts = set(adaptions(model.scene))
    for k, tie in enumerate(model.scene.ties):
        group = model.linked[[part.name in tie.bodies for part in model.parts]][0]
        names = [part.name for part, own in zip(model.parts, model.linked, strict=True) if own == group]
        for name in names:
            if adapts.intersection(names) and not can_be_cut(model.meshes[name]):
                found = ", ".join(model.meshes[name].blocks)
                problem = f"solids that adapt are glued to {name!r} of cells {found}, which cannot adapt"
                raise InputError(f"ties[{k}].between", problem, f"{WHAT} in all of them, or meshes that stay")
