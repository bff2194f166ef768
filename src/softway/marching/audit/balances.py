"""Energies and momenta of a state, and the contact forces that they ask for, computed again from the fields."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from softway.arrays import Array
from softway.bodies.discretised import UNSTRAINED
from softway.bodies.elements.section import Axisymmetric
from softway.marching.audit.ledger import momentum, spin
from softway.marching.audit.rigid_balances import rigid_balances
from softway.marching.results.step import Step
from softway.marching.state.model_state import join_states
from softway.mechanisms.members.springs import TorsionSpring
from softway.model.model import Model
from softway.model.scene import State
from softway.solve.equations.spin_balance import moment

PLACES = 16.0 * float(np.finfo(float).eps)
"""Rounding error of positions, relative to the coordinates, after the sums that yield forces."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Balances:
    """Energies, momentum and spin of a state, from its fields.

    Parameters
    ----------
    kinetic, strain
        Energies [J]; no strain with torsion springs, whose turns a state does not tell.
    momentum, moving
        Momentum (3,), and sum of the sizes of the momenta of all nodes [kg m/s].
    spin, turning
        Spin (3,) about the origin, and sum of the sizes of its parts [kg m^2/s].
    """

    kinetic: float
    strain: float | None
    momentum: Array
    moving: float
    spin: Array
    turning: float


def balances(model: Model, state: State) -> Balances:
    """Balances of the bodies of a model: the strain energy is evaluated from the displacements and the memory."""
    joined = join_states(model, state)
    now, rigid = joined.start, rigid_balances(model, joined, joined)
    momenta = model.mass @ now.velocity
    members = () if model.scene.mechanism is None else model.scene.mechanism.springs
    told = not any(isinstance(spring, TorsionSpring) for spring in members)
    return Balances(
        kinetic=0.5 * model.space.dot(now.velocity, momenta) + rigid.kinetic,
        strain=float(now.energy.sum()) + rigid.springs if told else None,
        momentum=momentum(model.space, momenta) + rigid.momentum,
        moving=model.space.total(np.abs(momenta)) + rigid.moving,
        spin=spin(model, now.displacement, momenta) + rigid.spin,
        turning=_turning(model, model.points + now.displacement, momenta) + rigid.turning,
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Pushed:
    """Contact forces that a body needs over a slab for its change of momentum and of spin.

    Parameters
    ----------
    resultant, scale
        Resultant (d,) of the forces, and sum of the sizes of its parts [N].
    moment, turning
        Moment (k,) of the forces about the middle of the body, and sum of the sizes of its parts [N m]; none in 1D and
        around an axis of revolution.
    arm
        Greatest distance of a node from the middle of the body [m].
    rounding
        Force that rounding of positions makes in the body at rest [N].
    """

    resultant: Array
    scale: float
    moment: Array
    turning: float
    arm: float
    rounding: float


def contact_forces(model: Model, step: Step) -> Mapping[tuple[str, ...], Pushed]:
    """Mean contact force that each body needs for its change of momentum, besides its loads and supports; of bodies
    that ties glue together that of all of them.

    The radial direction of axisymmetric bodies is left out, and so is their spin. Bodies that companion fields push on
    are not looked at.
    """
    if model.companions or step.report.scalars is None:
        return {}
    slab = model.pushed(step.slab.start, step.slab.end)
    load = slab.slab_load(np.array([step.report.scalars[p.name] for p in model.parts]))
    states = step.before, step.after
    momenta = [model.mass @ model.join(state.velocity) / step.slab.span for state in states]
    places = [model.points + model.join(state.displacement) for state in states]
    blurred, out = rounding_forces(model, model.join(step.after.displacement)), {}
    held = model.join(step.reactions)
    for group in dict.fromkeys(model.linked.tolist()):
        parts = [p for p, of in zip(model.parts, model.linked, strict=True) if of == group]
        here = np.concatenate([np.arange(p.nodes.start, p.nodes.stop) for p in parts])
        before, after = (p[here] for p in momenta)
        x0, x1 = (x[here] for x in places)
        given = load[here] + held[here]
        terms = ((x1, after), (x0, -before), (0.5 * (x0 + x1), -given))
        found = _pushed(model, parts[0].internal.section, terms, model.space.total(blurred[here]))
        out[tuple(p.name for p in parts)] = found
    return out


def rounding_forces(model: Model, u: Array) -> Array:
    """Forces (n,) that the rounding of positions makes at the nodes, with displacements u (n, d) [N]."""
    stiffness = model.floor / UNSTRAINED**2 / model.space.totals(np.ones(len(model.part_of)))
    return np.asarray(PLACES * model.extent(u) * stiffness[model.part_of] / model.edge**2)


def _pushed(model: Model, section: object, terms: Sequence[tuple[Array, Array]], rounding: float) -> Pushed:
    """Sums of forces (n, d) at places (n, d) on one body: the changes of its momenta, less what is given."""
    space, keep = model.space, np.ones(model.shape[1])
    keep[0] = not isinstance(section, Axisymmetric)
    found: Array = np.zeros(0)
    turning = arm = 0.0
    if model.shape[1] > 1 and keep.all():
        middle = space.sums(terms[0][0]) / space.total(np.ones(len(terms[0][0])))
        about = [(x - middle, force) for x, force in terms]
        found = np.asarray(sum(moment(space, x, force) for x, force in about))
        turning = sum(_turning(model, x, force) for x, force in about)
        arm = max(space.greatest(np.linalg.norm(x, axis=1)) for x, _ in about)
    return Pushed(
        resultant=np.asarray(sum(space.sums(force) for _, force in terms) * keep),
        scale=sum(space.total(np.abs(force)) for _, force in terms),
        moment=found,
        turning=turning,
        arm=arm,
        rounding=rounding,
    )


def _turning(model: Model, x: Array, force: Array) -> float:
    """Sum of the products of the sizes of places (n, d) and of forces or momenta (n, d) there; zero in 1D."""
    if model.shape[1] == 1:
        return 0.0
    return model.space.total(np.linalg.norm(x, axis=1) * np.linalg.norm(force, axis=1))
