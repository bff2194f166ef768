"""The march of the penalty method: slab after slab, halved where one fails."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from softway.contact.contact import DualMortar
from softway.contact.timing import Impulse
from softway.errors import Cancel, NoConvergence, NumericsError, heed
from softway.march.control import StepControl
from softway.march.situation import joined
from softway.model import build
from softway.race.penalty import Penalised, Penalty, Pressed, depths, solved
from softway.race.springs import springs, workshop
from softway.scene import Scene, State


def penalised(
    scene: Scene,
    state: State,
    until: float,
    span: float,
    method: Penalty,
    control: StepControl,
    cancel: Cancel | None = None,
) -> tuple[Penalised, Pressed, Iterator[Pressed]]:
    """What is marched, its start, and its slabs up to the time ``until``.

    Parameters
    ----------
    scene
        What moves; its contact nodes keep their inertia whatever rule it asks for.
    state
        Where to begin.
    span
        Length of a slab [s].
    cancel
        Asked before every slab whether the caller wants no more.

    Raises
    ------
    NumericsError
        While it goes on, when a slab fails at every length that was tried.
    Cancelled
        While it goes on, if ``cancel`` says so.
    """
    contacts = tuple(
        replace(c, timing=Impulse(), method=None if isinstance(c.method, DualMortar) else c.method)
        for c in scene.contacts
    )
    model = build(replace(scene, contacts=contacts))
    met = model.encounters
    closed = {name: np.zeros(len(met.contact), bool)[met.of(k)] for k, name in enumerate(met.labels)}
    given = replace(state, closed=closed, pressure={name: np.zeros(len(c)) for name, c in closed.items()})
    start = joined(model, given).start
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
    """Slabs; one that fails is tried again at half the length, which then doubles again slab by slab."""
    shop, length, rejected, reason = workshop(rules.model), span, 0, ""
    while now.time < until - 1e-9 * span:
        heed(cancel, now.time)
        if length <= rules.control.least * span:
            raise NumericsError(f"no slab holds, the last of {rejected} tries with {reason}", now.time)
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
