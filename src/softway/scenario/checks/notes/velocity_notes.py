"""Notes on initial velocities that supports take away, and with which bodies slide and flutter."""

from collections.abc import Sequence

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid, supported_components
from softway.bodies.setup.initial_fields import sample
from softway.bodies.solid import Driven, Guided, Solid
from softway.contact.impact_rule import Energy
from softway.errors import Note
from softway.marching.friction.flutter import Flutter, sliding_flutter
from softway.marching.state.model_state import ModelState
from softway.model.model import Model
from softway.tolerances import MOTION

LOUD = 1e3
"""Growth of vibrations in a run from which flutter is noted."""
UNKNOWNS = 20000
"""Number of unknowns up to which sliding bodies are examined for flutter."""
UNRESOLVED = 4.0
"""Product of angular frequency and slab length above which a vibration is not resolved, and a filter stops it."""
USUAL, MARGIN = 0.2, 1.5
"""Usual filter, and factor of the least one that stops a vibration."""


def velocity_notes(model: Model) -> tuple[Note, ...]:
    """Notes on the solids whose initial velocity differs from that of their supports, which have precedence.

    Nodes whose given velocity is zero are not meant, a driven support sets them in motion; nor are massless nodes.
    """
    if not model.inert:
        return ()
    notes = []
    start = model.velocity + model.prescribed(0.0)
    for part in model.parts:
        solid = model.scene.bodies[part.name]
        if not isinstance(solid, Solid):
            continue
        given = sample(solid.velocity, part.mesh)
        other = np.abs(given - start[part.nodes]) > MOTION * np.abs(given).max()
        changed = other & (given != 0.0) & model.massive[part.nodes, None]
        if changed.any():
            notes.append(_note(model, part, solid, given, np.where(changed, start[part.nodes], given)))
    return tuple(notes)


def _note(model: Model, part: DiscreteSolid, solid: Solid, given: Array, taken: Array) -> Note:
    """Note on a solid that starts with the velocities ``taken`` (n, d) in place of those ``given`` (n, d)."""
    changed = given != taken
    found = [(k, s) for k, s in enumerate(solid.supports) if (changed & supported_components(s, part.mesh)).any()]
    names = " and ".join(f"supports[{k}] on {s.on!r}" for k, s in found)
    mass = model.mass[part.nodes, part.nodes]
    energies = [0.5 * float(np.einsum("ni,ni->", v, mass @ v)) for v in (given, taken)]
    momenta = [float(np.linalg.norm((mass @ v).sum(axis=0))) for v in (given, taken)]
    count = int(changed.any(axis=1).sum())
    problem = (
        f"{names} {'holds' if len(found) == 1 else 'hold'} {count} nodes with a velocity, which start with that of the "
        f"support: the body starts with {energies[1]:.4g} J and {momenta[1]:.4g} N s, not {energies[0]:.4g} J and "
        f"{momenta[0]:.4g} N s"
    )
    driven = any(isinstance(s, Driven | Guided) for _, s in found)
    remedy = "nothing, if this is meant; or a field with the velocity of the support there"
    if not driven:
        remedy += f', such as kind = "Profile" with zero on {found[0][1].on!r}'
    return Note(where=f"bodies.{part.name}.velocity", problem=problem, remedy=remedy)


def flutter_notes(model: Model, state: ModelState, span: float, end: float) -> tuple[Note, ...]:
    """Note on bodies that slide from the start and whose vibrations grow under friction until the ``end`` [s], in slabs
    of length ``span`` [s]; bodies with a history, which may damp them, are not examined.
    """
    if model.dofs.size > UNKNOWNS or any(part.internal.path_dependent for part in model.parts):
        return ()
    try:
        modes = sliding_flutter(model, state)
    except RuntimeError:  # rows that depend on each other
        return ()
    calm = model.timing.calm if isinstance(model.timing, Energy) else 0.0
    worst = max(modes, key=lambda mode: mode.in_slabs(span, calm), default=None)
    factor = 1.0 if worst is None else worst.in_slabs(span, calm)
    folds = float(np.log(factor) * end / span)
    if worst is None or folds < np.log(LOUD):
        return ()
    first = int(model.contacts.contact[np.flatnonzero(state.closed & state.sliding)[0]])
    problem = (
        f"the sliding body flutters: friction makes a vibration of {worst.frequency / (2.0 * np.pi):.3g} Hz grow by "
        f"{factor - 1.0:.2g} of its amplitude in a slab, and 1e{folds / np.log(10.0):.0f} times until "
        "the end if it slides so long"
    )
    if calm > 0.0 and span * worst.frequency < UNRESOLVED:
        problem += f"; calm = {calm:g} does not stop it, as slabs of {span:.3g} s resolve it"
    most = max(mode.damping_time for mode in modes)
    remedy = f"nothing, if this is meant; or the material Kelvin, with viscosities above {most:.2g} s times its moduli"
    remedy += _filter(model, modes, span)
    return (Note(where=f"contacts[{model.declared[first]}].friction", problem=problem, remedy=remedy),)


def _filter(model: Model, modes: Sequence[Flutter], span: float) -> str:
    """The filter of the velocity as a remedy for vibrations in slabs of length ``span`` [s], none of which is resolved;
    else, and with another rule or rigid bodies, empty.
    """
    enough = max(USUAL, np.ceil(10.0 * MARGIN * max(mode.stopping_calm(span) for mode in modes)) / 10.0)
    resolved = any(span * mode.frequency < UNRESOLVED for mode in modes)
    if resolved or enough > 1.0 or model.rigid is not None or not isinstance(model.timing, Energy):
        return ""
    return f"; or, as the slabs do not resolve it, the timing Energy with calm = {enough:.1g}"
