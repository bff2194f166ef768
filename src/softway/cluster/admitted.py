"""What runs over several ranks; all else is refused in words."""

from collections.abc import Iterator

import numpy as np

from softway.bodies.dof_map import NodalDofs
from softway.bodies.setup.heat_loads import Radiation
from softway.bodies.solid import Driven, Guided
from softway.cluster.rank_contacts import served
from softway.contact.impact_rule import Energy
from softway.errors import InputError
from softway.heat.coupled.solid_temperature import SolidTemperature, temperatures_of
from softway.laws.law import Viscous
from softway.marching.rules.slab_rule import Method
from softway.model.model import Model
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.operators import ConjugateGradients, MatrixFree, Multigrid

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
    cells = sum(part.mesh.n_cells for part in model.parts)
    if size > cells:
        raise InputError("ranks", f"{size} for {cells} cells", f"{cells} or fewer")


def _of_scene(model: Model) -> Iterator[tuple[str, str]]:
    if model.rigid is not None:
        yield "mechanism", "rigid bodies"
    if not model.inert:
        yield "inertia", "a march without inertia"
    if model.adapted or model.remeshed or any(getattr(b, "adapt", None) for b in model.scene.bodies.values()):
        yield "bodies", "meshes that change in the march"
    if model.bonds:
        yield "ties", "ties that break"
    for _, temperature in temperatures_of(model.companions):
        yield from _of_heat(temperature)


def _of_solids(model: Model) -> Iterator[tuple[str, str]]:
    for part in model.parts:
        where = f"bodies.{part.name}"
        if any(isinstance(law, Viscous) for law in part.materials.laws):
            yield f"{where}.material", "a material without elasticity, whose slabs Newton's method has to take over"
        if part.dilatation == "corner":
            yield f"{where}.dilatation", "'corner', whose averages reach over several cells"
        if len(part.mesh.blocks) > 1:
            yield f"{where}.mesh", "cells of several types"
        if part.shock is not None:
            yield f"{where}.shock", "a bulk viscosity"
    if not isinstance(model.dofs, NodalDofs):
        yield "bodies", "supports along inclined directions, hanging nodes or ties"
    for support, _ in model.driven:
        if not isinstance(support, Driven | Guided):
            yield "bodies", f"the support {type(support).__name__}"


def _of_heat(temperature: SolidTemperature) -> Iterator[tuple[str, str]]:
    heat = temperature.model
    for part in heat.parts:
        where = f"bodies.{part.name}.thermal"
        if part.law.latent is not None:
            yield f"{where}.law", "heat of melting"
        here = np.arange(len(heat.mass))[part.nodes]
        if any(np.isin(nodes, here).any() for nodes, _ in temperature.moduli.curves):
            yield f"{where}.stiffness", "moduli that depend on the temperature"
    for expansion in temperature.expansions:
        if expansion.relieved is not None:
            problem = "thermal expansion of a law with a history in a body with free faces"
            yield f"bodies.{expansion.solid}.thermal.expansion", problem
    for surface in heat.surfaces:
        if isinstance(surface.load, Radiation):
            yield "loads", "radiation of a surface"
    if heat.conduction is None:
        yield "bodies", "conductivities and capacities that depend on the temperature"
    if heat.exchanges or temperature.glue or temperature.links or heat.lumps:
        yield "bodies", "heat through ties and into rigid bodies"


def _of_contacts(model: Model) -> Iterator[tuple[str, str]]:
    if not isinstance(model.timing, Energy) or model.timing.calm > 0.0:
        yield "contacts[0].timing", "another rule than Energy, and its filter calm"
    contacts = model.contacts
    if not all(served(m) for m in (*contacts.methods, *contacts.overlap_methods)):
        yield "contacts", "a contact of another kind than nodes, edges, mortar and tools"


def _of_method(method: Method) -> Iterator[tuple[str, str]]:
    if not isinstance(method, FixedPoint):
        yield "solver", f"{type(method).__name__}"
    elif method.operator != "auto" and not isinstance(method.operator, MatrixFree | ConjugateGradients | Multigrid):
        yield "solver.operator", f"{type(method.operator).__name__}"
