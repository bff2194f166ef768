"""March of the penalty method; a slab that fails is halved."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from softway.contact.contact import DualMortar
from softway.contact.impact_rule import Impulse
from softway.errors import Cancel, InputError, NoConvergence, NumericsError, heed
from softway.heat.coupled.build import build
from softway.marching.state.model_state import join_states
from softway.marching.state.step_control import StepControl
from softway.model.scene import Scene, State
from softway.studies.race.penalty import Penalised, Penalty, Pressed, depths, solved
from softway.studies.race.springs import springs, workshop


def penalised(
    scene: Scene,
    state: State,
    until: float,
    span: float,
    method: Penalty,
    control: StepControl,
    cancel: Cancel | None = None,
) -> tuple[Penalised, Pressed, Iterator[Pressed]]:
    """Prepare a penalty march: its fixed data, the initial slab state, and an iterator over slabs up to time ``until``.

    Parameters
    ----------
    scene
        Scene; its contact nodes keep their mass whatever its contact rule.
    state
        Initial state.
    span
        Length of a slab [s].
    cancel
        Function that returns True to stop; called before every slab.

    Raises
    ------
    InputError
        If a contact is of more than two bodies, or of one with itself, or a tie breaks.
    NumericsError
        During the iteration, if a slab fails with every length.
    Cancelled
        During the iteration, if ``cancel`` returns True.
    """
    for k, contact in enumerate(scene.contacts):
        if contact.many or len(set(contact.bodies)) == 1:
            raise InputError(f"contacts[{k}].between", f"{contact.label!r} in a race", "contacts of two bodies")
    _require_permanent(scene)
    contacts = tuple(
        replace(c, timing=Impulse(), method=None if isinstance(c.method, DualMortar) else c.method)
        for c in scene.contacts
    )
    model = build(replace(scene, contacts=contacts))
    met = model.contacts
    closed = {name: np.zeros(len(met.contact), bool)[met.rows_of(k)] for k, name in enumerate(met.labels)}
    given = replace(state, closed=closed, pressure={name: np.zeros(len(c)) for name, c in closed.items()})
    start = join_states(model, given).start
    rules = Penalised(model=model, method=method, control=control, springs=springs(model, method.stiffness))
    energy, force = model.energy_and_force(start.displacement)
    depth, gap = depths(model.rows(start.displacement, state.time), start.displacement)
    pressure = rules.springs * np.maximum(depth, 0.0)
    stored = 0.5 * float(pressure @ np.maximum(depth, 0.0))
    first = Pressed(
        time=state.time,
        displacement=start.displacement,
        velocity=start.velocity,
        acceleration=model.join(state.acceleration),
        force=force,
        pressure=pressure,
        energy=float(energy.sum()) + stored + float(model.kinetic(start.velocity).sum()),
        work=0.0,
        gap=gap,
    )
    return rules, first, _slabs(rules, first, until, span, cancel)


def _slabs(rules: Penalised, now: Pressed, until: float, span: float, cancel: Cancel | None) -> Iterator[Pressed]:
    """Iterate over slabs; a failed slab is halved, and the length then doubles from slab to slab."""
    shop, length, rejected, reason = workshop(rules.model), span, 0, ""
    while now.time < until - 1e-9 * span:
        heed(cancel, now.time)
        if length <= rules.control.least * span:
            raise NumericsError(f"no time step was accepted after {rejected} cutbacks; last: {reason}", now.time)
        last = until - now.time - length < 1e-9 * span
        end = until if last else now.time + length
        try:
            found, shop = solved(rules, now, end, shop)
        except NoConvergence as failure:
            length, rejected, reason = 0.5 * (end - now.time), rejected + 1, str(failure)
            continue
        now = replace(found, factorisations=shop.made, rejected=rejected)
        yield now
        length, rejected = min(span, length if rejected else 2.0 * length), 0


def _require_permanent(scene: Scene) -> None:
    """Refuse ties that break: these marches evaluate the forces of solids and contacts only."""
    for k, tie in enumerate(scene.ties):
        if tie.breaks is not None:
            raise InputError(f"ties[{k}].breaks", f"{tie.label!r} in a race", "a tie without breaks")
