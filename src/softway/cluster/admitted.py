"""What runs over several ranks; all else is refused in words."""

from collections.abc import Iterator
from dataclasses import replace

from softway.bodies.discretised import DiscreteSolid
from softway.bodies.dof_map import NodalDofs
from softway.bodies.internal_force.elastic.elastic_force import ElasticForce
from softway.bodies.internal_force.elastic.kernel_evaluation import KernelEvaluation
from softway.bodies.solid import Driven, Guided
from softway.contact.impact_rule import Energy
from softway.contact.node_to_surface.node_to_tool import NodeToTool
from softway.errors import InputError
from softway.marching.rules.slab_rule import Method
from softway.model.model import Model
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.operators import MatrixFree

REMEDY = "a run on one rank, without --ranks"


def require_several(model: Model, method: Method, size: int) -> None:
    """Refuse a march that runs on one rank only.

    Raises
    ------
    InputError
        With the place in the scene.
    """
    for where, what in (*_of_scene(model), *_of_solids(model), *_of_contacts(model), *_of_method(method)):
        raise InputError(where, f"runs on one rank only: {what}", REMEDY)
    cells = model.parts[0].mesh.n_cells
    if size > cells:
        raise InputError("ranks", f"{size} for {cells} cells", f"{cells} or fewer")


def _of_scene(model: Model) -> Iterator[tuple[str, str]]:
    if len(model.parts) > 1:
        yield "bodies", f"{len(model.parts)} deformable bodies"
    if model.rigid is not None:
        yield "mechanism", "rigid bodies"
    if not model.inert:
        yield "inertia", "a march without inertia"
    if model.adapted or model.remeshed or any(getattr(b, "adapt", None) for b in model.scene.bodies.values()):
        yield "bodies", "meshes that change in the march"
    if model.companions:
        yield "ties" if model.bonds else "bodies", "ties that break" if model.bonds else "a field beside the motion"


def _of_solids(model: Model) -> Iterator[tuple[str, str]]:
    for part in model.parts:
        where = f"bodies.{part.name}"
        if not isinstance(part.internal, ElasticForce):
            yield f"{where}.material", "several materials, or one with a history"
        elif not isinstance(part.internal.work, KernelEvaluation):
            yield f"{where}.material", f"{type(part.internal.material).__name__} without a compiled law for such cells"
        if len(part.mesh.blocks) > 1:
            yield f"{where}.mesh", "cells of several types"
        if part.shock is not None:
            yield f"{where}.shock", "a bulk viscosity"
    if not isinstance(model.dofs, NodalDofs):
        yield "bodies", "supports along inclined directions, hanging nodes or ties"
    for support, _ in model.driven:
        if not isinstance(support, Driven | Guided):
            yield "bodies", f"the support {type(support).__name__}"


def _of_contacts(model: Model) -> Iterator[tuple[str, str]]:
    if not isinstance(model.timing, Energy) or model.timing.calm > 0.0:
        yield "contacts[0].timing", "another rule than Energy, and its filter calm"
    if not all(isinstance(m, NodeToTool) for m in model.contacts.methods):
        yield "contacts", "contact between deformable surfaces"
    if not model.friction.frictionless:
        yield "contacts", "friction"


def _of_method(method: Method) -> Iterator[tuple[str, str]]:
    if not isinstance(method, FixedPoint):
        yield "solver", f"{type(method).__name__}"
    elif method.operator != "auto" and not isinstance(method.operator, MatrixFree):
        yield "solver.operator", f"{type(method.operator).__name__}"


def method_of_ranks(method: Method) -> FixedPoint:
    """Method over ranks: conjugate gradients, and no other method takes over."""
    assert isinstance(method, FixedPoint)
    operator = MatrixFree() if method.operator == "auto" else method.operator
    return replace(method, operator=operator, handover=False)


def of_kernels(part: DiscreteSolid) -> ElasticForce:
    """Internal force of an admitted solid."""
    assert isinstance(part.internal, ElasticForce)
    return part.internal
