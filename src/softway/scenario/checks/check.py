"""Check of a scenario before the computation, and the scales of its bodies and contacts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from softway.bodies.discretised import dofs_of
from softway.bodies.solid import Solid
from softway.errors import Cancel, InputError, Note, within
from softway.heat.coupled.build import build
from softway.marching.remeshing.adaptive_march import adapted_start
from softway.marching.remeshing.admitted import adaptions, admitted
from softway.marching.remeshing.forming.formable import formable
from softway.marching.remeshing.forming.formed_scene import formed_scene
from softway.marching.rules.slab_rule import Method
from softway.marching.start.preparation import prepare
from softway.marching.start.slab_tolerance import slab_tolerance
from softway.marching.state.march_state import MarchState, Settings
from softway.meshes.files.listed_mesh import LeftOut
from softway.model.model import Model
from softway.model.scene import Scene, StaticStart
from softway.scenario.built import built_and_left_out
from softway.scenario.checks.heat import CheckedHeat, check_heat, is_heat
from softway.scenario.checks.mechanism import (
    CheckedMechanism,
    RigidScales,
    check_mechanism,
    is_mechanism,
    mechanism_among_solids,
    rigid_scales,
)
from softway.scenario.checks.names import (
    check_contact,
    check_contacts,
    check_density,
    check_dimensions,
    check_loads,
    check_names,
    check_solid,
    check_ties,
    mesh_of,
)
from softway.scenario.checks.notes.part_notes import (
    body_notes,
    cell_notes,
    cohesion_notes,
    contact_notes,
    file_notes,
    tie_notes,
    wall_notes,
)
from softway.scenario.checks.notes.softening_notes import softening_notes
from softway.scenario.checks.notes.tool_notes import unit_notes
from softway.scenario.checks.notes.velocity_notes import flutter_notes, velocity_notes
from softway.scenario.checks.pile import CheckedPile, check_pile, is_pile
from softway.scenario.checks.probes import probe_readings
from softway.scenario.checks.scales import BodyScales, ContactScales, body_scales, contact_scales
from softway.scenario.checks.value_types import require
from softway.scenario.scenario import Scenario

MOST = 1_000_000_000
"""Maximum number of time steps (slabs) in a run."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Checked:
    """Scenario that has passed all checks.

    Parameters
    ----------
    scenario
        Scenario as given.
    model
        Scene as arrays, ready to march.
    bodies, contacts
        Scales of the bodies by name, rigid ones last, and of the contacts by label.
    march_state
        State at the start of the march.
    step, slabs
        Length of a time step (slab) [s], resolved if it is automatic, and number of slabs.
    notes
        Notes on parts of the scenario that are computed, although their results may be wrong.
    left_out
        Cards of the mesh files that are not honoured, by body.
    """

    scenario: Scenario
    model: Model
    bodies: Mapping[str, BodyScales | RigidScales]
    contacts: Mapping[str, ContactScales]
    march_state: MarchState
    step: float
    slabs: int
    notes: tuple[Note, ...] = ()
    left_out: Mapping[str, tuple[LeftOut, ...]] = field(default_factory=dict)

    @property
    def tolerance(self) -> float | None:
        """Tolerance by which slabs grow beyond ``step``; None if they do not."""
        return self.march_state.settings.tolerance


def check(
    scenario: Scenario, *, cancel: Cancel | None = None
) -> Checked | CheckedMechanism | CheckedPile | CheckedHeat:
    """Build the model, check all names, signs and dimensions, and prepare the march up to its first time step (slab).

    Everything that a run refuses before its first slab is refused here, with the same message.  A scenario of rigid
    bodies is checked as a mechanism, one of balls as a pile, and one of conductors by building their heat model.

    Parameters
    ----------
    scenario
        Scenario to check.
    cancel
        Function called in every iteration of an equilibrium at the start; the check stops when it returns True.

    Raises
    ------
    InputError
        With the path in the scenario, the value, and a remedy.
    NumericsError
        If there is no static equilibrium at the start.
    Cancelled
        If ``cancel`` requests it.
    """
    _require_scenario(scenario)
    check_names(scenario.bodies)
    if is_heat(scenario):
        return check_heat(scenario)
    if is_pile(scenario):
        return check_pile(scenario)
    return check_mechanism(scenario) if is_mechanism(scenario) else check_solids(scenario, cancel=cancel)


def check_solids(scenario: Scenario, *, cancel: Cancel | None = None) -> Checked:
    """Check a scenario of solids and tools, as :func:`check` does."""
    _check_densities(scenario)
    scene, left_out = built_and_left_out(scenario)
    scene = replace(scene, mechanism=mechanism_among_solids(scenario))
    solids = {n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}
    if not solids:
        raise InputError("bodies", f"no Solid among {list(scene.bodies)}", 'at least one body of kind = "Solid"')
    check_dimensions(scenario.bodies, solids)
    _require_edges(solids)
    for name, solid in solids.items():
        check_solid(solid, f"bodies.{name}")
    check_ties({**scenario.bodies, **solids}, scene.ties)
    of_files = (*file_notes(left_out), *unit_notes(scenario.scene.bodies, solids))
    notes = (*of_files, *body_notes(solids, scene.ties))
    check_loads(scenario.mechanical_loads, "loads", solids)
    check_contacts(scene.contacts)
    _scales(solids, scenario)
    for k, contact in enumerate(scene.contacts):
        check_contact({**scenario.bodies, **solids}, contact, f"contacts[{k}]")
    probe_readings(scenario, {n: mesh_of(s) for n, s in solids.items()}, scene.mechanism)
    if isinstance(scenario.start, StaticStart):
        check_loads(scenario.start.loads, "start.loads", solids)
    model, staying = _admitted(_model(scenario, scene), scenario.solver)
    scene = model.scene
    bodies = _scales({n: b for n, b in scene.bodies.items() if isinstance(b, Solid)}, scenario)
    model, march_state = _begun(scenario, model, cancel)
    step = march_state.step_history.span
    contacts = contact_scales(model, bodies)
    flutter = flutter_notes(model, march_state.state, step, scenario.time.end)
    return Checked(
        scenario=scenario,
        model=model,
        bodies={**bodies, **rigid_scales(scene.mechanism)},
        contacts=contacts,
        march_state=march_state,
        step=step,
        slabs=int(np.ceil(scenario.time.end / step * (1.0 - 1e-12))),
        notes=(*notes, *staying, *wall_notes(model, solids), *_model_notes(model, contacts), *flutter),
        left_out=left_out,
    )


def _scales(solids: Mapping[str, Solid], scenario: Scenario) -> dict[str, BodyScales]:
    """Scales of the solids by name."""
    factor, bodies = scenario.inertia.factor or 1.0, {}
    for name, solid in solids.items():
        with within(f"bodies.{name}"):
            bodies[name] = body_scales(solid, mesh_of(solid), dofs_of(solid.supports, mesh_of(solid)).size, factor)
    return bodies


def _model(scenario: Scenario, scene: Scene) -> Model:
    """Model of the built scene of a scenario; an error in a tie of a mesh file says where it comes from."""
    try:
        return build(scene)
    except InputError as error:
        if error.where.partition(".")[0] not in [f"ties[{k}]" for k in range(len(scenario.ties), len(scene.ties))]:
            raise
        remedy = f"{error.remedy}; a tie of the scenario between the same surfaces takes its place"
        raise InputError("ties", f"{error.problem} (a tie of a mesh file)", remedy) from None


def _admitted(model: Model, method: Method) -> tuple[Model, tuple[Note, ...]]:
    """Model whose solids with ``auto`` adapt, or get new meshes, where they can, and notes on the others."""
    model, coarse = admitted(model, method)
    model, stay = formable(model, method)
    return model, (*_staying(coarse, "adapt"), *_staying(stay, "remesh"))


def _staying(meshes: Mapping[str, InputError], key: str) -> Iterator[Note]:
    """Notes on meshes with ``auto`` at a key that stay, with the reasons."""
    for name, error in meshes.items():
        problem = f"'auto', but the mesh stays; {error.where} is {error.problem}"
        yield Note(where=f"bodies.{name}.{key}", problem=problem, remedy=error.remedy)


def _check_densities(scenario: Scenario) -> None:
    """Refuse solids whose density is not positive."""
    for name, body in scenario.bodies.items():
        if isinstance(body, Solid):
            check_density(body.density, f"bodies.{name}.density")


def _model_notes(model: Model, contacts: Mapping[str, ContactScales]) -> tuple[Note, ...]:
    """Notes on cells, velocities, softening laws, contacts and ties."""
    return (
        *cell_notes(model),
        *velocity_notes(model),
        *softening_notes(model, contacts),
        *contact_notes(model),
        *tie_notes(model),
        *cohesion_notes(model),
    )


def _require_edges(solids: Mapping[str, Solid]) -> None:
    """Refuse meshes with an edge of the length zero."""
    for name, solid in solids.items():
        if not mesh_of(solid).edge() > 0.0:
            raise InputError(
                f"bodies.{name}.mesh", "an edge has the length zero", "a mesh without coincident nodes in a cell"
            )


def _begun(scenario: Scenario, model: Model, cancel: Cancel | None) -> tuple[Model, MarchState]:
    """Model on its first meshes, and march state at the start of the run, prepared as by the march itself.

    Raises
    ------
    InputError
        If the march would refuse the model, or would need more than ``MOST`` slabs.
    """
    time = scenario.time
    if time.step != "auto" and time.step > time.end:
        raise InputError("time.step", f"{time.step:g} s is longer than time.end = {time.end:g} s", "a shorter step")
    settings = Settings(
        until=time.end,
        step=time.step,
        weight=time.weight,
        method=scenario.solver,
        control=time.control,
        tolerance=slab_tolerance(model, time.step, time.tolerance, time.weight, scenario.solver),
    )
    if adaptions(model.scene):
        model = adapted_start(model, settings).model
    model = formed_scene(model).model
    march_state = prepare(model, settings, cancel=cancel).march_state
    slabs, span = time.end / march_state.step_history.span, march_state.step_history.span
    if slabs > MOST:
        raise InputError("time.end", f"needs {slabs:.3g} slabs of {span:.3g} s", "an earlier end, or longer slabs")
    return model, march_state


def _require_scenario(scenario: object) -> None:
    """Refuse an object that is not a scenario, and a scenario with parts of a wrong type."""
    if not isinstance(scenario, Scenario):
        raise InputError("scenario", f"{scenario!r:.60} is no scenario", "a Scenario, such as softway.load(FILE)")
    require(scenario, Scenario, "")
