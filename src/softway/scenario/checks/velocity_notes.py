"""Notes on initial velocities that supports take away."""

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import DiscreteSolid, supported_components
from softway.bodies.setup.initial_fields import sample
from softway.bodies.solid import Driven, Guided, Solid
from softway.errors import Note
from softway.model.model import Model
from softway.tolerances import MOTION


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
